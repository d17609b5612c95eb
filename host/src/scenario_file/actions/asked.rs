//! What is asked of the axis, and what comes from outside it.

use leadscrew::setpoint::sources::Source;
use leadscrew::setpoint::thread::{SpindleWay, ThreadOrder};
use leadscrew_hal_mock::scenario::{Ask, Outer, Pulse};

use super::{Spec, number, whole};
use crate::scenario_file::words::{Key, Value};

const FEED: Key = number(
    "feed_mm_per_min",
    "mm/min",
    0.0,
    1e6,
    "largest feed; 0 or left out: that of the axis",
)
.or(0.0);

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

const PULSE: &[Key] = &[
    number("level", "of full command", -1.0, 1.0, "command"),
    number("length_s", "s", 0.001, 10.0, "for how long"),
    number(
        "rest_s",
        "s",
        0.0,
        10.0,
        "at zero command for so long after it",
    )
    .or(0.3),
    number(
        "window_mm",
        "mm",
        0.001,
        1000.0,
        "it ends early where the axis leaves so much to either side of where it began",
    ),
    Key {
        name: "loop",
        what: "\"open\": the command takes the place of the loop's; \"closed\": it is added to it",
        value: Value::Word(&["open", "closed"]),
        default: Some(0.0),
    },
];

/// All of it.
pub const ASKED: &[Spec] = &[
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
        "probe",
        "goes towards a position until the probe touches, then back",
        &[
            number("towards_mm", "mm", -1e6, 1e6, "how far to go for a touch"),
            number("feed_mm_per_min", "mm/min", 0.0, 1e6, "how fast"),
            number("retract_mm", "mm", 0.0, 1e6, "how far back after it").or(0.0),
        ],
        |values| Ask::Probe {
            towards_mm: values[0],
            feed_mm_per_min: values[1],
            retract_mm: values[2],
        },
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
        "engages the gear to the second encoder, at the phase that comes of it",
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
    Spec::ask(
        "experiment",
        "an experiment of identification: a step of the command, then zero; an open loop stays open until it is ended",
        PULSE,
        |values| {
            Ask::Experiment(Pulse {
                level: values[0],
                length_s: values[1],
                rest_s: values[2],
                window_mm: values[3],
                is_closed: values[4] == 1.0,
            })
        },
    ),
    Spec::ask(
        "end-experiment",
        "ends an experiment; the loop holds the axis where it stands",
        &[],
        |_| Ask::EndExperiment,
    ),
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
];
