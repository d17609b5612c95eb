//! A guest for people and their tools: no faster than the wall, until it ends or is interrupted.

use std::process::ExitCode;
use std::time::Duration;

use leadscrew_qemu::{Endpoint, Error, Guest, Start, build};

use crate::Arguments;

/// How often to look for something to show.
const LOOK: Duration = Duration::from_millis(200);
const SHIFT: u32 = 4;

/// Runs it, showing its log as it comes.
pub fn run(arguments: &Arguments) -> Result<ExitCode, Error> {
    let image = build(&arguments.bin, "firmware")?;
    let mut start = Start::new(image)
        .shift(arguments.shift.unwrap_or(SHIFT))
        .paced();
    for word in &arguments.words {
        start = start.arg(word);
    }
    if let Some(carrier) = arguments.link {
        start = start.link(carrier);
    }
    if let Some(carrier) = arguments.modbus {
        start = start.modbus(carrier);
    }
    let guest = start.start()?;
    show("link", guest.link());
    show("modbus", guest.modbus());
    follow(&guest)
}

fn show(name: &str, endpoint: Option<&Endpoint>) {
    match endpoint {
        Some(Endpoint::Tcp(address)) => println!("{name}: {address}"),
        Some(Endpoint::Pty(path)) => println!("{name}: {}", path.display()),
        None => {}
    }
}

fn follow(guest: &Guest) -> Result<ExitCode, Error> {
    let mut shown = 0;
    loop {
        let ended = match guest.wait(LOOK) {
            Ok(code) => Some(code),
            Err(Error::Timeout { .. }) => None,
            Err(error) => return Err(error),
        };
        let log = guest.log()?;
        for line in log.iter().skip(shown) {
            println!("{line}");
        }
        shown = log.len();
        if let Some(code) = ended {
            eprint!("{}", guest.stderr()?);
            return Ok(u8::try_from(code).map_or(ExitCode::FAILURE, ExitCode::from));
        }
    }
}
