use std::io;
use std::path::{self, Path, PathBuf};
use std::process::{Child, Command, Stdio};

use crate::files::RunFiles;
use crate::{Error, QEMU};

const MACHINE: &str = "mps2-an386";

/// A call of QEMU, as all runs make it.
#[derive(Clone, Debug)]
pub(crate) struct Call {
    pub(crate) image: PathBuf,
    /// One instruction takes 2^shift ns of virtual time.
    pub(crate) shift: u32,
    /// Never ahead of the wall.
    pub(crate) is_paced: bool,
    /// Words for the guest's command line.
    pub(crate) words: Vec<String>,
    /// Options of a chardev for each UART, from UART 0 on; `None` for nothing at its wire.
    pub(crate) uarts: Vec<Option<String>>,
}

impl Call {
    /// Starts it; log and words of QEMU go to `files`.
    pub(crate) fn spawn(&self, files: &RunFiles) -> Result<Child, Error> {
        // QEMU's own message for a missing kernel does not name the file.
        let image = path::absolute(&self.image)
            .and_then(|path| std::fs::File::open(&path).map(|_| path))
            .map_err(|source| Error::file(&self.image, source))?;
        if let Some(word) = self.words.iter().find(|word| word.contains(' ')) {
            return Err(Error::Word { word: word.clone() });
        }
        self.command(&image, &files.console.path)
            .stdin(Stdio::null())
            .stdout(files.stdout.create()?)
            .stderr(files.stderr.create()?)
            .spawn()
            .map_err(|e| match e.kind() {
                io::ErrorKind::NotFound => Error::NoQemu,
                _ => Error::Qemu(e),
            })
    }

    fn command(&self, image: &Path, console: &Path) -> Command {
        // The log has a chardev of its own, and the UART keeps off standard output: other text would
        // damage it.
        let mut semihosting = "enable=on,target=native,chardev=console".to_owned();
        let name = image.file_stem().unwrap_or_default().to_string_lossy();
        for word in [name.as_ref()]
            .into_iter()
            .chain(self.words.iter().map(String::as_str))
        {
            semihosting.push_str(",arg=");
            semihosting.push_str(&escape_commas(word));
        }
        let pace = if self.is_paced {
            "align=on"
        } else {
            "align=off,sleep=off"
        };
        let mut command = Command::new(QEMU);
        command
            .args(["-machine", MACHINE, "-display", "none", "-monitor", "none"])
            .arg("-icount")
            .arg(format!("shift={},{pace}", self.shift))
            .args(["-chardev", &file_chardev("console", console)])
            .args(["-semihosting-config", &semihosting]);
        for (number, uart) in self.uarts.iter().enumerate() {
            match uart {
                Some(options) => {
                    let (kind, rest) = options.split_once(',').unwrap_or((options, ""));
                    command
                        .args(["-chardev", &format!("{kind},id=uart{number},{rest}")])
                        .args(["-serial", &format!("chardev:uart{number}")]);
                }
                None => {
                    command.args(["-serial", "null"]);
                }
            }
        }
        command.arg("-kernel").arg(image);
        command
    }
}

/// Options of a chardev that writes a file, without its name.
pub(crate) fn file_uart(path: &Path) -> String {
    format!("file,path={}", escape_commas(&path.to_string_lossy()))
}

fn file_chardev(id: &str, path: &Path) -> String {
    format!(
        "file,id={id},path={}",
        escape_commas(&path.to_string_lossy())
    )
}

/// QEMU separates options by commas and takes two for one.
fn escape_commas(text: &str) -> String {
    text.replace(',', ",,")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(call: &Call) -> Vec<String> {
        let command = call.command(&call.image, Path::new("/tmp/a,b/log"));
        let words = command.get_args().map(|w| w.to_string_lossy().into_owned());
        words.collect()
    }

    fn after<'a>(words: &'a [String], option: &str) -> Vec<&'a str> {
        let pairs = words.windows(2).filter(|pair| pair[0] == option);
        pairs.map(|pair| pair[1].as_str()).collect()
    }

    #[test]
    fn the_command_line_has_instruction_time_and_escaped_words() {
        let call = Call {
            image: PathBuf::from("/t/axis"),
            shift: 5,
            is_paced: false,
            words: vec!["moves=1,2".to_owned()],
            uarts: vec![Some("pty".to_owned()), None],
        };
        let words = words(&call);
        assert_eq!(after(&words, "-icount"), ["shift=5,align=off,sleep=off"]);
        assert_eq!(
            after(&words, "-chardev"),
            ["file,id=console,path=/tmp/a,,b/log", "pty,id=uart0,"]
        );
        assert_eq!(after(&words, "-serial"), ["chardev:uart0", "null"]);
        assert_eq!(
            after(&words, "-semihosting-config"),
            ["enable=on,target=native,chardev=console,arg=axis,arg=moves=1,,2"]
        );
    }
}
