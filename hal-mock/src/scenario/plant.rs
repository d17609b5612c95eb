//! Everything on the other side of the seam, as parameters.

use crate::board::BoardParams;
use crate::machine::MachineParams;

/// A machine and its board.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Plant {
    /// The machine.
    pub machine: MachineParams,
    /// Its switches, the lines of its drive, its brake.
    pub board: BoardParams,
}

impl From<MachineParams> for Plant {
    fn from(machine: MachineParams) -> Self {
        Self {
            machine,
            board: BoardParams::default(),
        }
    }
}
