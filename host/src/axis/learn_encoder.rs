//! Learning the map of the encoder on the axis itself: steady feeds both ways at two speeds, learned by its firmware.
//!
//! A loop that is fast enough to follow the long waves of the encoder's errors steers the axis so that the encoder shows none:
//! nothing is left to be learned. While it learns, the feedforward feeds and a loop far below one revolution
//! keeps the axis near its line; then all is set as it was.

use std::time::Duration;

use leadscrew::calibration::MIN_REVOLUTIONS;
use leadscrew::calibration::{MAX_EDGES, MIN_EDGES, SPEED_RATIO};
use leadscrew::params::ControllerParams;
use leadscrew::scope::Signal;
use leadscrew::settings::Settings;
use leadscrew_client::{Axis, Error, Learned, LearningPhase, LearningStatus};

use super::calm::{made_ready, switched_off};
use super::follow::{ramp, record};
use super::settings::{Change, differences};
use super::tune::{has_loop, number_change};
use super::{ProcedureError, Room, apply};

/// Edges that the work memory of an axis has room for.
const MOST_EDGES: u32 = 10_000;
/// Revolutions besides those that are averaged: up to the index, two to measure the speed, and what it takes to notice.
const MORE_REVOLUTIONS: u32 = 5;
/// Time from the end of a ramp on that counts as not steady yet, s.
const STEADY_AFTER_S: f64 = 0.15;
/// Revolutions a second that are asked for: 500 and 400 rpm, a fifth apart and more.
const TURNS_PER_S: [f64; 2] = [500.0 / 60.0, 400.0 / 60.0];
/// Share of the largest feed that is used at most.
const FEED_SHARE: f64 = 0.9;
const LOOK: Duration = Duration::from_millis(20);
/// Position gain while it learns, 1/s: at 400 rpm the axis follows 1 % of an error that comes once a revolution.
const SOFT_GAIN_PER_S: f64 = 0.3;
/// Following error that is allowed meanwhile, mm.
const SOFT_ERROR_MM: f64 = 5.0;

/// How the runs are made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Feeds {
    /// Edges of a revolution.
    pub edges: u32,
    /// A revolution, mm.
    pub turn_mm: f64,
    /// The two feeds, mm/min, the faster one first.
    pub feeds_mm_per_min: [f64; 2],
    /// Revolutions that a run averages over.
    pub revolutions: u32,
    /// Where the runs begin and end, mm.
    pub from_mm: f64,
    /// The other end, mm.
    pub to_mm: f64,
}

/// How the velocity trembles at a constant feed, d/tick rms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ripple {
    /// Without the new map.
    pub before: f64,
    /// With it.
    pub after: f64,
}

/// What was learned.
#[derive(Clone, Copy, Debug)]
pub struct LearnedEncoder {
    /// The map, as the axis tells of it.
    pub learned: Learned,
    /// Velocity at the slower feed, as the axis estimates it.
    pub ripple: Ripple,
    /// Revolutions that each run averaged over.
    pub revolutions: u32,
}

impl Feeds {
    /// Chooses feeds and revolutions: `wanted` revolutions, or as many as `room` has.
    ///
    /// # Errors
    /// [`ProcedureError::NoDisc`], [`ProcedureError::NoRoom`] with the travel that the shortest runs take, an answer that cannot
    /// be.
    pub fn plan(
        settings: &Settings,
        room: &Room,
        at_mm: f64,
        wanted: u32,
        feeds: Option<[f64; 2]>,
    ) -> Result<Self, ProcedureError> {
        let motion = &settings.axis.motion;
        let counts = motion.counts_per_revolution;
        let most = MOST_EDGES.min(MAX_EDGES);
        let is_disc =
            (f64::from(MIN_EDGES)..=f64::from(most)).contains(&counts) && counts % 4.0 == 0.0;
        if !is_disc {
            return Err(ProcedureError::NoDisc { counts, most });
        }
        let turn_mm = counts / motion.counts_per_mm;
        let feeds_mm_per_min = match feeds {
            Some(feeds) => checked(feeds, motion.max_feed_mm_per_min)?,
            None => default_feeds(turn_mm, FEED_SHARE * motion.max_feed_mm_per_min),
        };
        let [fast, _] = feeds_mm_per_min;
        let (speed, ramp_s) = ramp(settings, fast);
        // Half the speed on average, at both ends.
        let lost_mm = speed * (ramp_s + STEADY_AFTER_S);
        let needed =
            |revolutions: u32| lost_mm + f64::from(revolutions + MORE_REVOLUTIONS) * turn_mm;
        // Whole fours of them are used.
        let mut revolutions = wanted.max(MIN_REVOLUTIONS) / 4 * 4;
        while revolutions > MIN_REVOLUTIONS && needed(revolutions) > room.length_mm() {
            revolutions -= 4;
        }
        let what = "learning the encoder over 12 revolutions in one go";
        let advice = "State the room that there is (--room-minus, --room-plus), move the axis to one end of its travel, lower the \
                      feeds, or learn from captures of a turned encoder: leadscrew calibrate-encoder FILES";
        let (from_mm, to_mm) = room.place(at_mm, needed(revolutions), what, advice)?;
        Ok(Self {
            edges: counts as u32,
            turn_mm,
            feeds_mm_per_min,
            revolutions,
            from_mm,
            to_mm,
        })
    }
}

impl std::fmt::Display for Feeds {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let [fast, slow] = self.feeds_mm_per_min;
        write!(
            f,
            "the axis goes from {:.1} to {:.1} mm and back with {fast:.0} mm/min, then with {slow:.0}, {} revolutions each in the \
             average, and a few ways to see the velocity.",
            self.from_mm, self.to_mm, self.revolutions
        )
    }
}

fn default_feeds(turn_mm: f64, most: f64) -> [f64; 2] {
    let [fast, slow] = TURNS_PER_S.map(|turns| 60.0 * turns * turn_mm);
    let part = (most / fast).min(1.0);
    [fast * part, slow * part]
}

fn checked([one, other]: [f64; 2], most: f64) -> Result<[f64; 2], ProcedureError> {
    let feeds = [one.max(other), one.min(other)];
    let [fast, slow] = feeds;
    let is_right = slow > 0.0 && fast <= most && fast / slow >= SPEED_RATIO;
    is_right.then_some(feeds).ok_or_else(|| {
        ProcedureError::Answer(format!(
            "feeds of {one} and {other} mm/min: they have to be a factor of {SPEED_RATIO} apart and at most {most} mm/min"
        ))
    })
}

/// Runs the feeds, makes the map, takes it into use (it is not saved), and looks at the velocity before and after. The drive
/// is off afterwards.
///
/// # Errors
/// [`ProcedureError::NotLearned`] with the learner's reason, others.
pub fn learn_encoder(
    axis: &mut Axis,
    settings: &Settings,
    feeds: &Feeds,
    progress: &mut dyn FnMut(&str),
) -> Result<LearnedEncoder, ProcedureError> {
    if !has_loop(settings) {
        return Err(ProcedureError::NoLoop);
    }
    progress("velocity without the map");
    made_ready(axis)?;
    let outcome = ripple(axis, settings, feeds);
    let before = switched_off(axis, outcome)?;
    let soft = softened(settings);
    apply(axis, &differences(settings, &soft))?;
    let ran = run_softly(axis, &soft, feeds, progress);
    let restored = apply(axis, &differences(&soft, settings));
    ran?;
    restored?;
    let finished = axis.finish_learning();
    let learned = reasoned(axis, finished)?;
    axis.take_map()?;
    progress("velocity with the map");
    made_ready(axis)?;
    let outcome = ripple(axis, settings, feeds);
    let after = switched_off(axis, outcome)?;
    Ok(LearnedEncoder {
        learned,
        ripple: Ripple { before, after },
        revolutions: feeds.revolutions,
    })
}

/// Ends learning without a map.
pub fn forget_learning(axis: &mut Axis) {
    // An axis that is lost forgets by itself.
    let _ = axis.end_learning();
}

/// Saves the map in use, with what it leaves of the encoder's errors, and all parameters.
///
/// # Errors
/// [`Error::Refused`]
pub fn keep_map(axis: &mut Axis, settings: &Settings, learned: &Learned) -> Result<(), Error> {
    apply(axis, &encoder_changes(settings, learned))?;
    axis.save_map()?;
    axis.save_parameters()
}

/// What the map leaves, for the section that estimates state their uncertainty from.
fn encoder_changes(settings: &Settings, learned: &Learned) -> Vec<Change> {
    let encoder = &settings.axis.encoder;
    let residual = &learned.residual;
    let changes = [
        number_change(
            "encoder.placement_d",
            "d",
            encoder.placement_d,
            residual.edge_sigma_d.min(0.25),
        ),
        number_change(
            "encoder.slope",
            "d/d",
            encoder.slope,
            residual.standing_slope.min(0.0009),
        ),
        number_change(
            "encoder.curvature_per_d",
            "1/d",
            encoder.curvature_per_d,
            residual.standing_curvature_per_d.min(1e-5),
        ),
    ];
    changes.into_iter().flatten().collect()
}

/// The same axis with a loop that does not answer to the encoder's errors. It is never saved.
fn softened(settings: &Settings) -> Settings {
    let mut soft = *settings;
    soft.axis.controller = ControllerParams {
        position_gain_per_s: SOFT_GAIN_PER_S,
        integral_gain_per_s2: 0.0,
        derivative_gain: 0.0,
        velocity_gain: 0.0,
        acceleration_gain_s: 0.0,
        learning_noise: 0.0,
        ..soft.axis.controller
    };
    soft.axis.calm.below_mm_per_min = 0.0;
    let supervisor = &mut soft.axis.supervisor;
    supervisor.following_error_mm = supervisor.following_error_mm.max(SOFT_ERROR_MM);
    supervisor.standstill_mm = supervisor.standstill_mm.max(SOFT_ERROR_MM);
    soft
}

fn run_softly(
    axis: &mut Axis,
    soft: &Settings,
    feeds: &Feeds,
    progress: &mut dyn FnMut(&str),
) -> Result<(), ProcedureError> {
    made_ready(axis)?;
    let outcome = run_all(axis, soft, feeds, progress);
    if outcome.is_err() {
        forget_learning(axis);
    }
    switched_off(axis, outcome)
}

/// All runs.
fn run_all(
    axis: &mut Axis,
    settings: &Settings,
    feeds: &Feeds,
    progress: &mut dyn FnMut(&str),
) -> Result<(), ProcedureError> {
    let [fast, slow] = feeds.feeds_mm_per_min;
    axis.move_and_wait(feeds.from_mm, fast)?;
    let begun = axis.learn(feeds.edges);
    reasoned(axis, begun)?;
    let runs = [
        (fast, feeds.to_mm),
        (fast, feeds.from_mm),
        (slow, feeds.to_mm),
        (slow, feeds.from_mm),
    ];
    for (number, (feed, to_mm)) in (1..).zip(runs) {
        let mut tell = |revolutions: u32| {
            progress(&format!(
                "run {number} of {}, {feed:.0} mm/min: {revolutions} of {} revolutions",
                runs.len(),
                feeds.revolutions
            ));
        };
        run(axis, settings, feeds, feed, to_mm, &mut tell)?;
    }
    Ok(())
}

/// A run from one end to the other.
fn run(
    axis: &mut Axis,
    settings: &Settings,
    feeds: &Feeds,
    feed: f64,
    to_mm: f64,
    tell: &mut dyn FnMut(u32),
) -> Result<(), ProcedureError> {
    axis.wait(Duration::from_millis(100))?;
    begin_steady(axis, settings, feed, to_mm)?;
    let begun = axis.learn_run(feeds.revolutions);
    reasoned(axis, begun)?;
    loop {
        let learning = axis.learning()?;
        if let Some(refusal) = learning.refusal {
            return Err(ProcedureError::NotLearned(refusal));
        }
        tell(learning.revolutions);
        if learning.phase == LearningPhase::RunComplete {
            break;
        }
        let status = axis.status()?;
        if !status.is_moving {
            return Err(unfinished(axis, &learning)?);
        }
        axis.wait(LOOK)?;
    }
    tell(feeds.revolutions);
    axis.wait_for_rest()?;
    let ended = axis.end_learn_run();
    reasoned(axis, ended)?;
    Ok(())
}

/// Why a run was not complete at the end of its way.
fn unfinished(axis: &mut Axis, learning: &LearningStatus) -> Result<ProcedureError, Error> {
    let status = axis.status()?;
    if status.fault_number != 0 {
        return Ok(Error::Faulted(status.fault_number).into());
    }
    if learning.phase == LearningPhase::WaitsForIndex {
        return Ok(ProcedureError::NotLearned(
            leadscrew::calibration::Refusal::IndexMissing { revolution: 0 },
        ));
    }
    Ok(Error::DisabledMeanwhile {
        what: "the run was complete",
    }
    .into())
}

/// Begins a move and waits until its feed is steady.
fn begin_steady(
    axis: &mut Axis,
    settings: &Settings,
    feed: f64,
    to_mm: f64,
) -> Result<(), ProcedureError> {
    let (_, ramp_s) = ramp(settings, feed);
    axis.move_to(to_mm, feed)?;
    axis.wait(Duration::from_secs_f64(ramp_s + STEADY_AFTER_S))?;
    Ok(())
}

/// Rms by which the estimated velocity strays at the slower feed, after a way over the index, from which on a map is in use.
fn ripple(axis: &mut Axis, settings: &Settings, feeds: &Feeds) -> Result<f64, ProcedureError> {
    let [_, slow] = feeds.feeds_mm_per_min;
    let turn_s = feeds.turn_mm / (slow / 60.0);
    let turns = 4.0;
    let samples = (turns * turn_s * settings.axis.tick_hz).min(10_000.0) as u32;
    axis.move_and_wait(feeds.from_mm + 2.0 * feeds.turn_mm, slow)?;
    axis.move_and_wait(feeds.from_mm, slow)?;
    begin_steady(axis, settings, slow, feeds.to_mm)?;
    let velocities = record(axis, &[Signal::Velocity], 1, samples, |axis| {
        axis.wait(Duration::from_secs_f64(turns * turn_s + 0.05))
    })?;
    axis.stop()?;
    let values: Vec<f64> = velocities.into_iter().flatten().collect();
    let count = (values.len() as f64).max(1.0);
    let mean = values.iter().sum::<f64>() / count;
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    Ok((squares / count).sqrt())
}

/// The learner's own reason, where the axis refused for it.
fn reasoned<T>(axis: &mut Axis, outcome: Result<T, Error>) -> Result<T, ProcedureError> {
    use leadscrew::protocol::refusal::Refusal;
    match outcome {
        Ok(done) => Ok(done),
        Err(error) if error.refusal() == Some(Refusal::LearningRefused) => {
            let reason = axis.learning()?.refusal;
            forget_learning(axis);
            Err(reason.map_or_else(|| error.into(), ProcedureError::NotLearned))
        }
        Err(error) => Err(error.into()),
    }
}
