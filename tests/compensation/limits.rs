//! Setpoint and compensation together stay within the limits of the axis, and what is announced is what is done.

use leadscrew::compensation::{Compensation, CompensationParams, ScrewPoint, ScrewTable};
use leadscrew::setpoint::Setpoint;
use leadscrew::units::{Acceleration, Position, Velocity};
use proptest::prelude::*;

use crate::motion::{axis_limits, config, memory, point, setpoints, with_backlash};
use crate::seeded::seeded;

/// Holds every setpoint against the limits of the axis, and positions against velocities and accelerations.
#[derive(Default)]
struct Watch {
    before: Vec<(Setpoint, f64)>,
}

impl Watch {
    fn see(
        &mut self,
        compensation: &Compensation<'_>,
        commanded: &Setpoint,
        compensated: Setpoint,
    ) {
        let limits = axis_limits();
        assert!(
            compensated.velocity.abs() <= limits.velocity(),
            "{compensated:?}"
        );
        assert!(
            compensated.acceleration.abs() <= limits.acceleration(),
            "{compensated:?}"
        );
        let amount: f64 = compensation.amount().to_num();
        let velocity: f64 = (compensated.velocity - commanded.velocity).to_num();
        if let [.., (_, older), (_, old)] = self.before[..] {
            // What the compensation itself does, by its positions: a unit of 2⁻²⁰ d each.
            let unit = 2.0_f64.powi(-20);
            let (step, step_before) = (amount - old, old - older);
            assert!(
                (step - velocity).abs() < 3.0 * unit,
                "{step} is not {velocity}"
            );
            let acceleration: f64 = (compensated.acceleration - commanded.acceleration).to_num();
            assert!((step - step_before - acceleration).abs() < 4.0 * unit);
        }
        self.before.push((compensated, amount));
    }
}

/// Tables that an axis takes: up to 0.002 d a d between points some hundreds of d apart.
fn points() -> impl Strategy<Value = Vec<ScrewPoint>> {
    prop::collection::vec((200.0..3000.0, -0.00199..0.00199, -0.00199..0.00199), 1..40).prop_map(
        |steps: Vec<(f64, f64, f64)>| {
            let mut last = [-9000.0, 0.0, -1.0];
            let mut points = vec![point(last[0], last[1], last[2])];
            for (length, forward, backward) in steps {
                last[0] += length;
                last[1] += forward * length;
                last[2] += backward * length;
                points.push(point(last[0], last[1], last[2]));
            }
            points
        },
    )
}

proptest! {
    #![proptest_config(seeded(60))]

    #[test]
    fn the_limits_of_the_axis_hold_in_every_tick(
        points in points(),
        distances in prop::collection::vec(-30_000.0..30_000.0_f64, 1..5),
        backlash_mm in 0.0..0.05,
        homed_at in 0..2000_usize,
        lost_after in 1..3000_usize,
    ) {
        let config = config(&with_backlash(backlash_mm));
        let limits = config.setpoint_limits(&axis_limits()).unwrap();
        let mut memory = memory();
        let table = ScrewTable::build(&points, &mut memory).unwrap();
        let mut compensation = Compensation::new(config);
        compensation.set_table(Some(table)).unwrap();
        let mut watch = Watch::default();
        for (tick, commanded) in setpoints(&distances, &limits).iter().enumerate() {
            // Into force and out of it in full motion.
            if tick == homed_at {
                compensation.set_origin(Some(Position::from_num(123.4)));
            } else if tick == homed_at + lost_after {
                compensation.set_origin(None);
            }
            let compensated = compensation.step(commanded);
            watch.see(&compensation, commanded, compensated);
        }
    }

    #[test]
    fn any_setpoints_are_compensated_within_the_reserve(
        words in prop::collection::vec((any::<i64>(), any::<i32>(), any::<i32>()), 1..200),
        near in prop::collection::vec(-20_000.0..20_000.0_f64, 1..200),
        points in points(),
        backlash_mm in 0.0..0.5,
    ) {
        let config = config(&with_backlash(backlash_mm));
        let mut memory = memory();
        let table = ScrewTable::build(&points, &mut memory).unwrap();
        let mut compensation = Compensation::new(config);
        compensation.set_table(Some(table)).unwrap();
        compensation.set_origin(Some(Position::ZERO));
        let wild = words.iter().map(|(position, velocity, acceleration)| Setpoint {
            position: Position::from_bits(*position),
            velocity: Velocity::from_bits(*velocity),
            acceleration: Acceleration::from_bits(*acceleration),
            ..Setpoint::default()
        });
        let tame = near.iter().map(|position| Setpoint {
            position: Position::from_num(*position),
            ..Setpoint::default()
        });
        let mut last = (0.0, 0.0);
        for commanded in wild.chain(tame) {
            compensation.step(&commanded);
            let amount: f64 = compensation.amount().to_num();
            let step = amount - last.0;
            let slack = 2.0_f64.powi(-20);
            prop_assert!(step.abs() <= config.velocity().to_num::<f64>() + slack);
            let gain = step - last.1;
            prop_assert!(gain.abs() <= config.acceleration().to_num::<f64>() + 2.0 * slack);
            last = (amount, step);
        }
    }

    #[test]
    fn the_compensated_place_grows_with_the_commanded_one(
        points in points(),
        distance in 100.0..60_000.0_f64,
    ) {
        let config = config(&with_backlash(0.003));
        let limits = config.setpoint_limits(&axis_limits()).unwrap();
        let mut memory = memory();
        let table = ScrewTable::build(&points, &mut memory).unwrap();
        let mut compensation = Compensation::new(config);
        compensation.set_table(Some(table)).unwrap();
        compensation.set_origin(Some(Position::ZERO));
        for _ in 0..1000 {
            compensation.step(&Setpoint::default());
        }
        let mut last: Option<Setpoint> = None;
        for commanded in setpoints(&[distance], &limits) {
            let compensated = compensation.step(&commanded);
            if let Some(last) = last {
                let step = compensated.position - last.position;
                // The lead is right to the acceleration: at the end of a jerk-limited stop the place ahead comes
                // back by T²·j·slope = 9² · 0.01 · 0.002 d/tick.
                prop_assert!(step.to_num::<f64>() >= -0.00165, "{step}");
            }
            last = Some(compensated);
        }
    }
}

#[test]
fn without_use_nothing_is_taken_from_the_limits() {
    let unused = config(&CompensationParams::default());
    assert_eq!(
        unused.setpoint_limits(&axis_limits()).unwrap(),
        axis_limits()
    );
    let used = config(&with_backlash(0.003));
    let left = used.setpoint_limits(&axis_limits()).unwrap();
    let share = |left: f64, whole: f64| 1.0 - left / whole;
    let feed = share(left.velocity().to_num(), 150.0);
    assert!((0.0024..0.0026).contains(&feed), "{feed}");
    let acceleration = share(left.acceleration().to_num(), 0.9);
    assert!((0.08..=0.1001).contains(&acceleration), "{acceleration}");
}

#[test]
fn every_tick_rate_keeps_its_shares() {
    use leadscrew::setpoint::profile::Limits;
    use leadscrew::units::AxisScale;
    for tick_hz in [100.0, 1000.0, 2500.0, 10_000.0, 40_000.0] {
        let scale = AxisScale::new(1000.0, tick_hz).unwrap();
        let per_tick = 1000.0 / tick_hz;
        let limits = Limits::new(
            150.0 * per_tick,
            0.9 * per_tick.powi(2),
            (0.01 * per_tick.powi(3)).min(3.0),
        )
        .unwrap();
        let config = with_backlash(0.01).quantise(scale, &limits).unwrap();
        let left = config.setpoint_limits(&limits).unwrap();
        let feed = left.velocity().to_num::<f64>() / limits.velocity().to_num::<f64>();
        let acceleration =
            left.acceleration().to_num::<f64>() / limits.acceleration().to_num::<f64>();
        assert!((0.997..1.0).contains(&feed), "{feed} at {tick_hz}");
        assert!(
            (0.89..1.0).contains(&acceleration),
            "{acceleration} at {tick_hz}"
        );
    }
}
