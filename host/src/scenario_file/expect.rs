//! What must come of a run.

use leadscrew::probe::ProbeEnd;
use leadscrew::supervisor::{Fault, State};
use toml::de::DeTable;

use super::words::{Key, Value, read_all};
use crate::fault_names::{FAULT_COUNT, FAULT_NAMES, PROBE_ENDS, STATES};
use crate::toml_file::Complaint;

/// Words of `fault`: none, then [`FAULT_NAMES`].
const FAULT_WORDS: [&str; FAULT_COUNT + 1] = {
    let mut words = ["none"; FAULT_COUNT + 1];
    let mut index = 0;
    while index < FAULT_COUNT {
        words[index + 1] = FAULT_NAMES[index];
        index += 1;
    }
    words
};
/// Words of `final_state`.
const STATE_WORDS: [&str; STATES.len()] = {
    let mut words = [""; STATES.len()];
    let mut index = 0;
    while index < STATES.len() {
        words[index] = STATES[index].1;
        index += 1;
    }
    words
};

/// A figure of a run that may be limited.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Figure {
    /// Largest magnitude of the following error while under control, d.
    FollowingErrorPeak,
    /// Its rms, d.
    FollowingErrorRms,
    /// Largest magnitude of the following error at rest, d.
    StandingError,
    /// Rms of the velocity shown less that of the shaft, d/tick.
    ShownVelocity,
    /// Differences between places of rest, d: carriage less position reported.
    Positioning,
    /// Setpoint at the end, from the start, mm.
    FinalPosition,
    /// Farthest position of the shaft either way, from the start, mm.
    Travel,
    /// From the trouble to the fault, s.
    Detected,
    /// Way of the shaft in that time, mm.
    DetectedWay,
    /// Ticks from the fault to zero output.
    ZeroOutput,
    /// From the fault to standstill, s.
    Stopped,
    /// Way of the shaft in that time, mm.
    StoppedWay,
    /// Largest magnitude of the output, of full command.
    OutputPeak,
    /// Actions that were refused.
    Refused,
    /// Touches of the probe.
    Touches,
    /// Edges of the probe that were none of a touch.
    Glitches,
    /// How far the axis went beyond the last contact, mm.
    Overtravel,
    /// Stated 1σ of the last touch, d.
    TouchSigma,
}

/// How a figure is limited.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bound {
    /// It is no larger.
    AtMost,
    /// It is this, but for [`POSITION_TOLERANCE_MM`].
    Near,
    /// It is exactly this.
    Exactly,
}

/// How near a position is that is as expected, mm.
pub const POSITION_TOLERANCE_MM: f64 = 1e-6;

/// A key that limits a figure.
#[derive(Clone, Copy, Debug)]
pub struct Limit {
    /// The key.
    pub key: Key,
    /// The figure.
    pub figure: Figure,
    /// How.
    pub bound: Bound,
}

const fn limit(
    name: &'static str,
    unit: &'static str,
    figure: Figure,
    bound: Bound,
    what: &'static str,
) -> Limit {
    let (min, max) = if matches!(bound, Bound::Near) {
        (-1e6, 1e6)
    } else {
        (0.0, 1e6)
    };
    Limit {
        key: Key {
            name,
            what,
            value: Value::Number { unit, min, max },
            default: Some(f64::NAN),
        },
        figure,
        bound,
    }
}

/// All limits.
pub const LIMITS: &[Limit] = &[
    limit(
        "following_error_peak_d",
        "d",
        Figure::FollowingErrorPeak,
        Bound::AtMost,
        "largest following error while under control and without a fault",
    ),
    limit(
        "following_error_rms_d",
        "d",
        Figure::FollowingErrorRms,
        Bound::AtMost,
        "its rms",
    ),
    limit(
        "standing_error_d",
        "d",
        Figure::StandingError,
        Bound::AtMost,
        "largest following error from 0.1 s after a motion ends",
    ),
    limit(
        "shown_velocity_rms_d_per_tick",
        "d/tick",
        Figure::ShownVelocity,
        Bound::AtMost,
        "rms of the velocity shown less that of the shaft, while under control and without a fault",
    ),
    limit(
        "positioning_error_d",
        "d",
        Figure::Positioning,
        Bound::AtMost,
        "carriage less position reported, from 1 s after a motion ends and since the origin is known: largest less smallest",
    ),
    limit(
        "final_position_mm",
        "mm",
        Figure::FinalPosition,
        Bound::Near,
        "setpoint at the end, from the start",
    ),
    limit(
        "travel_mm",
        "mm",
        Figure::Travel,
        Bound::AtMost,
        "farthest place of the shaft either way, from the start",
    ),
    limit(
        "detected_within_s",
        "s",
        Figure::Detected,
        Bound::AtMost,
        "from the last trouble that began to the first fault",
    ),
    limit(
        "detected_within_mm",
        "mm",
        Figure::DetectedWay,
        Bound::AtMost,
        "way of the shaft in that time",
    ),
    limit(
        "zero_output_within_ticks",
        "ticks",
        Figure::ZeroOutput,
        Bound::AtMost,
        "from the first fault to zero output",
    ),
    limit(
        "stopped_within_s",
        "s",
        Figure::Stopped,
        Bound::AtMost,
        "from the first fault to standstill of the shaft",
    ),
    limit(
        "stopped_within_mm",
        "mm",
        Figure::StoppedWay,
        Bound::AtMost,
        "way of the shaft in that time",
    ),
    limit(
        "output_peak",
        "of full command",
        Figure::OutputPeak,
        Bound::AtMost,
        "largest output",
    ),
    limit(
        "refused",
        "actions",
        Figure::Refused,
        Bound::Exactly,
        "actions that the axis refuses; left out: none",
    ),
    limit(
        "touches",
        "touches",
        Figure::Touches,
        Bound::Exactly,
        "touches of the probe, sought or not",
    ),
    limit(
        "glitches",
        "edges",
        Figure::Glitches,
        Bound::Exactly,
        "edges of the probe that were none of a touch",
    ),
    limit(
        "overtravel_mm",
        "mm",
        Figure::Overtravel,
        Bound::AtMost,
        "how far the axis went beyond the last contact",
    ),
    limit(
        "touch_sigma_d",
        "d",
        Figure::TouchSigma,
        Bound::AtMost,
        "stated 1σ of the place of the last touch",
    ),
];

/// The first fault of the run.
pub const FAULT: Key = Key {
    name: "fault",
    what: "the first fault of the run; left out: none",
    value: Value::Word(&FAULT_WORDS),
    default: Some(0.0),
};
/// A warning of the run.
pub const WARNING: Key = Key {
    name: "warning",
    what: "a warning that must come; left out: it does not matter",
    ..FAULT
};
/// The state at the end.
pub const FINAL_STATE: Key = Key {
    name: "final_state",
    what: "state at the end",
    value: Value::Word(&STATE_WORDS),
    default: Some(f64::NAN),
};

/// Words of `probed`: the ends by number, then none.
const PROBED_WORDS: [&str; PROBE_ENDS.len() + 1] = {
    let mut words = ["none"; PROBE_ENDS.len() + 1];
    let mut index = 0;
    while index < PROBE_ENDS.len() {
        words[index] = PROBE_ENDS[index];
        index += 1;
    }
    words
};
/// How the last probing ended.
pub const PROBED: Key = Key {
    name: "probed",
    what: "how the last probing ended; left out: it does not matter",
    value: Value::Word(&PROBED_WORDS),
    default: Some(f64::NAN),
};

/// `[expect]`.
#[derive(Clone, Debug)]
pub struct Expectations {
    /// Limits and their values.
    pub limits: Vec<(&'static Limit, f64)>,
    /// The first fault, or none.
    pub fault: Option<Fault>,
    /// Warnings that must come.
    pub warnings: Vec<Fault>,
    /// The state at the end, if it matters.
    pub final_state: Option<State>,
    /// How the last probing ended, or that there was none, if it matters.
    pub probed: Option<Option<ProbeEnd>>,
}

impl Expectations {
    pub(super) fn read(table: Option<&DeTable<'_>>) -> Result<Self, Complaint> {
        let empty = DeTable::new();
        let table = table.unwrap_or(&empty);
        let keys: Vec<&Key> = LIMITS
            .iter()
            .map(|limit| &limit.key)
            .chain([&FAULT, &FINAL_STATE, &WARNING, &PROBED])
            .collect();
        let values = read_all(table, &keys, &[], "[expect]", 0..0)?;
        let (limits, words) = values.split_at(LIMITS.len());
        let stated = LIMITS
            .iter()
            .zip(limits.iter().copied())
            .map(|(limit, value)| match limit.figure {
                Figure::Refused if value.is_nan() => (limit, 0.0),
                _ => (limit, value),
            })
            .filter(|(_, value)| !value.is_nan());
        let place = |value: f64| (!value.is_nan()).then_some(value as usize);
        let fault = |value: f64| Fault::ALL.get(place(value)?.checked_sub(1)?).copied();
        Ok(Self {
            limits: stated.collect(),
            fault: fault(words[0]),
            warnings: fault(words[2]).into_iter().collect(),
            final_state: place(words[1])
                .and_then(|place| STATES.get(place))
                .map(|(state, _)| *state),
            probed: place(words[3]).map(|place| ProbeEnd::ALL.get(place).copied()),
        })
    }
}
