//! Where an axis is reached: the address that people write.

use std::path::PathBuf;
use std::str::FromStr;

use crate::error::Error;
use crate::line::{Line, SerialLine, TcpLine};

/// What an address may be, for messages.
const FORMS: &str = "/dev/ttyACM0, COM3, tcp:HOST:PORT, qemu or sim";

/// Where an axis is reached.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Port {
    /// A serial port, by its path or name: `/dev/ttyACM0`, `COM3`.
    Serial(PathBuf),
    /// A TCP server, as `host:port`: `tcp:192.168.0.7:5000`.
    Tcp(String),
    /// An axis in QEMU, which the tool starts itself: `qemu`.
    Qemu,
    /// A simulated axis within the tool's process: `sim`.
    Sim,
}

impl Port {
    /// Opens the line to a serial port or a TCP server. The others are made by whoever can run them.
    ///
    /// # Errors
    /// [`Error::Open`] with what there is instead and what to do; [`Error::NoLine`] for `qemu` and `sim`.
    pub fn open(&self, baud: u32) -> Result<Box<dyn Line>, Error> {
        let opened = match self {
            Self::Serial(path) => {
                SerialLine::open(path, baud).map(|line| -> Box<dyn Line> { Box::new(line) })
            }
            Self::Tcp(address) => {
                TcpLine::connect(address).map(|line| -> Box<dyn Line> { Box::new(line) })
            }
            Self::Qemu | Self::Sim => {
                return Err(Error::NoLine {
                    port: self.to_string(),
                });
            }
        };
        opened.map_err(|source| Error::Open {
            port: self.to_string(),
            advice: self.advice(&source),
            source,
        })
    }

    fn advice(&self, error: &std::io::Error) -> String {
        use std::io::ErrorKind;
        match (self, error.kind()) {
            (Self::Serial(_), ErrorKind::PermissionDenied) => {
                "It may not be opened by you: on Linux join the group that owns it (dialout), then log in anew."
                    .to_owned()
            }
            (Self::Serial(_), ErrorKind::ResourceBusy) => {
                "Close the program that uses it.".to_owned()
            }
            (Self::Serial(_), _) => format!("{} Plug the board in, or name one of them.", there_are()),
            (Self::Tcp(_), ErrorKind::ConnectionRefused) => {
                "Nobody listens there: start the server, or name its host and port as tcp:HOST:PORT.".to_owned()
            }
            _ => "Check host, port and cable; the address is tcp:HOST:PORT.".to_owned(),
        }
    }
}

/// The serial ports of this computer, in a sentence.
fn there_are() -> String {
    let ports = SerialLine::ports();
    if ports.is_empty() {
        "This computer has no serial port.".to_owned()
    } else {
        format!(
            "The serial ports of this computer are {}.",
            ports.join(", ")
        )
    }
}

impl std::fmt::Display for Port {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Serial(path) => write!(f, "{}", path.display()),
            Self::Tcp(address) => write!(f, "tcp:{address}"),
            Self::Qemu => f.write_str("qemu"),
            Self::Sim => f.write_str("sim"),
        }
    }
}

impl FromStr for Port {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self, Error> {
        let no = |why: &str| {
            Err(Error::NoSuchPort {
                port: text.to_owned(),
                why: why.to_owned(),
                there: there_are(),
            })
        };
        if let Some(address) = text.strip_prefix("tcp:") {
            return match address.rsplit_once(':') {
                Some((host, port)) if !host.is_empty() && port.parse::<u16>().is_ok() => {
                    Ok(Self::Tcp(address.to_owned()))
                }
                _ => no("A TCP address is tcp:HOST:PORT with a port of 0 to 65535."),
            };
        }
        match text {
            "qemu" => Ok(Self::Qemu),
            "sim" => Ok(Self::Sim),
            _ if text.starts_with('/') || is_windows_port(text) => Ok(Self::Serial(text.into())),
            _ => no(&format!("A port is {FORMS}.")),
        }
    }
}

/// `COM3`, or `\\.\COM10`.
fn is_windows_port(text: &str) -> bool {
    let name = text.strip_prefix(r"\\.\").unwrap_or(text);
    let number = name
        .get(..3)
        .filter(|start| start.eq_ignore_ascii_case("com"))
        .and_then(|_| name.get(3..));
    number.is_some_and(|number| {
        !number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_are_read_and_written_alike() {
        let cases = [
            ("/dev/ttyACM0", Port::Serial("/dev/ttyACM0".into())),
            ("COM3", Port::Serial("COM3".into())),
            ("com12", Port::Serial("com12".into())),
            ("tcp:lathe:5000", Port::Tcp("lathe:5000".into())),
            ("tcp:[::1]:5000", Port::Tcp("[::1]:5000".into())),
            ("qemu", Port::Qemu),
            ("sim", Port::Sim),
        ];
        for (text, port) in cases {
            assert_eq!(text.parse::<Port>().unwrap(), port);
            assert_eq!(port.to_string(), text);
        }
    }

    #[test]
    fn what_is_none_is_told_with_what_there_is() {
        for text in [
            "",
            "ttyACM0",
            "COM",
            "COMx",
            "tcp:",
            "tcp:lathe",
            "tcp::1",
            "tcp:lathe:99999",
            "QEMU",
        ] {
            let error = text.parse::<Port>().unwrap_err().to_string();
            assert!(error.contains(&format!("`{text}`")), "{error}");
            assert!(error.contains("tcp:HOST:PORT"), "{error}");
            assert!(error.contains("serial port"), "{error}");
        }
    }

    #[test]
    fn a_port_that_is_not_there_is_named_with_what_to_do() {
        let Err(error) = Port::Serial("/dev/none-such".into()).open(115_200) else {
            panic!("opened");
        };
        let text = error.to_string();
        assert!(
            text.contains("/dev/none-such") && text.contains("serial port"),
            "{text}"
        );
        assert!(matches!(Port::Qemu.open(1), Err(Error::NoLine { .. })));
    }
}
