//! What is accepted, and the gains that come of it.

use leadscrew::estimator::EstimatorConfig;
use leadscrew::estimator::observer::{Config, Gains, Model, ObserverParams};
use leadscrew::units::{AxisScale, RangeError};

fn with(change: impl Fn(&mut ObserverParams), tick_hz: f64) -> Result<Config, RangeError> {
    let mut params = ObserverParams::default();
    change(&mut params);
    Config::new(&params, AxisScale::new(1000.0, tick_hz).unwrap())
}

#[test]
fn the_default_is_by_name() {
    let by_name = EstimatorConfig::by_name("observer").unwrap().unwrap();
    assert_eq!(
        by_name,
        EstimatorConfig::Observer(Config::of_16k20f3().unwrap())
    );
    assert!(
        (20..2000).contains(&by_name.warm_up_ticks()),
        "{}",
        by_name.warm_up_ticks()
    );
}

#[test]
fn parameters_out_of_range_are_refused_by_name() {
    let name = |result: Result<Config, RangeError>| result.unwrap_err().name;
    assert_eq!(name(with(|params| params.damping = 0.0, 1000.0)), "damping");
    assert_eq!(
        name(with(|params| params.edge_noise_d = f64::NAN, 1000.0)),
        "edge_noise_d"
    );
    assert_eq!(
        name(with(|params| params.natural_period_s = 0.007, 1000.0)),
        "natural_period_ticks"
    );
    assert_eq!(
        name(with(|params| params.delay_s = 0.1, 1000.0)),
        "delay_ticks"
    );
    assert_eq!(
        name(with(
            |params| params.full_command_feed_mm_per_min = 1e6,
            1000.0
        )),
        "full_command_d_per_tick"
    );
}

#[test]
fn the_drive_is_exact_at_each_tick() {
    for (tick_hz, damping) in [(1000.0, 0.5), (40_000.0, 0.5), (100.0, 0.7), (1000.0, 2.0)] {
        let change = |params: &mut ObserverParams| {
            params.damping = damping;
            params.delay_s = 0.0;
            params.full_command_feed_mm_per_min = 960.0;
        };
        let config = with(change, tick_hz).unwrap();
        let [stiffness, drag] = config.jerk_coefficients();
        let omega = core::f64::consts::TAU / (0.09 * tick_hz);
        // A thousand steps of a tick, by the midpoint rule, from v = 1 and from a = 1.
        let after = |mut v: f64, mut a: f64| {
            let step = 1e-4;
            let slope = |v: f64, a: f64| -omega * omega * v - 2.0 * damping * omega * a;
            for _ in 0..10_000 {
                let (half_v, half_a) = (v + a * step / 2.0, a + slope(v, a) * step / 2.0);
                v += half_a * step;
                a += slope(half_v, half_a) * step;
            }
            a
        };
        assert!((-after(1.0, 0.0) / stiffness - 1.0).abs() < 2e-5);
        assert!(((1.0 - after(0.0, 1.0)) / drag - 1.0).abs() < 2e-5);
    }
}

/// The gains for one edge a tick, by an iteration written out for itself.
fn gains_of_one_edge(params: &ObserverParams, drive: bool, coefficients: [f64; 2]) -> [f64; 4] {
    let scale = AxisScale::new(1000.0, 1000.0).unwrap();
    let root = 1000.0_f64.sqrt();
    let [stiffness, drag] = coefficients;
    let jerk_noise = if drive {
        params.model_noise_m_s3
    } else {
        params.motion_noise_m_s3
    };
    let jerk_noise = scale.acceleration_from_m_s2(jerk_noise / root);
    let change = if drive {
        stiffness * params.disturbance_noise_m_s2 / root * 1000.0
    } else {
        0.0
    };
    let by = if drive {
        [0.0, -stiffness, -drag, 1.0]
    } else {
        [0.0; 4]
    };
    let mut transition = [
        [1.0, 1.0, 0.5, 0.0],
        [0.0, 1.0, 1.0, 0.0],
        [0.0, 0.0, 1.0, 0.0],
        [0.0, 0.0, 0.0, 1.0],
    ];
    for (row, share) in [1.0 / 6.0, 0.5, 1.0].into_iter().enumerate() {
        for column in 0..4 {
            transition[row][column] += share * by[column];
        }
    }
    let through = [jerk_noise / 6.0, jerk_noise / 2.0, jerk_noise, 0.0];
    let measured = [1.0, -0.5, 0.125, 0.0];
    let variance = params.edge_noise_d.powi(2) + (params.time_noise_s * 1000.0).powi(2);
    let mut covariance = [[0.0; 4]; 4];
    let mut gains = [0.0; 4];
    for _ in 0..20_000 {
        let mut next = [[0.0; 4]; 4];
        for (i, row) in next.iter_mut().enumerate() {
            for (j, value) in row.iter_mut().enumerate() {
                for k in 0..4 {
                    for l in 0..4 {
                        *value += transition[i][k] * covariance[k][l] * transition[j][l];
                    }
                }
                *value += through[i] * through[j];
            }
        }
        next[3][3] += change * change;
        let seen = next.map(|row| {
            row.iter()
                .zip(measured)
                .map(|(value, share)| value * share)
                .sum::<f64>()
        });
        let innovation: f64 = seen
            .iter()
            .zip(measured)
            .map(|(value, share)| value * share)
            .sum::<f64>()
            + variance;
        gains = seen.map(|value| value / innovation);
        for (i, row) in next.iter_mut().enumerate() {
            for (value, seen) in row.iter_mut().zip(seen) {
                *value -= gains[i] * seen;
            }
        }
        covariance = next;
    }
    gains
}

#[test]
fn gains_solve_the_riccati_equation() {
    let params = ObserverParams::default();
    let config = Config::of_16k20f3().unwrap();
    for model in [Model::Drive, Model::Kinematic] {
        let drive = model == Model::Drive;
        let expected = gains_of_one_edge(&params, drive, config.jerk_coefficients());
        for (found, expected) in Gains::solve(&config).of(model, 0).into_iter().zip(expected) {
            let off = (found - expected).abs();
            assert!(
                off <= 2e-4 * expected.abs(),
                "{model:?}: {found} instead of {expected}"
            );
        }
    }
}

#[test]
fn the_filter_is_stable_at_every_age_of_an_edge() {
    let config = Config::of_16k20f3().unwrap();
    let [stiffness, drag] = config.jerk_coefficients();
    let solved = Gains::solve(&config);
    for model in [Model::Drive, Model::Kinematic] {
        for octave in -6..=10 {
            let gains = solved.of(model, octave);
            // The mean of several ages lies in the middle of the tick.
            let spread = 0.5 / f64::from(1_u32 << octave.max(0));
            for age in [0.5 - spread, 0.5, 0.5 + spread] {
                let mut state = [1.0, 0.0, 0.0, 0.0];
                for _ in 0..20_000 {
                    for _ in 0..1_u32 << (-octave).max(0) {
                        let [x, v, a, d] = state;
                        let jerk = if model == Model::Drive {
                            d - stiffness * v - drag * a
                        } else {
                            0.0
                        };
                        state = [
                            x + v + a / 2.0 + jerk / 6.0,
                            v + a + jerk / 2.0,
                            a + jerk,
                            d,
                        ];
                    }
                    let innovation = -(state[0] - state[1] * age + state[2] * age * age / 2.0);
                    for (part, gain) in state.iter_mut().zip(gains) {
                        *part += gain * innovation;
                    }
                    if state.iter().all(|part| part.abs() < 1e-9) {
                        break;
                    }
                }
                let rest = state
                    .iter()
                    .fold(0.0, |most: f64, part| most.max(part.abs()));
                assert!(
                    rest < 1e-3,
                    "{model:?}, octave {octave}, age {age}: {state:?}"
                );
            }
        }
    }
}

#[test]
fn every_rate_and_drive_in_range_makes_a_configuration() {
    for tick_hz in [100.0, 1000.0, 2500.0, 10_000.0, 40_000.0] {
        for period in [0.002, 0.01, 0.09, 1.0, 10.0] {
            if !(8.0..=20_000.0).contains(&(period * tick_hz)) {
                continue;
            }
            let config = with(
                |params| {
                    params.natural_period_s = period;
                    params.delay_s = 0.0;
                    // In d/tick it is 2 000 at most.
                    params.full_command_feed_mm_per_min = 9600.0;
                },
                tick_hz,
            );
            let config = config.unwrap();
            let gains = Gains::solve(&config).of(Model::Drive, 0);
            assert!(
                gains.iter().all(|gain| gain.is_finite()),
                "{tick_hz} Hz, {period} s: {gains:?}"
            );
            assert!(
                gains[0] > 0.0 && gains[1] > 0.0,
                "{tick_hz} Hz, {period} s: {gains:?}"
            );
        }
    }
}
