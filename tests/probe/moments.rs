//! Wrong moments, and what the debounce makes of edges: captures made up, an axis that stands in for none.

use leadscrew::axis::{Axis, Inputs, Outputs};
use leadscrew::estimator::EstimatorConfig;
use leadscrew::hal::{Capture, Latch, Lines};
use leadscrew::params::{AxisParams, MotionParams};
use leadscrew::probe::{ProbeEnd, ProbeOrder, ProbeParams, ProbeRefused, Stage};
use leadscrew::setpoint::travel::TravelLimits;
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

#[test]
fn a_touch_is_found_between_the_edges_and_the_axis_goes_back() {
    for target in [3000.0, -3000.0] {
        let mut follower = Follower::new(ProbeParams::default());
        let start = follower.position;
        let bound: f64 = follower.probe(target, 200.0).unwrap().to_num();
        follower.run(400);
        let place = follower.touch();
        follower.touching = true;
        follower.reach(Stage::Retract);
        follower.run(5);
        follower.touching = false;
        follower.finish();
        let report = *follower.axis.probe().report();
        assert_eq!(report.end, Some(ProbeEnd::Touched));
        let touch = report.touch.unwrap();
        let raw: f64 = touch.raw.to_num();
        assert!((raw - place).abs() < 0.01, "{raw} instead of {place}");
        assert_eq!(touch.position, touch.raw, "no origin, no compensation");
        let overtravel: f64 = touch.overtravel.to_num();
        assert!(
            overtravel > 20.0 && overtravel <= bound,
            "{overtravel} {bound}"
        );
        let way = if target > 0.0 { 1.0 } else { -1.0 };
        let back = place + way * (overtravel - 200.0) - follower.position;
        // A tick of the way back is 8.3 d: one by which the stop comes early, and one by which it is foreseen.
        assert!(back.abs() < 2.0 * 8.4, "{back}");
        assert!(way * (place - start) > 500.0);
        assert!(touch.edges > 20);
    }
}

#[test]
fn the_trigger_delay_is_taken_off_in_time() {
    let delayed = ProbeParams {
        trigger_delay_s: 0.005,
        ..ProbeParams::default()
    };
    let mut follower = Follower::new(delayed);
    follower.probe(3000.0, 0.0).unwrap();
    follower.run(400);
    let place = follower.touch() - 5.0 * 1.67;
    follower.touching = true;
    follower.finish();
    let raw: f64 = follower.axis.probe().report().touch.unwrap().raw.to_num();
    assert!((raw - place).abs() < 0.01, "{raw} instead of {place}");
}

#[test]
fn the_latch_is_that_of_the_first_edge_whatever_bounces_after_it() {
    let debounced = ProbeParams {
        debounce_s: 0.003,
        ..ProbeParams::default()
    };
    // Level in the ticks after the edge: what is not here stays.
    for bounces in [
        vec![],
        vec![false, true, false, true],
        vec![true, false, true, false, false, true],
        vec![false, false, true, false, false, true, false, false, true],
    ] {
        let mut follower = Follower::new(debounced);
        follower.probe(3000.0, 0.0).unwrap();
        follower.run(400);
        let place = follower.touch();
        let latched_in = follower.outputs.tick.wrapping_add(1);
        follower.touching = true;
        follower.step();
        for &level in &bounces {
            follower.touching = level;
            if level {
                follower.touch();
            }
            follower.step();
        }
        follower.touching = true;
        follower.finish();
        let touch = follower.axis.probe().report().touch.unwrap();
        let raw: f64 = touch.raw.to_num();
        assert!((raw - place).abs() < 0.01, "{bounces:?}: {raw} {place}");
        assert_eq!(touch.tick, latched_in);
        assert_eq!(follower.axis.probe().report().glitches, 0);
    }
}

#[test]
fn a_glitch_is_counted_and_the_next_edge_is_the_touch() {
    let mut follower = Follower::new(ProbeParams::default());
    follower.probe(3000.0, 0.0).unwrap();
    for _ in 0..3 {
        follower.run(100);
        follower.touch();
        follower.run(5);
    }
    assert_eq!(follower.axis.probe().stage(), Stage::Approach);
    follower.run(100);
    let place = follower.touch();
    follower.touching = true;
    follower.finish();
    let report = *follower.axis.probe().report();
    assert_eq!((report.glitches, report.touches), (3, 1));
    let raw: f64 = report.touch.unwrap().raw.to_num();
    assert!((raw - place).abs() < 0.01);
}

#[test]
fn wrong_moments_are_results() {
    // No touch.
    let mut follower = Follower::new(ProbeParams::default());
    follower.probe(300.0, 0.0).unwrap();
    follower.finish();
    assert_eq!(follower.end(), Some(ProbeEnd::NoTouch));
    assert!(
        (follower.position - 300.0).abs() < 5.0,
        "{}",
        follower.position
    );
    assert_eq!(follower.axis.probe().report().touch, None);

    // Already touching: nothing moves.
    let mut follower = Follower::new(ProbeParams::default());
    let before = follower.position;
    follower.touching = true;
    follower.probe(300.0, 0.0).unwrap();
    follower.finish();
    assert_eq!(follower.end(), Some(ProbeEnd::AlreadyTouching));
    assert_eq!(follower.position, before);
    follower.run(50);
    assert_eq!(
        follower.end(),
        Some(ProbeEnd::AlreadyTouching),
        "no touch either"
    );

    // Again on the way back.
    let mut follower = Follower::new(ProbeParams::default());
    follower.probe(3000.0, 500.0).unwrap();
    follower.run(400);
    follower.touch();
    follower.touching = true;
    follower.reach(Stage::Retract);
    follower.run(30);
    follower.touching = false;
    follower.run(10);
    follower.touch();
    follower.touching = true;
    follower.finish();
    assert_eq!(follower.end(), Some(ProbeEnd::TouchedOnRetract));
    assert!(follower.axis.probe().report().touch.is_some());

    // It stays deflected.
    let mut follower = Follower::new(ProbeParams::default());
    follower.probe(3000.0, 20.0).unwrap();
    follower.run(400);
    follower.touch();
    follower.touching = true;
    follower.finish();
    assert_eq!(follower.end(), Some(ProbeEnd::StillTouching));

    // The axis is disabled, or its encoder lost.
    for (lost, end) in [
        (false, ProbeEnd::Interrupted),
        (true, ProbeEnd::EncoderLost),
    ] {
        let mut follower = Follower::new(ProbeParams::default());
        follower.probe(3000.0, 20.0).unwrap();
        follower.run(400);
        follower.lines.encoder_lost = lost;
        follower.enable = lost;
        follower.finish();
        assert_eq!(follower.end(), Some(end));
    }
}

#[test]
fn a_touch_that_nobody_sought_is_told_and_stops_the_axis_where_it_shall() {
    for stops in [false, true] {
        let mut follower = Follower::new(ProbeParams {
            stop_on_touch: f64::from(u8::from(stops)),
            ..ProbeParams::default()
        });
        let limits = follower.axis.config().limits;
        let tick = follower.outputs.tick;
        let mut planner = leadscrew::setpoint::planner::Planner::new(
            limits,
            follower.axis.commanded().position,
            tick,
        );
        let planned = planner.move_to(
            Position::from_num(20_000),
            Velocity::from_num(10),
            tick + 10,
        );
        let timed = planned.unwrap().unwrap();
        follower.axis.queue(&timed.plan, timed.start).unwrap();
        follower.run(500);
        let place = follower.touch();
        follower.touching = true;
        follower.run(3000);
        let report = *follower.axis.probe().report();
        assert_eq!((report.end, report.touches), (Some(ProbeEnd::Unasked), 1));
        let touch = report.touch.unwrap();
        let raw: f64 = touch.raw.to_num();
        assert!((raw - place).abs() <= 1.0, "{raw} {place}");
        if stops {
            let beyond = follower.position - place;
            assert!((0.0..=500.0).contains(&beyond), "{beyond}");
            assert!(!follower.outputs.moving);
        } else {
            assert!(
                (follower.position - 20_000.0).abs() < 1.0,
                "{} {:?}",
                follower.position,
                follower.outputs
            );
        }
    }
}

#[test]
fn what_cannot_be_probed_is_refused_with_its_figures() {
    let mut follower = Follower::new(ProbeParams::default());
    let order = |target: f64, feed: f64| ProbeOrder {
        target: Position::from_num(target),
        feed: Velocity::from_num(feed),
        retract: Position::from_num(100),
    };
    let here = follower.position;
    let mut ask = |order| follower.axis.probe_towards(&order);
    assert_eq!(ask(order(here, 1.0)), Err(ProbeRefused::NoWay));
    assert_eq!(ask(order(500.0, 0.0)), Err(ProbeRefused::FeedOutOfRange));
    assert_eq!(ask(order(500.0, 1000.0)), Err(ProbeRefused::FeedOutOfRange));
    let refused = ask(order(500.0, 50.0)).unwrap_err();
    assert!(
        matches!(refused, ProbeRefused::Overtravel { bound, allowed: 1000 } if bound > 1000),
        "{refused}"
    );
    let travel = |low, high| TravelLimits::new(Position::from_num(low), Position::from_num(high));
    follower.axis.set_travel(Some(travel(-1000, 520).unwrap()));
    let mut ask = |order| follower.axis.probe_towards(&order);
    assert_eq!(ask(order(500.0, 1.67)), Err(ProbeRefused::BeyondTravel));
    follower.axis.set_travel(Some(travel(-50, 1000).unwrap()));
    let mut ask = |order| follower.axis.probe_towards(&order);
    assert_eq!(ask(order(500.0, 1.67)), Err(ProbeRefused::BeyondTravel));
    follower.axis.set_travel(None);
    assert!(follower.probe(500.0, 0.0).is_ok());
    follower.step();
    assert_eq!(follower.probe(500.0, 0.0), Err(ProbeRefused::Moving));
    follower.enable = false;
    follower.run(500);
    assert_eq!(follower.probe(500.0, 0.0), Err(ProbeRefused::NotReady));
}
