//! The first commissioning of an axis, step by step: each says what it moves, asks, and leaves what it found in the
//! axis's store, so that the next session goes on from there.
//!
//! ```text
//! machine ─► polarity ─► direction ─► index ─► identify ─► tune ─► encoder ─► offset ─► home
//!            (open-loop, bounded)              (open-loop)  (the first loop)
//! ```
//!
//! With the encoder's map learned the drive is identified and tuned once more: edges then count where they really are.

mod answers;
mod closed;
mod open_loop;
mod outcome;

pub use answers::Answers;
pub use outcome::{Outcome, TunedFigures};

use std::fmt;

use leadscrew::settings::Settings;
use leadscrew::tuning::DriveModel;
use leadscrew_client::{Axis, Kind};

use super::settings::{Change, Setting};
use super::{Guide, ProcedureError, Room, apply, read_settings};

/// A step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, clap::ValueEnum)]
pub enum Step {
    /// What the machine is, by questions
    Machine,
    /// The sign of the loop, by open-loop pulses
    Polarity,
    /// Which way is plus
    Direction,
    /// Counts from index to index
    Index,
    /// What the drive does
    Identify,
    /// The loop
    Tune,
    /// The map of the encoder, then identification and loop once more
    Encoder,
    /// The offset of the drive
    Offset,
    /// The home switch
    Home,
}

impl Step {
    const ALL: [Self; 9] = [
        Self::Machine,
        Self::Polarity,
        Self::Direction,
        Self::Index,
        Self::Identify,
        Self::Tune,
        Self::Encoder,
        Self::Offset,
        Self::Home,
    ];

    const fn name(self) -> &'static str {
        match self {
            Self::Machine => "machine",
            Self::Polarity => "polarity",
            Self::Direction => "direction",
            Self::Index => "index",
            Self::Identify => "identify",
            Self::Tune => "tune",
            Self::Encoder => "encoder",
            Self::Offset => "offset",
            Self::Home => "home",
        }
    }
}

impl fmt::Display for Step {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// Which steps are made.
#[derive(Clone, Debug, Default)]
pub struct Steps {
    /// These are left out.
    pub skip: Vec<Step>,
    /// Those before it are left out: they were made in an earlier session.
    pub from: Option<Step>,
}

impl Steps {
    fn has(&self, step: Step) -> bool {
        !self.skip.contains(&step) && self.from.is_none_or(|from| step >= from)
    }
}

/// A session of it.
struct Session<'s> {
    axis: &'s mut Axis,
    guide: &'s mut dyn Guide,
    answers: Answers,
    settings: Settings,
    room: Room,
    /// Counts of a revolution as they were answered.
    expected_counts: f64,
    /// Command of the proof of the sign.
    proof_level: Option<f64>,
    /// What was identified.
    model: Option<DriveModel>,
    outcome: Outcome,
}

/// Commissions the axis. The drive is off afterwards, whatever the end.
///
/// # Errors
/// [`ProcedureError`]; what the steps before found is kept.
pub fn setup(
    axis: &mut Axis,
    guide: &mut dyn Guide,
    answers: Answers,
    steps: &Steps,
) -> Result<Outcome, ProcedureError> {
    if axis.status()?.is_enabled {
        axis.disable()?;
    }
    let settings = read_settings(axis)?;
    let mut session = Session {
        axis,
        guide,
        answers,
        settings,
        room: Room {
            low_mm: 0.0,
            high_mm: 0.0,
        },
        expected_counts: settings.axis.motion.counts_per_revolution,
        proof_level: None,
        model: None,
        outcome: Outcome::default(),
    };
    session.run(steps)?;
    Ok(session.outcome)
}

impl Session<'_> {
    fn run(&mut self, steps: &Steps) -> Result<(), ProcedureError> {
        if steps.has(Step::Machine) {
            self.machine(steps)?;
        }
        self.find_room()?;
        for step in Step::ALL.into_iter().filter(|step| steps.has(*step)) {
            match step {
                Step::Machine => continue,
                Step::Polarity => self.polarity()?,
                Step::Direction => self.direction()?,
                Step::Index => self.index()?,
                Step::Identify => self.identify("identify")?,
                Step::Tune => self.tune()?,
                Step::Encoder => self.encoder()?,
                Step::Offset => self.offset()?,
                Step::Home => self.home()?,
            }
            self.outcome.steps.push(step.name());
        }
        self.save()
    }

    /// Asks what the machine is, and sets it.
    fn machine(&mut self, steps: &Steps) -> Result<(), ProcedureError> {
        self.guide.tell("machine");
        let names = [
            "counts_per_revolution",
            "counts_per_mm",
            "full_command_feed_mm_per_min",
            "max_feed_mm_per_min",
            "max_acceleration_m_s2",
            "max_jerk_m_s3",
            "travel_low_mm",
            "travel_high_mm",
            "tick_hz",
        ];
        let mut changes = Vec::new();
        for name in names {
            let value = self.answers.get(name, &self.settings, self.guide)?;
            let key = if name == "tick_hz" {
                name.to_owned()
            } else {
                format!("motion.{name}")
            };
            changes.push((key, value));
        }
        if let Some((_, counts)) = changes.first_mut() {
            self.expected_counts = *counts;
            if steps.has(Step::Index) {
                // Not watched before it is found.
                *counts = 0.0;
            }
        }
        let tick_hz = self.settings.axis.tick_hz;
        self.set(changes)?;
        self.save()?;
        if self.settings.axis.tick_hz != tick_hz {
            self.guide
                .tell("the control rate changes: the axis restarts");
            self.axis.restart()?;
            self.settings = read_settings(self.axis)?;
        }
        self.outcome.steps.push(Step::Machine.name());
        Ok(())
    }

    /// How far the axis may go in this session.
    fn find_room(&mut self) -> Result<(), ProcedureError> {
        let status = self.axis.status()?;
        let limits = Room::of_limits(&status, &self.settings);
        let mut ask = |name| self.answers.get(name, &self.settings, self.guide);
        self.room = match limits {
            Some(limits) => limits,
            None => {
                let (minus, plus) = (ask("room_minus_mm")?, ask("room_plus_mm")?);
                Room::around(&status, &self.settings, minus, plus)
            }
        };
        Ok(())
    }

    /// Tells what will move, and asks.
    fn agreed(&mut self, what: &str) -> Result<(), ProcedureError> {
        if self.guide.agree(&format!("{what} Go on?"), true)? {
            Ok(())
        } else {
            Err(ProcedureError::Declined)
        }
    }

    /// Sets numbers as one edit.
    fn set(
        &mut self,
        numbers: impl IntoIterator<Item = (String, f64)>,
    ) -> Result<(), ProcedureError> {
        let changes: Vec<_> = numbers
            .into_iter()
            .map(|(name, value)| Change {
                name,
                unit: "",
                before: Setting::Number(value),
                after: Setting::Number(value),
            })
            .collect();
        apply(self.axis, &changes)?;
        self.settings = read_settings(self.axis)?;
        Ok(())
    }

    fn save(&mut self) -> Result<(), ProcedureError> {
        Ok(self.axis.save_parameters()?)
    }

    /// True with a map in use, or one that was saved.
    fn has_map(&mut self) -> Result<bool, ProcedureError> {
        Ok(self.axis.stored(Kind::EncoderMap)?.length > 0)
    }
}
