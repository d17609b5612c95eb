//! An axis on a board on a machine, whose invariants are checked in every tick.

use leadscrew::axis::{Axis, Outputs};
use leadscrew::estimator::EstimatorConfig;
use leadscrew::hal::Reference;
use leadscrew::params::AxisParams;
use leadscrew::setpoint::profile::Profile;
use leadscrew::setpoint::trajectory::QueueError;
use leadscrew::supervisor::{Fault, FirstFault, State, SupervisorParams};
use leadscrew::units::{Command, Position};
use leadscrew_hal_mock::board::{Board, BoardParams};
use leadscrew_hal_mock::invariants::Invariants;
use leadscrew_hal_mock::machine::MachineParams;
use leadscrew_hal_mock::scenario::MoveAndBack;

/// What a rig is made of.
pub struct Plan {
    pub machine: MachineParams,
    pub board: BoardParams,
    pub supervisor: SupervisorParams,
    pub counts_per_revolution: f64,
    pub estimator: &'static str,
    pub tick_hz: f64,
    pub output_limit: f64,
    pub max_feed_mm_per_min: f64,
}

impl Plan {
    /// The machine with all its imperfections; the index is watched.
    pub fn full() -> Self {
        Self {
            machine: MachineParams::z_16k20f3(),
            board: BoardParams::default(),
            supervisor: SupervisorParams::default(),
            counts_per_revolution: 10_000.0,
            estimator: "simple",
            tick_hz: 1000.0,
            output_limit: 1.0,
            max_feed_mm_per_min: 9000.0,
        }
    }

    pub fn axis_params(&self) -> AxisParams {
        let scenario = MoveAndBack {
            feed_mm_per_min: self.max_feed_mm_per_min,
            ..MoveAndBack::standard(self.tick_hz)
        };
        let nominal = MachineParams::z_16k20f3();
        let estimator = EstimatorConfig::by_name(self.estimator).unwrap().unwrap();
        let estimator = scenario.tuned(&nominal, estimator, false).unwrap();
        let mut params = scenario.axis_params(&nominal, estimator).unwrap();
        params.supervisor = self.supervisor;
        params.motion.counts_per_revolution = self.counts_per_revolution;
        params.output.limit = self.output_limit;
        params
    }

    pub fn rig(&self) -> Rig {
        let config = self.axis_params().validate().unwrap();
        Rig {
            board: Board::new(&self.board, &self.machine, self.tick_hz, 1).unwrap(),
            axis: Axis::new(config),
            invariants: Invariants::new(self.output_limit),
            enable: true,
        }
    }
}

/// An axis on its board.
pub struct Rig {
    pub board: Board,
    pub axis: Axis<'static>,
    invariants: Invariants,
    pub enable: bool,
}

impl Rig {
    /// One tick.
    pub fn step(&mut self) -> Outputs {
        self.board.step(self.axis.outputs());
        let inputs = self.board.inputs(self.enable, Reference::default());
        let outputs = *self.axis.step(&inputs);
        self.invariants.check(&self.axis).unwrap();
        outputs
    }

    pub fn run(&mut self, ticks: u32) -> Outputs {
        (0..ticks).for_each(|_| _ = self.step());
        *self.axis.outputs()
    }

    /// Ticks until `condition` holds; fails after `at_most`.
    #[track_caller]
    pub fn until(&mut self, at_most: u32, condition: impl Fn(&Outputs) -> bool) -> u32 {
        for tick in 1..=at_most {
            if condition(&self.step()) {
                return tick;
            }
        }
        panic!("not within {at_most} ticks: {:?}", self.axis.outputs());
    }

    /// Queues a move that starts with the next tick.
    #[track_caller]
    pub fn go(&mut self, distance_mm: f64) {
        if let Err(error) = self.try_to_go(distance_mm) {
            panic!("{error}: {:?}", self.axis.supervisor().first_fault());
        }
    }

    /// The same where it may be refused: the axis is off, stops, or still moves.
    pub fn try_to_go(&mut self, distance_mm: f64) -> Result<(), QueueError> {
        let distance = Position::from_num(distance_mm * 1000.0);
        let profile = Profile::plan(distance, &self.axis.config().limits).unwrap();
        let start = self.axis.outputs().tick.wrapping_add(1);
        self.axis.queue(&profile, start)
    }

    /// Enabled, and so far into a move of 300 mm that it is at full speed.
    pub fn at_full_speed(&mut self) {
        self.run(100);
        self.go(300.0);
        let outputs = self.run(600);
        assert_eq!((outputs.state, outputs.fault), (State::Moving, None));
        assert!(outputs.setpoint.velocity.to_num::<f64>() > 149.0);
    }

    pub fn clear(&mut self) -> Result<(), leadscrew::supervisor::ClearError> {
        let result = self.axis.clear_fault();
        if result.is_ok() {
            self.invariants.note_cleared();
        }
        result
    }

    pub fn first(&self) -> FirstFault {
        *self
            .axis
            .supervisor()
            .first_fault()
            .expect("a fault is latched")
    }

    /// True position of the shaft, d.
    pub fn shaft(&self) -> f64 {
        self.board.machine.truth().shaft.position
    }

    /// Asserts `fault` at 0 V now; the drive then brakes within `stop_mm` and is off after the time of 0 V.
    #[track_caller]
    pub fn assert_zero_volts(&mut self, fault: Fault, stop_mm: f64) {
        let outputs = *self.axis.outputs();
        assert_eq!(
            outputs.fault,
            Some(fault),
            "{:?}",
            self.axis.supervisor().first_fault()
        );
        assert_eq!(
            (outputs.state, outputs.command),
            (State::Fault, Command::ZERO)
        );
        assert!(outputs.enabled, "enable is kept");
        let start = self.board.machine.truth().shaft.position;
        let kept = self.until(1000, |outputs| !outputs.enabled);
        assert_eq!(kept, 500);
        let way = (self.shaft() - start).abs();
        assert!(way <= stop_mm * 1000.0, "stopped after {way} d");
        self.assert_at_rest();
    }

    /// Asserts `fault` with the drive off now.
    #[track_caller]
    pub fn assert_off(&mut self, fault: Fault) {
        let outputs = *self.axis.outputs();
        assert_eq!(
            outputs.fault,
            Some(fault),
            "{:?}",
            self.axis.supervisor().first_fault()
        );
        assert_eq!(
            (outputs.state, outputs.command),
            (State::Fault, Command::ZERO)
        );
        assert!(!outputs.enabled && !outputs.brake_released);
        self.run(300);
        self.assert_at_rest();
    }

    /// Asserts `fault` now, a deceleration within two ticks, a stop within the plan, and the end in Fault.
    #[track_caller]
    pub fn assert_controlled_stop(&mut self, fault: Fault) {
        let outputs = *self.axis.outputs();
        assert_eq!(
            outputs.fault,
            Some(fault),
            "{:?}",
            self.axis.supervisor().first_fault()
        );
        assert_eq!(outputs.state, State::Stopping);
        let start = outputs.setpoint;
        let speed = start.velocity.abs();
        let second = self.run(2).setpoint;
        assert!(second.velocity.abs() < speed, "decelerates");
        let limits = self.axis.config().limits;
        let (v, a, j): (f64, f64, f64) = (
            speed.to_num(),
            limits.acceleration().to_num(),
            limits.jerk().to_num(),
        );
        // From constant speed: v/a + a/j ticks, v/2 times as long.
        let planned = v / a + a / j;
        let mut ticks = 0;
        let mut end = second.position;
        while self.step().enabled {
            end = self.axis.outputs().setpoint.position;
            ticks += 1;
            assert!(f64::from(ticks) < planned + 3.0, "planned {planned} ticks");
        }
        assert!(
            f64::from(ticks) > planned - 5.0,
            "{ticks} ticks, planned {planned}"
        );
        let outputs = *self.axis.outputs();
        assert_eq!((outputs.state, outputs.fault), (State::Fault, Some(fault)));
        let way: f64 = (end - start.position).to_num();
        assert!(way.abs() < 0.5 * v * planned + 300.0, "way {way}");
        self.run(300);
        self.assert_at_rest();
    }

    #[track_caller]
    fn assert_at_rest(&mut self) {
        let velocity = self.board.machine.truth().shaft.velocity;
        assert!(velocity.abs() < 0.05, "still {velocity} d/tick");
    }
}
