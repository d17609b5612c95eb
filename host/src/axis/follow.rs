//! How well an axis follows: a test move there and back, recorded by its scope.

use leadscrew::scope::{Setup, Signal, Signals, Trigger};
use leadscrew::settings::Settings;
use leadscrew_client::{Axis, Error};
use serde::Serialize;

/// Words of a recording.
const WORDS: u32 = 10_000;
/// Rest after a move, after which what still stands counts, s.
const SETTLED_S: f64 = 0.1;
/// Time at each end of the move, s.
const DWELL_S: f64 = 0.4;

/// A move there and back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TestMove {
    /// Where it begins, mm.
    pub from_mm: f64,
    /// Where it turns, mm.
    pub to_mm: f64,
    /// Its feed, mm/min.
    pub feed_mm_per_min: f64,
    /// How often; the last one counts, the others let the feedforward learn.
    pub passes: u32,
}

/// Following errors, by the encoder.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Follows {
    /// Largest, d.
    pub peak_d: f64,
    /// Rms over the motion, d.
    pub rms_d: f64,
    /// Largest later than a tenth of a second after a move, d.
    pub standing_d: f64,
    /// Ticks between two samples of it: 1 unless the move is long.
    pub every_ticks: u16,
}

/// Time that a move of `way_mm` takes with `feed` mm/min, s.
pub(super) fn time_of(settings: &Settings, way_mm: f64, feed: f64) -> f64 {
    let (speed, ramp_s) = ramp(settings, feed);
    way_mm / speed + ramp_s
}

/// Speed in mm/s and time of a ramp to it, s.
pub(super) fn ramp(settings: &Settings, feed: f64) -> (f64, f64) {
    let motion = &settings.axis.motion;
    let speed = feed / 60.0;
    let acceleration = 1e3 * motion.max_acceleration_m_s2;
    let jerk = 1e3 * motion.max_jerk_m_s3;
    // A ramp that does not come to the largest acceleration takes no longer.
    (speed, speed / acceleration + acceleration / jerk)
}

/// Moves there and back, on an axis that is enabled, and tells how it followed.
///
/// # Errors
/// [`Error::Faulted`], [`Error::Refused`], those of a lost axis.
pub fn follow(axis: &mut Axis, settings: &Settings, test: &TestMove) -> Result<Follows, Error> {
    let TestMove {
        from_mm,
        to_mm,
        feed_mm_per_min: feed,
        passes,
    } = *test;
    axis.move_and_wait(from_mm, feed)?;
    for _ in 1..passes {
        axis.move_and_wait(to_mm, feed)?;
        axis.move_and_wait(from_mm, feed)?;
    }
    let one_way_s = time_of(settings, (to_mm - from_mm).abs(), feed) + DWELL_S;
    let signals = [Signal::FollowingError, Signal::SetpointVelocity];
    let samples = WORDS / signals.len() as u32;
    let every = (2.0 * one_way_s * settings.axis.tick_hz / f64::from(samples)).ceil();
    let every = every.clamp(1.0, 1000.0) as u16;
    let dwell = std::time::Duration::from_secs_f64(DWELL_S);
    let recorded = record(axis, &signals, every, samples, |axis| {
        axis.move_and_wait(to_mm, feed)?;
        axis.wait(dwell)?;
        axis.move_and_wait(from_mm, feed)?;
        axis.wait(dwell)
    })?;
    let settled = (SETTLED_S * settings.axis.tick_hz / f64::from(every)).ceil() as u32;
    Ok(figures(&recorded, settled, every))
}

/// Records signals, each a narrow one, while `work` moves the axis; values are in the signals' units.
pub(super) fn record(
    axis: &mut Axis,
    signals: &[Signal],
    every: u16,
    samples: u32,
    work: impl FnOnce(&mut Axis) -> Result<(), Error>,
) -> Result<Vec<Vec<f64>>, Error> {
    let Ok(set) = Signals::new(signals) else {
        // More than a scope has: nothing is recorded.
        work(axis)?;
        return Ok(Vec::new());
    };
    axis.arm_scope(&Setup {
        signals: set,
        every,
        trigger: Trigger::Now,
        pre: 0,
        samples,
    })?;
    let done = work(axis);
    // It may be over by itself.
    let _ = axis.end_scope();
    done?;
    let mut scope = axis.scope()?;
    for _ in 0..20 {
        if scope.is_over() {
            break;
        }
        axis.wait(std::time::Duration::from_millis(10))?;
        scope = axis.scope()?;
    }
    let units: Vec<f64> = signals
        .iter()
        .map(|signal| 2_f64.powi(-(signal.description().frac as i32)))
        .collect();
    let values = |sample: Vec<i32>| {
        let pairs = sample.into_iter().zip(&units);
        pairs.map(|(word, unit)| f64::from(word) * unit).collect()
    };
    Ok(axis.read_scope(&scope)?.into_iter().map(values).collect())
}

fn figures(recorded: &[Vec<f64>], settled: u32, every_ticks: u16) -> Follows {
    let (mut peak_d, mut squares, mut moving, mut standing_d) = (0.0_f64, 0.0, 0.0, 0.0_f64);
    // Before the move the axis may still come to rest from the one before.
    let mut rests: Option<u32> = None;
    for sample in recorded {
        let &[error, speed] = sample.as_slice() else {
            continue;
        };
        peak_d = peak_d.max(error.abs());
        if speed != 0.0 {
            rests = Some(0);
            squares += error * error;
            moving += 1.0;
        } else if let Some(rest) = &mut rests {
            *rest += 1;
            if *rest > settled {
                standing_d = standing_d.max(error.abs());
            }
        }
    }
    Follows {
        peak_d,
        rms_d: (squares / f64::max(moving, 1.0)).sqrt(),
        standing_d,
        every_ticks,
    }
}
