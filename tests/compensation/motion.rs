//! Motions to compensate, and configurations to do it by.

use leadscrew::compensation::{
    Compensation, CompensationParams, Config, ScrewError, ScrewPoint, ScrewTable, Stretch,
};
use leadscrew::setpoint::Setpoint;
use leadscrew::setpoint::profile::{Limits, Profile};
use leadscrew::setpoint::trajectory::Trajectory;
use leadscrew::units::{AxisScale, Position};

/// The limits of the reference machine, per tick of 1 ms.
pub fn axis_limits() -> Limits {
    Limits::new(150.0, 0.9, 0.01).unwrap()
}

pub fn config(params: &CompensationParams) -> Config {
    let scale = AxisScale::new(1000.0, 1000.0).unwrap();
    params.quantise(scale, &axis_limits()).unwrap()
}

pub fn with_backlash(backlash_mm: f64) -> CompensationParams {
    CompensationParams {
        backlash_mm,
        screw_table: 1.0,
        ..CompensationParams::default()
    }
}

/// A point at `position` with the errors `forward` and `backward`, all in d.
pub fn point(position: f64, forward: f64, backward: f64) -> ScrewPoint {
    ScrewPoint {
        position: Position::from_num(position),
        error: [forward, backward].map(ScrewError::from_num),
    }
}

/// Memory for the largest table.
pub fn memory() -> Vec<Stretch> {
    vec![Stretch::default(); 255]
}

/// A compensation whose origin is raw position 0.
pub fn at_origin<'m>(config: Config, table: Option<ScrewTable<'m>>) -> Compensation<'m> {
    let mut compensation = Compensation::new(config);
    compensation.set_table(table).unwrap();
    compensation.set_origin(Some(Position::ZERO));
    compensation
}

pub fn standing(position: f64) -> Setpoint {
    Setpoint {
        position: Position::from_num(position),
        ..Setpoint::default()
    }
}

/// Stands at `position` until nothing changes any more.
pub fn settled(compensation: &mut Compensation<'_>, position: f64) -> f64 {
    for _ in 0..20_000 {
        compensation.step(&standing(position));
    }
    compensation.amount().to_num()
}

/// Setpoints of a trajectory that moves by each of `distances` (d) in turn, with a rest between.
pub fn setpoints(distances: &[f64], limits: &Limits) -> Vec<Setpoint> {
    let mut trajectory = Trajectory::new();
    let mut all = vec![trajectory.step(0)];
    for distance in distances {
        let profile = Profile::plan(Position::from_num(*distance), limits).unwrap();
        let now = all.len() as u32;
        trajectory.queue(&profile, now, now - 1).unwrap();
        for tick in 0..profile.ticks() + 50 {
            all.push(trajectory.step(now + tick));
        }
    }
    all
}
