//! `leadscrew serve`: an axis in QEMU or in this process that goes on running.

use std::io::Write as _;
use std::net::{SocketAddr, ToSocketAddrs as _};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

use leadscrew_client::Port;
use leadscrew_qemu::{Carrier, Endpoint, Guest, Start, build};
use serde::Serialize;

use crate::axis::serve::Server;
use crate::axis::{self, PortArgs, QEMU_IMAGE};
use crate::cli::ServeArgs;
use crate::command::{print, print_json};
use crate::error::CommandError;

/// Time between two looks at what ends it.
const LOOK: Duration = Duration::from_millis(50);

/// Where the axis is served.
#[derive(Debug, Serialize)]
struct Report {
    port: String,
    modbus: Option<String>,
}

impl Report {
    fn tell(&self, args: &ServeArgs) -> Result<(), CommandError> {
        if args.output.json {
            return print_json(self);
        }
        let modbus = self
            .modbus
            .as_ref()
            .map_or_else(String::new, |modbus| format!("Modbus is on {modbus}\n"));
        print(&format!(
            "the axis is on --port {}, until Ctrl-C\n{modbus}",
            self.port
        ))
    }
}

/// Runs the command.
///
/// # Errors
/// A port that is served already, or cannot be; the axis ended.
pub fn run(
    port: &PortArgs,
    args: &ServeArgs,
    interrupted: &Arc<AtomicBool>,
) -> Result<(), CommandError> {
    let served = match axis::port(port)? {
        Port::Sim => simulated(port, args, interrupted),
        Port::Qemu => qemu(port, args, interrupted),
        other => Err(CommandError::Usage(format!(
            "--port {other}: this axis runs by itself. Serve one of --port sim or qemu"
        ))),
    };
    served?;
    // Nobody may be listening.
    let _ = writeln!(std::io::stderr(), "the axis is switched off");
    Ok(())
}

fn simulated(
    port: &PortArgs,
    args: &ServeArgs,
    interrupted: &AtomicBool,
) -> Result<(), CommandError> {
    if args.pty || args.modbus.is_some() {
        return Err(CommandError::Usage(
            "--port sim is served on TCP alone: take --listen, or --port qemu".to_owned(),
        ));
    }
    let address = address(&args.listen)?;
    let failed = |error: std::io::Error| {
        CommandError::Data(format!(
            "--listen {address}: cannot be listened on ({error}). Choose another port, or 0 for any that is free"
        ))
    };
    let mut server = Server::listen(address, axis::simulated(port)?).map_err(failed)?;
    let report = Report {
        port: format!("tcp:{}", server.address().map_err(failed)?),
        modbus: None,
    };
    report.tell(args)?;
    server
        .run(interrupted)
        .map_err(|error| CommandError::Data(format!("the simulated axis has ended: {error}")))
}

fn address(listen: &str) -> Result<SocketAddr, CommandError> {
    let found = listen.to_socket_addrs().ok();
    found.and_then(|mut found| found.next()).ok_or_else(|| {
        CommandError::Usage(format!(
            "--listen {listen}: an address is HOST:PORT, as 127.0.0.1:5000"
        ))
    })
}

fn qemu(port: &PortArgs, args: &ServeArgs, interrupted: &AtomicBool) -> Result<(), CommandError> {
    let link = if args.pty {
        Carrier::Pty
    } else {
        let address = address(&args.listen)?;
        if !address.ip().is_loopback() {
            return Err(CommandError::Usage(format!(
                "--listen {address}: QEMU is served on this computer alone: take 127.0.0.1:PORT"
            )));
        }
        Carrier::Tcp {
            port: address.port(),
        }
    };
    let failed = |error: leadscrew_qemu::Error| CommandError::Data(error.to_string());
    let (bin, profile) = QEMU_IMAGE;
    let mut start = Start::new(build(bin, profile).map_err(failed)?)
        .paced()
        .link(link)
        .flash(&axis::flash(port)?)
        .arg(format!("machine={}", axis::machine(port).name()));
    if let Some(port) = args.modbus {
        start = start.modbus(Carrier::Tcp { port });
    }
    let mut guest = start.start().map_err(failed)?;
    let report = Report {
        port: guest.link().map_or_else(String::new, named),
        modbus: guest.modbus().map(named),
    };
    report.tell(args)?;
    watch(&guest, interrupted)?;
    guest.kill().map_err(failed)
}

/// Waits for Ctrl-C.
fn watch(guest: &Guest, interrupted: &AtomicBool) -> Result<(), CommandError> {
    while !interrupted.load(Ordering::Relaxed) {
        let ended = guest
            .ended()
            .map_err(|error| CommandError::Data(error.to_string()))?;
        if let Some(status) = ended {
            // QEMU gets the same Ctrl-C, and may be faster.
            thread::sleep(LOOK);
            if interrupted.load(Ordering::Relaxed) {
                break;
            }
            let told = guest.stderr().unwrap_or_default();
            return Err(CommandError::Data(format!(
                "QEMU has ended ({status}): {told}"
            )));
        }
        thread::sleep(LOOK);
    }
    Ok(())
}

/// An endpoint as `--port` takes it.
fn named(endpoint: &Endpoint) -> String {
    match endpoint {
        Endpoint::Tcp(address) => format!("tcp:{address}"),
        Endpoint::Pty(path) => path.display().to_string(),
    }
}
