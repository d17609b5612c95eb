//! What a tick leaves for thread mode.

use leadscrew::axis::Axis;
use leadscrew::identification::experiment::Ending;
use leadscrew::protocol::service::Seen;
use leadscrew::telemetry::Record;
use leadscrew::units::Command;

/// How an experiment stands.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ExperimentSeen {
    /// Segment under way.
    pub segment: u8,
    /// Ticks since it began, 1 in the first one.
    pub ticks: u32,
    /// How it ended; none while it runs.
    pub ending: Option<Ending>,
    /// Position, 1/16 d.
    pub position: i64,
    /// Command under which the axis moved to it.
    pub in_force: Command,
}

/// Indexes of the encoder.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Indexes {
    /// How many came; wraps.
    pub number: u32,
    /// Count at the last one.
    pub count: i64,
    /// Counts to it from the one before; 0 for the first one.
    pub distance: i64,
}

/// A tick.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Report {
    /// The record for telemetry.
    pub record: Record,
    /// What the link sees.
    pub seen: Seen,
    /// The experiment, if there is one.
    pub experiment: Option<ExperimentSeen>,
    /// Indexes so far.
    pub indexes: Indexes,
    /// Ticks missed before this one.
    pub missed: u16,
    /// The scope was triggered, and goes on.
    pub scope_triggered: bool,
    /// It is no tick: one was missed, and nothing else here is true.
    pub is_missed: bool,
}

impl Report {
    /// A tick that was missed: the drive is off.
    #[must_use]
    pub fn of_missed_tick() -> Self {
        Self {
            is_missed: true,
            ..Self::default()
        }
    }

    /// The tick that `axis` has just done.
    #[must_use]
    pub fn of(axis: &Axis<'_>) -> Self {
        Self {
            record: Record::new(axis.outputs()),
            seen: Seen::of(axis),
            experiment: axis.experiment().map(|experiment| ExperimentSeen {
                segment: experiment.segment() as u8,
                ticks: experiment.ticks(),
                ending: experiment.ending(),
                position: experiment.position(),
                in_force: experiment.in_force(),
            }),
            indexes: Indexes::default(),
            missed: 0,
            scope_triggered: false,
            is_missed: false,
        }
    }
}
