//! How an axis stands, in the units of people.

use leadscrew::protocol::reply::{
    ENABLED, HELD, HOMED, LEASED, LEASED_HERE, MOVING, PLANNED, Reply, UNSAVED,
};
use leadscrew::supervisor::{Fault, State};

pub(crate) const NM_PER_MM: f64 = 1e6;
pub(crate) const UM_PER_MM: f64 = 1e3;

/// How an axis stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Status {
    /// The tick that it tells of.
    pub tick: u32,
    /// Number of the [`State`]: [`Self::state`].
    pub state_number: u8,
    /// Number of the [`Fault`] that is latched, 0 for none: [`Self::fault`].
    pub fault_number: u8,
    /// Bit n: the warning of number n: [`Self::warnings`].
    pub warning_bits: u32,
    /// The drive is enabled.
    pub is_enabled: bool,
    /// A motion is commanded.
    pub is_moving: bool,
    /// The origin is known.
    pub is_homed: bool,
    /// A feed hold is on.
    pub is_held: bool,
    /// Somebody holds the control lease.
    pub is_leased: bool,
    /// It is this session that holds it.
    pub is_leased_here: bool,
    /// Planned moves are what moves the axis, or may: it is ready or moving, and neither homing nor driven by another
    /// source.
    pub is_planned: bool,
    /// Parameters were set since they were saved, or since the axis was switched on: they go when it is switched off.
    pub is_unsaved: bool,
    /// Feed override, %.
    pub override_percent: u16,
    /// Where it is, mm from the origin; from where the encoder counts while none is known.
    pub position_mm: f64,
    /// Where it should be, mm.
    pub setpoint_mm: f64,
    /// How fast it is, mm/min.
    pub velocity_mm_per_min: f64,
    /// Setpoint less position, mm.
    pub following_error_mm: f64,
    /// Where it should be, nm.
    pub(crate) setpoint_nm: i64,
}

impl Status {
    pub(crate) fn of(reply: &Reply<'_>) -> Option<Self> {
        let Reply::Status {
            tick,
            state,
            fault,
            warnings,
            flags,
            percent,
            position_nm,
            setpoint_nm,
            velocity_um_per_min,
            following_error_nm,
        } = *reply
        else {
            return None;
        };
        let is = |bit: u16| flags & bit != 0;
        Some(Self {
            tick,
            state_number: state,
            fault_number: fault,
            warning_bits: warnings,
            is_enabled: is(ENABLED),
            is_moving: is(MOVING),
            is_homed: is(HOMED),
            is_held: is(HELD),
            is_leased: is(LEASED),
            is_leased_here: is(LEASED_HERE),
            is_planned: is(PLANNED),
            is_unsaved: is(UNSAVED),
            override_percent: percent,
            position_mm: position_nm as f64 / NM_PER_MM,
            setpoint_mm: setpoint_nm as f64 / NM_PER_MM,
            velocity_mm_per_min: f64::from(velocity_um_per_min) / UM_PER_MM,
            following_error_mm: f64::from(following_error_nm) / NM_PER_MM,
            setpoint_nm,
        })
    }

    /// Its state; `None` for one of a later version.
    #[must_use]
    pub const fn state(&self) -> Option<State> {
        Some(match self.state_number {
            0 => State::Disabled,
            1 => State::Enabling,
            2 => State::Ready,
            3 => State::Moving,
            4 => State::Stopping,
            5 => State::Fault,
            _ => return None,
        })
    }

    /// Its state in words.
    #[must_use]
    pub const fn state_text(&self) -> &'static str {
        match self.state() {
            Some(State::Disabled) => "disabled",
            Some(State::Enabling) => "enabling",
            Some(State::Ready) => "ready",
            Some(State::Moving) => "moving",
            Some(State::Stopping) => "stopping",
            Some(State::Fault) => "in fault",
            None => "in a state that this tool does not know",
        }
    }

    /// The fault that is latched; `None` too for one of a later version.
    #[must_use]
    pub const fn fault(&self) -> Option<Fault> {
        Fault::from_number(self.fault_number)
    }

    /// The warnings that are on; those of later versions are not among them.
    pub fn warnings(&self) -> impl Iterator<Item = Fault> {
        let bits = self.warning_bits;
        let is_on = move |fault: &&Fault| {
            bits.checked_shr(u32::from(**fault as u8))
                .is_some_and(|bits| bits & 1 != 0)
        };
        Fault::ALL.iter().filter(is_on).copied()
    }

    /// True if it stands: nothing is commanded, and it is not on its way to or from enabled.
    #[must_use]
    pub const fn is_at_rest(&self) -> bool {
        !self.is_moving && !matches!(self.state(), Some(State::Stopping | State::Enabling))
    }
}

/// What was dropped of a link, on both sides of it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LinkStatistics {
    /// What the axis dropped since it was switched on.
    pub axis: Losses,
    /// What this side dropped in this session's connection.
    pub here: Losses,
}

/// What one side of a link dropped.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Losses {
    /// Frames whose stuffing was wrong.
    pub torn: u32,
    /// Frames too long.
    pub too_long: u32,
    /// Frames too short.
    pub too_short: u32,
    /// Frames with a wrong checksum.
    pub checksum: u32,
    /// Messages not known.
    pub unknown: u32,
    /// Messages that came twice or too late.
    pub late: u32,
    /// Records: of the axis those that found no room on their way out, of this side all that did not arrive.
    pub records_lost: u32,
}

impl Losses {
    pub(crate) const fn of_axis(reply: &Reply<'_>) -> Option<Self> {
        match *reply {
            Reply::Link {
                torn,
                too_long,
                too_short,
                checksum,
                unknown,
                late,
                records_lost,
            } => Some(Self {
                torn,
                too_long,
                too_short,
                checksum,
                unknown,
                late,
                records_lost,
            }),
            _ => None,
        }
    }
}
