//! The encoder "real" on a shaft that trembles by 1.7 d with a period of 90 ticks and drifts by 3 d.

use leadscrew::calibration::{Learned, Learner, Refusal, Requirements, RunPlan};
use leadscrew::encoder_map::Direction;

use crate::generator::{Memory, Shaft, learn, ticks};
use crate::motion::{Dice, Motion};
use crate::truth::Off;

/// Learns from runs in both directions at each of `speeds` d/tick.
fn run_both_ways(
    learner: &mut Learner<'_>,
    shaft: &Shaft,
    revolutions: u32,
    speeds: &[f64],
    seed: u64,
) {
    let mut dice = Dice::new(seed);
    for (number, &speed) in (0..).zip(speeds) {
        for velocity in [speed, -speed] {
            let motion = Motion::calibrating(velocity, &mut dice);
            let seed = seed * 100 + 2 * number + u64::from(velocity < 0.0);
            learn(
                learner,
                RunPlan::steady(revolutions),
                ticks(shaft, motion, revolutions, seed),
            )
            .unwrap();
        }
    }
}

/// The map of a shaft, in its memory.
fn map<'m>(
    memory: &'m mut Memory,
    shaft: &Shaft,
    revolutions: u32,
    speeds: &[f64],
    seed: u64,
) -> Result<Learned<'m>, Refusal> {
    let mut learner = memory.learner();
    run_both_ways(&mut learner, shaft, revolutions, speeds, seed);
    learner.finish(&Requirements::default())
}

#[test]
fn forty_revolutions_at_two_speeds_both_ways_give_the_map() {
    for seed in 1..=5 {
        let shaft = Shaft::real(seed);
        let mut memory = Memory::new(shaft.edges());
        let learned = map(&mut memory, &shaft, 40, &[83.3, 66.7], seed).unwrap();
        for direction in [Direction::Forward, Direction::Backward] {
            let off = Off::new(&learned, &shaft, direction);
            assert!(off.rms() < 0.0007, "{}", off.rms());
            for order in 1..=10 {
                let amplitude = off.amplitude(order);
                assert!(amplitude < 0.0002, "{order}: {amplitude}");
            }
        }
        assert_eq!(learned.index_front(Direction::Forward), Some(0));
        assert_eq!(learned.index_front(Direction::Backward), Some(2));
        let hysteresis = learned.report().hysteresis_a_less_b_d.unwrap();
        assert!((hysteresis - 0.02).abs() < 0.0002, "{hysteresis}");
    }
}

#[test]
fn speeds_chosen_without_thought_still_satisfy_the_figures() {
    // 100 and 60 d/tick: 1.11 and 1.85 cycles a revolution.
    for seed in 1..=5 {
        let shaft = Shaft::real(seed);
        let mut memory = Memory::new(shaft.edges());
        let learned = map(&mut memory, &shaft, 40, &[100.0, 60.0], seed).unwrap();
        let off = Off::new(&learned, &shaft, Direction::Forward);
        assert!(off.rms() < 0.003, "{}", off.rms());
        for order in 1..=10 {
            let amplitude = off.amplitude(order);
            assert!(amplitude < 0.004, "{order}: {amplitude}");
        }
    }
}

#[test]
fn the_fewest_revolutions_give_a_map_at_well_chosen_speeds() {
    let shaft = Shaft::real(1);
    let mut memory = Memory::new(shaft.edges());
    let learned = map(&mut memory, &shaft, 12, &[83.3, 48.0], 1).unwrap();
    let off = Off::new(&learned, &shaft, Direction::Forward);
    assert!(off.rms() < 0.0015, "{}", off.rms());
}

#[test]
fn the_report_estimates_the_errors_of_the_map() {
    let within = |stated: f64, true_value: f64, factor: f64| {
        let ratio = stated / true_value;
        assert!(
            ratio < factor && ratio > 1.0 / factor,
            "{stated} {true_value}"
        );
    };
    for (revolutions, speeds) in [(40, [83.3, 66.7]), (20, [83.3, 66.7]), (40, [100.0, 60.0])] {
        let (mut stated, mut real) = ([0.0; 4], [0.0; 4]);
        let mut standing = 0.0;
        for seed in 1..=5 {
            let shaft = Shaft::real(seed);
            let mut memory = Memory::new(shaft.edges());
            let learned = map(&mut memory, &shaft, revolutions, &speeds, seed).unwrap();
            let off = Off::new(&learned, &shaft, Direction::Forward);
            let residual = learned.report().residual;
            let white = (off.rms().powi(2) - off.harmonics(0).powi(2)).sqrt();
            let pairs = [
                (residual.edge_sigma_d, white),
                (residual.long_wave_d, off.harmonics(0)),
                (residual.slope, off.harmonics(1)),
                (residual.curvature_per_d, off.harmonics(2)),
            ];
            standing += residual.standing_slope.powi(2);
            for ((stated, real), pair) in stated.iter_mut().zip(&mut real).zip(pairs) {
                *stated += pair.0 * pair.0;
                *real += pair.1 * pair.1;
            }
        }
        within(stated[0].sqrt(), real[0].sqrt(), 1.05);
        // Four runs at two speeds tell the long waves to a factor.
        for kind in 1..4 {
            within(stated[kind].sqrt(), real[kind].sqrt(), 1.8);
        }
        // At well-chosen speeds nothing but noise is left; at 100 and 60 d/tick the wobble is.
        if speeds[1] == 60.0 {
            within(standing.sqrt(), real[2].sqrt(), 1.8);
        } else {
            assert!(
                standing.sqrt() < 0.7 * real[2].sqrt(),
                "{standing} {real:?}"
            );
        }
    }
}

#[test]
fn the_report_shows_what_a_map_leaves_on_another_run() {
    let shaft = Shaft::real(3);
    let mut memory = Memory::new(shaft.edges());
    let learned = map(&mut memory, &shaft, 40, &[83.3, 48.0], 3).unwrap();
    let report = learned.report();
    assert_eq!(report.runs().len(), 4);
    let last = report.runs()[3];
    let left = last.less_earlier_runs.unwrap();
    // Eccentricity 1.5 d, second harmonic 0.3 d, lines 0.10 d, edges 0.03 d.
    assert!(
        (last.errors.first - 1.06).abs() < 0.02 && left.first < 0.0005,
        "{left:?}"
    );
    assert!((last.errors.second - 0.21).abs() < 0.02 && left.second < 0.0005);
    assert!((last.errors.lines - 0.10).abs() < 0.01 && left.lines < 0.001);
    assert!((last.errors.edges - 0.026).abs() < 0.005 && left.edges < 0.002);
    assert!(
        last.halves.first < 0.01 && last.halves.second < 0.01,
        "{:?}",
        last.halves
    );
    let noise = report.noise.unwrap();
    assert!((noise.place_d - 0.005).abs() < 0.0003, "{noise:?}");
    assert!(noise.time_s > 1e-8 && noise.time_s < 3e-8, "{noise:?}");
}

#[test]
fn a_tremble_in_step_with_the_shaft_at_one_speed_shows_and_is_refused() {
    let shaft = Shaft::real(2);
    let mut memory = Memory::new(shaft.edges());
    // 111.1 d/tick: once a revolution.
    let refused = map(&mut memory, &shaft, 40, &[111.1, 66.7], 2).unwrap_err();
    let Refusal::RunsDisagree {
        order,
        difference_d,
        ..
    } = refused
    else {
        panic!("{refused}");
    };
    assert_eq!(order, 1);
    assert!(difference_d > 0.3, "{difference_d}");
}

#[test]
fn a_hum_in_step_with_the_shaft_at_one_speed_shows_in_short_waves() {
    // 300 Hz: 36.0 times a revolution at 83.3 d/tick, 45.0 times at 66.7, 39.5 times at 76.
    let learn_at = |speeds: [f64; 2]| {
        let shaft = Shaft::real(2);
        let mut memory = Memory::new(shaft.edges());
        let mut learner = memory.learner();
        for (seed, velocity) in (1..).zip([speeds[0], -speeds[1]]) {
            let motion = Motion {
                wobble_d: 0.05,
                wobble_ticks: 10.0 / 3.0,
                ..Motion::steady(velocity)
            };
            let run = ticks(&shaft, motion, 40, seed);
            learn(&mut learner, RunPlan::steady(40), run).unwrap();
        }
        let finished = learner.finish(&Requirements::default());
        finished.map(|learned| Off::new(&learned, &shaft, Direction::Forward).rms())
    };
    let refused = learn_at([83.3, 66.7]).unwrap_err();
    assert!(
        matches!(refused, Refusal::LinesDisagree { run: 1, .. }),
        "{refused}"
    );
    let off = learn_at([92.3, 76.0]).unwrap();
    assert!(off < 0.001, "{off}");
}

#[test]
fn a_coast_down_gives_the_map_whatever_the_damping() {
    // Constant, mixed, proportional to speed; both wheels slow by a tenth and more.
    for (deceleration, damping) in [(0.006, 0.0), (0.003, 2e-5), (0.0, 4e-5)] {
        let shaft = Shaft::real(4);
        let mut memory = Memory::new(shaft.edges());
        let mut learner = memory.learner();
        for velocity in [150.0, -110.0] {
            let motion = Motion {
                acceleration: -deceleration * f64::signum(velocity),
                damping,
                ..Motion::steady(velocity)
            };
            learn(
                &mut learner,
                RunPlan::coast(40),
                ticks(&shaft, motion, 40, 9),
            )
            .unwrap();
        }
        let learned = learner.finish(&Requirements::default()).unwrap();
        let off = Off::new(&learned, &shaft, Direction::Forward);
        assert!(off.rms() < 0.001, "{}", off.rms());
        for order in 1..=10 {
            let amplitude = off.amplitude(order);
            assert!(amplitude < 0.0002, "{order}: {amplitude}");
        }
    }
}
