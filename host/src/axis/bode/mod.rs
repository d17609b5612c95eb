//! Frequency responses of an axis: a chirp through it, and what came of it frequency by frequency.
//!
//! ```text
//!           d                      drive: w / u, the loop open, the chirp about a steady feed, so that the axis never turns
//!           ▼       u               back and friction is a constant
//!   C(e) ──(+)──► drive ──► w      loop:  T = 1 − u / d, the loop closed, the chirp added to its command
//! ```
//!
//! w is the mean velocity over the tick in which the command u is held: the hold and the mean delay by half a tick each way,
//! and what is left is the drive between the two, with a gain of sinc² that is taken out. Both records begin and end in the
//! same steady state, so their Fourier sums need no window.

mod model;
mod spectrum;

use std::time::Duration;

use leadscrew::identification::program::{Bounds, Program, Segment, command};
use leadscrew::scope::Signal;
use leadscrew_client::{Axis, Error, ExperimentPhase, Scale};

pub use model::DriveCurve;
pub use spectrum::Point;

use crate::error::CommandError;
use spectrum::{Records, points};

/// Steady time before the chirp, and behind it, s.
const LEAD_S: f64 = 0.6;
const TAIL_S: f64 = 0.4;
/// Time within the lead after which the axis feeds steadily, s.
const SETTLED_S: f64 = 0.5;
/// What the chirp goes beyond the frequencies that are looked at, at either end.
const BEYOND: f64 = 1.15;
/// Room that bounds leave above what is expected.
const ROOM: f64 = 1.4;
/// Words of the work memory that the axis's own record of the experiment may take.
const RECORD_WORDS: f64 = 9000.0;

/// A chirp.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chirp {
    /// Lowest and highest frequency, Hz.
    pub hz: (f64, f64),
    /// Its length, s.
    pub seconds: f64,
    /// Amplitude, share of full command.
    pub amplitude: f64,
    /// Command about which it swings with the loop open, share of full command.
    pub centre: f64,
    /// Frequencies that are looked at.
    pub points: usize,
}

/// What a measurement moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Travel {
    /// How far the axis goes with the loop open, mm; negative backward.
    pub drive_mm: f64,
    /// How far it swings to either side with the loop closed, mm.
    pub loop_mm: f64,
}

impl Chirp {
    /// Checks it at a control rate.
    ///
    /// # Errors
    /// What cannot be, and what could.
    pub fn check(&self, tick_hz: f64) -> Result<(), CommandError> {
        let usage = |text: String| Err(CommandError::Usage(text));
        let (from, to) = self.hz;
        if !(from > 0.0 && to > from && to <= tick_hz / 4.0) {
            return usage(format!(
                "--from-hz {from} --to-hz {to}: expected frequencies above 0, rising, up to a quarter of the control rate: {}",
                tick_hz / 4.0
            ));
        }
        if self.seconds * from < 2.0 {
            return usage(format!(
                "--seconds {}: too short for {from} Hz, take {} at least",
                self.seconds,
                2.0 / from
            ));
        }
        if !(0.001..=0.5).contains(&self.amplitude) {
            return usage(
                "--amplitude, --loop-amplitude: expected 0.1 to 50 % of full command".to_owned(),
            );
        }
        Ok(())
    }

    /// The same for the drive's, which does not turn the axis back.
    ///
    /// # Errors
    /// As of [`Self::check`].
    pub fn check_drive(&self, tick_hz: f64) -> Result<(), CommandError> {
        self.check(tick_hz)?;
        let usage = |text: String| Err(CommandError::Usage(text));
        if self.centre.abs() <= self.amplitude || self.centre.abs() + self.amplitude > 0.9 {
            return usage(
                "--centre: it has to be above the amplitude, so that the axis does not turn back, and 90 % of full command \
                 with it at most"
                    .to_owned(),
            );
        }
        Ok(())
    }

    /// What it moves on an axis of that feed at full command, mm/min.
    #[must_use]
    pub fn travel(&self, full_feed: f64) -> Travel {
        let per_s = full_feed / 60.0;
        let swing = self.amplitude * per_s / (std::f64::consts::PI * self.hz.0);
        Travel {
            drive_mm: self.centre * per_s * (self.seconds + LEAD_S + TAIL_S),
            loop_mm: swing,
        }
    }

    fn ticks(&self, scale: Scale) -> [u32; 3] {
        [LEAD_S, self.seconds, TAIL_S].map(|seconds| (seconds * scale.tick_hz).round() as u32)
    }

    /// The program about a command, of an experiment that leaves a way of `way_mm` at the farthest.
    fn program(&self, centre: f64, scale: Scale, full_feed: f64, way_mm: f64) -> Program {
        let [lead, ticks, tail] = self.ticks(scale);
        let (from, to) = self.hz;
        let cycles = (from / BEYOND / scale.tick_hz, to * BEYOND / scale.tick_hz);
        let segments = [
            Segment::level(centre, lead),
            Segment::chirp(centre, self.amplitude, cycles, ticks),
            Segment::level(centre, tail),
        ];
        let most = centre.abs() + self.amplitude;
        let fastest = (most.max(0.05) * full_feed / 60.0) * scale.counts_per_mm / scale.tick_hz;
        let bounds = Bounds {
            window_d: (way_mm.abs().max(1.0) * ROOM * scale.counts_per_mm).ceil() as u32,
            speed_d_per_tick: (2.0 * fastest * ROOM).ceil() as u32 + 2,
            ticks: lead + ticks + tail + 10,
            command: command((most * 1.01).min(1.0)),
        };
        Program::new(&segments, bounds)
    }
}

/// The drive's response: command to velocity, in the gain of `full_feed`. Moves by [`Travel::drive_mm`]; the axis stays
/// where it comes to rest.
///
/// # Errors
/// The experiment did not run to its end, samples were lost, the axis.
pub fn drive(axis: &mut Axis, chirp: &Chirp, full_feed: f64) -> Result<Vec<Point>, CommandError> {
    let scale = axis.scale()?;
    chirp.check_drive(scale.tick_hz)?;
    let way = chirp.travel(full_feed).drive_mm;
    let program = chirp.program(chirp.centre, scale, full_feed, way);
    let records = run(axis, &program)?;
    let full_d = full_feed / 60.0 * scale.counts_per_mm / scale.tick_hz;
    let velocity: Vec<f64> = records.velocity.iter().map(|d| d / full_d).collect();
    let mut points = points(chirp, scale.tick_hz, &records.command, &velocity);
    for point in &mut points {
        let half = std::f64::consts::PI * point.hz / scale.tick_hz;
        point.gain *= (half / half.sin()).powi(2);
    }
    Ok(points)
}

/// The closed loop's response T: of what is added to the command, the share that the loop takes back.
///
/// # Errors
/// As of [`drive`].
pub fn closed_loop(
    axis: &mut Axis,
    chirp: &Chirp,
    full_feed: f64,
) -> Result<Vec<Point>, CommandError> {
    let scale = axis.scale()?;
    chirp.check(scale.tick_hz)?;
    let way = chirp.travel(full_feed).loop_mm;
    let program = chirp.program(0.0, scale, full_feed, way).closed();
    let records = run(axis, &program)?;
    let added = &records.added;
    let taken: Vec<f64> = added
        .iter()
        .zip(&records.command)
        .map(|(added, command)| added - command)
        .collect();
    Ok(points(chirp, scale.tick_hz, added, &taken))
}

/// Runs a program and gives what was put out and what came of it, from its first tick on.
fn run(axis: &mut Axis, program: &Program) -> Result<Records, CommandError> {
    let signals = [Signal::ExperimentPosition, Signal::Command];
    let mut live = axis.live(&signals, 1)?;
    let record_ticks = (f64::from(program.bounds.ticks) / RECORD_WORDS).ceil() as u32;
    let ended = axis.run_experiment(program, record_ticks);
    // What is still on its way.
    let heard = axis.listen(&mut live, Duration::from_millis(100));
    let stopped = axis.end_live(&mut live);
    let released = axis.end_experiment();
    let ended = ended?;
    heard.and(stopped).and(released)?;
    if ended.phase != ExperimentPhase::Complete {
        return Err(CommandError::Data(stopped_by(ended.phase)));
    }
    axis.wait_for_rest().map(drop).or_else(not_moving)?;
    let recording = live.into_recording();
    let start = ended.tick.wrapping_sub(ended.ticks).wrapping_add(1);
    let first = recording
        .ticks
        .iter()
        .position(|tick| *tick as u32 == start);
    let whole = program.bounds.ticks as usize - 10;
    let first = first.filter(|first| first + whole < recording.len());
    let Some(first) = first.filter(|_| recording.missing() == 0) else {
        return Err(CommandError::Data(format!(
            "{} samples were lost on the line: a response cannot be made of what is left. Use a faster line, or a lower \
             control rate",
            recording.missing()
        )));
    };
    let [positions, commands] = signals.map(|signal| recording.bits(signal).unwrap_or_default());
    let one = (-f64::from(Signal::ExperimentPosition.frac())).exp2();
    let full = f64::from(1 << Signal::Command.frac());
    // Before that the axis comes up to its feed.
    let settled = (SETTLED_S * recording.scale.tick_hz) as usize;
    let span = first + settled..first + whole;
    Ok(Records {
        command: commands[span.clone()]
            .iter()
            .map(|bits| *bits as f64 / full)
            .collect(),
        velocity: positions[span.start..=span.end]
            .windows(2)
            .map(|pair| (pair[1] - pair[0]) as f64 * one)
            .collect(),
        added: added(program).split_off(settled),
    })
}

/// An axis that an experiment leaves alone may be off.
fn not_moving(error: Error) -> Result<(), Error> {
    match error {
        Error::Faulted(_) => Err(error),
        _ => Ok(()),
    }
}

fn stopped_by(phase: ExperimentPhase) -> String {
    let why = match phase {
        ExperimentPhase::WindowLeft => {
            "it left its window: the axis is faster than its settings say"
        }
        ExperimentPhase::TooFast => "it was faster than allowed: choose a smaller amplitude",
        ExperimentPhase::TooLong => "it took too long",
        ExperimentPhase::NotPermitted => "the axis did not permit it: look at `leadscrew faults`",
        _ => "it was ended from outside",
    };
    format!("the experiment did not run to its end: {why}")
}

/// What a program adds, tick by tick, as a share of full command.
fn added(program: &Program) -> Vec<f64> {
    let full = f64::from(1 << Signal::Command.frac());
    let limit = program.bounds.command.to_bits();
    let mut added = Vec::new();
    for index in 0.. {
        let Some(segment) = program.segment(index) else {
            return added;
        };
        let commands = (0..segment.ticks).map(|tick| segment.shape.command(tick));
        added.extend(commands.map(|bits| f64::from(bits.clamp(-limit, limit)) / full));
    }
    added
}
