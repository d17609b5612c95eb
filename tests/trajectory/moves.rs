//! Random moves: machines from a slow retrofit to a fast direct drive, and the corners of the formats.

use leadscrew::setpoint::Setpoint;
use leadscrew::setpoint::profile::{Limits, Profile};
use leadscrew::setpoint::trajectory::Trajectory;
use leadscrew::units::{AxisScale, Position};
use proptest::prelude::*;

/// Uniform in the logarithm.
fn log_uniform(low: f64, high: f64) -> impl Strategy<Value = f64> + Clone {
    (low.ln()..high.ln()).prop_map(f64::exp)
}

/// Limits of a machine: 100 Hz to 40 kHz, 10 to 1e5 d/mm, feeds to 60 m/min, 0.001 to 10 g, jerks to 5 000 m/s³.
pub fn machine_limits() -> impl Strategy<Value = Limits> {
    let tick_hz = log_uniform(100.0, 40_000.0);
    let counts_per_mm = log_uniform(10.0, 1e5);
    let feed = log_uniform(1.0, 60_000.0);
    (
        tick_hz,
        counts_per_mm,
        feed,
        log_uniform(0.01, 100.0),
        log_uniform(0.1, 5000.0),
    )
        .prop_filter_map(
            "beyond the formats",
            |(tick_hz, counts_per_mm, feed, acceleration, jerk)| {
                let scale = AxisScale::new(counts_per_mm, tick_hz).ok()?;
                let velocity = scale.velocity_from_feed(feed).ok()?;
                Limits::new(
                    velocity,
                    scale.acceleration_from_m_s2(acceleration),
                    scale.jerk_from_m_s3(jerk),
                )
                .ok()
            },
        )
}

/// Any limits that the formats carry.
pub fn format_limits() -> impl Strategy<Value = Limits> {
    (
        log_uniform(1e-4, 2047.0),
        log_uniform(6e-6, 127.0),
        log_uniform(2e-9, 3.9),
    )
        .prop_map(|(velocity, acceleration, jerk)| {
            Limits::new(velocity, acceleration, jerk).unwrap()
        })
}

/// 1 LSB of a position to 1e6 d, both ways.
pub fn distance() -> impl Strategy<Value = Position> {
    let size = log_uniform(Position::DELTA.to_num(), 1e6).prop_map(Position::from_num::<f64>);
    (size, any::<bool>()).prop_map(|(size, back)| {
        if back {
            -size.max(Position::DELTA)
        } else {
            size.max(Position::DELTA)
        }
    })
}

/// A distance and limits, and what was planned for them.
#[derive(Clone, Copy, Debug)]
pub struct Move {
    pub distance: Position,
    pub limits: Limits,
    pub profile: Profile,
}

impl Move {
    pub fn plan(distance: Position, limits: Limits) -> Option<Self> {
        Some(Self {
            distance,
            limits,
            profile: Profile::plan(distance, &limits).ok()?,
        })
    }
}

/// Moves that can be planned.
pub fn any_move() -> impl Strategy<Value = Move> {
    let limits = prop_oneof![machine_limits(), format_limits()];
    (distance(), limits).prop_filter_map("too long", |(distance, limits)| {
        Move::plan(distance, limits)
    })
}

/// Moves of up to `ticks`.
pub fn move_within(ticks: u32) -> impl Strategy<Value = Move> {
    any_move().prop_filter("too long to evaluate here", move |planned| {
        planned.profile.ticks() <= ticks
    })
}

/// Starts `profile` at tick `start` and calls `visit` with the setpoint of every tick from there to the target.
pub fn run(
    trajectory: &mut Trajectory,
    profile: &Profile,
    start: u32,
    mut visit: impl FnMut(Setpoint),
) {
    trajectory
        .queue(profile, start, start.wrapping_sub(1))
        .unwrap();
    for tick in 0..=profile.ticks() {
        visit(trajectory.step(start.wrapping_add(tick)));
    }
}
