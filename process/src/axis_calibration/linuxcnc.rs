//! LinuxCNC's `COMP_FILE`: a line each place, `nominal forward reverse`, mm.
//!
//! | `COMP_FILE_TYPE` | forward and reverse are | here |
//! | --- | --- | --- |
//! | 0 | where the carriage is when told to be at nominal | nominal + error |
//! | 1 | trims: nominal less where it is, added to the command of the motor | − error |
//!
//! LinuxCNC makes trims of type 0, adds the trim of the direction, linear between places and held outside, to the position
//! command, by its velocity's sign; `tests/axis_calibration/linuxcnc.rs` runs it. Where a file is given its BACKLASH is not used.

use std::fmt::Write;

use super::table::{ErrorPoint, ErrorTable};

/// `COMP_FILE_TYPE`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CompType {
    /// 0: places.
    Places,
    /// 1: trims.
    Trims,
}

impl CompType {
    /// The number of LinuxCNC's configuration.
    #[must_use]
    pub const fn number(self) -> u8 {
        match self {
            Self::Places => 0,
            Self::Trims => 1,
        }
    }
}

/// Most points that LinuxCNC takes.
pub const MOST_POINTS: usize = 256;

impl ErrorTable {
    /// The text of a `COMP_FILE` of a type, in mm with nine decimals.
    #[must_use]
    pub fn to_linuxcnc(&self, comp_type: CompType) -> String {
        let mut text = String::new();
        for ErrorPoint {
            position_mm,
            error_um,
        } in &self.points
        {
            let [forward, reverse] = error_um.map(|um| match comp_type {
                CompType::Places => position_mm + um / 1000.0,
                // Not the negative: a trim of nothing is 0, not -0.
                CompType::Trims => 0.0 - um / 1000.0,
            });
            let _ = writeln!(text, "{position_mm:.9} {forward:.9} {reverse:.9}");
        }
        text
    }
}
