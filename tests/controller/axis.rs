//! Whatever comes in, nothing overflows and the output keeps its limit.

use leadscrew::axis::{Axis, Inputs};
use leadscrew::controller::config::Gains;
use leadscrew::controller::{Config, Controller};
use leadscrew::estimator::{Estimate, EstimatorConfig, Lags};
use leadscrew::hal::{Capture, Latch};
use leadscrew::output::{self, ActiveLimits};
use leadscrew::params::AxisConfig;
use leadscrew::setpoint::Setpoint;
use leadscrew::setpoint::profile::{Limits, Profile};
use leadscrew::setpoint::trajectory::QueueError;
use leadscrew::units::{Acceleration, Command, Jerk, Lag, Position, Velocity};
use proptest::prelude::*;

use crate::seeded::seeded;

/// Gains of any size that validation passes.
fn any_config() -> impl Strategy<Value = Config> {
    let gain = || prop_oneof![Just(0.0), Just(1e6), (1e-9_f64.ln()..1e6_f64.ln()).prop_map(f64::exp)];
    let link = || (gain(), any::<bool>()).prop_map(|(gain, negative)| if negative { -gain } else { gain });
    let feedforward = (gain(), gain(), gain());
    let rest = (prop_oneof![Just(0.0), Just(1.9e-3)], 0.0..=1000.0_f64, -1.0..=1.0_f64, 1.0..1e6_f64);
    ((gain(), gain(), link(), link()), feedforward, rest).prop_filter_map("beyond the common scale", |(feedback, forward, rest)| {
        let (position, derivative, velocity, acceleration) = feedback;
        let (velocity_feedforward, acceleration_feedforward, jerk_feedforward) = forward;
        let (integral, deadband, bias, transfer_ticks) = rest;
        let gains = Gains { position, integral, derivative, velocity, acceleration, velocity_feedforward, acceleration_feedforward, jerk_feedforward };
        Config::new(&gains, deadband, bias, transfer_ticks).ok()
    })
}

/// Bits from anywhere, the extremes often.
fn extreme_i32() -> impl Strategy<Value = i32> {
    prop_oneof![Just(i32::MIN), Just(i32::MAX), any::<i32>(), -100..100_i32]
}

fn extreme_i64() -> impl Strategy<Value = i64> {
    prop_oneof![Just(i64::MIN), Just(i64::MAX), any::<i64>(), any::<i32>().prop_map(i64::from)]
}

fn any_setpoint() -> impl Strategy<Value = Setpoint> {
    (extreme_i64(), extreme_i32(), extreme_i32(), extreme_i32()).prop_map(|(position, velocity, acceleration, jerk)| Setpoint {
        position: Position::from_bits(position),
        velocity: Velocity::from_bits(velocity),
        acceleration: Acceleration::from_bits(acceleration),
        jerk: Jerk::from_bits(jerk),
    })
}

fn any_estimate() -> impl Strategy<Value = Estimate> {
    let lag = || any::<u32>().prop_map(Lag::from_bits);
    let lags = (lag(), lag(), lag()).prop_map(|(position, velocity, acceleration)| Lags { position, velocity, acceleration });
    (extreme_i64(), extreme_i32(), extreme_i32(), lags).prop_map(|(position, velocity, acceleration, lags)| Estimate {
        position: Position::from_bits(position),
        velocity: Velocity::from_bits(velocity),
        acceleration: Acceleration::from_bits(acceleration),
        lags,
    })
}

fn any_limits() -> impl Strategy<Value = ActiveLimits> {
    any::<(bool, bool, bool)>().prop_map(|(high, low, slew)| ActiveLimits { high, low, slew })
}

proptest! {
    #![proptest_config(seeded(1000))]

    // Overflow checks are on in this profile: an overflow is a panic.
    #[test]
    fn the_controller_takes_any_bits_whatever(
        config in any_config(),
        other in any_config(),
        ticks in prop::collection::vec((any_setpoint(), extreme_i64(), any_estimate(), any_limits()), 1..30),
    ) {
        let mut controller = Controller::new(config);
        let half = ticks.len() / 2;
        for (tick, (setpoint, position, estimate, active)) in ticks.into_iter().enumerate() {
            if tick == half {
                controller.reconfigure(other, Command::ONE);
            }
            controller.step(&setpoint, Position::from_bits(position), &estimate, active);
        }
    }
}

/// What may happen to an axis between two ticks and in the next one.
#[derive(Clone, Debug)]
enum Event {
    /// Words of the hardware, and the enable line.
    Tick { words: Words, enable: bool },
    /// The same again and again: long enough for filters and integral to fill up.
    Ticks { words: Words, times: u8 },
    Queue { distance: i64, ahead: u32 },
    Reconfigure { estimator: usize, controller: Config, limit: f64, slew: f64 },
}

#[derive(Clone, Debug)]
struct Words {
    count: u32,
    /// The count is the previous one plus this, rather than any.
    step: Option<i32>,
    sampled_at: u32,
    last_edge_at: Option<u32>,
    edges: (usize, usize),
    illegal: u16,
    overrun: bool,
    latches: (Option<(u32, u32)>, Option<(u32, u32)>),
}

fn words() -> impl Strategy<Value = Words> {
    let latch = || prop::option::of(any::<(u32, u32)>());
    let step = prop_oneof![Just(None), (-200..200_i32).prop_map(Some), (-5000..5000_i32).prop_map(Some)];
    let times = (any::<u32>(), any::<Option<u32>>(), (0..200_usize, 0..200_usize));
    (any::<u32>(), step, times, any::<u16>(), any::<bool>(), (latch(), latch())).prop_map(
        |(count, step, (sampled_at, last_edge_at, edges), illegal, overrun, latches)| Words {
            count,
            step,
            sampled_at,
            last_edge_at,
            edges,
            illegal,
            overrun,
            latches,
        },
    )
}

fn event() -> impl Strategy<Value = Event> {
    let distance = prop_oneof![-(1000_i64 << 16)..1000 << 16, extreme_i64()];
    let ahead = prop_oneof![0..20_u32, any::<u32>()];
    let reconfigure = (0..EstimatorConfig::NAMES.len(), any_config(), 1e-4..1.0_f64, 1e-6..2.0_f64);
    prop_oneof![
        6 => (words(), prop::bool::weighted(0.9)).prop_map(|(words, enable)| Event::Tick { words, enable }),
        1 => (words(), 2..100_u8).prop_map(|(words, times)| Event::Ticks { words, times }),
        2 => (distance, ahead).prop_map(|(distance, ahead)| Event::Queue { distance, ahead }),
        1 => reconfigure.prop_map(|(estimator, controller, limit, slew)| Event::Reconfigure { estimator, controller, limit, slew }),
    ]
}

fn config(estimator: usize, controller: Config, limit: f64, slew: f64) -> AxisConfig {
    AxisConfig {
        estimator: EstimatorConfig::by_name(EstimatorConfig::NAMES[estimator]).unwrap().unwrap(),
        controller,
        output: output::Config::new(limit, slew).unwrap(),
        limits: Limits::new(1000.0, 100.0, 3.0).unwrap(),
    }
}

/// An axis, and what its output may be.
struct Watched {
    axis: Axis,
    limit: Command,
    slew: Command,
    /// Above the limit only on the way down to one newly lowered.
    allowed: Command,
    count: u32,
    tick: u32,
}

impl Watched {
    fn tick(&mut self, words: &Words, enable: bool) {
        let times = [0_u32; 200];
        let latch = |words: Option<(u32, u32)>| words.map(|(count, time)| Latch { count, time });
        self.count = words.step.map_or(words.count, |step| self.count.wrapping_add_signed(step));
        let capture = Capture {
            count: self.count,
            sampled_at: words.sampled_at,
            last_edge_at: words.last_edge_at,
            edges: [&times[..words.edges.0], &times[..words.edges.1]],
            illegal: words.illegal,
            overrun: words.overrun,
            index: latch(words.latches.0),
            probe: latch(words.latches.1),
        };
        let outputs = self.axis.step(&Inputs { capture, enable });
        self.allowed = self.limit.max(self.allowed.saturating_sub(self.slew));
        assert!(outputs.command.abs() <= self.allowed, "{outputs:?}");
        if !enable {
            assert_eq!((outputs.command, outputs.limits), (Command::ZERO, ActiveLimits::default()));
            assert!(!outputs.moving && !outputs.enabled);
            self.allowed = self.limit;
        }
        assert_eq!(outputs.tick, self.tick);
        assert_eq!(outputs.count as u32, self.count);
        self.tick = self.tick.wrapping_add(1);
    }

    fn event(&mut self, event: Event) {
        match event {
            Event::Tick { words, enable } => self.tick(&words, enable),
            Event::Ticks { words, times } => (0..times).for_each(|_| self.tick(&words, true)),
            Event::Queue { distance, ahead } => {
                if let Ok(profile) = Profile::plan(Position::from_bits(distance), &self.axis.config().limits) {
                    let _ = self.axis.queue(&profile, self.tick.wrapping_add(ahead));
                }
            }
            Event::Reconfigure { estimator, controller, limit, slew } => {
                let before = self.limit;
                self.axis.reconfigure(config(estimator, controller, limit, slew));
                self.limit = Command::from_num(limit);
                self.slew = Command::saturating_from_num(slew);
                self.allowed = self.allowed.max(before);
            }
        }
    }
}

proptest! {
    #![proptest_config(seeded(300))]

    #[test]
    fn for_any_sequence_of_captures_and_calls_the_command_keeps_its_limit_and_is_zero_while_disabled(
        estimator in 0..EstimatorConfig::NAMES.len(),
        controller in any_config(),
        events in prop::collection::vec(event(), 1..80),
    ) {
        let axis = Axis::new(config(estimator, controller, 0.5, 0.3));
        let (limit, slew) = (Command::lit("0.5"), Command::from_num(0.3));
        let mut watched = Watched { axis, limit, slew, allowed: limit, count: 0, tick: 0 };
        for event in events {
            watched.event(event);
        }
    }
}

fn quiet_axis() -> Axis {
    let gains = Gains { position: 0.01, integral: 1e-5, ..Gains::default() };
    Axis::new(config(0, Config::new(&gains, 0.0, 0.0, 50.0).unwrap(), 1.0, 2.0))
}

fn still(count: u32, enable: bool) -> Inputs<'static> {
    Inputs { capture: Capture { count, ..Capture::default() }, enable }
}

#[test]
fn an_axis_is_enabled_where_it_stands_without_a_command() {
    let mut axis = quiet_axis();
    axis.step(&still(12_000, false));
    for _ in 0..100 {
        let outputs = axis.step(&still(12_345, true));
        assert_eq!((outputs.following_error.to_bits(), outputs.command), (0, Command::ZERO));
        assert_eq!(outputs.setpoint.position, Position::lit("12345.5"));
    }
}

#[test]
fn a_shaft_turned_by_hand_while_disabled_is_not_brought_back() {
    let mut axis = quiet_axis();
    (0..10).for_each(|_| _ = axis.step(&still(0, true)));
    (0..10).for_each(|_| _ = axis.step(&still(500, false)));
    assert_eq!(axis.step(&still(500, true)).command, Command::ZERO);
}

#[test]
fn a_move_needs_an_enabled_axis_and_is_dropped_with_it() {
    let mut axis = quiet_axis();
    let profile = Profile::plan(Position::from_num(100), &axis.config().limits).unwrap();
    axis.step(&still(0, false));
    assert_eq!(axis.queue(&profile, 5), Err(QueueError::Disabled));
    axis.step(&still(0, true));
    assert_eq!(axis.queue(&profile, 1), Err(QueueError::Late), "tick 1 has just been evaluated");
    axis.queue(&profile, 2).unwrap();
    assert!(axis.step(&still(0, true)).moving);
    assert!(!axis.step(&still(0, false)).moving);
    for _ in 0..20 {
        let outputs = axis.step(&still(0, true));
        assert_eq!((outputs.moving, outputs.setpoint.position), (false, Position::lit("0.5")));
    }
}

#[test]
fn a_new_configuration_does_not_move_the_output_and_a_new_estimator_starts_afresh() {
    let mut axis = quiet_axis();
    axis.step(&still(0, true));
    let before = (0..50).map(|_| axis.step(&still(30, true))).last().unwrap();
    assert!(before.command != Command::ZERO);
    let gains = Gains { position: 0.05, ..Gains::default() };
    let exponential = 1;
    axis.reconfigure(config(exponential, Config::new(&gains, 0.0, 0.1, 50.0).unwrap(), 1.0, 2.0));
    let after = axis.step(&still(30, true));
    assert_eq!(after.command, before.command);
    assert_eq!(after.estimate.position, Position::lit("30.5"), "no jump from zero");
    assert_eq!(axis.config().estimator.name(), "exponential");
}
