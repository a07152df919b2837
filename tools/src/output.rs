//! Writing results: a file appears whole or not at all.

use crate::npy;
use anyhow::{Context, Result, ensure};
use serde::Serialize;
use std::fmt::Display;
use std::fs;
use std::io::{self, Cursor, ErrorKind, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

/// Where a result goes.
#[derive(Debug)]
pub(crate) enum Target {
    /// Standard output.
    Stdout,
    /// A file.
    File(PathBuf),
}

impl Target {
    /// The file at `path`; that it can be written is found out now, not after minutes of sampling.
    pub(crate) fn file(path: &Path) -> Result<Self> {
        // Through a symbolic link: the rename would replace the link itself.
        let file = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        let cannot = || format!("cannot write {}", path.display());
        ensure!(!file.is_dir(), "{}: it is a folder", cannot());
        if !is_special(&file) {
            temporary(&file).with_context(cannot)?;
        }
        Ok(Self::File(file))
    }

    /// Writes all of `bytes`.
    pub(crate) fn write(&self, bytes: &[u8]) -> Result<()> {
        match self {
            Self::Stdout => print(bytes),
            Self::File(path) => write(path, bytes).with_context(|| format!("cannot write {}", path.display())),
        }
    }
}

/// Writes figures as JSON to `json`, and as a table to standard output unless the JSON goes there.
pub(crate) fn report<F: Serialize + Display>(figures: &F, json: Option<&Target>) -> Result<()> {
    if let Some(target) = json {
        target.write(&self::json(figures)?)?;
    }
    match json {
        Some(Target::Stdout) => Ok(()),
        _ => print(figures.to_string().as_bytes()),
    }
}

/// Figures as a JSON file.
pub(crate) fn json<F: Serialize>(figures: &F) -> Result<Vec<u8>> {
    let mut text = serde_json::to_vec_pretty(figures)?;
    text.push(b'\n');
    Ok(text)
}

/// Writes to standard output; a reader who has seen enough is no failure.
fn print(bytes: &[u8]) -> Result<()> {
    let mut stdout = io::stdout().lock();
    match stdout.write_all(bytes).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(error).context("cannot write to standard output"),
        _ => Ok(()),
    }
}

/// The .npz file of some columns.
pub(crate) fn npz(columns: &[(&str, &[f32])]) -> Result<Vec<u8>> {
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, column) in columns {
        zip.start_file(format!("{name}.npy"), SimpleFileOptions::default())?;
        zip.write_all(&npy::encode(column))?;
    }
    Ok(zip.finish()?.into_inner())
}

fn write(path: &Path, bytes: &[u8]) -> io::Result<()> {
    if is_special(path) {
        return fs::OpenOptions::new().write(true).open(path)?.write_all(bytes);
    }
    let mut file = temporary(path)?;
    file.write_all(bytes)?;
    file.as_file().sync_all()?;
    file.persist(path)?;
    Ok(())
}

/// A device or a pipe: it is written to, never replaced.
fn is_special(path: &Path) -> bool {
    fs::metadata(path).is_ok_and(|metadata| !metadata.is_file())
}

/// A file in the folder of `path`, which vanishes unless it is renamed to it.
fn temporary(path: &Path) -> io::Result<NamedTempFile> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut builder = tempfile::Builder::new();
    builder.prefix(".airlight-");
    #[cfg(unix)]
    {
        // As any new file: what the umask leaves.
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(folder)
}
