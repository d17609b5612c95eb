//! What is done in a run: by the person at the panel, and by fate.

use leadscrew::setpoint::sources::Source;
use leadscrew::setpoint::thread::ThreadOrder;

use crate::faults::Channel;

/// An action at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Timed {
    /// When, s from the start; the first tick that sees it is the nearest.
    pub at_s: f64,
    /// What.
    pub action: Action,
}

/// What is done.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Action {
    /// The person at the panel, or the control above, asks for something.
    Ask(Ask),
    /// The outer control, or the spindle, does something.
    Set(Outer),
    /// Something goes wrong, for a time.
    Trouble {
        /// What goes wrong.
        trouble: Trouble,
        /// For how long, s; infinite for the rest of the run.
        for_s: f64,
    },
}

/// What is asked of the axis. Positions are from the origin that homing found, before that from where the axis stood at
/// the start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ask {
    /// Takes the axis under control.
    Enable,
    /// Takes it out of control.
    Disable,
    /// Clears the fault that is latched.
    ClearFault,
    /// Forgets the warnings.
    ClearWarnings,
    /// Moves to a position.
    MoveTo {
        /// Where to, mm.
        position_mm: f64,
        /// How fast at most, mm/min; 0 for the largest feed of the axis.
        feed_mm_per_min: f64,
    },
    /// Moves by a distance, from the target if there is one.
    MoveBy {
        /// How far, mm.
        distance_mm: f64,
        /// How fast at most, mm/min; 0 for the largest feed of the axis.
        feed_mm_per_min: f64,
    },
    /// Moves until it is stopped.
    Jog {
        /// How fast, mm/min; negative downward.
        feed_mm_per_min: f64,
    },
    /// Feed hold.
    Hold,
    /// Ends a feed hold.
    Resume,
    /// Feed override.
    Override {
        /// Percent of the feed.
        percent: u16,
    },
    /// Stops, and forgets the target.
    Stop,
    /// Sets soft limits of travel.
    SetTravel {
        /// The low one, mm.
        low_mm: f64,
        /// The high one, mm.
        high_mm: f64,
    },
    /// Looks for the home switch and the index.
    Home,
    /// Probes towards a position, and goes back after the touch.
    Probe {
        /// How far to go for a touch, mm.
        towards_mm: f64,
        /// How fast, mm/min.
        feed_mm_per_min: f64,
        /// How far back after it, mm.
        retract_mm: f64,
    },
    /// Follows another source of setpoints.
    Select(Source),
    /// Engages the gear, or disengages it.
    Engage(bool),
    /// Cuts a pass of a thread.
    ArmThread(ThreadOrder),
    /// An experiment of identification.
    Experiment(Pulse),
    /// Ends an experiment, and gives the axis back to its loop.
    EndExperiment,
}

/// A step of the command, and zero command after it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pulse {
    /// Command, as a share of full command.
    pub level: f64,
    /// For how long, s.
    pub length_s: f64,
    /// At zero command for so long after it, s.
    pub rest_s: f64,
    /// The experiment ends early where the axis leaves so much to either side of where it began, mm.
    pub window_mm: f64,
    /// The command is added to the loop's; else it takes its place.
    pub is_closed: bool,
}

/// What comes from outside the axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outer {
    /// Steps that an outer control gives from now on.
    StepRate {
        /// Steps a second; negative backward.
        steps_per_s: f64,
    },
    /// The analog command of a legacy control from now on.
    Analog {
        /// Share of full scale.
        level: f64,
    },
    /// The spindle goes to another speed.
    SpindleSpeed {
        /// rpm; negative backward.
        rpm: f64,
    },
    /// The tool enters the workpiece, or leaves it.
    Cut(bool),
}

/// What goes wrong.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Trouble {
    /// At the encoder, its lines or its capture.
    Encoder(EncoderTrouble),
    /// The encoder loses a share of its motion in its coupling; 1: broken.
    CouplingSlip {
        /// Share that is lost, 0 to 1.
        share: f64,
    },
    /// The encoder's cable is cut: no edge comes, and its line receiver tells of it.
    SignalLoss,
    /// A pair of the encoder's wires is exchanged: it counts the other way.
    EncoderReversed,
    /// The command's wires are exchanged.
    DriveReversed,
    /// The drive reports a fault, and brakes to a stop.
    DriveFault,
    /// The drive is enabled in vain, or ceases to be ready.
    DriveNotReady,
    /// The converter puts out the same whatever it is told.
    ConverterStuck {
        /// What, as a share of full command.
        output: f64,
    },
    /// The converter puts out more than it is told.
    ConverterOffset {
        /// By how much, as a share of full command.
        offset: f64,
    },
    /// The emergency-stop chain is open; power stays on for the stop.
    EmergencyStop,
    /// The cable of the second encoder is cut, for good: no edge comes, and its line receiver tells of it.
    MasterLost,
    /// The encoder's index line is broken.
    IndexLost,
    /// A pulse on the line of the touch probe, shorter than a tick, once.
    ProbeGlitch,
    /// The parameter store is found to be corrupt.
    StoreCorrupt,
    /// The axis misses ticks, once: the machine goes on under the last command.
    MissedTicks {
        /// How many.
        ticks: u16,
    },
}

/// What goes wrong at the encoder: [`faults::Fault`](crate::faults::Fault) in the units of a file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EncoderTrouble {
    /// Interference on A.
    FalseEdges(Interference),
    /// Interference on A and B at once.
    IllegalTransitions(Interference),
    /// One of so many edges is missed.
    LostEdges {
        /// Edges from one to the next.
        every: u32,
    },
    /// One of so many edges is counted twice.
    DoubledEdges {
        /// Edges from one to the next.
        every: u32,
    },
    /// A channel stays at its level.
    DeadChannel(Channel),
    /// A falls late.
    DutyDrift {
        /// By how much, µs.
        delay_us: f64,
    },
    /// All lines stay at their levels.
    LineLoss,
    /// The buffer of edge times is too small.
    Overrun {
        /// Times that it holds.
        kept: u32,
    },
}

/// Bursts of pulses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interference {
    /// Bursts a second, Hz.
    pub burst_hz: f64,
    /// Pulses of a burst.
    pub pulses: u32,
    /// Width of a pulse and of the pause after it, µs.
    pub width_us: f64,
}
