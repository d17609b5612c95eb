//! What may go wrong between a tool and its axis, in sentences that say what to do.

use std::time::Duration;

use leadscrew::protocol::VERSION;
use leadscrew::protocol::refusal::Refusal;
use leadscrew::supervisor::Fault;

/// What went wrong.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// An address that is none.
    #[error("no port `{port}`. {why} {there}")]
    NoSuchPort {
        /// The address.
        port: String,
        /// What it should be.
        why: String,
        /// What ports there are.
        there: String,
    },
    /// A line could not be opened.
    #[error("cannot open {port}: {source}. {advice}")]
    Open {
        /// The address.
        port: String,
        /// What to do.
        advice: String,
        /// What the system says.
        source: std::io::Error,
    },
    /// An address whose line this crate does not make.
    #[error(
        "{port} is not reached over a serial port or TCP: open its line and give it to Axis::open"
    )]
    NoLine {
        /// The address.
        port: String,
    },
    /// The line itself has failed.
    #[error(
        "the line {port} is gone: {source}. An axis that this tool moved stops by itself. Check the cable, then connect anew"
    )]
    Line {
        /// The address.
        port: String,
        /// What the system says.
        source: std::io::Error,
    },
    /// The axis does not answer any more, or never did.
    #[error(
        "the axis on {port} did not answer within {} ms ({asked}). An axis that this tool moved stops by itself. \
         Check power, cable, port and baud rate, then connect anew", .after.as_millis()
    )]
    Lost {
        /// The address.
        port: String,
        /// What was asked.
        asked: String,
        /// How long it was waited, on the line's clock.
        after: Duration,
    },
    /// The axis speaks another version of the protocol.
    #[error(
        "the axis speaks version {axis} of the protocol (firmware {firmware}), this tool version {VERSION}. \
         Use the tool of the firmware's version, or bring the firmware to the tool's"
    )]
    ProtocolVersion {
        /// Version of the axis.
        axis: u16,
        /// Its firmware.
        firmware: String,
    },
    /// The axis has refused a request; it goes on as it was.
    #[error("{0}")]
    Refused(Refused),
    /// The lease has lapsed while the axis was enabled.
    #[error(
        "the control lease has lapsed: the axis did not hear from this tool for a tenth of a second, has made a controlled stop \
         and switched its drive off. Look where it stands, then enable it and give the order anew"
    )]
    LeaseLapsed,
    /// Another tool has opened a session since.
    #[error(
        "another tool has connected to this axis and ended this session. Close it, then connect anew"
    )]
    SessionTaken,
    /// The axis does not know the session any more.
    #[error(
        "the axis was switched off and on, or restarted, since the tool connected. Connect anew, then look where it stands"
    )]
    Restarted,
    /// A fault stopped the axis.
    #[error("{}: {}", fault_name(.0), fault_text(.0))]
    Faulted(u8),
    /// What was waited for did not come.
    #[error("{what} after {} ms: the axis is {now}. {advice}", .after.as_millis())]
    NotReached {
        /// What was waited for, as `not ready`.
        what: &'static str,
        /// How long it was waited, on the line's clock.
        after: Duration,
        /// How the axis stands.
        now: String,
        /// What to do.
        advice: &'static str,
    },
    /// The axis was disabled while it was waited for something else.
    #[error(
        "the axis was disabled before {what}. Find out by whom, then enable it and give the order anew"
    )]
    DisabledMeanwhile {
        /// What was waited for.
        what: &'static str,
    },
    /// No parameter of that name.
    #[error("no parameter `{name}`{} List them; a name is section and name, with a point between them", suggested(.nearest.as_deref()))]
    UnknownParameter {
        /// The name.
        name: String,
        /// The nearest one that there is.
        nearest: Option<String>,
    },
    /// A value outside a parameter's range.
    #[error(
        "{name} = {value} {unit} is outside its range of {min} to {max} {unit}: choose a value within it"
    )]
    ParameterOutOfRange {
        /// Section and name.
        name: String,
        /// The value.
        value: f64,
        /// Its unit.
        unit: String,
        /// Smallest value allowed.
        min: f64,
        /// Largest value allowed.
        max: f64,
    },
    /// A number that cannot be said to an axis.
    #[error("{what} {value} cannot be: it has to be a number of {range}")]
    NoNumber {
        /// What it is.
        what: &'static str,
        /// The value.
        value: f64,
        /// What it has to be.
        range: &'static str,
    },
    /// A text that is too long for a frame.
    #[error("{asked}: the text is too long for the link, shorten it to 200 bytes")]
    TooLong {
        /// What was asked.
        asked: String,
    },
    /// The axis has answered what was not asked.
    #[error("{asked}: the axis answered something else. Compare the versions of tool and firmware")]
    Unexpected {
        /// What was asked.
        asked: String,
    },
    /// The wait was interrupted.
    #[error("interrupted: {}", if *.stands { "the axis stands" } else { "the axis was told to stop, and does not stand yet: watch it" })]
    Interrupted {
        /// The axis has come to rest, or was not moved by this tool.
        stands: bool,
    },
}

impl Error {
    /// True where the axis cannot be reached any more, or not by this session.
    #[must_use]
    pub const fn is_lost(&self) -> bool {
        matches!(
            self,
            Self::Line { .. } | Self::Lost { .. } | Self::SessionTaken | Self::Restarted
        )
    }

    /// The same refusal with other words for what was asked.
    pub(crate) fn asked(mut self, asked: &str) -> Self {
        if let Self::Refused(refused) = &mut self {
            asked.clone_into(&mut refused.asked);
        }
        self
    }

    /// The refusal, where it is one that is known.
    #[must_use]
    pub const fn refusal(&self) -> Option<Refusal> {
        match self {
            Self::Refused(refused) => refused.refusal(),
            _ => None,
        }
    }
}

/// A request that was refused.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Refused {
    /// What was asked.
    pub asked: String,
    /// The number of the refusal.
    pub number: u16,
    /// Figures that belong to it; may be empty.
    pub detail: String,
}

impl Refused {
    /// The refusal; `None` for one of a later version.
    #[must_use]
    pub const fn refusal(&self) -> Option<Refusal> {
        Refusal::from_number(self.number)
    }
}

impl std::fmt::Display for Refused {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self {
            asked,
            number,
            detail,
        } = self;
        match self.refusal() {
            Some(refusal) => write!(f, "{asked} was refused: {refusal}")?,
            None => write!(
                f,
                "{asked} was refused with number {number}, which this tool does not know. Use the tool of the firmware's version."
            )?,
        }
        if detail.is_empty() {
            Ok(())
        } else {
            write!(f, " {detail}")
        }
    }
}

fn fault_name(number: &u8) -> String {
    Fault::from_number(*number).map_or_else(
        || format!("fault {number}"),
        |fault| format!("fault {number}, {}", fault.name()),
    )
}

fn fault_text(number: &u8) -> String {
    Fault::from_number(*number).map_or_else(
        || "this tool does not know it. See docs/faults.md of the firmware's version".to_owned(),
        |fault| {
            let description = fault.description();
            format!(
                "{} {} Then disable the axis, clear the fault and enable it.",
                description.what, description.remedy
            )
        },
    )
}

fn suggested(nearest: Option<&str>) -> String {
    nearest.map_or_else(
        || ".".to_owned(),
        |name| format!("; did you mean `{name}`?"),
    )
}
