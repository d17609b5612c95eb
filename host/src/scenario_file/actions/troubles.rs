//! What goes wrong.

use leadscrew_hal_mock::faults::Channel;
use leadscrew_hal_mock::scenario::{EncoderTrouble, Interference, Trouble};

use super::{Spec, number, whole};
use crate::scenario_file::words::{Key, Value};

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

const fn bursts(values: &[f64]) -> Interference {
    Interference {
        burst_hz: values[0],
        pulses: values[1] as u32,
        width_us: values[2],
    }
}

/// All of it.
pub const TROUBLES: &[Spec] = &[
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
        "probe-glitch",
        "a pulse on the line of the touch probe, shorter than a tick",
        &[],
        |_| Trouble::ProbeGlitch,
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
