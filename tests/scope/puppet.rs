//! An axis that is pulled about by captures that no machine gives, and what it gave, written down by hand.

use leadscrew::axis::{Axis, Inputs, Outputs};
use leadscrew::capture::CaptureHealth;
use leadscrew::estimator::EstimatorConfig;
use leadscrew::hal::{Capture, Lines, Reference};
use leadscrew::params::AxisParams;
use leadscrew::scope::Signal;
use leadscrew::setpoint::sources::Source;
use leadscrew::units::{Command, Position};

/// What of an axis can be recorded after a tick, whole.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Row {
    pub outputs: Outputs,
    /// A fault was cleared before the tick.
    pub is_cleared: bool,
    commanded: i64,
    experiment: (i64, i32),
    withheld: i32,
    master: (i64, i32),
    health: CaptureHealth,
}

impl Row {
    pub fn of(axis: &Axis<'_>) -> Self {
        let experiment = axis.experiment();
        Self {
            outputs: *axis.outputs(),
            is_cleared: false,
            commanded: axis.commanded().position.to_bits(),
            experiment: experiment.map_or((0, 0), |now| (now.position(), now.in_force().to_bits())),
            withheld: axis.withheld().to_bits(),
            master: (
                axis.master().count(),
                axis.master().estimate().velocity.to_bits(),
            ),
            health: axis.capture_health(),
        }
    }

    /// The whole value of a signal, by its name.
    pub fn value(&self, signal: Signal) -> i64 {
        let outputs = &self.outputs;
        match signal.name() {
            "tick" => outputs.tick.into(),
            "count" => outputs.count,
            "position" => outputs.estimate.position.to_bits(),
            "velocity" => outputs.estimate.velocity.to_bits().into(),
            "acceleration" => outputs.estimate.acceleration.to_bits().into(),
            "setpoint_position" => outputs.setpoint.position.to_bits(),
            "setpoint_velocity" => outputs.setpoint.velocity.to_bits().into(),
            "setpoint_acceleration" => outputs.setpoint.acceleration.to_bits().into(),
            "setpoint_jerk" => outputs.setpoint.jerk.to_bits().into(),
            "following_error" => outputs.following_error.to_bits().into(),
            "command" => outputs.command.to_bits().into(),
            "flags" => leadscrew::telemetry::Record::new(outputs).flags.into(),
            "warnings" => outputs.warnings.bits().into(),
            "state" => outputs.state as i64,
            "fault" => outputs.fault.map_or(0, |fault| fault as i64),
            "reported_position" => outputs.reported.to_bits(),
            "commanded_position" => self.commanded,
            "experiment_position" => self.experiment.0,
            "experiment_command" => self.experiment.1.into(),
            "friction_command" => self.withheld.into(),
            "master_count" => self.master.0,
            "master_velocity" => self.master.1.into(),
            "illegal_transitions" => self.health.illegal.into(),
            "overrun_ticks" => self.health.overrun_ticks.into(),
            "ambiguous_ticks" => self.health.ambiguous_ticks.into(),
            name => panic!("{name} is not known here: say what it is"),
        }
    }
}

/// What is done to the axis before and in a tick.
#[derive(Clone, Copy, Debug, Default)]
pub struct Pull {
    /// Counts that the encoder moves.
    pub delta: i32,
    pub enable: bool,
    pub drive_fault: bool,
    /// Clears fault and warnings.
    pub clear: bool,
    /// The origin, d.
    pub origin: Option<i64>,
    pub analog: f64,
}

pub struct Puppet {
    pub axis: Axis<'static>,
    count: u32,
    master: u32,
}

impl Puppet {
    pub fn new(start: u32) -> Self {
        let estimator = EstimatorConfig::by_name("difference").unwrap().unwrap();
        let mut axis = Axis::new(AxisParams::new(estimator).validate().unwrap());
        axis.select(Source::Analog).unwrap();
        Self {
            axis,
            count: start,
            master: start.wrapping_mul(3),
        }
    }

    pub fn step(&mut self, pull: &Pull) -> Row {
        let mut is_cleared = false;
        if pull.clear {
            is_cleared = self.axis.clear_fault().is_ok();
            self.axis.supervisor_mut().clear_warnings();
            let _ = self.axis.select(Source::Analog);
        }
        if let Some(origin) = pull.origin {
            self.axis.set_origin(Some(Position::from_num(origin)));
        }
        self.count = self.count.wrapping_add(pull.delta.cast_unsigned());
        self.master = self.master.wrapping_sub(pull.delta.cast_unsigned());
        let inputs = Inputs {
            lines: Lines {
                drive_fault: pull.drive_fault,
                ..Lines::default()
            },
            reference: Reference {
                analog: Command::from_num(pull.analog),
                master: Some(Capture {
                    count: self.master,
                    ..Capture::default()
                }),
                ..Reference::default()
            },
            ..Inputs::of(
                Capture {
                    count: self.count,
                    ..Capture::default()
                },
                pull.enable,
            )
        };
        self.axis.step(&inputs);
        Row {
            is_cleared,
            ..Row::of(&self.axis)
        }
    }
}
