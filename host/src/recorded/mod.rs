//! Recordings of an axis in files: what it was set to, what it did, and the fault it stopped with.
//!
//! A file is CSV that any spreadsheet reads: a row a sample, the values in the units of people, told to the last bit. The
//! comment lines before the rows are TOML behind their `# `, and carry all that a desk needs to go on from: rates,
//! units, every parameter. Where samples are missing a comment line says so.

mod header;
mod read;
mod write;

use leadscrew::scope::Signal;
use leadscrew_client::{Axis, Error, FaultPage, Recording, Value};

pub use header::{Fault, Header, Parameter, Source};
pub use read::{ReadError, is_recording, read};
pub use write::write;

/// First line of a file.
pub const FIRST_LINE: &str = "# leadscrew recording 1";

/// Signals by which a recording replays in full: the estimators, the control law, the monitors.
pub const REPLAY_SIGNALS: [Signal; 8] = [
    Signal::Count,
    Signal::Velocity,
    Signal::Acceleration,
    Signal::SetpointVelocity,
    Signal::SetpointAcceleration,
    Signal::FollowingError,
    Signal::Command,
    Signal::Flags,
];

/// A recording with all that belongs to it.
#[derive(Clone, Debug, PartialEq)]
pub struct Recorded {
    /// What it is of.
    pub header: Header,
    /// The samples.
    pub recording: Recording,
}

impl Recorded {
    /// A recording of `axis` as it is set now, with the fault that it stands in, if there is one.
    ///
    /// # Errors
    /// Of a lost axis.
    pub fn of(axis: &mut Axis, source: Source, recording: Recording) -> Result<Self, Error> {
        let mut parameters = Vec::new();
        for parameter in axis.parameters()? {
            let value = match parameter.value {
                Value::Number { value, .. } => Parameter::Number(value),
                Value::Word(word) => Parameter::Word(word),
            };
            parameters.push((parameter.name, value));
        }
        parameters.sort_by(|(one, _), (other, _)| one.cmp(other));
        let fault = axis.fault_page()?.as_ref().map(fault_of);
        let identity = axis.identity();
        Ok(Self {
            header: Header {
                source,
                firmware: identity.firmware.clone(),
                build: identity.build.clone(),
                board: identity.board.clone(),
                fault,
                parameters,
            },
            recording,
        })
    }
}

const fn fault_of(page: &FaultPage) -> Fault {
    Fault {
        number: page.fault_number,
        tick: page.tick,
        value: page.value,
        limit: page.limit,
    }
}
