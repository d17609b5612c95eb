//! Everything on the other side of the seam, as parameters.

use crate::board::BoardParams;
use crate::machine::MachineParams;
use crate::spindle::SpindleParams;

/// A machine, its board and its spindle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plant {
    /// The machine.
    pub machine: MachineParams,
    /// Its switches, the lines of its drive, its brake.
    pub board: BoardParams,
    /// The spindle; it is there if it turns, or is made to.
    pub spindle: SpindleParams,
}

impl Default for Plant {
    fn default() -> Self {
        MachineParams::default().into()
    }
}

impl From<MachineParams> for Plant {
    fn from(machine: MachineParams) -> Self {
        Self {
            machine,
            board: BoardParams::default(),
            spindle: SpindleParams {
                rpm: 0.0,
                ..SpindleParams::default()
            },
        }
    }
}
