//! Sources on a whole axis: selected at rest only, kept while off, stopped whatever they do.

use leadscrew::axis::{Axis, Inputs, Outputs};
use leadscrew::estimator::EstimatorConfig;
use leadscrew::hal::{Capture, Latch, Lines, Reference};
use leadscrew::params::AxisParams;
use leadscrew::setpoint::profile::Profile;
use leadscrew::setpoint::sources::{GearError, SelectError, Source};
use leadscrew::setpoint::thread::{SpindleWay, ThreadOrder};
use leadscrew::setpoint::trajectory::QueueError;
use leadscrew::supervisor::Fault;
use leadscrew::units::{Command, Position};
use proptest::prelude::*;

use crate::seeded::seeded;

fn axis() -> Axis<'static> {
    let estimator = EstimatorConfig::by_name("simple").unwrap().unwrap();
    let mut params = AxisParams::new(estimator);
    // The captures made here have no index.
    params.motion.counts_per_revolution = 0.0;
    Axis::new(params.validate().unwrap())
}

/// An axis whose encoder is where the setpoint was: it follows.
struct Following {
    axis: Axis<'static>,
    tick: u32,
    reference: Reference<'static>,
}

impl Following {
    fn new() -> Self {
        let mut following = Self {
            axis: axis(),
            tick: 0,
            reference: Reference::default(),
        };
        for _ in 0..50 {
            following.step();
        }
        following
    }

    fn step(&mut self) -> Outputs {
        self.tick += 1;
        let count = self.axis.outputs().setpoint.position.to_bits() >> Position::FRAC_NBITS;
        let capture = Capture {
            count: count as u32,
            sampled_at: self.tick.wrapping_mul(84_000),
            ..Capture::default()
        };
        let inputs = Inputs {
            reference: self.reference,
            ..Inputs::of(capture, true)
        };
        *self.axis.step(&inputs)
    }
}

#[test]
fn pulses_move_the_axis_once_they_are_selected() {
    let mut following = Following::new();
    following.reference.steps = 5000;
    for _ in 0..10 {
        assert!(!following.step().moving);
    }
    following.axis.select(Source::StepDir).unwrap();
    let start = following.step().setpoint.position;
    for _ in 0..100 {
        following.reference.steps += 20;
        following.step();
    }
    assert!(following.axis.outputs().moving);
    assert_eq!(
        following.axis.select(Source::Analog),
        Err(SelectError::Moving)
    );
    let profile = Profile::plan(Position::from_num(10), &following.axis.config().limits).unwrap();
    let now = following.axis.outputs().tick;
    assert_eq!(
        following.axis.queue(&profile, now + 5),
        Err(QueueError::OtherSource)
    );
    for _ in 0..30 {
        following.step();
    }
    let rest = following.step();
    assert_eq!(rest.setpoint.position - start, Position::from_num(2000));
    assert!(!rest.moving && rest.fault.is_none());
    following.axis.select(Source::Trajectory).unwrap();
    following.axis.queue(&profile, now + 500).unwrap();
}

#[test]
fn pulses_that_are_too_fast_are_a_fault_and_stop_the_axis() {
    let mut following = Following::new();
    following.axis.select(Source::StepDir).unwrap();
    for _ in 0..300 {
        following.reference.steps += 100;
        following.step();
    }
    following.reference.steps += 500;
    let lost = following.step();
    assert_eq!(lost.fault, Some(Fault::SetpointLost));
    assert_eq!(following.axis.source(), Source::Trajectory);
    let next = following.step();
    assert!(next.setpoint.acceleration < 0);
    let mut last = next;
    for _ in 0..400 {
        last = following.step();
    }
    assert_eq!(last.setpoint.velocity, 0);
}

#[test]
fn an_analog_command_moves_the_axis_and_a_stop_ends_it() {
    let mut following = Following::new();
    following.axis.select(Source::Analog).unwrap();
    following.reference.analog = Command::from_num(0.5);
    for _ in 0..400 {
        following.step();
    }
    let velocity: f64 = following.step().setpoint.velocity.to_num();
    assert!((velocity - 75.0).abs() < 0.2, "{velocity}");
    assert!(following.axis.outputs().moving);
}

#[test]
fn a_gear_is_engaged_only_when_it_can_be() {
    let mut following = Following::new();
    assert_eq!(
        following.axis.engage_gear(true),
        Err(GearError::NotSelected)
    );
    following.axis.select(Source::Gearing).unwrap();
    assert_eq!(following.axis.engage_gear(true), Err(GearError::NoSignal));
    following.reference.master = Some(Capture::default());
    following.step();
    following.axis.engage_gear(true).unwrap();
    assert_eq!(following.axis.engage_gear(true), Err(GearError::Busy));
    for _ in 0..20 {
        following.step();
    }
    assert_eq!(
        following.axis.select(Source::Analog),
        Err(SelectError::Engaged)
    );
    // The master's cable.
    following.reference.master = None;
    assert_eq!(following.step().fault, Some(Fault::SetpointLost));
    assert_eq!(
        Axis::engage_gear(&mut axis(), true),
        Err(GearError::Disabled)
    );
}

/// What a tick may bring.
#[derive(Clone, Debug)]
struct Any {
    count: u32,
    time: u32,
    master: Option<(u32, u32, Option<u32>)>,
    steps: u32,
    analog: i32,
    lost: bool,
    request: u8,
}

fn any_tick() -> impl Strategy<Value = Any> {
    let near = || prop_oneof![4 => 0..100_u32, 1 => any::<u32>()];
    (
        (near(), near(), near(), any::<i32>()),
        prop::option::weighted(0.9, (near(), near(), prop::option::of(near()))),
        (prop::bool::weighted(0.02), 0..12_u8),
    )
        .prop_map(
            |((count, time, steps, analog), master, (lost, request))| Any {
                count,
                time: time.wrapping_mul(840),
                master,
                steps,
                analog,
                lost,
                request,
            },
        )
}

proptest! {
    #![proptest_config(seeded(200))]

    #[test]
    fn whatever_comes_in_nothing_panics_and_the_output_keeps_its_limits(
        ticks in prop::collection::vec(any_tick(), 1..120),
    ) {
        let mut axis = axis();
        let (mut count, mut master_count, mut steps, mut time) = (0_u32, 0_u32, 0_u32, 0_u32);
        for tick in ticks {
            count = count.wrapping_add(tick.count);
            steps = steps.wrapping_add(tick.steps);
            time = time.wrapping_add(tick.time);
            let edges = [time.wrapping_sub(3), time.wrapping_sub(1)];
            let master = tick.master.map(|(by, _, index)| {
                master_count = master_count.wrapping_add(by);
                Capture {
                    count: master_count,
                    sampled_at: time,
                    edges: [&edges, &[]],
                    index: index.map(|back| Latch {
                        count: master_count.wrapping_sub(back),
                        time: time.wrapping_sub(back),
                    }),
                    ..Capture::default()
                }
            });
            match tick.request {
                0 => drop(axis.select(Source::StepDir)),
                1 => drop(axis.select(Source::Analog)),
                2 => drop(axis.select(Source::Gearing)),
                3 => drop(axis.select(Source::Trajectory)),
                4 => drop(axis.engage_gear(true)),
                5 => drop(axis.engage_gear(false)),
                6 => drop(axis.arm_thread(&ThreadOrder {
                    lead_mm: f64::from(tick.analog).abs() * 1e-8,
                    start_mm: 0.0,
                    from_mm: 50.0,
                    to_mm: 60.0,
                    angle_deg: 0.0,
                    starts: 1,
                    start: 0,
                    spindle: SpindleWay::Forward,
                    retract_deg: 10.0,
                })),
                _ => (),
            }
            let capture = Capture { count, sampled_at: time, ..Capture::default() };
            let outputs = axis.step(&Inputs {
                lines: Lines { master_lost: tick.lost, ..Lines::default() },
                reference: Reference { steps, master, analog: Command::from_bits(tick.analog) },
                ..Inputs::of(capture, true)
            });
            prop_assert!(outputs.command.abs() <= Command::ONE);
        }
    }
}
