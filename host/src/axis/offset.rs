//! The offset of a drive, nulled.
//!
//! At rest friction holds an axis against an offset, and the command of the loop there is anything between the two break-aways.
//! In steady motion friction acts against it both ways alike: the mean of the commands that a slow feed
//! takes forward and backward, over the same revolution, is what stands the drive still.

use leadscrew::identification::program::{Bounds, Program, Segment, command};
use leadscrew::scope::Signal;
use leadscrew::settings::Settings;
use leadscrew_client::{Axis, Error};

use super::calm::{made_ready, switched_off};
use super::follow::{ramp, record, time_of};
use super::identify::{run_from_rest, scale_of};
use super::settings::Change;
use super::tune::{has_loop, number_change};
use super::{ProcedureError, Room, apply};

/// Way of an encoder without an index, mm.
const WAY_MM: f64 = 10.0;
/// Time of the slow feed over its way, s.
const TIME_S: f64 = 1.0;
/// Window of the open-loop look at the drift, mm.
const WINDOW_MM: f64 = 1.0;

/// What an open loop does in a second, mm/min.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drift {
    /// At zero command.
    pub at_zero: f64,
    /// At the constant output of the loop.
    pub at_bias: f64,
}

/// An offset, and what was done about it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NulledOffset {
    /// Mean command of the slow feed forward and backward, of full command.
    pub forward: f64,
    /// The same backward.
    pub backward: f64,
    /// The constant output before.
    pub bias_before: f64,
    /// The constant output that stands the drive still: the mean of the two commands.
    pub bias: f64,
    /// What was left for the loop before, of full command.
    pub left_before: f64,
    /// What is left for it now.
    pub left_after: f64,
    /// Open-loop drift before.
    pub drift_before: Drift,
    /// Open-loop drift now.
    pub drift_after: Drift,
}

/// Way that it takes, mm.
#[must_use]
pub fn way_mm(settings: &Settings) -> f64 {
    let (_, feed) = slow(settings);
    let (speed, ramp_s) = ramp(settings, feed);
    slow(settings).0 + speed * ramp_s + 2.0 * WINDOW_MM
}

/// Way and feed of the slow motion, mm and mm/min: a revolution, over which what keeps to the shaft's angle is gone.
fn slow(settings: &Settings) -> (f64, f64) {
    let motion = &settings.axis.motion;
    let turn = motion.counts_per_revolution / motion.counts_per_mm;
    let way = if turn > 0.0 { turn } else { WAY_MM };
    (
        way,
        (60.0 * way / TIME_S).min(0.25 * motion.max_feed_mm_per_min),
    )
}

/// Measures the offset and sets the constant output against it (not saved). The drive is off afterwards.
///
/// # Errors
/// [`ProcedureError`]
pub fn null_offset(
    axis: &mut Axis,
    settings: &Settings,
    room: &Room,
    progress: &mut dyn FnMut(&str),
) -> Result<NulledOffset, ProcedureError> {
    if !has_loop(settings) {
        return Err(ProcedureError::NoLoop);
    }
    let at_mm = axis.status()?.position_mm;
    let advice = "Move the axis away from the end, or state more room";
    let place = room.place(at_mm, way_mm(settings), "nulling the offset", advice)?;
    let bias_before = settings.axis.controller.bias;
    progress("before");
    let before = measured(axis, settings, place, bias_before)?;
    let [forward, backward] = before.commands;
    let bias = 0.5 * (forward + backward);
    apply(axis, &changes(settings, bias))?;
    progress("after");
    let after = measured(axis, settings, place, bias)?;
    let [again_forward, again_backward] = after.commands;
    Ok(NulledOffset {
        forward,
        backward,
        bias_before,
        bias,
        left_before: bias - bias_before,
        left_after: 0.5 * (again_forward + again_backward) - bias,
        drift_before: before.drift,
        drift_after: after.drift,
    })
}

fn changes(settings: &Settings, bias: f64) -> Vec<Change> {
    let unit = "of full command";
    let changes = [
        number_change(
            "controller.bias",
            unit,
            settings.axis.controller.bias,
            bias.clamp(-1.0, 1.0),
        ),
        number_change(
            "observer.offset",
            unit,
            settings.observer.offset,
            (-bias).clamp(-0.5, 0.5),
        ),
    ];
    changes.into_iter().flatten().collect()
}

struct Measured {
    commands: [f64; 2],
    drift: Drift,
}

fn measured(
    axis: &mut Axis,
    settings: &Settings,
    place: (f64, f64),
    bias: f64,
) -> Result<Measured, ProcedureError> {
    made_ready(axis)?;
    let mut look = || {
        let commands = slow_commands(axis, settings, place)?;
        let drift = Drift {
            at_zero: drift(axis, settings, 0.0)?,
            at_bias: drift(axis, settings, bias)?,
        };
        Ok(Measured { commands, drift })
    };
    let outcome = look();
    switched_off(axis, outcome)
}

/// Mean commands of the slow feed forward and backward.
fn slow_commands(
    axis: &mut Axis,
    settings: &Settings,
    (low, high): (f64, f64),
) -> Result<[f64; 2], ProcedureError> {
    let (_, feed) = slow(settings);
    let (low, high) = (low + WINDOW_MM, high - WINDOW_MM);
    axis.move_and_wait(low, feed)?;
    // The slack of the encoder's coupling and of the screw is taken up before anything counts.
    let mut commands = [0.0; 2];
    for (place, to) in commands.iter_mut().zip([high, low]) {
        let ticks = time_of(settings, high - low, feed) * settings.axis.tick_hz;
        let signals = [Signal::Command, Signal::SetpointVelocity];
        let every = (ticks / 4500.0).ceil().clamp(1.0, 1000.0) as u16;
        let samples = (ticks / f64::from(every)).ceil() as u32 + 200;
        let recorded = record(axis, &signals, every, samples.min(5000), |axis| {
            axis.move_and_wait(to, feed).map(drop)
        })?;
        *place = steady(&recorded);
    }
    Ok(commands)
}

/// Mean command where the feed is steady, the first fifth of it left out.
fn steady(recorded: &[Vec<f64>]) -> f64 {
    let speed = |sample: &Vec<f64>| sample.get(1).map_or(0.0, |speed| speed.abs());
    let top = recorded.iter().map(speed).fold(0.0, f64::max);
    let kept: Vec<f64> = recorded
        .iter()
        .filter(|sample| speed(sample) > 0.999 * top)
        .filter_map(|sample| sample.first().copied())
        .collect();
    let kept = kept.get(kept.len() / 5..).unwrap_or_default();
    kept.iter().sum::<f64>() / (kept.len() as f64).max(1.0)
}

/// What the axis does in a second with its loop open at a constant command, mm/min.
fn drift(axis: &mut Axis, settings: &Settings, level: f64) -> Result<f64, ProcedureError> {
    let scale = scale_of(settings)?;
    let ticks = settings.axis.tick_hz as u32;
    let bounds = Bounds {
        window_d: scale.counts_from_mm(WINDOW_MM).ceil() as u32,
        speed_d_per_tick: 2047,
        ticks: ticks + 100,
        command: command(level.abs().max(1e-3)),
    };
    axis.wait_for_rest()?;
    let from = axis.experiment()?.count;
    let program = Program::new(&[Segment::level(level, ticks)], bounds);
    let ended = run_from_rest(axis, &program, 1)?;
    axis.end_experiment()?;
    let way_mm = scale.mm_from_counts((ended.count - from) as f64);
    let time_s = f64::from(ended.ticks.max(1)) / settings.axis.tick_hz;
    // The loop comes back where the axis stands.
    settle(axis)?;
    Ok(60.0 * way_mm / time_s)
}

fn settle(axis: &mut Axis) -> Result<(), Error> {
    axis.wait(std::time::Duration::from_millis(200))
}
