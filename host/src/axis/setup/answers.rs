//! What setup asks about the machine.

use std::path::Path;

use leadscrew::settings::Settings;
use leadscrew::units::TICK_HZ;
use toml::de::DeValue;

use crate::axis::{Guide, ProcedureError};
use crate::toml_file::{self, Complaint, TomlFileError, plain_number, suggestion};

/// A question whose answer is a number.
struct Question {
    name: &'static str,
    text: &'static str,
    range: (f64, f64),
    default: fn(&Settings) -> f64,
}

/// A question by its name in a file of answers; the text is what people read.
const fn question(
    name: &'static str,
    text: &'static str,
    range: (f64, f64),
    default: fn(&Settings) -> f64,
) -> Question {
    Question {
        name,
        text,
        range,
        default,
    }
}

const MM: (f64, f64) = (-1e6, 1e6);

const QUESTIONS: [Question; 15] = [
    question(
        "counts_per_revolution",
        "Counts of the encoder from index to index: 4 times its lines; 0 if it has no index",
        (0.0, 1e7),
        |settings| settings.axis.motion.counts_per_revolution,
    ),
    question(
        "counts_per_mm",
        "Counts of the encoder in 1 mm: counts of a revolution over the pitch of the screw",
        (0.001, 1e7),
        |settings| settings.axis.motion.counts_per_mm,
    ),
    question(
        "full_command_feed_mm_per_min",
        "Feed at full command (10 V), mm/min, as the drive's plate has it; it is measured later",
        (0.001, 1e6),
        |settings| settings.axis.motion.full_command_feed_mm_per_min,
    ),
    question(
        "max_feed_mm_per_min",
        "Largest feed, mm/min",
        (1e-6, 1e6),
        |settings| settings.axis.motion.max_feed_mm_per_min,
    ),
    question(
        "max_acceleration_m_s2",
        "Largest acceleration, m/s²",
        (1e-6, 1e4),
        |settings| settings.axis.motion.max_acceleration_m_s2,
    ),
    question(
        "max_jerk_m_s3",
        "Largest jerk, m/s³",
        (1e-6, 1e7),
        |settings| settings.axis.motion.max_jerk_m_s3,
    ),
    question(
        "travel_low_mm",
        "Low soft limit, mm from the origin of homing; the same as the high one for none",
        MM,
        |settings| settings.axis.motion.travel_low_mm,
    ),
    question("travel_high_mm", "High soft limit, mm", MM, |settings| {
        settings.axis.motion.travel_high_mm
    }),
    question("tick_hz", "Control rate, Hz", TICK_HZ, |settings| {
        settings.axis.tick_hz
    }),
    question(
        "room_minus_mm",
        "Free travel from where the axis stands now to the minus side, mm",
        (0.0, 1e6),
        |_| 20.0,
    ),
    question(
        "room_plus_mm",
        "Free travel from there to the plus side, mm",
        (0.0, 1e6),
        |_| 220.0,
    ),
    question(
        "window_mm",
        "Window of the experiments that identify the drive, mm",
        (0.1, 1000.0),
        |_| 20.0,
    ),
    question(
        "revolutions",
        "Revolutions that each run averages over to learn the encoder, 12 or more; 40 if there is room",
        (12.0, 1000.0),
        |_| 40.0,
    ),
    question(
        "plus_is_right",
        "Plus is the way that the axis goes on a plus command: 1 yes, 0 no, -1 to be asked when it has moved",
        (-1.0, 1.0),
        |_| -1.0,
    ),
    question(
        "home_switch",
        "End of the travel at which the home switch is: -1 low, 1 high; 0 if there is none, or not yet",
        (-1.0, 1.0),
        |_| 0.0,
    ),
];

/// Answers that are there before anything is asked.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Answers(Vec<(&'static str, f64)>);

impl Answers {
    /// Those of a file; `name = number` each.
    ///
    /// # Errors
    /// [`TomlFileError`] with what is wrong and where.
    pub fn of_file(path: &Path) -> Result<Self, TomlFileError> {
        toml_file::read(path, |text| {
            let document = toml_file::document(text)?;
            let mut answers = Self::default();
            for (name, value) in document.get_ref() {
                let number = match value.get_ref() {
                    DeValue::Boolean(is_so) => Some(f64::from(u8::from(*is_so))),
                    _ => plain_number(value),
                };
                let number = number.ok_or_else(|| {
                    Complaint::new(
                        value.span(),
                        format!("{} has to be a number", name.get_ref()),
                    )
                })?;
                answers
                    .give(name.get_ref(), number)
                    .map_err(|error| Complaint::new(name.span(), error.to_string()))?;
            }
            Ok(answers)
        })
    }

    /// Adds an answer.
    ///
    /// # Errors
    /// [`ProcedureError::Answer`]: there is no such question, or the answer is out of range.
    pub fn give(&mut self, name: &str, value: f64) -> Result<(), ProcedureError> {
        let Some(question) = QUESTIONS.iter().find(|question| question.name == name) else {
            let known = QUESTIONS.iter().map(|question| question.name);
            return Err(ProcedureError::Answer(format!(
                "{name} is not asked{}",
                suggestion(name, known)
            )));
        };
        question.check(value)?;
        self.0.push((question.name, value));
        Ok(())
    }

    /// The answer of that name: the one that is there, else what is given now.
    ///
    /// # Errors
    /// Nobody can answer; an answer out of range.
    pub(super) fn get(
        &mut self,
        name: &'static str,
        settings: &Settings,
        guide: &mut dyn Guide,
    ) -> Result<f64, ProcedureError> {
        // The last one counts.
        let given = self.0.iter().rev().find(|(known, _)| *known == name);
        if let Some((_, value)) = given {
            return Ok(*value);
        }
        let question = QUESTIONS.iter().find(|question| question.name == name);
        let question = question.ok_or_else(|| ProcedureError::Answer(name.to_owned()))?;
        let value = guide.number(question.text, (question.default)(settings))?;
        question.check(value)?;
        self.0.push((question.name, value));
        Ok(value)
    }

    /// The answer that is there, else the default: what is not worth a question.
    pub(super) fn known(&self, name: &'static str, settings: &Settings) -> f64 {
        let given = self.0.iter().rev().find(|(known, _)| *known == name);
        let default = || {
            let question = QUESTIONS.iter().find(|question| question.name == name);
            question.map_or(0.0, |question| (question.default)(settings))
        };
        given.map_or_else(default, |(_, value)| *value)
    }
}

impl Question {
    fn check(&self, value: f64) -> Result<(), ProcedureError> {
        let (min, max) = self.range;
        if (min..=max).contains(&value) {
            return Ok(());
        }
        Err(ProcedureError::Answer(format!(
            "{} = {value}: allowed are {min} to {max}",
            self.name
        )))
    }
}
