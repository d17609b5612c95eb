//! Signals: what can be recorded, with numbers that are only ever appended to; one table, from which the tick takes its
//! values and `docs/scope.md` its text.
//!
//! Variances and what the feedforward learned are not among them: they are made when they are asked for, outside the
//! tick.

use core::fmt;

use crate::axis::Axis;
use crate::controller::FollowingError;
use crate::identification::experiment::{Experiment, POSITION_FRAC};
use crate::telemetry;
use crate::units::{Acceleration, Command, Jerk, Position, Velocity};

/// How the 32 bits of a sample are to be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A signed number.
    Narrow,
    /// The low word of a signed number of 64 bits: [`Unwrap`](super::Unwrap) makes it whole.
    Wide,
    /// An unsigned number, or bits.
    Word,
}

impl Kind {
    /// What it is, for people.
    #[must_use]
    pub const fn text(self) -> &'static str {
        match self {
            Self::Narrow => "signed",
            Self::Wide => "low word",
            Self::Word => "unsigned",
        }
    }
}

/// Unit of a signal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// A number or bits without a unit.
    None,
    /// Ticks.
    Tick,
    /// Discretes: counts of the encoder.
    D,
    /// d/tick.
    DPerTick,
    /// d/tick².
    DPerTick2,
    /// d/tick³.
    DPerTick3,
    /// Parts of full command.
    FullCommand,
}

impl Unit {
    /// Its symbol.
    #[must_use]
    pub const fn text(self) -> &'static str {
        match self {
            Self::None => "",
            Self::Tick => "ticks",
            Self::D => "d",
            Self::DPerTick => "d/tick",
            Self::DPerTick2 => "d/tick²",
            Self::DPerTick3 => "d/tick³",
            Self::FullCommand => "of full",
        }
    }
}

/// What is to be known of a signal to read its samples: a value in its unit is the number × 2^−`frac`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Description {
    /// What it is, in a sentence.
    pub what: &'static str,
    /// How its bits are to be read.
    pub kind: Kind,
    /// The unit of its value.
    pub unit: Unit,
    /// Fractional bits.
    pub frac: u32,
}

// Functions, looked up once: a tick that looks at the list of signals for each of its samples takes twice as long.
/// Reads the word that a sample has of a signal.
pub(super) type ReadWord = fn(&Axis<'_>) -> i32;
/// Reads the whole value of a signal.
pub(super) type ReadValue = fn(&Axis<'_>) -> i64;

/// Declares the signals: description, `Name = number, "name", kind, unit, fractional bits, value`, which is whole, as an
/// `i64`.
macro_rules! signals {
    ($($(#[doc = $what:literal])+ $signal:ident = $number:literal, $name:literal, $kind:ident, $unit:ident, $frac:expr,
        |$axis:ident| $value:expr;)*) => {
        /// What of an axis can be recorded. The numbers are part of the link: a number is never used anew.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[repr(u8)]
        pub enum Signal {
            $($(#[doc = $what])+ $signal = $number,)*
        }

        impl Signal {
            /// All signals, by number.
            pub const ALL: &'static [Self] = &[$(Self::$signal,)*];

            /// Its name, as people write it.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self { $(Self::$signal => $name,)* }
            }

            /// The signal of that name.
            #[must_use]
            pub fn from_name(name: &str) -> Option<Self> {
                Self::ALL.iter().copied().find(|signal| signal.name() == name)
            }

            /// The signal of that number.
            #[must_use]
            pub const fn from_number(number: u8) -> Option<Self> {
                match number { $($number => Some(Self::$signal),)* _ => None }
            }

            /// All that is to be known of it.
            #[must_use]
            pub const fn description(self) -> Description {
                match self { $(Self::$signal => Description {
                    what: concat!($($what),+).trim_ascii(),
                    kind: Kind::$kind,
                    unit: Unit::$unit,
                    frac: $frac,
                },)* }
            }

            /// Reads its word in the last tick.
            pub(super) const fn word_reader(self) -> ReadWord {
                match self { $(Self::$signal => |$axis: &Axis<'_>| $value as i32,)* }
            }

            /// Reads its whole value in the last tick.
            pub(super) const fn value_reader(self) -> ReadValue {
                match self { $(Self::$signal => |$axis: &Axis<'_>| $value,)* }
            }
        }
    };
}

signals! {
    /// Number of the tick; wraps.
    Tick = 1, "tick", Word, Tick, 0, |axis| i64::from(axis.outputs().tick);
    /// Count of the encoder.
    Count = 2, "count", Wide, D, 0, |axis| axis.outputs().count;
    /// Position, estimated.
    Position = 3, "position", Wide, D, Position::FRAC_NBITS, |axis| axis.outputs().estimate.position.to_bits();
    /// Velocity, estimated.
    Velocity = 4, "velocity", Narrow, DPerTick, Velocity::FRAC_NBITS,
        |axis| i64::from(axis.outputs().estimate.velocity.to_bits());
    /// Acceleration, estimated.
    Acceleration = 5, "acceleration", Narrow, DPerTick2, Acceleration::FRAC_NBITS,
        |axis| i64::from(axis.outputs().estimate.acceleration.to_bits());
    /// Position of the setpoint, compensation included.
    SetpointPosition = 6, "setpoint_position", Wide, D, Position::FRAC_NBITS,
        |axis| axis.outputs().setpoint.position.to_bits();
    /// Velocity of the setpoint.
    SetpointVelocity = 7, "setpoint_velocity", Narrow, DPerTick, Velocity::FRAC_NBITS,
        |axis| i64::from(axis.outputs().setpoint.velocity.to_bits());
    /// Acceleration of the setpoint.
    SetpointAcceleration = 8, "setpoint_acceleration", Narrow, DPerTick2, Acceleration::FRAC_NBITS,
        |axis| i64::from(axis.outputs().setpoint.acceleration.to_bits());
    /// Jerk of the setpoint from this tick to the next.
    SetpointJerk = 9, "setpoint_jerk", Narrow, DPerTick3, Jerk::FRAC_NBITS,
        |axis| i64::from(axis.outputs().setpoint.jerk.to_bits());
    /// Setpoint less measured position.
    FollowingError = 10, "following_error", Narrow, D, FollowingError::FRAC_NBITS,
        |axis| i64::from(axis.outputs().following_error.to_bits());
    /// Command to the drive.
    Command = 11, "command", Narrow, FullCommand, Command::FRAC_NBITS,
        |axis| i64::from(axis.outputs().command.to_bits());
    /// Flags of a telemetry record: bit 0 enabled, 1 limited high, 2 limited low, 3 limited by slew, 4 moving, 5 brake
    /// released; bits 8 to 15 the state, bits 16 to 23 the fault.
    Flags = 12, "flags", Word, None, 0, |axis| i64::from(telemetry::flags(axis.outputs()));
    /// Warnings: bit n is the fault of number n.
    Warnings = 13, "warnings", Word, None, 0, |axis| i64::from(axis.outputs().warnings.bits());
    /// State: 0 disabled, 1 enabling, 2 ready, 3 moving, 4 stopping, 5 fault.
    State = 14, "state", Word, None, 0, |axis| axis.outputs().state as i64;
    /// Number of the fault that is latched, 0 for none.
    Fault = 15, "fault", Word, None, 0, |axis| axis.outputs().fault.map_or(0, |fault| fault as i64);
    /// Position for the users of the axis: from the origin, compensation taken out.
    ReportedPosition = 16, "reported_position", Wide, D, Position::FRAC_NBITS,
        |axis| axis.outputs().reported.to_bits();
    /// Position of the setpoint before compensation.
    CommandedPosition = 17, "commanded_position", Wide, D, Position::FRAC_NBITS,
        |axis| axis.commanded().position.to_bits();
    /// Position in an experiment of identification, 0 without one.
    ExperimentPosition = 18, "experiment_position", Wide, D, POSITION_FRAC,
        |axis| axis.experiment().map_or(0, Experiment::position);
    /// Command under which the last step of an experiment was made, 0 without one.
    ExperimentCommand = 19, "experiment_command", Narrow, FullCommand, Command::FRAC_NBITS,
        |axis| i64::from(axis.experiment().map_or(0, |experiment| experiment.in_force().to_bits()));
    /// What of the command goes against friction.
    FrictionCommand = 20, "friction_command", Narrow, FullCommand, Command::FRAC_NBITS,
        |axis| i64::from(axis.withheld().to_bits());
    /// Count of the second encoder: the spindle, or the master of the gear.
    MasterCount = 21, "master_count", Wide, D, 0, |axis| axis.master().count();
    /// Velocity of the second encoder.
    MasterVelocity = 22, "master_velocity", Narrow, DPerTick, Velocity::FRAC_NBITS,
        |axis| i64::from(axis.master().estimate().velocity.to_bits());
    /// Illegal transitions of the encoder since start-up.
    IllegalTransitions = 23, "illegal_transitions", Word, None, 0, |axis| i64::from(axis.capture_health().illegal);
    /// Ticks since start-up in which edge times were lost.
    OverrunTicks = 24, "overrun_ticks", Word, Tick, 0, |axis| i64::from(axis.capture_health().overrun_ticks);
    /// Ticks since start-up in which the edge times do not explain the count: a reversal, or edges lost.
    AmbiguousTicks = 25, "ambiguous_ticks", Word, Tick, 0, |axis| i64::from(axis.capture_health().ambiguous_ticks);
}

impl Signal {
    /// How its samples are to be read.
    #[must_use]
    pub const fn kind(self) -> Kind {
        self.description().kind
    }

    /// The unit of its value.
    #[must_use]
    pub const fn unit(self) -> Unit {
        self.description().unit
    }

    /// Fractional bits of its value.
    #[must_use]
    pub const fn frac(self) -> u32 {
        self.description().frac
    }
}

impl fmt::Display for Signal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
