//! Faults: numbers, which are only ever appended to, and all that is to be said about each: one table, from which
//! the axis takes its reactions and `docs/faults.md` its text.

/// What the axis does about a fault, from the weakest to the strongest.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Reaction {
    /// Tells of it and goes on.
    Warning,
    /// Controlled stop in the loop, then brake, then enable off.
    ControlledStop,
    /// 0 V with enable kept for a set time, then brake, then enable off (stop category 1).
    ZeroVolts,
    /// Enable off at once.
    Off,
}

impl Reaction {
    /// What it is, for people.
    #[must_use]
    pub const fn text(self) -> &'static str {
        match self {
            Self::Warning => "warning",
            Self::ControlledStop => "controlled stop, then enable off",
            Self::ZeroVolts => "0 V with enable kept, then enable off",
            Self::Off => "enable off at once",
        }
    }
}

/// What is to be said about a fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Description {
    /// What happened, in a sentence.
    pub what: &'static str,
    /// What the axis does.
    pub reaction: Reaction,
    /// When it is detected.
    pub condition: &'static str,
    /// Time and distance until then, with the default parameters.
    pub bound: &'static str,
    /// What the recorded value and limit are.
    pub figure: &'static str,
    /// What brings it about.
    pub cause: &'static str,
    /// What to do.
    pub remedy: &'static str,
}

macro_rules! faults {
    ($($(#[doc = $what:literal])+ $name:ident = $number:literal, $reaction:ident {
        condition: $condition:literal, bound: $bound:literal, figure: $figure:literal,
        cause: $cause:literal, remedy: $remedy:literal $(,)?
    })*) => {
        /// What brought the axis to a stop. The numbers are part of telemetry and of the link: a number is never used anew.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[repr(u8)]
        pub enum Fault {
            $($(#[doc = $what])+ $name = $number,)*
        }

        impl Fault {
            /// All faults, by number.
            pub const ALL: &'static [Self] = &[$(Self::$name,)*];

            /// Its name, as in the code.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self { $(Self::$name => stringify!($name),)* }
            }

            /// The fault of that number.
            #[must_use]
            pub const fn from_number(number: u8) -> Option<Self> {
                match number { $($number => Some(Self::$name),)* _ => None }
            }

            /// What the axis does about it.
            #[must_use]
            pub const fn reaction(self) -> Reaction {
                match self { $(Self::$name => Reaction::$reaction,)* }
            }

            /// All that is to be said about it.
            #[must_use]
            pub const fn description(self) -> Description {
                match self { $(Self::$name => Description {
                    what: concat!($($what),+).trim_ascii(),
                    reaction: Reaction::$reaction,
                    condition: $condition, bound: $bound, figure: $figure, cause: $cause, remedy: $remedy,
                },)* }
            }
        }
    };
}

faults! {
    /// The axis does not follow its setpoint.
    FollowingError = 1, ZeroVolts {
        condition: "|following error| above `following_error_mm` + `following_error_per_feed_s` × |setpoint velocity|. A warning from `following_warning_share` of it on.",
        bound: "the tick in which the error passes the limit; 1 mm at rest, 2.5 mm at 9 000 mm/min",
        figure: "following error, d",
        cause: "A jammed or overloaded axis, a slow or weak drive, a loop that is not tuned, an encoder that no longer turns.",
        remedy: "Look for a mechanical cause; read the peak and compare it with the limit; run autotune; lower feed or acceleration.",
    }
    /// The axis moves against its command: wrong polarity of drive or encoder.
    MotionAgainstCommand = 2, Off {
        condition: "With |command| above `against_level`: motion against its sign over more than `against_mm` and for `against_time_s`, faster than when it began.",
        bound: "30 ms and 0.3 mm, whichever is later; 30 ms at the drive's acceleration of 2.1 m/s² are 1 mm",
        figure: "way against the command, d",
        cause: "Wires of the command or of an encoder pair exchanged; a load that turns the drive over.",
        remedy: "Exchange the command's wires or one pair of the encoder; prove the sign with `identify` before the loop is closed.",
    }
    /// The axis moves while it should stand.
    MotionAtStandstill = 3, ZeroVolts {
        condition: "Setpoint at rest for longer than `standstill_after_s` and |following error| above `standstill_mm`.",
        bound: "the tick in which the error passes the limit; 0.2 mm",
        figure: "following error, d",
        cause: "An outer force, a loop that swings or has too little gain, an offset of the drive that the loop does not take up.",
        remedy: "Null the offset, check gains and brake; look for what pushes the axis.",
    }
    /// The axis moves while its drive is off.
    MotionWhileDisabled = 4, Warning {
        condition: "Drive off for longer than `disabled_after_s` and more than `disabled_mm` of way. A fault instead of a warning where `disabled_is_fault` is 1.",
        bound: "the tick in which the way passes the limit; 0.1 mm",
        figure: "way, d",
        cause: "Turned by hand; a load sinks through a brake that does not hold.",
        remedy: "Check the brake of a vertical axis; otherwise none is needed, the axis takes control where it stands.",
    }
    /// A line receiver of the encoder sees no signal.
    SignalLoss = 5, ZeroVolts {
        condition: "The receiver's line is active while the axis is under control, or is to be.",
        bound: "one tick; 0.15 mm at 9 000 mm/min",
        figure: "1, limit 0",
        cause: "Cable or plug of the encoder, its supply, the encoder itself.",
        remedy: "Check cable, plug and supply; then home again, since the position is not to be trusted.",
    }
    /// A and B changed at once too often.
    IllegalTransitions = 6, ControlledStop {
        condition: "More than `illegal_limit` illegal transitions, of which `illegal_forgiven_per_s` a second are forgiven.",
        bound: "the tick of the transition that is too many",
        figure: "transitions not forgiven",
        cause: "Interference on the encoder's cable, edges faster than the input, a loose plug.",
        remedy: "Check screen, earthing and cable; lower the feed; then home again.",
    }
    /// Counts between two indexes are not those of a revolution.
    IndexInconsistent = 7, ControlledStop {
        condition: "Counts between two indexes passed in the same direction that are off from whole revolutions by more than `index_tolerance_d`. Not watched with `counts_per_revolution` 0 (section `motion`).",
        bound: "one revolution of the encoder in one direction",
        figure: "counts off whole revolutions, d",
        cause: "False or lost edges: interference, a channel near its limit of frequency; wrong counts per revolution; a slipping coupling.",
        remedy: "Check screen and cable, then the number of lines of the encoder; then home again.",
    }
    /// No index where one must be.
    IndexNotFound = 8, ControlledStop {
        condition: "`index_within_revolutions` from the last index, or from where control began, without an index. Not watched with `counts_per_revolution` 0.",
        bound: "1.25 revolutions of the encoder",
        figure: "way without an index, d",
        cause: "The index line is broken or not connected; a slipping coupling.",
        remedy: "Check the index pair of the encoder; set `counts_per_revolution` to 0 for an encoder without one.",
    }
    /// The drive is commanded and the encoder stands.
    EncoderLoss = 9, ZeroVolts {
        condition: "|command| above `encoder_loss_level` for `encoder_loss_time_s` and for a way of `encoder_loss_mm` at full-command speed × command, while the encoder moves less than `encoder_loss_counts`.",
        bound: "with the command above its level all the while: the 51st tick of it from 6.3 % of full command on, the 63rd at 5 %; the commanded way is then 0.5 mm, and 51 ticks of it above 600 mm/min: 8.2 mm at full command. In fast motion the following error is earlier",
        figure: "commanded way, d",
        cause: "The encoder's coupling is broken, the encoder dead, the axis jammed, the drive without power.",
        remedy: "Turn the screw by hand and watch the count; check coupling, cable and drive; then home again.",
    }
    /// The drive reports a fault.
    DriveFault = 10, Off {
        condition: "The drive's fault line is active while the axis is under control, or is to be.",
        bound: "the tick in which the line is active",
        figure: "1, limit 0",
        cause: "The drive has found one: see its display.",
        remedy: "Remove what the drive tells of, reset the drive, then clear.",
    }
    /// The drive did not become ready in time, or ceased to be.
    DriveNotReady = 11, Off {
        condition: "No ready within `ready_timeout_s` of enable, or ready lost while under control.",
        bound: "1 s after enable with the brake on; one tick when lost",
        figure: "ticks since enable, limit of them",
        cause: "The drive has no power or an interlock is open; the ready wire is broken.",
        remedy: "Check mains contactor, interlocks and the ready wire; a longer timeout for a slow drive.",
    }
    /// The converter does not put out what it was told.
    OutputMismatch = 12, Off {
        condition: "What the converter reads back differs from the last command by more than `readback_tolerance` in two ticks running. Not watched without a read-back.",
        bound: "the second tick of the difference",
        figure: "read-back less command, of full command; the whole range or half of it: the converter did not start, does not answer, or lost its settings",
        cause: "The converter, its supply or its reference is defective; the output is shorted.",
        remedy: "Check its supply and the wires to the drive. With the axis off it is set up anew, five times, a second apart; then clear the fault, or restart the axis. If it comes back, measure the output with the drive disconnected; replace the board.",
    }
    /// A limit switch was reached.
    HardLimit = 13, ZeroVolts {
        condition: "On a limit switch with motion toward it: a setpoint that moves, or more than `still_feed_mm_per_min` measured.",
        bound: "the first tick that sees the switch closed: 1 ms and 0.15 mm beyond it at 9 000 mm/min. The way to stop is the drive's: 5.4 mm from there at 2.1 m/s², and its lag",
        figure: "velocity toward the switch, d/tick",
        cause: "Soft limits wrong or off, a lost origin, a wire of the switch broken.",
        remedy: "Clear, enable and move out of the switch, which stays possible; home again; check the soft limits.",
    }
    /// A soft limit would be passed.
    SoftLimit = 14, ControlledStop {
        condition: "The source of setpoints can only just stop before a soft limit.",
        bound: "before the limit by the stopping distance",
        figure: "set by the source",
        cause: "A move, jog or outer control beyond the travel.",
        remedy: "Clear and move back into the travel.",
    }
    /// The axis is faster than it may be.
    Overspeed = 15, ZeroVolts {
        condition: "|estimated velocity| above `overspeed_share` of the largest feed plus 5 % of the full-command feed for 3 ticks running.",
        bound: "3 ticks and the lag of the estimate; 0.6 mm and that lag at 10 380 mm/min",
        figure: "velocity, d/tick",
        cause: "A loop out of control, a drive whose speed at full command is higher than was set, false edges.",
        remedy: "Check the full-command feed by `identify`; check the tachogenerator of the drive.",
    }
    /// The output is at its limit for too long.
    OutputSaturated = 16, ControlledStop {
        condition: "The output at its limit, not its slew, for longer than `saturated_time_s` without a pause.",
        bound: "one second at the limit",
        figure: "ticks at the limit, limit of them",
        cause: "An overloaded or jammed axis, a drive slower than was set, a loop that is unstable.",
        remedy: "Check the full-command feed by `identify`; lower feed or acceleration; look for a mechanical cause.",
    }
    /// Ticks were missed or ended too late.
    LateTick = 17, ControlledStop {
        condition: "More than `missed_limit` ticks that were missed or ended after their budget, of which `missed_forgiven_per_s` a second are forgiven.",
        bound: "the first tick after them",
        figure: "such ticks not forgiven",
        cause: "Another interrupt holds the processor; a tick rate that is too high for the board.",
        remedy: "Look at the worst start and end of the tick; lower the rate or choose a cheaper estimator.",
    }
    /// The source of the setpoint is gone, or not to be followed.
    SetpointLost = 18, ControlledStop {
        condition: "The source of setpoints says so: steps faster than the axis, no master signal, a command out of range.",
        bound: "one tick after the source finds it",
        figure: "set by the source",
        cause: "Cable of the outer control or of the second encoder; a ratio or scale that asks for more than the axis can do.",
        remedy: "Check the cable, then ratio and scale.",
    }
    /// The parameter store is corrupt.
    StoreCorrupt = 19, Off {
        condition: "The store's checksum was wrong at start-up, and the axis is to be enabled.",
        bound: "before enable",
        figure: "1, limit 0",
        cause: "Power failed during a write; the memory is worn out.",
        remedy: "Write the parameters anew, from a backup, and check them before enabling.",
    }
    /// The emergency-stop chain is open.
    EmergencyStop = 20, ZeroVolts {
        condition: "The chain's line is active while the axis is under control, or is to be.",
        bound: "one tick; 0.15 mm at 9 000 mm/min",
        figure: "1, limit 0",
        cause: "The emergency-stop button or an interlock in its chain.",
        remedy: "Make the machine safe, close the chain, clear.",
    }
    /// The home switch was not found within its distance or time, or the index lies too near to it.
    HomingFailed = 21, ControlledStop {
        condition: "Homing says so.",
        bound: "the search distance and time that homing is given",
        figure: "set by homing",
        cause: "Switch or index broken or not connected; the switch is next to the index.",
        remedy: "Check switch and index; shift the switch by a third of a revolution.",
    }
    /// The spindle's signal was lost, or it turned back, while a thread was cut.
    SpindleLost = 22, ControlledStop {
        condition: "While threading: the spindle's line receiver sees no signal, its index fails, or it turns back.",
        bound: "one tick after the source finds it",
        figure: "set by the source",
        cause: "Cable or coupling of the spindle's encoder; the spindle was stopped or reversed in the thread.",
        remedy: "Check the spindle's encoder; the pass is spoilt, the thread's phase is not.",
    }
}
