//! How probing ended, and why it did not begin.

use core::fmt;

/// How probing ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum ProbeEnd {
    /// There was a touch, and the way back was free.
    Touched = 1,
    /// The whole way was gone without a touch.
    NoTouch = 2,
    /// The probe was deflected before the axis began to move; it did not.
    AlreadyTouching = 3,
    /// There was a touch, and another one on the way back, which ended there.
    TouchedOnRetract = 4,
    /// There was a touch, and the probe is still deflected after the way back.
    StillTouching = 5,
    /// The axis was stopped or disabled, or a fault tripped.
    Interrupted = 6,
    /// The encoder's signals were lost: where the touch was is not known.
    EncoderLost = 7,
    /// No probing: a touch while something else moved the axis, or nothing did.
    Unasked = 8,
}

impl ProbeEnd {
    /// All of them, in the order of their numbers.
    pub const ALL: [Self; 8] = [
        Self::Touched,
        Self::NoTouch,
        Self::AlreadyTouching,
        Self::TouchedOnRetract,
        Self::StillTouching,
        Self::Interrupted,
        Self::EncoderLost,
        Self::Unasked,
    ];

    /// True if the touch that was measured is the one that was sought.
    #[must_use]
    pub const fn is_good(self) -> bool {
        matches!(self, Self::Touched)
    }

    /// The one of that number.
    #[must_use]
    pub fn of_number(number: u8) -> Option<Self> {
        Self::ALL.into_iter().find(|end| *end as u8 == number)
    }
}

impl fmt::Display for ProbeEnd {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Touched => "the probe touched",
            Self::NoTouch => {
                "there was no touch on the whole way: probe farther, or check the probe, its battery and its wire"
            }
            Self::AlreadyTouching => {
                "the probe was deflected before the axis moved: move it clear of the part, or check its wire and polarity"
            }
            Self::TouchedOnRetract => {
                "the probe touched again on the way back, where the axis stopped: there is something behind it"
            }
            Self::StillTouching => {
                "the probe is still deflected after the way back: retract farther, or check that it seats"
            }
            Self::Interrupted => {
                "probing was interrupted: the axis was stopped or disabled, or a fault tripped"
            }
            Self::EncoderLost => {
                "the encoder's signals were lost while probing: mend that, home and probe anew"
            }
            Self::Unasked => "the probe touched while nobody probed",
        })
    }
}

/// Why probing did not begin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ProbeRefused {
    /// The axis is not under control.
    NotReady,
    /// It is in motion.
    Moving,
    /// The target is where the axis stands.
    NoWay,
    /// The feed is zero, or greater than the axis's largest.
    FeedOutOfRange,
    /// At this feed the axis goes on too far after a touch.
    Overtravel {
        /// How far it may go on at this feed, d.
        bound: i32,
        /// How far it is allowed to, d.
        allowed: i32,
    },
    /// The target, what lies behind it by the overtravel, or the end of the way back is beyond the soft limits.
    BeyondTravel,
}

impl fmt::Display for ProbeRefused {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::NotReady => {
                f.write_str("the axis is not ready: clear faults and enable it, then probe")
            }
            Self::Moving => f.write_str("the axis moves: let it come to rest, then probe"),
            Self::NoWay => f.write_str(
                "there is no way to probe: give a target at least 1 d from where the axis stands",
            ),
            Self::FeedOutOfRange => {
                f.write_str("the feed to probe with is zero or above the axis's largest")
            }
            Self::Overtravel { bound, allowed } => write!(
                f,
                "after a touch at this feed the axis goes on by up to {bound} d, allowed are {allowed} d \
                 (probe.max_overtravel_mm): probe slower"
            ),
            Self::BeyondTravel => f.write_str(
                "the way of probing, its overtravel or its way back ends beyond the soft limits of travel: probe less far",
            ),
        }
    }
}

impl core::error::Error for ProbeRefused {}
