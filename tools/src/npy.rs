//! NumPy's .npy format, as far as a column needs it: one dimension of little-endian float32.

use anyhow::{Context, Result, bail, ensure};

const MAGIC: &[u8] = b"\x93NUMPY";
const FLOAT32: &str = "<f4";

/// The column that is held in `file`.
pub(crate) fn decode(file: &[u8]) -> Result<Vec<f32>> {
    let (header, data) = split(file).context("not a complete .npy file")?;
    let header = std::str::from_utf8(header).context("the .npy header is not text")?;

    let dtype = entry(header, "descr").context("the .npy header has no 'descr'")?;
    ensure!(dtype == FLOAT32, "dtype is {}, expected little-endian float32 ('{FLOAT32}')", spoken(dtype));

    let shape = entry(header, "shape").context("the .npy header has no 'shape'")?;
    let lengths: Vec<&str> = shape.split(',').map(str::trim).filter(|length| !length.is_empty()).collect();
    let [length] = lengths[..] else { bail!("has {} dimensions, expected 1", lengths.len()) };
    let length: usize = length.parse().with_context(|| format!("the .npy header has the shape ({shape})"))?;

    let (values, rest) = data.as_chunks();
    ensure!(
        values.len() == length && rest.is_empty(),
        "holds {} bytes of data, expected {length} values of 4",
        data.len()
    );
    Ok(values.iter().map(|&value| f32::from_le_bytes(value)).collect())
}

/// The .npy file of a column.
pub(crate) fn encode(column: &[f32]) -> Vec<u8> {
    const ALIGNMENT: usize = 64;
    let mut header = format!("{{'descr': '{FLOAT32}', 'fortran_order': False, 'shape': ({},), }}", column.len());
    let start = MAGIC.len() + 4;
    // Spaces and a line feed, so that the data are aligned.
    let padded = (start + header.len() + 1).next_multiple_of(ALIGNMENT) - start;
    header.push_str(&" ".repeat(padded - 1 - header.len()));
    header.push('\n');
    let length = u16::try_from(header.len()).expect("a short header");

    let mut file = [MAGIC, &[1, 0], &length.to_le_bytes(), header.as_bytes()].concat();
    file.extend(column.iter().flat_map(|value| value.to_le_bytes()));
    file
}

/// Header and data. Version 1 counts the header's bytes in 16 bits, later ones in 32.
fn split(file: &[u8]) -> Option<(&[u8], &[u8])> {
    let (&[major, _minor], rest) = file.strip_prefix(MAGIC)?.split_first_chunk()?;
    let (length, rest) = if major == 1 {
        let (length, rest) = rest.split_first_chunk()?;
        (usize::from(u16::from_le_bytes(*length)), rest)
    } else {
        let (length, rest) = rest.split_first_chunk()?;
        (usize::try_from(u32::from_le_bytes(*length)).ok()?, rest)
    };
    rest.split_at_checked(length)
}

/// What the header, a Python dictionary, holds under `key`: a string or a tuple without its delimiters, or the text of
/// anything else.
fn entry<'a>(header: &'a str, key: &str) -> Option<&'a str> {
    let at = ['\'', '"'].iter().find_map(|quote| {
        let quoted = format!("{quote}{key}{quote}");
        header.find(&quoted).map(|at| at + quoted.len())
    })?;
    let value = header[at..].trim_start().strip_prefix(':')?.trim_start();
    let (end, inner) = match value.chars().next()? {
        quote @ ('\'' | '"') => (quote, &value[1..]),
        '(' => (')', &value[1..]),
        '[' => return Some(value.split_inclusive(']').next().unwrap_or(value)),
        _ => (',', value),
    };
    inner.split(end).next()
}

/// A dtype by its name and as it stands in the file: `>f4` is "big-endian float32 ('>f4')".
fn spoken(dtype: &str) -> String {
    let mut letters = dtype.chars();
    let order = match letters.next() {
        Some('>') => "big-endian ",
        Some('<' | '|' | '=') => "",
        _ => return format!("structured ({dtype})"),
    };
    let kind = match letters.next() {
        Some('f') => "float",
        Some('i') => "int",
        Some('u') => "uint",
        Some('c') => "complex",
        Some('b') => "bool",
        _ => return format!("'{dtype}'"),
    };
    match letters.as_str().parse::<u32>() {
        Ok(_) if kind == "bool" => format!("bool ('{dtype}')"),
        Ok(bytes) => format!("{order}{kind}{} ('{dtype}')", 8 * bytes),
        Err(_) => format!("'{dtype}'"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_column_survives_the_round_trip_and_is_aligned() {
        for length in [0, 1, 9, 10, 99_999, 100_000] {
            let column: Vec<f32> = (0..length).map(|i| i as f32 * 0.1).collect();
            let file = encode(&column);
            assert_eq!((file.len() - 4 * column.len()) % 64, 0);
            assert_eq!(decode(&file).unwrap(), column);
        }
    }

    #[test]
    fn headers_of_other_writers_are_read() {
        let header = "{\"shape\":(2,),\"fortran_order\":False,\"descr\":\"<f4\"}\n";
        let length = u32::try_from(header.len()).unwrap().to_le_bytes();
        let mut file = [MAGIC, &[2, 0], &length, header.as_bytes()].concat();
        file.extend([1f32, 2.0].iter().flat_map(|value| value.to_le_bytes()));
        assert_eq!(decode(&file).unwrap(), [1.0, 2.0]);
    }

    #[test]
    fn dtypes_are_spoken() {
        assert_eq!(spoken(">f4"), "big-endian float32 ('>f4')");
        assert_eq!(spoken("<i8"), "int64 ('<i8')");
        assert_eq!(spoken("|b1"), "bool ('|b1')");
        assert_eq!(spoken("|O"), "'|O'");
        assert_eq!(spoken("[('x', '<f4')]"), "structured ([('x', '<f4')])");
    }

    #[test]
    fn no_prefix_of_a_file_is_a_column() {
        let file = encode(&[1.0, 2.0, 3.0]);
        for length in 0..file.len() {
            assert!(decode(&file[..length]).is_err(), "{length} of {} bytes", file.len());
        }
    }
}
