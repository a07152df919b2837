//! Files of columns and of wavefronts, as NumPy writes them.

use std::io::{Cursor, Write};
use zip::result::ZipResult;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

/// The columns of a wavefront of spots.
const COLUMNS: &str = "ox oy oz dx dy dz t_min t_max ex ey ez nx ny nz cos_outer cos_inner u";

/// The .npy file of a column of two values: a dtype, and their bytes.
#[must_use]
pub fn npy(dtype: &str, data: &[u8]) -> Vec<u8> {
    let header = format!("{{'descr': '{dtype}', 'fortran_order': False, 'shape': (2,), }}\n");
    let magic: &[u8] = b"\x93NUMPY\x01\x00";
    [magic, &[header.len() as u8, 0], header.as_bytes(), data].concat()
}

/// The .npz file of a wavefront, each of whose columns has the same .npy file.
///
/// # Errors
/// If the archive cannot be written.
pub fn npz(column: &[u8], compression: CompressionMethod) -> ZipResult<Vec<u8>> {
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    for name in COLUMNS.split(' ') {
        zip.start_file(format!("{name}.npy"), SimpleFileOptions::default().compression_method(compression))?;
        zip.write_all(column)?;
    }
    Ok(zip.finish()?.into_inner())
}
