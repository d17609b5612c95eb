//! Pulses: exact at rest, smooth on the way, lag as stated, and lost rather than followed when too fast.

use leadscrew::setpoint::Setpoint;
use leadscrew::setpoint::step_dir::{Config, StepDir, StepDirParams};
use leadscrew::units::{AxisScale, Position, Velocity};
use proptest::prelude::*;

use crate::ratio::any_fraction;
use crate::seeded::seeded;

const LARGEST: f64 = 150.0;

fn config(over: i64, under: i64, smoothing_ticks: u32) -> Config {
    let params = StepDirParams {
        step_ratio_counts: over as f64,
        step_ratio_steps: under as f64,
        step_smoothing_s: f64::from(smoothing_ticks) / 1000.0,
    };
    let scale = AxisScale::new(1000.0, 1000.0).unwrap();
    params.quantise(scale, Velocity::from_num(LARGEST)).unwrap()
}

/// Standing at `position`, after the first count.
fn started(config: Config, position: Position, count: u32) -> StepDir {
    let mut source = StepDir::new(config);
    source.start(position);
    let first = source.step(count);
    assert_eq!(first.position, position);
    assert!(!source.is_moving());
    source
}

/// Most steps a tick at which the axis is not too fast.
fn most_steps(over: i64, under: i64) -> i64 {
    (150 * under / over.abs()).min(2047)
}

proptest! {
    #![proptest_config(seeded(200))]

    #[test]
    fn at_rest_the_setpoint_is_where_the_pulses_say(
        (over, under) in any_fraction(),
        shares in prop::collection::vec(-1.0..1.0_f64, 1..100),
        bits in 0..6_u32,
        count in any::<u32>(),
    ) {
        let config = config(over, under, 1 << bits);
        let mut source = started(config, Position::from_num(-7), count);
        let (mut now, mut total) = (count, 0_i64);
        for share in shares {
            let steps = (share * most_steps(over, under) as f64) as i64;
            total += steps;
            now = now.wrapping_add(steps as u32);
            source.step(now);
        }
        let mut last = Setpoint::default();
        for _ in 0..=3 << bits {
            last = source.step(now);
        }
        prop_assert!(!source.is_lost() && !source.is_moving());
        let way = (i128::from(over) * i128::from(total) * 65_536).div_euclid(i128::from(under));
        let position = Position::from_num(-7) + Position::from_bits(way as i64);
        prop_assert_eq!(last, Setpoint { position, ..Setpoint::default() });
    }

    #[test]
    fn velocity_and_acceleration_are_those_of_the_position(
        (over, under) in any_fraction(),
        shares in prop::collection::vec(-1.0..1.0_f64, 3..100),
        bits in 2..6_u32,
    ) {
        let mut source = started(config(over, under, 1 << bits), Position::ZERO, 0);
        let mut now = 0_u32;
        let mut seen = vec![Setpoint::default()];
        for share in shares {
            now = now.wrapping_add((share * most_steps(over, under) as f64) as i64 as u32);
            seen.push(source.step(now));
        }
        for three in seen.windows(3) {
            let [before, middle, after] = [0, 1, 2].map(|k| three[k].position.to_num::<f64>());
            let velocity: f64 = three[1].velocity.to_num();
            let acceleration: f64 = three[1].acceleration.to_num();
            // Positions are rounded down to 2⁻¹⁶ d.
            prop_assert!((velocity - (after - before) / 2.0).abs() < 2e-5);
            prop_assert!((acceleration - (after - 2.0 * middle + before)).abs() < 4e-5);
            // A change of speed by twice the largest within a tick, spread over n ticks.
            let length = f64::from(1_u32 << bits);
            prop_assert!(acceleration.abs() <= 2.0 * LARGEST / length + 1e-4);
            let jerk: f64 = three[2].jerk.to_num();
            prop_assert!(jerk.abs() <= 4.0 * LARGEST / (length * length) + 1e-4 || jerk.abs() >= 3.99);
            prop_assert!(velocity.abs() <= LARGEST + 1e-4);
        }
    }

    #[test]
    fn whatever_is_counted_nothing_jumps(counts in prop::collection::vec(any::<u32>(), 1..50)) {
        let mut source = started(config(3, 7, 8), Position::ZERO, 0);
        let mut last = Setpoint::default();
        for count in counts {
            let next = source.step(count);
            let way = (next.position - last.position).to_num::<f64>();
            prop_assert!(way.abs() <= LARGEST + 1e-4);
            prop_assert!((next.acceleration - last.acceleration).to_num::<f64>().abs() <= LARGEST);
            last = next;
        }
    }
}

#[test]
fn a_steady_train_gives_a_steady_velocity_at_the_stated_lag() {
    // 31.25 steps a tick of 2/3 d, across the wrap of the counter.
    let config = config(2, 3, 8);
    assert_eq!(config.lag_ticks(), 11.5);
    let first = u32::MAX - 1000;
    let mut source = started(config, Position::ZERO, first);
    for tick in 1..=400_u32 {
        let pulses = tick * 125 / 4;
        let setpoint = source.step(first.wrapping_add(pulses));
        if tick > 30 {
            let velocity: f64 = setpoint.velocity.to_num();
            let wanted = 31.25 * 2.0 / 3.0;
            assert!((velocity - wanted).abs() < 1e-5, "{velocity}");
            assert!(setpoint.acceleration.to_num::<f64>().abs() < 3e-5);
            // Pulses are counted when they are whole: 3/8 of one on average, 1/4 d.
            let behind = f64::from(tick) * wanted - setpoint.position.to_num::<f64>() - 0.25;
            assert!((behind / wanted - 11.5).abs() < 1e-3, "{}", behind / wanted);
        }
    }
}

#[test]
fn single_pulses_are_bumps_not_kicks() {
    let mut source = started(config(1, 1, 16), Position::ZERO, 0);
    let mut peak = 0.0_f64;
    for tick in 0..500_u32 {
        let setpoint = source.step(tick / 50);
        peak = peak.max(setpoint.acceleration.to_num::<f64>().abs());
    }
    // One d over three averages of 16 ticks: its velocity rises within 24.
    assert!(peak > 0.002 && peak <= 1.0 / 256.0, "{peak}");
}

#[test]
fn pulses_that_are_too_fast_end_the_motion() {
    let mut source = started(config(1, 1, 8), Position::ZERO, 0);
    let mut count = 0;
    for _ in 0..50 {
        count += 100;
        source.step(count);
    }
    assert!(!source.is_lost());
    count += 152;
    source.step(count);
    assert!(source.is_lost());
    let mut last = Setpoint::default();
    for _ in 0..40 {
        count += 100;
        last = source.step(count);
    }
    assert!(!source.is_moving() && source.is_lost());
    assert_eq!(last.position, Position::from_num(5000));
    assert_eq!(last.velocity, Velocity::ZERO);
    // Selected anew it stands where it is, and goes on from there.
    source.start(last.position);
    source.step(count);
    assert!(!source.is_lost());
}

#[test]
fn parameters_are_refused_by_name() {
    let scale = AxisScale::new(1000.0, 1000.0).unwrap();
    let refused = |change: fn(&mut StepDirParams)| {
        let mut params = StepDirParams::default();
        change(&mut params);
        params
            .quantise(scale, Velocity::from_num(LARGEST))
            .unwrap_err()
            .to_string()
    };
    assert!(refused(|p| p.step_ratio_counts = 0.0).starts_with("step_ratio_counts = 0 is out"));
    assert!(refused(|p| p.step_ratio_steps = 0.5).starts_with("step_ratio_steps = 0.5 is out"));
    assert!(refused(|p| p.step_smoothing_s = 0.4).starts_with("step_smoothing_s = 0.4 is out"));
}
