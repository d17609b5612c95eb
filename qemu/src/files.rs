use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};

use crate::{Error, LogLine, decode};

/// How QEMU tells where a pseudo-terminal is.
const REDIRECTED: &str = "char device redirected to ";
/// How it tells that a paced guest is behind the wall; the line ends with [`LATE_END`].
const LATE: &str = "Warning: The guest is now late by ";
const LATE_END: &str = " seconds\n";

/// The files of a run, in a folder of its own.
#[derive(Debug)]
pub(crate) struct RunFiles {
    folder: tempfile::TempDir,
    pub(crate) console: RunFile,
    pub(crate) stdout: RunFile,
    pub(crate) stderr: RunFile,
}

/// A file of the run.
#[derive(Debug)]
pub(crate) struct RunFile {
    pub(crate) path: PathBuf,
}

impl RunFiles {
    pub(crate) fn new() -> Result<Self, Error> {
        let folder = tempfile::tempdir().map_err(Error::Qemu)?;
        let file = |name| RunFile::new(folder.path(), name);
        Ok(Self {
            console: file("console"),
            stdout: file("stdout"),
            stderr: file("stderr"),
            folder,
        })
    }

    pub(crate) fn folder(&self) -> &Path {
        self.folder.path()
    }

    /// What the guest has logged so far, as it came.
    ///
    /// QEMU sends a guest's `:tt` to the semihosting chardev or, 7.2 does, to its own standard output; there it tells
    /// of pseudo-terminals and of delays, too.
    pub(crate) fn log_bytes(&self) -> Result<Vec<u8>, Error> {
        let mut bytes = self.console.read_if_there()?;
        let stdout = self.stdout.read_if_there()?;
        bytes.extend(of_guest(&stdout));
        Ok(bytes)
    }

    /// The same, decoded.
    pub(crate) fn log(&self, image: &Path) -> Result<Vec<LogLine>, Error> {
        decode(image, &self.log_bytes()?)
    }

    /// Where QEMU has put the pseudo-terminal of that name, if it has.
    pub(crate) fn pty(&self, name: &str) -> Result<Option<PathBuf>, Error> {
        let stdout = self.stdout.read_if_there()?;
        let text = String::from_utf8_lossy(&stdout);
        let mut paths = text.lines().filter_map(|line| {
            let (path, label) = line.strip_prefix(REDIRECTED)?.split_once(' ')?;
            (label == format!("(label {name})")).then(|| PathBuf::from(path))
        });
        Ok(paths.next())
    }
}

/// What of QEMU's standard output is the guest's.
fn of_guest(mut stdout: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    while let Some((byte, rest)) = stdout.split_first() {
        let told = [(REDIRECTED, ")\n"), (LATE, LATE_END)];
        let told = told.into_iter().find_map(|(begin, end)| {
            let rest = stdout.strip_prefix(begin.as_bytes())?;
            let at = rest
                .windows(end.len())
                .position(|part| part == end.as_bytes())?;
            Some(&rest[at + end.len()..])
        });
        stdout = told.unwrap_or_else(|| {
            bytes.push(*byte);
            rest
        });
    }
    bytes
}

impl RunFile {
    pub(crate) fn new(folder: &Path, name: &str) -> Self {
        Self {
            path: folder.join(name),
        }
    }

    pub(crate) fn create(&self) -> Result<File, Error> {
        File::create(&self.path).map_err(|source| Error::file(&self.path, source))
    }

    /// QEMU makes its files only when it starts for good.
    pub(crate) fn read_if_there(&self) -> Result<Vec<u8>, Error> {
        match fs::read(&self.path) {
            Err(e) if e.kind() == io::ErrorKind::NotFound => Ok(Vec::new()),
            read => read.map_err(|source| Error::file(&self.path, source)),
        }
    }

    pub(crate) fn read_text(&self) -> Result<String, Error> {
        let bytes = self.read_if_there()?;
        Ok(String::from_utf8_lossy(&bytes).into_owned())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_qemu_tells_is_kept_out_of_the_log() {
        let files = RunFiles::new().unwrap();
        let lines = "char device redirected to /dev/pts/3 (label uart0)\n\
                     char device redirected to /dev/pts/4 (label uart1)\n";
        let mut bytes = lines.as_bytes().to_vec();
        bytes.extend([0x7f, b'\n']);
        bytes.extend(b"Warning: The guest is now late by 0.2 to 0.3 seconds\n\0");
        fs::write(&files.stdout.path, &bytes).unwrap();
        let pty = |name| files.pty(name).unwrap();
        assert_eq!(pty("uart1"), Some(PathBuf::from("/dev/pts/4")));
        assert_eq!(pty("uart2"), None);
        assert_eq!(files.log_bytes().unwrap(), [0x7f, b'\n', 0]);
    }
}
