//! Faults and states by the names that files and reports give them.

use leadscrew::supervisor::{Fault, State};

/// All faults, by number from 1, with their names.
pub const FAULTS: [(Fault, &str); 22] = [
    (Fault::FollowingError, "following-error"),
    (Fault::MotionAgainstCommand, "motion-against-command"),
    (Fault::MotionAtStandstill, "motion-at-standstill"),
    (Fault::MotionWhileDisabled, "motion-while-disabled"),
    (Fault::SignalLoss, "signal-loss"),
    (Fault::IllegalTransitions, "illegal-transitions"),
    (Fault::IndexInconsistent, "index-inconsistent"),
    (Fault::IndexNotFound, "index-not-found"),
    (Fault::EncoderLoss, "encoder-loss"),
    (Fault::DriveFault, "drive-fault"),
    (Fault::DriveNotReady, "drive-not-ready"),
    (Fault::OutputMismatch, "output-mismatch"),
    (Fault::HardLimit, "hard-limit"),
    (Fault::SoftLimit, "soft-limit"),
    (Fault::Overspeed, "overspeed"),
    (Fault::OutputSaturated, "output-saturated"),
    (Fault::LateTick, "late-tick"),
    (Fault::SetpointLost, "setpoint-lost"),
    (Fault::StoreCorrupt, "store-corrupt"),
    (Fault::EmergencyStop, "emergency-stop"),
    (Fault::HomingFailed, "homing-failed"),
    (Fault::SpindleLost, "spindle-lost"),
];

/// All states with their names.
pub const STATES: [(State, &str); 6] = [
    (State::Disabled, "disabled"),
    (State::Enabling, "enabling"),
    (State::Ready, "ready"),
    (State::Moving, "moving"),
    (State::Stopping, "stopping"),
    (State::Fault, "fault"),
];

/// The name of a fault.
#[must_use]
pub fn fault_name(fault: Fault) -> &'static str {
    let found = FAULTS.iter().find(|(known, _)| *known == fault);
    found.map_or("unknown", |(_, name)| name)
}

/// The name of a state.
#[must_use]
pub fn state_name(state: State) -> &'static str {
    let found = STATES.iter().find(|(known, _)| *known == state);
    found.map_or("unknown", |(_, name)| name)
}
