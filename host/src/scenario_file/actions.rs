//! The actions of a timeline, by the names that files give them.

use std::ops::Range;

use leadscrew::setpoint::sources::Source;
use leadscrew::setpoint::thread::{SpindleWay, ThreadOrder};
use leadscrew_hal_mock::faults::Channel;
use leadscrew_hal_mock::scenario::{
    Action, Ask, EncoderTrouble, Interference, Outer, Timed, Trouble,
};
use toml::de::DeTable;

use super::words::{Key, Value, read_all};
use crate::toml_file::{Complaint, suggestion};

/// An action: its name, its keys, and what is made of their values.
#[derive(Clone, Copy, Debug)]
pub struct Spec {
    /// Its name.
    pub name: &'static str,
    /// What it does.
    pub what: &'static str,
    /// Its keys, beside those that all have.
    pub keys: &'static [Key],
    make: Make,
}

#[derive(Clone, Copy, Debug)]
enum Make {
    Ask(fn(&[f64]) -> Ask),
    /// Lasts for a time.
    Trouble(fn(&[f64]) -> Trouble),
    /// From outside the axis.
    Outer(fn(&[f64]) -> Outer),
    /// Comes once.
    Event(fn(&[f64]) -> Trouble),
}

impl Spec {
    const fn ask(
        name: &'static str,
        what: &'static str,
        keys: &'static [Key],
        make: fn(&[f64]) -> Ask,
    ) -> Self {
        let make = Make::Ask(make);
        Self {
            name,
            what,
            keys,
            make,
        }
    }

    const fn trouble(
        name: &'static str,
        what: &'static str,
        keys: &'static [Key],
        make: fn(&[f64]) -> Trouble,
    ) -> Self {
        let make = Make::Trouble(make);
        Self {
            name,
            what,
            keys,
            make,
        }
    }

    const fn outer(
        name: &'static str,
        what: &'static str,
        keys: &'static [Key],
        make: fn(&[f64]) -> Outer,
    ) -> Self {
        let make = Make::Outer(make);
        Self {
            name,
            what,
            keys,
            make,
        }
    }

    const fn event(
        name: &'static str,
        what: &'static str,
        keys: &'static [Key],
        make: fn(&[f64]) -> Trouble,
    ) -> Self {
        let make = Make::Event(make);
        Self {
            name,
            what,
            keys,
            make,
        }
    }

    /// True for what goes wrong, false for what is asked of the axis.
    #[must_use]
    pub const fn is_trouble(&self) -> bool {
        matches!(self.make, Make::Trouble(_) | Make::Event(_))
    }

    /// True for what lasts for a time.
    #[must_use]
    pub const fn lasts(&self) -> bool {
        matches!(self.make, Make::Trouble(_))
    }
}

const fn number(
    name: &'static str,
    unit: &'static str,
    min: f64,
    max: f64,
    what: &'static str,
) -> Key {
    Key {
        name,
        what,
        value: Value::Number { unit, min, max },
        default: None,
    }
}

const fn whole(name: &'static str, min: u32, max: u32, what: &'static str) -> Key {
    Key {
        name,
        what,
        value: Value::Whole { min, max },
        default: None,
    }
}

impl Key {
    const fn or(self, default: f64) -> Self {
        Self {
            default: Some(default),
            ..self
        }
    }
}

const TIME: Key = number(
    "time_s",
    "s",
    0.0,
    1e5,
    "when, from the start of the run; the nearest tick is the first to see it",
);
/// How long a trouble lasts.
pub const FOR: Key = number(
    "for_s",
    "s",
    0.0,
    1e5,
    "for how long; left out: to the end of the run",
)
.or(f64::INFINITY);
const FEED: Key = number(
    "feed_mm_per_min",
    "mm/min",
    0.0,
    1e6,
    "largest feed; 0 or left out: that of the axis",
)
.or(0.0);
const EVERY: Key = whole("every", 1, u32::MAX, "edges from one to the next");
const BURSTS: &[Key] = &[
    number("burst_hz", "Hz", 0.01, 1e6, "bursts a second"),
    whole("pulses", 1, 10_000, "pulses of a burst").or(3.0),
    number(
        "width_us",
        "µs",
        0.1,
        1e4,
        "width of a pulse, and of the pause after it",
    )
    .or(2.0),
];

const THREAD: &[Key] = &[
    number(
        "lead_mm",
        "mm",
        0.001,
        1000.0,
        "travel a revolution: starts × pitch",
    ),
    number(
        "start_mm",
        "mm",
        -1e6,
        1e6,
        "where the pass waits for the spindle",
    ),
    number(
        "from_mm",
        "mm",
        -1e6,
        1e6,
        "where the full-depth part begins",
    ),
    number("to_mm", "mm", -1e6, 1e6, "where it ends"),
    number(
        "angle_deg",
        "°",
        -360.0,
        360.0,
        "where the spindle stands when the line passes 0 mm",
    )
    .or(0.0),
    whole("starts", 1, 100, "starts of the thread").or(1.0),
    whole("start", 0, 99, "which of them").or(0.0),
    number(
        "retract_deg",
        "°",
        0.0,
        3600.0,
        "how much before the end retraction is requested",
    )
    .or(0.0),
    Key {
        name: "spindle",
        what: "way that the spindle turns",
        value: Value::Word(&["forward", "backward"]),
        default: Some(0.0),
    },
];

const fn bursts(values: &[f64]) -> Interference {
    Interference {
        burst_hz: values[0],
        pulses: values[1] as u32,
        width_us: values[2],
    }
}

/// All actions.
pub const ACTIONS: &[Spec] = &[
    Spec::ask("enable", "takes the axis under control", &[], |_| {
        Ask::Enable
    }),
    Spec::ask("disable", "takes it out of control", &[], |_| Ask::Disable),
    Spec::ask(
        "clear-fault",
        "clears the fault that is latched, once the axis stands and is disabled",
        &[],
        |_| Ask::ClearFault,
    ),
    Spec::ask("clear-warnings", "forgets the warnings", &[], |_| {
        Ask::ClearWarnings
    }),
    Spec::ask(
        "move-to",
        "moves to a position: from the origin of homing, before that from where the axis stood at the start",
        &[number("position_mm", "mm", -1e6, 1e6, "where to"), FEED],
        |values| Ask::MoveTo {
            position_mm: values[0],
            feed_mm_per_min: values[1],
        },
    ),
    Spec::ask(
        "move-by",
        "moves by a distance, from the target if there is one",
        &[number("distance_mm", "mm", -1e6, 1e6, "how far"), FEED],
        |values| Ask::MoveBy {
            distance_mm: values[0],
            feed_mm_per_min: values[1],
        },
    ),
    Spec::ask(
        "jog",
        "moves until it is stopped",
        &[number(
            "feed_mm_per_min",
            "mm/min",
            -1e6,
            1e6,
            "how fast; negative downward",
        )],
        |values| Ask::Jog {
            feed_mm_per_min: values[0],
        },
    ),
    Spec::ask(
        "hold",
        "feed hold: stops, and remembers the target",
        &[],
        |_| Ask::Hold,
    ),
    Spec::ask("resume", "ends a feed hold", &[], |_| Ask::Resume),
    Spec::ask(
        "override",
        "feed override",
        &[whole("percent", 0, 200, "percent of the feed")],
        |values| Ask::Override {
            percent: values[0] as u16,
        },
    ),
    Spec::ask("stop", "stops, and forgets the target", &[], |_| Ask::Stop),
    Spec::ask(
        "soft-limits",
        "sets soft limits of travel",
        &[
            number("low_mm", "mm", -1e6, 1e6, "the low one"),
            number("high_mm", "mm", -1e6, 1e6, "the high one"),
        ],
        |values| Ask::SetTravel {
            low_mm: values[0],
            high_mm: values[1],
        },
    ),
    Spec::ask(
        "home",
        "looks for the home switch, then for the index",
        &[],
        |_| Ask::Home,
    ),
    Spec::ask(
        "select",
        "follows another source of setpoints",
        &[Key {
            name: "source",
            what: "which",
            value: Value::Word(&["trajectory", "step-dir", "analog", "gearing"]),
            default: None,
        }],
        |values| {
            let sources = [
                Source::Trajectory,
                Source::StepDir,
                Source::Analog,
                Source::Gearing,
            ];
            Ask::Select(sources[values[0] as usize])
        },
    ),
    Spec::ask(
        "engage",
        "engages the gear to the second encoder",
        &[],
        |_| Ask::Engage(true),
    ),
    Spec::ask("disengage", "disengages it", &[], |_| Ask::Engage(false)),
    Spec::ask("arm-thread", "cuts a pass of a thread", THREAD, |values| {
        Ask::ArmThread(ThreadOrder {
            lead_mm: values[0],
            start_mm: values[1],
            from_mm: values[2],
            to_mm: values[3],
            angle_deg: values[4],
            starts: values[5] as u32,
            start: values[6] as u32,
            retract_deg: values[7],
            spindle: [SpindleWay::Forward, SpindleWay::Backward][values[8] as usize],
        })
    }),
    Spec::outer(
        "step-rate",
        "the outer control gives steps at this rate from now on",
        &[number("steps_per_s", "1/s", -1e7, 1e7, "negative backward")],
        |values| Outer::StepRate {
            steps_per_s: values[0],
        },
    ),
    Spec::outer(
        "analog",
        "the analog command of the outer control from now on",
        &[number("level", "of full scale", -1.0, 1.0, "its level")],
        |values| Outer::Analog { level: values[0] },
    ),
    Spec::outer(
        "spindle-speed",
        "the spindle goes to another speed",
        &[number("rpm", "rpm", -1e4, 1e4, "negative backward")],
        |values| Outer::SpindleSpeed { rpm: values[0] },
    ),
    Spec::outer(
        "cut",
        "the tool enters the workpiece: the spindle's speed drops",
        &[],
        |_| Outer::Cut(true),
    ),
    Spec::outer("leave", "the tool leaves it", &[], |_| Outer::Cut(false)),
    Spec::trouble(
        "false-edges",
        "interference on A: false edges in pairs",
        BURSTS,
        |values| Trouble::Encoder(EncoderTrouble::FalseEdges(bursts(values))),
    ),
    Spec::trouble(
        "illegal-transitions",
        "interference on A and B at once",
        BURSTS,
        |values| Trouble::Encoder(EncoderTrouble::IllegalTransitions(bursts(values))),
    ),
    Spec::trouble("lost-edges", "edges are missed", &[EVERY], |values| {
        Trouble::Encoder(EncoderTrouble::LostEdges {
            every: values[0] as u32,
        })
    }),
    Spec::trouble(
        "doubled-edges",
        "edges are counted twice",
        &[EVERY],
        |values| {
            Trouble::Encoder(EncoderTrouble::DoubledEdges {
                every: values[0] as u32,
            })
        },
    ),
    Spec::trouble(
        "dead-channel",
        "a channel of the encoder stays at its level",
        &[Key {
            name: "channel",
            what: "which",
            value: Value::Word(&["a", "b"]),
            default: None,
        }],
        |values| {
            let channel = [Channel::A, Channel::B][values[0] as usize];
            Trouble::Encoder(EncoderTrouble::DeadChannel(channel))
        },
    ),
    Spec::trouble(
        "duty-drift",
        "A falls late",
        &[number("delay_us", "µs", 0.0, 1000.0, "by how much")],
        |values| {
            Trouble::Encoder(EncoderTrouble::DutyDrift {
                delay_us: values[0],
            })
        },
    ),
    Spec::trouble(
        "line-loss",
        "all lines of the encoder stay at their levels; no receiver tells of it",
        &[],
        |_| Trouble::Encoder(EncoderTrouble::LineLoss),
    ),
    Spec::trouble(
        "overrun",
        "the buffer of edge times is too small",
        &[whole("kept", 0, 4096, "times of a tick that it holds")],
        |values| {
            Trouble::Encoder(EncoderTrouble::Overrun {
                kept: values[0] as u32,
            })
        },
    ),
    Spec::trouble(
        "coupling-slip",
        "the encoder loses a share of its motion in its coupling",
        &[number("share", "1", 0.0, 1.0, "the share; 1 for a broken coupling").or(1.0)],
        |values| Trouble::CouplingSlip { share: values[0] },
    ),
    Spec::trouble(
        "signal-loss",
        "the encoder's cable is cut: no edge comes, and its line receiver tells of it",
        &[],
        |_| Trouble::SignalLoss,
    ),
    Spec::trouble(
        "encoder-reversed",
        "a pair of the encoder's wires is exchanged: it counts the other way",
        &[],
        |_| Trouble::EncoderReversed,
    ),
    Spec::trouble(
        "drive-reversed",
        "the command's wires are exchanged",
        &[],
        |_| Trouble::DriveReversed,
    ),
    Spec::trouble(
        "drive-fault",
        "the drive reports a fault, and brakes to a stop",
        &[],
        |_| Trouble::DriveFault,
    ),
    Spec::trouble(
        "drive-not-ready",
        "the drive is enabled in vain, or ceases to be ready and brakes to a stop",
        &[],
        |_| Trouble::DriveNotReady,
    ),
    Spec::trouble(
        "converter-stuck",
        "the output converter puts out the same whatever it is told",
        &[number("output", "of full command", -1.0, 1.0, "what")],
        |values| Trouble::ConverterStuck { output: values[0] },
    ),
    Spec::trouble(
        "converter-offset",
        "the output converter puts out more than it is told",
        &[number(
            "offset",
            "of full command",
            -1.0,
            1.0,
            "by how much",
        )],
        |values| Trouble::ConverterOffset { offset: values[0] },
    ),
    Spec::trouble(
        "emergency-stop",
        "the emergency-stop chain is open; power stays on for the stop",
        &[],
        |_| Trouble::EmergencyStop,
    ),
    Spec::trouble(
        "master-lost",
        "the cable of the second encoder is cut, for good",
        &[],
        |_| Trouble::MasterLost,
    ),
    Spec::trouble(
        "index-lost",
        "the encoder's index line is broken",
        &[],
        |_| Trouble::IndexLost,
    ),
    Spec::trouble(
        "store-corrupt",
        "the parameter store is found to be corrupt",
        &[],
        |_| Trouble::StoreCorrupt,
    ),
    Spec::event(
        "missed-ticks",
        "the axis misses ticks; the machine goes on under the last command",
        &[whole("ticks", 1, 1000, "how many")],
        |values| Trouble::MissedTicks {
            ticks: values[0] as u16,
        },
    ),
];

/// Reads one `[[at]]`.
pub(super) fn read(table: &DeTable<'_>, place: Range<usize>) -> Result<Timed, Complaint> {
    let names = || ACTIONS.iter().map(|spec| spec.name);
    let Some(value) = table.get("action") else {
        let first = names().take(3).collect::<Vec<_>>().join("\", \"");
        return Err(Complaint::new(
            place,
            format!("an [[at]] needs an `action`, such as \"{first}\""),
        ));
    };
    let word = value.get_ref().as_str().unwrap_or_default();
    let Some(spec) = ACTIONS.iter().find(|spec| spec.name == word) else {
        return Err(Complaint::new(
            value.span(),
            format!("unknown action `{word}`{}", suggestion(word, names())),
        ));
    };
    let keys: Vec<&Key> = [&TIME]
        .into_iter()
        .chain(spec.keys)
        .chain(spec.lasts().then_some(&FOR))
        .collect();
    let of = format!("action \"{}\"", spec.name);
    let values = read_all(table, &keys, &["action"], &of, place)?;
    let own = &values[1..=spec.keys.len()];
    let action = match spec.make {
        Make::Ask(make) => Action::Ask(make(own)),
        Make::Outer(make) => Action::Set(make(own)),
        Make::Trouble(make) => Action::Trouble {
            trouble: make(own),
            for_s: values[values.len() - 1],
        },
        Make::Event(make) => Action::Trouble {
            trouble: make(own),
            for_s: 0.0,
        },
    };
    Ok(Timed {
        at_s: values[0],
        action,
    })
}
