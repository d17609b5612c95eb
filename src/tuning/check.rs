//! A trial before parameters are offered: the axis itself, in fixed point, on a model of the drive.
//!
//! The drive is the model with all it has: delay, offset, steps of command, friction both ways, dead time, the limit of
//! acceleration; the encoder is ideal with one time stamp a tick. A move is made there and back.

use super::model::DriveModel;
use super::plant::Plant;
use crate::axis::{Axis, Inputs};
use crate::hal::Capture;
use crate::params::{AxisParams, MotionParams, ParamError};
use crate::setpoint::profile::Profile;
use crate::supervisor::Fault;
use crate::units::{AxisScale, Position};

/// What the trial came to.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Trial {
    /// Largest following error, d.
    pub peak_d: f64,
    /// Largest following error from 100 ms after a move to its end, d.
    pub standing_d: f64,
    /// Peak to peak of the shaft in the last of four seconds of rest, d.
    pub swing_d: f64,
    /// What the supervisor stopped it for; the moves after that are not made.
    pub fault: Option<Fault>,
}

impl Trial {
    /// The worse of both in each figure.
    #[must_use]
    pub const fn or(&self, other: &Self) -> Self {
        Self {
            peak_d: self.peak_d.max(other.peak_d),
            standing_d: self.standing_d.max(other.standing_d),
            swing_d: self.swing_d.max(other.swing_d),
            fault: match self.fault {
                Some(fault) => Some(fault),
                None => other.fault,
            },
        }
    }
}

/// Most ticks of delay in a trial.
const LINE: usize = 128;
/// Where the shaft stands at first, d.
const START_D: f64 = 0.5;

/// The drive and its shaft.
struct Machine {
    plant: Plant,
    model: DriveModel,
    /// Friction in fractions of full command: kinetic and static, forward and backward.
    friction: [[f64; 2]; 2],
    stribeck: f64,
    most_acceleration: f64,
    state: [f64; 3],
    line: [f64; LINE],
    place: usize,
    delay: usize,
    dead_ticks: u32,
    dead_left: u32,
    sign: f64,
}

impl Machine {
    fn new(model: &DriveModel, scale: AxisScale) -> Result<Self, ParamError> {
        let rate = scale.tick_hz();
        let full = scale.velocity_from_feed(model.full_command_feed_mm_per_min)?;
        let share = |feed: f64| feed / model.full_command_feed_mm_per_min;
        Ok(Self {
            plant: Plant::with_period(model.natural_period_s * rate, model.damping, full),
            model: *model,
            friction: [
                [
                    share(model.friction_forward_mm_per_min),
                    share(model.breakaway_forward_mm_per_min),
                ],
                [
                    share(model.friction_backward_mm_per_min),
                    share(model.breakaway_backward_mm_per_min),
                ],
            ],
            stribeck: scale.velocity_from_feed(model.stribeck_mm_per_min)?,
            most_acceleration: scale.acceleration_from_m_s2(model.max_acceleration_m_s2),
            state: [START_D, 0.0, 0.0],
            line: [0.0; LINE],
            place: 0,
            delay: (libm::round(model.delay_s * rate) as usize).min(LINE.wrapping_sub(1)),
            dead_ticks: libm::round(model.dead_time_s * rate) as u32,
            dead_left: 0,
            sign: 0.0,
        })
    }

    /// What reaches the drive, with its steps, offset and dead time, in fractions of full command.
    fn answered(&mut self, command: f64) -> f64 {
        if let Some(slot) = self.line.get_mut(self.place % LINE) {
            *slot = command;
        }
        let due = self.place.wrapping_sub(self.delay) % LINE;
        self.place = self.place.wrapping_add(1);
        let wanted = self.line.get(due).copied().unwrap_or(0.0) + self.model.offset;
        let wanted = if self.model.resolution > 0.0 {
            libm::round(wanted / self.model.resolution) * self.model.resolution
        } else {
            wanted
        };
        if wanted * self.sign < 0.0 {
            self.dead_left = self.dead_ticks;
        }
        if wanted != 0.0 {
            self.sign = wanted.signum();
        }
        if self.dead_left > 0 {
            self.dead_left = self.dead_left.wrapping_sub(1);
            0.0
        } else {
            wanted
        }
    }

    /// A tick; where the shaft was before and is after it.
    fn step(&mut self, command: f64) -> [f64; 2] {
        let wanted = self.answered(command);
        let [x, v, a] = self.state;
        let forward = if v == 0.0 { wanted > 0.0 } else { v > 0.0 };
        let [ahead, behind] = self.friction;
        let [kinetic, held] = if forward { ahead } else { behind };
        if (v == 0.0 || (v + a) * v <= 0.0) && wanted.abs() <= held {
            self.state = [x, 0.0, 0.0];
            return [x, x];
        }
        let relative = v / self.stribeck;
        let level = kinetic + (held - kinetic).max(0.0) / (1.0 + relative * relative);
        let net = wanted - if forward { level } else { -level };
        let [_, _, next] = self.plant.step(&self.state, net);
        let next = next.clamp(-self.most_acceleration, self.most_acceleration);
        let after = [x + v + a / 3.0 + next / 6.0, v + (a + next) / 2.0, next];
        self.state = after;
        let [place, ..] = after;
        [x, place]
    }
}

/// Counts before d = 0, so that none is negative.
const AHEAD: f64 = 1e6;
/// Clocks of the timer in a tick, where it is exact.
const CLOCKS: f64 = 65_536.0;

/// What the encoder shows of a way from `before` to `after`: the count and, if it changed, when it did last, clocks
/// before the end of the tick.
fn seen(before: f64, after: f64) -> (u32, Option<u32>) {
    let (old, count) = (libm::floor(before + AHEAD), libm::floor(after + AHEAD));
    if old == count {
        return (count as u32, None);
    }
    let edge = if after > before { count } else { count + 1.0 } - AHEAD;
    let age = (after - edge) / (after - before);
    (count as u32, Some((age.clamp(0.0, 0.999) * CLOCKS) as u32))
}

/// Makes a move of `distance_mm` there and back with `params` on `drive`.
///
/// # Errors
/// Parameters out of range. A move that cannot be planned is not made.
pub fn trial(
    params: &AxisParams,
    drive: &DriveModel,
    distance_mm: f64,
) -> Result<Trial, ParamError> {
    let scale = AxisScale::new(params.motion.counts_per_mm, params.tick_hz)?;
    let timed = AxisParams {
        timer_hz: (params.tick_hz * CLOCKS).clamp(1e6, 250e6),
        // The model's encoder has no index.
        motion: MotionParams {
            counts_per_revolution: 0.0,
            ..params.motion
        },
        ..*params
    };
    let config = timed.validate()?;
    let clocks = timed.timer_hz / params.tick_hz;
    let mut axis = Axis::new(config);
    let mut machine = Machine::new(drive, scale)?;
    let mut result = Trial::default();
    let ticks = |seconds: f64| (seconds * params.tick_hz) as u32;
    let mut tick = 0_u32;
    let mut run = |axis: &mut Axis<'_>, count: u32, take: &mut dyn FnMut(u32, f64, f64)| {
        for index in 0..count {
            let [before, after] = machine.step(axis.outputs().command.to_num());
            let (place, age) = seen(before, after);
            tick = tick.wrapping_add(1);
            let sampled_at = libm::round(f64::from(tick) * clocks) as u64 as u32;
            let age = age.map(|age| (f64::from(age) / CLOCKS * clocks) as u32);
            let outputs = axis.step(&Inputs::of(
                Capture {
                    count: place,
                    sampled_at,
                    last_edge_at: age.map(|age| sampled_at.wrapping_sub(age)),
                    ..Capture::default()
                },
                true,
            ));
            take(index, outputs.following_error.to_num(), after);
        }
    };
    run(&mut axis, ticks(0.2).max(10), &mut |_, _, _| {});
    for way in [distance_mm, -distance_mm] {
        let distance = Position::saturating_from_num(scale.counts_from_mm(way));
        let Ok(profile) = Profile::plan(distance, &config.limits) else {
            continue;
        };
        let notice = axis.notice_ticks();
        let start = axis.outputs().tick.wrapping_add(notice);
        if axis.queue(&profile, start).is_err() {
            continue;
        }
        let moving = profile.ticks().saturating_add(notice).saturating_sub(1);
        run(&mut axis, moving, &mut |_, error, _| {
            result.peak_d = result.peak_d.max(error.abs());
        });
        let (settled, quiet, all) = (ticks(0.1), ticks(3.0), ticks(4.0));
        let mut extent = [f64::INFINITY, f64::NEG_INFINITY];
        run(&mut axis, all, &mut |index, error, shaft| {
            if index < settled {
                result.peak_d = result.peak_d.max(error.abs());
            } else {
                result.standing_d = result.standing_d.max(error.abs());
            }
            if index >= quiet {
                let [low, high] = extent;
                extent = [low.min(shaft), high.max(shaft)];
            }
        });
        let [low, high] = extent;
        result.swing_d = result.swing_d.max(high - low);
    }
    result.fault = axis.outputs().fault;
    Ok(result)
}
