//! From `--port` to an axis that answers.

use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use clap::Args;
use leadscrew_client::{Axis, DEFAULT_BAUD, Line, Options, Port};
use leadscrew_hal_mock::scenario::Base;

use super::qemu_line::QemuLine;
use crate::error::CommandError;
use crate::simulated_axis::{FlashImage, SimulatedAxis};

/// Control rate of an axis that nobody has set up, Hz.
const FACTORY_TICK_HZ: f64 = 1000.0;
/// Where the flash of a simulated axis is kept unless another place is named.
const DEFAULT_FLASH: &str = "target/leadscrew/axis.flash";

/// Where the axis is.
#[derive(Clone, Debug, Args)]
pub struct PortArgs {
    /// The axis: a serial port, tcp:HOST:PORT, qemu (the firmware in QEMU) or sim (the same in this process)
    #[arg(long, value_name = "PORT", global = true)]
    pub port: Option<String>,
    /// Baud rate of a serial port
    #[arg(long, value_name = "N", default_value_t = DEFAULT_BAUD, global = true)]
    pub baud: u32,
    /// Flash image of an axis in QEMU or in this process, made if it is not there [default: target/leadscrew/axis.flash]
    #[arg(long, value_name = "FILE", global = true)]
    pub flash: Option<PathBuf>,
    /// Machine of such an axis
    #[arg(long = "on", value_name = "MACHINE", default_value = "16k20f3", value_parser = ["16k20f3", "16k20f3-bare"], global = true)]
    pub machine: String,
}

/// Connects to the axis. What is set in `interrupted` stops it and ends whatever waits.
///
/// # Errors
/// No port is named, there is none, nobody answers, or QEMU cannot be run.
pub fn open(args: &PortArgs, interrupted: &Arc<AtomicBool>) -> Result<Axis, CommandError> {
    let options = Options {
        interrupted: Some(Arc::clone(interrupted)),
        ..Options::default()
    };
    Ok(Axis::open(line(args)?, options)?)
}

fn line(args: &PortArgs) -> Result<Box<dyn Line>, CommandError> {
    let machine = machine(args);
    Ok(match port(args)? {
        Port::Qemu => {
            let flash = flash(args)?;
            let qemu = QemuLine::start(|start| {
                let start = start.flash(&flash);
                start.arg(format!("machine={}", machine.name()))
            });
            Box::new(qemu.map_err(|error| CommandError::Data(error.to_string()))?)
        }
        Port::Sim => Box::new(simulated(args)?),
        other => other.open(args.baud)?,
    })
}

/// The port that is named.
///
/// # Errors
/// None is, or it is no port.
pub fn port(args: &PortArgs) -> Result<Port, CommandError> {
    let Some(port) = &args.port else {
        return Err(CommandError::Usage(
            "which axis? Name its port: --port /dev/ttyACM0, tcp:HOST:PORT, qemu or sim".to_owned(),
        ));
    };
    Ok(port.parse()?)
}

/// The machine of a simulated axis.
#[must_use]
pub fn machine(args: &PortArgs) -> Base {
    let found = Base::ALL
        .into_iter()
        .find(|base| base.name() == args.machine);
    found.unwrap_or_default()
}

/// The axis in this process, switched on.
///
/// # Errors
/// Its flash image cannot be used.
pub fn simulated(args: &PortArgs) -> Result<SimulatedAxis, CommandError> {
    let image = FlashImage::open(&flash(args)?);
    let image = image.map_err(|error| CommandError::Data(error.to_string()))?;
    Ok(SimulatedAxis::new(
        machine(args),
        FACTORY_TICK_HZ,
        1,
        image,
    )?)
}

/// The flash image, in a folder that is there. A new one is told of.
///
/// # Errors
/// The folder cannot be made.
pub fn flash(args: &PortArgs) -> Result<PathBuf, CommandError> {
    let path = args.flash.as_deref().unwrap_or(Path::new(DEFAULT_FLASH));
    if let Some(folder) = path.parent().filter(|_| args.flash.is_none()) {
        fs::create_dir_all(folder).map_err(CommandError::write(folder))?;
    }
    if !path.exists() {
        let shown = path.display();
        // Nobody may be listening.
        let _ = writeln!(
            std::io::stderr(),
            "{shown}: a new flash, the axis has factory settings"
        );
    }
    Ok(path.to_owned())
}
