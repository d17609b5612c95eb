//! Faults: numbers, which are only ever appended to, and what the axis does about each.

/// What brought the axis to a stop. The numbers are part of telemetry and of the link: a number is never used anew.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Fault {
    /// The axis does not follow its setpoint.
    FollowingError = 1,
    /// The axis moves against its command: wrong polarity of drive or encoder.
    MotionAgainstCommand = 2,
    /// The axis moves while it should stand.
    MotionAtStandstill = 3,
    /// The axis moves while its drive is off.
    MotionWhileDisabled = 4,
    /// A line receiver of the encoder sees no signal.
    SignalLoss = 5,
    /// A and B changed at once too often.
    IllegalTransitions = 6,
    /// Counts between two indexes are not those of a revolution.
    IndexInconsistent = 7,
    /// No index where one must be.
    IndexNotFound = 8,
    /// The drive is commanded and the encoder stands.
    EncoderLoss = 9,
    /// The drive reports a fault.
    DriveFault = 10,
    /// The drive did not become ready in time, or ceased to be.
    DriveNotReady = 11,
    /// The converter does not put out what it was told.
    OutputMismatch = 12,
    /// A limit switch was reached.
    HardLimit = 13,
    /// A soft limit would be passed.
    SoftLimit = 14,
    /// The axis is faster than it may be.
    Overspeed = 15,
    /// The output is at its limit for too long.
    OutputSaturated = 16,
    /// Ticks were late or missed.
    LateTick = 17,
    /// The source of the setpoint is gone, or not to be followed.
    SetpointLost = 18,
    /// The parameter store is corrupt.
    StoreCorrupt = 19,
    /// The emergency-stop chain is open.
    EmergencyStop = 20,
    /// The home switch was not found within its distance or time, or the index lies too near to it.
    HomingFailed = 21,
    /// The spindle's signal was lost, or it turned back, while a thread was cut.
    SpindleLost = 22,
}

/// What the axis does about a fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reaction {
    /// Tells of it and goes on.
    Warning,
    /// Controlled stop in the loop, then enable off.
    ControlledStop,
    /// 0 V with enable kept for a set time, then enable off (stop category 1).
    ZeroVolts,
    /// Enable off at once.
    Off,
}
