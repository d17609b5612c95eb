//! Feedforward ahead of a planned motion: over the changes of its jerk too.

use leadscrew::controller::Controller;
use leadscrew::controller::config::Gains;
use leadscrew::setpoint::Setpoint;
use leadscrew::setpoint::profile::{Limits, Profile};
use leadscrew::setpoint::trajectory::Trajectory;
use leadscrew::units::Position;

use crate::signals::{Signals, config, demanded, standing};

/// Setpoints of a move that starts in the fifth tick, and of a rest after it.
pub fn motion(distance: f64) -> Vec<Setpoint> {
    let limits = Limits::new(100.0, 0.9, 0.01).unwrap();
    let plan = Profile::plan(Position::from_num(distance), &limits).unwrap();
    let mut trajectory = Trajectory::new();
    trajectory.queue(&plan, 5, u32::MAX).unwrap();
    (0..plan.ticks() + 20)
        .map(|now| trajectory.step(now))
        .collect()
}

/// Velocity, acceleration and jerk half a tick after a setpoint.
pub fn half_a_tick_after(setpoint: &Setpoint) -> [f64; 3] {
    let velocity: f64 = setpoint.velocity.to_num();
    let acceleration: f64 = setpoint.acceleration.to_num();
    let jerk: f64 = setpoint.jerk.to_num();
    [
        velocity + acceleration / 2.0 + jerk / 8.0,
        acceleration + jerk / 2.0,
        jerk,
    ]
}

#[test]
fn it_is_the_inverse_of_the_drive_where_the_command_acts() {
    let weights = [1.0 / 160.0, 14.3 / 160.0, 205.0 / 160.0];
    let [
        velocity_feedforward,
        acceleration_feedforward,
        jerk_feedforward,
    ] = weights;
    let gains = Gains {
        velocity_feedforward,
        acceleration_feedforward,
        jerk_feedforward,
        feedforward_lead: 2.5,
        ..Gains::default()
    };
    for distance in [30_000.0, -2_000.0] {
        let motion = motion(distance);
        let mut controller = Controller::new(config(&gains, 0.0, 0.0, 1.0));
        let (mut judged, mut missed) = (0, 0.0_f64);
        for window in motion.windows(4) {
            let [now, next, due, _] = window else {
                unreachable!()
            };
            let signals = Signals {
                setpoint: *now,
                position: now.position,
                ..standing(0.0)
            };
            let demand = demanded(&mut controller, &signals);
            let asked: f64 = half_a_tick_after(due)
                .iter()
                .zip(weights)
                .map(|(signal, weight)| signal * weight)
                .sum();
            // One change of the jerk is announced; short segments of a plan bring a second one.
            if now.jerk == next.jerk || next.jerk == due.jerk {
                judged += 1;
                assert!((demand - asked).abs() < 3e-6, "{now:?}: {demand} {asked}");
            } else {
                missed = missed.max((demand - asked).abs());
            }
        }
        assert!(judged > motion.len() - 12, "{judged} of {}", motion.len());
        assert!(missed < 0.02, "{missed}");
    }
}
