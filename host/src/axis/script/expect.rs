//! What a script expects of an axis.

use leadscrew::supervisor::State;
use leadscrew_client::{Axis, Error, Status};

use crate::axis::values::{entry, number_in};
use crate::axis_file::Content;
use crate::fault_names::{FAULT_NAMES, STATES, fault_name};
use crate::toml_file::suggestion;

/// Something that is to be true.
#[derive(Clone, Debug, PartialEq)]
pub enum Expected {
    /// A figure of the axis.
    Figure {
        /// Which.
        figure: Figure,
        /// What it is to be; 0 for one that is to be small.
        value: f64,
        /// By how much it may be off.
        within: f64,
    },
    /// The state.
    State(State),
    /// A fault, by its name.
    Fault(String),
    /// No fault.
    NoFault,
    /// No warning.
    NoWarning,
    /// The origin is known, or not.
    Homed(bool),
    /// A parameter's value, as it stands there.
    Parameter(String, String),
}

/// A figure of the axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Figure {
    /// mm.
    Position,
    /// mm.
    Setpoint,
    /// mm.
    FollowingError,
    /// mm/min.
    Velocity,
}

const FIGURES: [(&str, Figure); 4] = [
    ("position", Figure::Position),
    ("setpoint", Figure::Setpoint),
    ("following-error", Figure::FollowingError),
    ("velocity", Figure::Velocity),
];
/// What may be expected.
const WORDS: [&str; 10] = [
    "position",
    "setpoint",
    "following-error",
    "velocity",
    "state",
    "fault",
    "no",
    "homed",
    "not",
    "parameter",
];

impl Figure {
    const fn unit(self) -> &'static str {
        match self {
            Self::Velocity => "mm/min",
            _ => "mm",
        }
    }

    fn name(self) -> &'static str {
        let found = FIGURES.iter().find(|(_, figure)| *figure == self);
        found.map_or("", |(name, _)| name)
    }

    const fn of(self, status: &Status) -> f64 {
        match self {
            Self::Position => status.position_mm,
            Self::Setpoint => status.setpoint_mm,
            Self::FollowingError => status.following_error_mm,
            Self::Velocity => status.velocity_mm_per_min,
        }
    }
}

/// What is expected by those words.
pub(super) fn parse(words: &[&str]) -> Result<Expected, String> {
    let [first, rest @ ..] = words else {
        let words = WORDS.join(", ");
        return Err(format!("what is expected? One of {words}"));
    };
    if let Some((_, figure)) = FIGURES.iter().find(|(name, _)| name == first) {
        return of_figure(*figure, rest);
    }
    match (*first, rest) {
        ("state", [name]) => {
            let found = STATES.iter().find(|(_, known)| known == name);
            found
                .map(|(state, _)| Expected::State(*state))
                .ok_or_else(|| {
                    let hint = suggestion(name, STATES.map(|(_, name)| name));
                    format!("there is no state `{name}`{hint}")
                })
        }
        ("fault", [name]) if FAULT_NAMES.contains(name) => Ok(Expected::Fault((*name).to_owned())),
        ("fault", [name]) => {
            let hint = suggestion(name, FAULT_NAMES);
            Err(format!("there is no fault `{name}`{hint}"))
        }
        ("no", ["fault"]) => Ok(Expected::NoFault),
        ("no", ["warning" | "warnings"]) => Ok(Expected::NoWarning),
        ("homed", []) => Ok(Expected::Homed(true)),
        ("not", ["homed"]) => Ok(Expected::Homed(false)),
        ("parameter", [name, value]) => {
            Ok(Expected::Parameter((*name).to_owned(), (*value).to_owned()))
        }
        (known, _) if WORDS.contains(&known) => Err(format!(
            "`expect {}` is not understood: expected {}",
            words.join(" "),
            form(known)
        )),
        (other, _) => {
            let hint = suggestion(other, WORDS);
            Err(format!("nothing is known of `{other}`{hint}"))
        }
    }
}

fn form(word: &str) -> &'static str {
    match word {
        "state" => "`expect state NAME`",
        "fault" => "`expect fault NAME`, or `expect no fault`",
        "no" => "`expect no fault`, or `expect no warnings`",
        "parameter" => "`expect parameter NAME VALUE`",
        _ => "`expect homed`",
    }
}

fn of_figure(figure: Figure, rest: &[&str]) -> Result<Expected, String> {
    let unit = figure.unit();
    let name = figure.name();
    let (value, within) = match rest {
        [value, "within", within] => (number_in(name, value, unit)?, within),
        // Both are best near nothing.
        ["within", within] if figure == Figure::FollowingError => (0.0, within),
        _ => {
            let unit = if figure == Figure::Velocity {
                "MM_PER_MIN"
            } else {
                "MM"
            };
            return Err(format!(
                "expected `expect {name} {unit} within {unit}`: how far off may it be?"
            ));
        }
    };
    let within = number_in("within", within, unit)?;
    if within < 0.0 || within.is_nan() {
        return Err(format!("within {within}: a tolerance is not negative"));
    }
    Ok(Expected::Figure {
        figure,
        value,
        within,
    })
}

impl Expected {
    /// Looks at the axis; gives what is seen, and whether it is what is expected.
    ///
    /// # Errors
    /// Of a lost axis; no such parameter.
    pub fn check(&self, axis: &mut Axis) -> Result<Result<String, String>, Error> {
        if let Self::Parameter(name, value) = self {
            let content = entry(axis.parameter(name)?).content;
            let is_it = match &content {
                Content::Number {
                    value: is, unit, ..
                } => number_in(name, value, unit).is_ok_and(|value| value == *is),
                Content::Word { word, .. } => word == value,
            };
            return Ok(judged(is_it, format!("it is {content}")));
        }
        Ok(self.judge(&axis.status()?))
    }

    fn judge(&self, status: &Status) -> Result<String, String> {
        match self {
            Self::Figure {
                figure,
                value,
                within,
            } => {
                let is = figure.of(status);
                let off = (is - value).abs();
                let unit = figure.unit();
                let seen = format!("{} is {is:.4} {unit}, {off:.4} {unit} off", figure.name());
                judged(off <= *within, seen)
            }
            Self::State(state) => judged(
                status.state() == Some(*state),
                format!("the axis is {}", status.state_text()),
            ),
            Self::Fault(name) => {
                let fault = status.fault().map_or("no fault", fault_name);
                judged(fault == name, format!("there is {fault}"))
            }
            Self::NoFault => {
                let fault = status.fault().map_or("no fault", fault_name);
                judged(status.fault_number == 0, format!("there is {fault}"))
            }
            Self::NoWarning => {
                let warnings: Vec<_> = status.warnings().map(fault_name).collect();
                let seen = if warnings.is_empty() {
                    "there is none".to_owned()
                } else {
                    format!("there is {}", warnings.join(", "))
                };
                judged(status.warning_bits == 0, seen)
            }
            Self::Homed(homed) => {
                let not = if status.is_homed { "" } else { "not " };
                judged(status.is_homed == *homed, format!("it is {not}homed"))
            }
            // Looked at where it is asked for.
            Self::Parameter(..) => Ok(String::new()),
        }
    }
}

fn judged(is_it: bool, seen: String) -> Result<String, String> {
    if is_it { Ok(seen) } else { Err(seen) }
}
