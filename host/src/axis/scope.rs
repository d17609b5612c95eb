//! The scope as people ask for it: seconds, triggers in physical units, a move of its own.

mod trigger;

use std::time::Duration;

use leadscrew::scope::{Setup, Signal, Signals};
use leadscrew_client::{Axis, Recording, Scale};

pub use trigger::{TriggerText, WhatTrigger, signal};

use crate::error::CommandError;

/// What is looked at unless other signals are named.
pub const DEFAULT_SIGNALS: [Signal; 4] = [
    Signal::ReportedPosition,
    Signal::CommandedPosition,
    Signal::FollowingError,
    Signal::Command,
];

/// How much of a recording lies before its trigger.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Before {
    /// A share of it.
    Share(f64),
    /// Seconds.
    Seconds(f64),
}

/// What is to be recorded.
#[derive(Clone, Debug, PartialEq)]
pub struct Wanted {
    /// The signals.
    pub signals: Vec<Signal>,
    /// For how long, s; none: as long as there is room.
    pub seconds: Option<f64>,
    /// Ticks from sample to sample; none: as many as are needed for the time.
    pub every: Option<u16>,
    /// What it waits for.
    pub trigger: TriggerText,
    /// What lies before that.
    pub before: Before,
}

/// A move that is made once the scope is armed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Move {
    /// Target, mm from the origin.
    pub target_mm: f64,
    /// Feed, mm/min.
    pub feed_mm_per_min: f64,
}

impl Wanted {
    /// The setup on an axis of that scale with room for so many samples.
    ///
    /// # Errors
    /// More time than there is room for, with how much there is.
    pub fn setup(&self, scale: Scale, room: u32) -> Result<Setup, CommandError> {
        let usage = |text: String| CommandError::Usage(text);
        let signals = Signals::new(&self.signals).map_err(|error| usage(error.to_string()))?;
        let seconds_of = |every: u16| f64::from(room) * f64::from(every) / scale.tick_hz;
        let every = match (self.every, self.seconds) {
            (Some(every), _) => every,
            (None, None) => 1,
            (None, Some(seconds)) => {
                let every = (seconds * scale.tick_hz / f64::from(room)).ceil().max(1.0);
                if every > f64::from(u16::MAX) {
                    return Err(usage(format!(
                        "--seconds {seconds}: {} s fit the memory of the axis at most",
                        seconds_of(u16::MAX).floor()
                    )));
                }
                every as u16
            }
        };
        let samples = match self.seconds {
            None => f64::from(room),
            Some(seconds) => (seconds * scale.tick_hz / f64::from(every))
                .round()
                .max(1.0),
        };
        if samples > f64::from(room) {
            let least = (samples / f64::from(room) * f64::from(every)).ceil();
            return Err(usage(format!(
                "{} s of {} signals in every {every}. tick do not fit the memory of the axis: {:.3} s do. Name fewer \
                 signals, or take --every {least}, or leave it out",
                self.seconds.unwrap_or_default(),
                self.signals.len(),
                seconds_of(every),
            )));
        }
        let before = match self.before {
            Before::Share(share) => samples * share,
            Before::Seconds(seconds) => seconds * scale.tick_hz / f64::from(every),
        };
        if !(0.0..samples).contains(&before.round()) {
            return Err(usage(format!(
                "--before: {} s before the trigger leave nothing of {} s for it: ask for less",
                before * f64::from(every) / scale.tick_hz,
                samples * f64::from(every) / scale.tick_hz,
            )));
        }
        Ok(Setup {
            signals,
            every,
            trigger: self.trigger.at(scale),
            pre: before.round() as u32,
            samples: samples as u32,
        })
    }
}

/// Arms the scope, makes the move if there is one, waits for the end for as long as `patience` beyond the recording itself,
/// and reads it. What was recorded without a trigger by then is read as well.
///
/// # Errors
/// What does not fit, a move that is refused, a lost axis.
pub fn record(
    axis: &mut Axis,
    wanted: &Wanted,
    motion: Option<Move>,
    patience: Duration,
) -> Result<Recording, CommandError> {
    let scale = axis.scale()?;
    let setup = wanted.setup(scale, axis.scope_room(wanted.signals.len()))?;
    axis.arm_scope(&setup)?;
    let ticks = |samples: u32| f64::from(samples) * f64::from(setup.every) / scale.tick_hz;
    if let Some(motion) = motion {
        // What is to be seen before the motion.
        axis.wait(Duration::from_secs_f64(ticks(setup.pre)))?;
        let made = axis.move_and_wait(motion.target_mm, motion.feed_mm_per_min);
        match made {
            // A fault is what may be looked for: what was recorded is read all the same.
            Ok(_) | Err(leadscrew_client::Error::Faulted(_)) => {}
            Err(error) => return Err(error.into()),
        }
    }
    let longest = Duration::from_secs_f64(ticks(setup.samples)).saturating_add(patience);
    if let Some(scope) = axis.wait_for_scope(longest)? {
        return Ok(axis.read_recording(&scope)?);
    }
    axis.end_scope()?;
    let ended = axis.wait_for_scope(Duration::from_secs(1))?;
    let ended =
        ended.ok_or_else(|| CommandError::Data("the scope did not end: arm it anew".to_owned()))?;
    Ok(axis.read_recording(&ended)?)
}
