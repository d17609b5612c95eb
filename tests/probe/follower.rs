//! An axis that stands in for none: its encoder follows the setpoint, its captures are made up.

use leadscrew::axis::{Axis, Inputs, Outputs};
use leadscrew::estimator::EstimatorConfig;
use leadscrew::hal::{Capture, Latch, Lines};
use leadscrew::params::{AxisParams, MotionParams};
use leadscrew::probe::{ProbeEnd, ProbeOrder, ProbeParams, ProbeRefused, Stage};
use leadscrew::supervisor::SupervisorParams;
use leadscrew::units::{Position, Velocity};

/// Clocks of a tick.
const TICK: u32 = 84_000;

/// An encoder that follows the setpoint exactly, all edges timed evenly within the tick.
pub struct Follower {
    pub axis: Axis<'static>,
    pub outputs: Outputs,
    /// Where it is, d.
    pub position: f64,
    pub now: u32,
    times: Vec<u32>,
    pub latch: Option<Latch>,
    pub touching: bool,
    pub lines: Lines,
    pub enable: bool,
}

pub fn params(probe: ProbeParams) -> AxisParams {
    let estimator = EstimatorConfig::by_name("polynomial").unwrap().unwrap();
    AxisParams {
        probe,
        supervisor: SupervisorParams::widest(),
        // Nor has it an index.
        motion: MotionParams {
            counts_per_revolution: 0.0,
            ..MotionParams::default()
        },
        ..AxisParams::new(estimator)
    }
}

impl Follower {
    pub fn new(probe: ProbeParams) -> Self {
        let config = params(probe).validate().unwrap();
        let mut follower = Self {
            axis: Axis::new(config),
            outputs: Outputs::default(),
            position: 0.5,
            now: 0,
            times: Vec::new(),
            latch: None,
            touching: false,
            lines: Lines::default(),
            enable: true,
        };
        for _ in 0..50 {
            follower.step();
        }
        assert!(follower.outputs.enabled);
        follower
    }

    /// A tick: goes to where the setpoint was in the last one.
    pub fn step(&mut self) {
        let to: f64 = self.outputs.setpoint.position.to_num();
        let to = if self.outputs.enabled {
            to
        } else {
            self.position
        };
        self.go(to);
    }

    fn go(&mut self, to: f64) {
        let from = self.position;
        self.times.clear();
        let (low, high) = (from.min(to), from.max(to));
        let mut boundaries: Vec<f64> = ((low.floor() as i64 + 1)..=(high.floor() as i64))
            .map(|boundary| boundary as f64)
            .collect();
        if to < from {
            boundaries.reverse();
        }
        for boundary in boundaries {
            let share = (boundary - from) / (to - from);
            self.times
                .push(self.now.wrapping_add((share * f64::from(TICK)) as u32));
        }
        self.position = to;
        self.now = self.now.wrapping_add(TICK);
        let capture = Capture {
            count: (to.floor() as i64) as u32,
            sampled_at: self.now,
            last_edge_at: self.times.last().copied(),
            edges: [&self.times, &[]],
            touching: self.touching,
            probe: self.latch.take(),
            ..Capture::default()
        };
        let inputs = Inputs {
            lines: self.lines,
            ..Inputs::of(capture, self.enable)
        };
        self.outputs = *self.axis.step(&inputs);
    }

    /// The probe's edge in the middle of the tick that comes: gives the place there.
    pub fn touch(&mut self) -> f64 {
        let to: f64 = self.outputs.setpoint.position.to_num();
        let place = 0.5 * (self.position + to);
        self.latch = Some(Latch {
            count: (place.floor() as i64) as u32,
            time: self.now.wrapping_add(TICK / 2),
        });
        place
    }

    pub fn probe(&mut self, target: f64, retract: f64) -> Result<Position, ProbeRefused> {
        self.axis.probe_towards(&ProbeOrder {
            target: Position::from_num(target),
            feed: Velocity::from_num(1.67),
            retract: Position::from_num(retract),
        })
    }

    /// Until probing is over; says how many ticks it took.
    pub fn finish(&mut self) -> usize {
        for tick in 0..200_000 {
            if !self.axis.probe().is_active() {
                return tick;
            }
            self.step();
        }
        panic!("probing does not end: {:?}", self.axis.probe().stage());
    }

    pub fn reach(&mut self, stage: Stage) {
        for _ in 0..10_000 {
            if self.axis.probe().stage() == stage {
                return;
            }
            self.step();
        }
        panic!("it does not come to {stage:?}");
    }

    pub fn run(&mut self, ticks: usize) {
        for _ in 0..ticks {
            self.step();
        }
    }

    pub fn end(&self) -> Option<ProbeEnd> {
        self.axis.probe().report().end
    }
}
