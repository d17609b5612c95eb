//! The seam: what a board gives to the core, and nothing more.
//!
//! The same shapes are filled by timer hardware, by the software decode of a recording and by the
//! simulator; the core cannot tell them apart.

use crate::units::Command;

/// What the encoder inputs saw up to one sampling instant.
///
/// All times are values of one free-running 32-bit timer that wraps; all counts are values of one
/// 32-bit x4 counter that wraps. Count k means that the shaft is between the boundaries k and k + 1,
/// x ∈ [k, k+1) d: the boundary between counts k − 1 and k is the same physical edge in both
/// directions, hysteresis apart.
///
/// The two low bits of the count tell the levels A B, as [`crate::quadrature`] counts them: 00, 10, 11, 01 for
/// 0, 1, 2, 3 modulo 4, so that odd boundaries are edges of A and even ones of B. Boards preset their
/// counter so; an encoder map goes by it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Capture<'a> {
    /// The x4 count at the sampling instant.
    pub count: u32,
    /// The timer at the sampling instant.
    pub sampled_at: u32,
    /// Time of the newest edge, if one came since the previous capture.
    pub last_edge_at: Option<u32>,
    /// Times of all edges since the previous capture, oldest first, as the two parts of a ring; both
    /// empty where the source keeps only the newest edge.
    ///
    /// They are times only: neither channel nor direction is known.
    pub edges: [&'a [u32]; 2],
    /// Illegal transitions (both channels at once) since the previous capture.
    pub illegal: u16,
    /// Edge times were lost since the previous capture; the count is still good.
    pub overrun: bool,
    /// The probe is deflected at the sampling instant, whatever the polarity of its wire.
    // In what the alignment leaves unused beside the two before.
    pub touching: bool,
    /// The index pulse, if it came since the previous capture.
    pub index: Option<Latch>,
    /// The probe input, if it triggered since the previous capture.
    pub probe: Option<Latch>,
    /// The home switch, if it was actuated since the previous capture.
    pub home: Option<Latch>,
}

/// Count and time that hardware latched at an event.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Latch {
    /// The x4 count at the event.
    pub count: u32,
    /// The timer at the event.
    pub time: u32,
}

/// Levels of the board's discrete inputs at the sampling instant, true where the name says so whatever the
/// polarity of the wire. The default is a machine at which all is well.
// In this order four of them are a word, and so are compared as one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C, align(4))]
pub struct Lines {
    /// The drive reports that it is ready to follow its command.
    pub drive_ready: bool,
    /// The drive reports a fault.
    pub drive_fault: bool,
    /// A line receiver of the encoder sees no valid differential signal.
    pub encoder_lost: bool,
    /// The emergency-stop chain is open. It removes power by itself; this only tells of it.
    pub emergency_stop: bool,
    /// The carriage is on the limit switch at the low end.
    pub limit_low: bool,
    /// The carriage is on the limit switch at the high end.
    pub limit_high: bool,
    /// The carriage is on the home switch.
    pub home: bool,
    /// The same of the second encoder (spindle, master) as [`Self::encoder_lost`] of the first.
    pub master_lost: bool,
}

impl Lines {
    /// True if no line stops the axis: limit switches are judged with the motion.
    #[must_use]
    #[inline(always)]
    pub const fn is_well(&self) -> bool {
        let lines = [
            self.drive_ready as u8,
            self.drive_fault as u8,
            self.encoder_lost as u8,
            self.emergency_stop as u8,
        ];
        u32::from_le_bytes(lines) == 1
    }

    /// True on a limit switch.
    #[must_use]
    #[inline(always)]
    pub const fn is_at_limit(&self) -> bool {
        u16::from_le_bytes([self.limit_low as u8, self.limit_high as u8]) != 0
    }
}

impl Default for Lines {
    fn default() -> Self {
        Self {
            drive_ready: true,
            drive_fault: false,
            encoder_lost: false,
            emergency_stop: false,
            limit_low: false,
            limit_high: false,
            home: false,
            master_lost: false,
        }
    }
}

/// What an outer control or a second encoder gives as reference for the setpoint.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Reference<'a> {
    /// Step/dir: the wrapping count of the hardware, net of direction.
    pub steps: u32,
    /// Gearing and threading: what the second encoder's inputs saw.
    pub master: Option<Capture<'a>>,
    /// Analog velocity command of a legacy control, raw fraction of its full scale.
    pub analog: Command,
}

/// A source of captures.
pub trait Encoder {
    /// The capture of the newest sampling instant.
    fn capture(&self) -> Capture<'_>;
}
