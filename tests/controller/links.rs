//! The corrective links compare a lagging estimate with the setpoint of the same instant.

use leadscrew::controller::config::Gains;
use leadscrew::controller::{Config, Controller};
use leadscrew::estimator::Estimate;
use leadscrew::setpoint::Setpoint;
use leadscrew::setpoint::profile::{Limits, Profile};
use leadscrew::setpoint::trajectory::Trajectory;
use leadscrew::units::{Acceleration, Position, Velocity};

use crate::signals::{LSB, Signals, demanded, lags};

/// An S-curve with every phase: 60 ticks of jerk, 60 of acceleration, cruise at 72 d/tick.
fn s_curve() -> Vec<Setpoint> {
    let limits = Limits::new(72.0, 0.6, 0.01).unwrap();
    let profile = Profile::plan(Position::from_num(40_000), &limits).unwrap();
    let mut trajectory = Trajectory::new();
    // It stands still for longer than any lag before and after.
    trajectory.queue(&profile, 100, 0).unwrap();
    (1..profile.ticks() + 200)
        .map(|tick| trajectory.step(tick))
        .collect()
}

/// Error that a link of gain 1e-3 sees each tick, for estimates that are the setpoint of `lag` ticks ago
/// and are stated to lag by `stated`.
fn seen_by_link(link: Gains, lag: usize, stated: f64) -> Vec<f64> {
    let config = Config::new(&link, &lags(stated, stated), 0.0, 0.0, 1.0).unwrap();
    let mut controller = Controller::new(config);
    let curve = s_curve();
    let ticks = curve.iter().enumerate().map(|(tick, setpoint)| {
        let then = curve[tick.saturating_sub(lag)];
        let estimate = Estimate {
            velocity: then.velocity,
            acceleration: then.acceleration,
            ..Estimate::default()
        };
        demanded(
            &mut controller,
            &Signals {
                setpoint: *setpoint,
                position: setpoint.position,
                estimate,
            },
        ) * 1e3
    });
    ticks.collect()
}

fn by_velocity() -> Gains {
    Gains {
        velocity: 1e-3,
        ..Gains::default()
    }
}

fn by_acceleration() -> Gains {
    Gains {
        acceleration: 1e-3,
        ..Gains::default()
    }
}

fn largest(errors: &[f64]) -> f64 {
    errors
        .iter()
        .fold(0.0, |largest, error| largest.max(error.abs()))
}

/// What the expansion about this tick's jerk leaves out: ∫ s^`power` |j(t − s) − j(t)| ds over the lag.
fn remainders(lag: usize, power: i32) -> Vec<f64> {
    let jerks: Vec<f64> = s_curve()
        .iter()
        .map(|setpoint| setpoint.jerk.to_num())
        .collect();
    let remainder = |tick: usize| -> f64 {
        let ages = 1..=lag.min(tick);
        // The jerk of `age` ticks ago acts from that tick to the next one; s^power is at most age^power there.
        ages.map(|age| (age as f64).powi(power) * (jerks[tick - age] - jerks[tick]).abs())
            .sum()
    };
    (0..jerks.len()).map(remainder).collect()
}

#[test]
fn with_exact_delayed_estimates_the_links_see_only_what_the_expansion_leaves_out() {
    let (v, a): (f64, f64) = (Velocity::DELTA.to_num(), Acceleration::DELTA.to_num());
    for lag in [1, 4, 8, 20] {
        // Half an LSB of setpoint and estimate each, the setpoint's acceleration and jerk times the lag, and what the
        // weights lack: half of 2⁻³⁰ of their sum (v: 2 + lag/16 LSB per LSB) on 72 d/tick.
        let lag_ticks = lag as f64;
        let rounding = 1e3 * 2.0 * LSB + 72.0 * (2.0 + lag_ticks / 16.0) * 0.5_f64.powi(30);
        let velocity_bound =
            |remainder: f64| remainder + v + lag_ticks * (a + lag_ticks * a / 32.0) + rounding;
        for (seen, remainder) in seen_by_link(by_velocity(), lag, lag_ticks)
            .iter()
            .zip(remainders(lag, 1))
        {
            assert!(
                seen.abs() <= velocity_bound(remainder),
                "lag {lag}: {seen}, left out {remainder}"
            );
        }
        let acceleration_bound = |remainder: f64| remainder + a + lag_ticks * a / 32.0 + rounding;
        for (seen, remainder) in seen_by_link(by_acceleration(), lag, lag_ticks)
            .iter()
            .zip(remainders(lag, 0))
        {
            assert!(
                seen.abs() <= acceleration_bound(remainder),
                "lag {lag}: {seen}, left out {remainder}"
            );
        }
    }
}

#[test]
fn without_the_compensation_they_would_see_the_acceleration_times_the_lag() {
    for lag in [4, 8, 20] {
        let lag_ticks = lag as f64;
        let blind = largest(&seen_by_link(by_velocity(), lag, 0.0));
        assert!((blind / (0.6 * lag_ticks) - 1.0).abs() < 0.01, "{blind}");
        // With it, what is left lasts only while the jerk changes: at most half the lag squared times that change.
        let compensated = seen_by_link(by_velocity(), lag, lag_ticks);
        assert!(largest(&compensated) <= 0.51 * lag_ticks * lag_ticks * 0.01 + 1e-3);
        let sum = |errors: &[f64]| errors.iter().map(|error| error.abs()).sum::<f64>();
        let left = sum(&compensated) / sum(&seen_by_link(by_velocity(), lag, 0.0));
        assert!(left < 0.1, "lag {lag}: {left} of the error is left");
    }
}

#[test]
fn lags_of_half_ticks_count_too() {
    // Constant acceleration 0.5 d/tick²: the setpoint of 8.5 ticks ago was 4.25 d/tick slower.
    let setpoint = Setpoint {
        velocity: Velocity::from_num(20),
        acceleration: Acceleration::lit("0.5"),
        ..Setpoint::default()
    };
    let estimate = Estimate {
        velocity: Velocity::lit("15.75"),
        acceleration: Acceleration::lit("0.5"),
        ..Estimate::default()
    };
    let gains = Gains {
        velocity: 0.1,
        acceleration: 0.1,
        ..Gains::default()
    };
    let mut controller =
        Controller::new(Config::new(&gains, &lags(8.5, 9.0), 0.0, 0.0, 1.0).unwrap());
    for _ in 0..3 {
        let seen = demanded(
            &mut controller,
            &Signals {
                setpoint,
                position: Position::ZERO,
                estimate,
            },
        );
        // The weights' sum is below 0.4 per d/tick; half of 2⁻³⁰ of it on 20 d/tick, and the output's own LSB.
        assert!(seen.abs() < 0.4 * 20.0 * 0.5_f64.powi(30) + LSB, "{seen}");
    }
}
