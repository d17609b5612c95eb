//! Durations against a time-optimal planner in continuous time.

use leadscrew::setpoint::profile::Limits;
use leadscrew::units::Position;
use proptest::prelude::*;
use rsruckig::prelude::*;

use crate::moves::{Move, any_move};
use crate::seeded::seeded;

/// Duration in ticks of the time-optimal move from rest to rest under the same limits. The oracle works
/// with absolute tolerances, so it gets the problem in units in which distance and jerk are 1.
fn optimal_ticks(distance: Position, limits: &Limits) -> f64 {
    let length = distance.to_num::<f64>().abs();
    let time = (length / limits.jerk().to_num::<f64>()).cbrt();
    let mut input = InputParameter::<1>::new(None);
    input.target_position[0] = 1.0;
    input.max_velocity[0] = limits.velocity().to_num::<f64>() * time / length;
    input.max_acceleration[0] = limits.acceleration().to_num::<f64>() * time * time / length;
    input.max_jerk[0] = 1.0;
    let mut trajectory = Trajectory::new(None);
    Ruckig::<1, ThrowErrorHandler>::new(None, 1.0)
        .calculate(&input, &mut trajectory)
        .unwrap();
    trajectory.get_duration() * time
}

/// True if a move of `distance` cruises at the velocity limit for some ticks, however its phases are rounded.
fn cruises(distance: Position, limits: &Limits) -> bool {
    let (velocity, acceleration, jerk) = (
        limits.velocity().to_num::<f64>(),
        limits.acceleration().to_num::<f64>(),
        limits.jerk().to_num::<f64>(),
    );
    let ramp = if velocity * jerk >= acceleration * acceleration {
        velocity / acceleration + acceleration / jerk
    } else {
        2.0 * (velocity / jerk).sqrt()
    };
    distance.to_num::<f64>().abs() >= velocity * (ramp + 3.0)
}

proptest! {
    #![proptest_config(seeded(2000))]

    #[test]
    fn a_move_takes_at_most_seven_ticks_longer_than_the_time_optimal_one_and_never_less(planned in any_move()) {
        let Move { distance, limits, profile } = planned;
        let optimal = optimal_ticks(distance, &limits);
        let ticks = f64::from(profile.ticks());
        // The oracle's own rounding.
        let error = 1e-9 * optimal;
        prop_assert!(ticks >= optimal - error, "{} ticks are fewer than {}", ticks, optimal);
        prop_assert!(ticks <= optimal + 7.0 + error, "{} ticks are too many for {}", ticks, optimal);
        // With a cruise only the phases of one ramp and the whole are rounded: T₁, T₁ + T₂, and S.
        if cruises(distance, &limits) {
            prop_assert!(ticks < optimal + 3.0 + error, "{} ticks are too many for {} with a cruise", ticks, optimal);
        }
    }
}
