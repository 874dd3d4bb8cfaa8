//! Files that appear whole or not at all: written under another name in the same folder, then renamed.

use super::unfinished::{self, Registration};
use crate::{Error, Result};
use std::fs::{self, File, OpenOptions, Permissions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// Finds out early whether [`write_atomically`] could write this file, and leaves nothing behind: folders that are
/// missing are not made yet, but the nearest one above must allow new entries.
///
/// # Errors
/// [`Error::File`] with `action`, such as "write the picture".
pub fn check_writable(action: &'static str, path: &Path) -> Result<()> {
    let check = || -> io::Result<()> {
        let target = Target::find(path)?;
        let mut folder = target.folder();
        while let Err(error) = fs::metadata(folder) {
            match folder.parent() {
                Some(parent) if error.kind() == io::ErrorKind::NotFound => folder = or_current(parent),
                _ => return Err(error),
            }
        }
        temporary_file(folder, "", None).map(drop)
    };
    check().map_err(|source| Error::file(action, path, source))
}

/// Lets `write` fill a new file that then takes the place of `path`; see [`AtomicFile`].
///
/// # Errors
/// [`Error::File`] with `action`; an existing file is then as it was, and no temporary one is left.
pub fn write_atomically(
    action: &'static str,
    path: &Path,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<()> {
    let fill = || -> io::Result<AtomicFile> {
        let file = AtomicFile::create(path, "")?;
        let mut out = BufWriter::new(file.handle()?);
        write(&mut out)?;
        out.flush()?;
        Ok(file)
    };
    fill().and_then(AtomicFile::commit).map_err(|source| Error::file(action, path, source))
}

/// A file in the making, under a temporary name in the folder of the one that it will be.
pub struct AtomicFile {
    target: Target,
    file: NamedTempFile,
    registration: Registration,
}

impl AtomicFile {
    /// Begins a file whose temporary name ends in `suffix`. Missing folders are made. A new file gets the permissions
    /// of any created file (the process's umask), a replaced one keeps its own.
    ///
    /// # Errors
    /// Where the folder takes no new file, or the file may not be replaced.
    pub fn create(path: &Path, suffix: &str) -> io::Result<Self> {
        let target = Target::find(path)?;
        fs::create_dir_all(target.folder())?;
        let (file, registration) = unfinished::register(|| {
            let file = temporary_file(target.folder(), suffix, target.permissions.clone())?;
            let temporary = file.path().to_owned();
            Ok::<_, io::Error>((file, Box::new(move || drop(fs::remove_file(&temporary))) as _))
        })?;
        Ok(AtomicFile { target, file, registration })
    }

    /// A handle to write to.
    ///
    /// # Errors
    /// Where the system has no more.
    pub fn handle(&self) -> io::Result<File> {
        self.file.as_file().try_clone()
    }

    /// The temporary name, for other programs that write the file.
    pub fn temporary_path(&self) -> &Path {
        self.file.path()
    }

    /// Gives the file its name, and takes that of an existing one.
    ///
    /// # Errors
    /// Where the system refuses; an existing file is then as it was, and the temporary one is gone.
    pub fn commit(self) -> io::Result<()> {
        let AtomicFile { target, file, registration } = self;
        registration.finish(|| file.persist(&target.path).map(drop).map_err(|error| error.error))
    }
}

/// The file to replace, with symbolic links followed: the link stays, and what it points to is replaced.
struct Target {
    path: PathBuf,
    permissions: Option<Permissions>,
}

impl Target {
    fn find(path: &Path) -> io::Result<Target> {
        if path.file_name().is_none() {
            return Err(io::Error::new(io::ErrorKind::InvalidInput, "the path names no file"));
        }
        match fs::metadata(path) {
            Ok(metadata) if metadata.is_file() => {
                // Renaming would replace a file that may not be written to; opening it asks the right question.
                OpenOptions::new().write(true).open(path)?;
                Ok(Target { path: fs::canonicalize(path)?, permissions: Some(metadata.permissions()) })
            }
            Ok(metadata) if metadata.is_dir() => Err(io::Error::new(io::ErrorKind::IsADirectory, "it is a folder")),
            Ok(_) => Err(io::Error::new(io::ErrorKind::InvalidInput, "it is not a regular file")),
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                Ok(Target { path: path.to_owned(), permissions: None })
            }
            Err(error) => Err(error),
        }
    }

    fn folder(&self) -> &Path {
        or_current(self.path.parent().unwrap_or(Path::new("")))
    }
}

/// The parent of a bare file name is the empty path, which the file system does not know.
fn or_current(folder: &Path) -> &Path {
    if folder.as_os_str().is_empty() { Path::new(".") } else { folder }
}

/// A file in this folder that is removed when dropped. Without given permissions it gets those of any created file,
/// where tempfile's default is that nobody else may read it.
fn temporary_file(folder: &Path, suffix: &str, permissions: Option<Permissions>) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".gpu-trace-").suffix(suffix);
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    let file = builder.tempfile_in(folder).map_err(without_path)?;
    if let Some(permissions) = permissions {
        file.as_file().set_permissions(permissions)?;
    }
    Ok(file)
}

/// The system's own error: tempfile wraps it with the temporary file's name, which means nothing to the user.
fn without_path(error: io::Error) -> io::Error {
    let inner =
        error.get_ref().and_then(|wrapper| wrapper.source()).and_then(|source| source.downcast_ref::<io::Error>());
    inner.and_then(io::Error::raw_os_error).map_or(error, io::Error::from_raw_os_error)
}
