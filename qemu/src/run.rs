use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread;
use std::time::{Duration, Instant};
use std::{fmt, path};

use crate::{Error, LogLine, decode};

/// The emulator, as it is called on the path and as Debian calls its package.
pub const QEMU: &str = "qemu-system-arm";
/// QEMU takes no larger one: 1 µs an instruction.
pub const LARGEST_SHIFT: u32 = 10;
const MACHINE: &str = "mps2-an386";
const POLL: Duration = Duration::from_millis(5);

/// One run of an image.
#[derive(Clone, Debug)]
pub struct Run {
    /// The ELF file; [`crate::build`] makes it.
    pub image: PathBuf,
    /// One instruction takes 2^shift ns of virtual time; 0 to [`LARGEST_SHIFT`].
    pub shift: u32,
    /// Words for the guest's command line.
    pub args: Vec<String>,
    /// Wall time after which the guest is killed.
    pub timeout: Duration,
}

/// What a run left.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Output {
    /// The guest's exit code.
    pub exit_code: i32,
    /// The guest's log, decoded.
    pub log_lines: Vec<LogLine>,
    /// The same, as it came: equal bytes mean equal runs.
    pub log_bytes: Vec<u8>,
    /// What the guest sent on UART 0.
    pub uart: String,
    /// What QEMU itself had to say.
    pub stderr: String,
}

impl fmt::Display for Output {
    /// Log, UART and QEMU's words, for a person to read.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for line in &self.log_lines {
            writeln!(f, "{line}")?;
        }
        write!(f, "{}{}", self.uart, self.stderr)
    }
}

impl Run {
    /// A run at shift 3 without arguments, killed after two minutes.
    pub fn new(image: PathBuf) -> Self {
        Self {
            image,
            shift: 3,
            args: Vec::new(),
            timeout: Duration::from_secs(120),
        }
    }

    /// Sets the virtual time of an instruction to 2^`shift` ns; 0 to [`LARGEST_SHIFT`].
    #[must_use]
    pub fn shift(mut self, shift: u32) -> Self {
        self.shift = shift;
        self
    }

    /// Adds a word to the guest's command line; it must not have spaces.
    #[must_use]
    pub fn arg(mut self, word: impl Into<String>) -> Self {
        self.args.push(word.into());
        self
    }

    /// Sets the wall time after which the guest is killed.
    #[must_use]
    pub fn timeout(mut self, timeout: Duration) -> Self {
        self.timeout = timeout;
        self
    }

    /// Runs to the guest's exit.
    pub fn run(&self) -> Result<Output, Error> {
        // QEMU's own message for a missing kernel does not name the file.
        let image = path::absolute(&self.image)
            .and_then(|path| File::open(&path).map(|_| path))
            .map_err(|source| file_error(&self.image, source))?;
        let folder = tempfile::tempdir().map_err(Error::Qemu)?;
        let file = |name| RunFile::new(folder.path(), name);
        let (console, stdout, stderr) = (file("console"), file("stdout"), file("stderr"));
        let uart = file("uart");
        let child = self
            .command(&image, &console.path, &uart.path)
            .stdin(Stdio::null())
            .stdout(stdout.create()?)
            .stderr(stderr.create()?)
            .spawn()
            .map_err(|e| match e.kind() {
                io::ErrorKind::NotFound => Error::NoQemu,
                _ => Error::Qemu(e),
            })?;
        let status = wait(child, self.timeout).map_err(Error::Qemu)?;
        // QEMU sends a guest's `:tt` to the semihosting chardev or, 7.2 does, to its own standard output.
        let mut log_bytes = console.read_if_there()?;
        log_bytes.extend(stdout.read_if_there()?);
        let log_lines = decode(&image, &log_bytes)?;
        let Some(status) = status else {
            return Err(Error::Timeout {
                after: self.timeout,
                log: log_lines,
            });
        };
        let stderr = stderr.read_text()?;
        let Some(exit_code) = status.code() else {
            return Err(Error::Signal { stderr });
        };
        if exit_code != 0 && log_bytes.is_empty() && stderr.starts_with(QEMU) {
            return Err(Error::Refused { stderr });
        }
        Ok(Output {
            exit_code,
            log_lines,
            log_bytes,
            uart: uart.read_text()?,
            stderr,
        })
    }

    fn command(&self, image: &Path, console: &Path, uart: &Path) -> Command {
        // The log has a chardev of its own, and the UART keeps off standard output: other text would
        // damage it.
        let mut semihosting = "enable=on,target=native,chardev=console".to_owned();
        let name = image.file_stem().unwrap_or_default().to_string_lossy();
        for word in [name.as_ref()]
            .into_iter()
            .chain(self.args.iter().map(String::as_str))
        {
            semihosting.push_str(",arg=");
            semihosting.push_str(&escape_commas(word));
        }
        let mut command = Command::new(QEMU);
        command
            .args(["-machine", MACHINE, "-display", "none", "-monitor", "none"])
            .args(["-serial", "chardev:uart"])
            .arg("-icount")
            .arg(format!("shift={},align=off,sleep=off", self.shift))
            .args(["-chardev", &chardev("console", console)])
            .args(["-chardev", &chardev("uart", uart)])
            .args(["-semihosting-config", &semihosting])
            .arg("-kernel")
            .arg(image);
        command
    }
}

fn chardev(id: &str, path: &Path) -> String {
    format!(
        "file,id={id},path={}",
        escape_commas(&path.to_string_lossy())
    )
}

/// QEMU separates options by commas and takes two for one.
fn escape_commas(text: &str) -> String {
    text.replace(',', ",,")
}

fn file_error(path: &Path, source: io::Error) -> Error {
    Error::File {
        path: path.to_owned(),
        source,
    }
}

/// `None` if it did not end in time; it is dead in any case.
fn wait(mut child: Child, timeout: Duration) -> io::Result<Option<ExitStatus>> {
    let started = Instant::now();
    let ended = loop {
        match child.try_wait() {
            Ok(None) if started.elapsed() < timeout => thread::sleep(POLL),
            ended => break ended,
        }
    };
    if !matches!(ended, Ok(Some(_))) {
        child.kill()?;
        child.wait()?;
    }
    ended
}

/// A file of the run.
struct RunFile {
    path: PathBuf,
}

impl RunFile {
    fn new(folder: &Path, name: &str) -> Self {
        Self {
            path: folder.join(name),
        }
    }

    fn create(&self) -> Result<File, Error> {
        File::create(&self.path).map_err(|source| file_error(&self.path, source))
    }

    /// QEMU makes its files only when it starts for good.
    fn read_if_there(&self) -> Result<Vec<u8>, Error> {
        match fs::read(&self.path) {
            Err(e) if e.kind() == io::ErrorKind::NotFound => Ok(Vec::new()),
            read => read.map_err(|source| file_error(&self.path, source)),
        }
    }

    fn read_text(&self) -> Result<String, Error> {
        let bytes = self.read_if_there()?;
        Ok(String::from_utf8_lossy(&bytes).into_owned())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_line_has_instruction_time_and_escaped_words() {
        let run = Run::new(PathBuf::from("/t/axis")).shift(5).arg("moves=1,2");
        let command = run.command(
            &run.image,
            Path::new("/tmp/a,b/log"),
            Path::new("/tmp/uart"),
        );
        let words: Vec<_> = command.get_args().map(|w| w.to_string_lossy()).collect();
        let after = |option: &str| {
            let at = words.iter().position(|word| word == option);
            words[at.expect("option is there") + 1].as_ref()
        };
        assert_eq!(after("-icount"), "shift=5,align=off,sleep=off");
        assert_eq!(after("-chardev"), "file,id=console,path=/tmp/a,,b/log");
        assert_eq!(
            after("-semihosting-config"),
            "enable=on,target=native,chardev=console,arg=axis,arg=moves=1,,2"
        );
    }

    #[test]
    fn a_missing_image_is_named() {
        let error = Run::new(PathBuf::from("/no/such/image")).run().unwrap_err();
        assert!(error.to_string().starts_with("/no/such/image: "), "{error}");
    }

    #[test]
    fn what_does_not_end_is_killed() {
        let child = Command::new("sleep").arg("600").spawn().unwrap();
        assert_eq!(wait(child, Duration::from_millis(1)).unwrap(), None);
        let child = Command::new("false").spawn().unwrap();
        let status = wait(child, Duration::from_secs(60)).unwrap().unwrap();
        assert_eq!(status.code(), Some(1));
    }
}
