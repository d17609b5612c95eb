//! Why a request was refused: numbers, which are only ever appended to, with what happened and what to do.

mod from;

macro_rules! refusals {
    ($($(#[doc = $what:literal])+ $name:ident = $number:literal, $remedy:literal;)*) => {
        /// Why a request was refused; the axis goes on as it was. The numbers are part of the link: a number is never used
        /// anew.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[repr(u16)]
        pub enum Refusal {
            $($(#[doc = $what])+ $name = $number,)*
        }

        impl Refusal {
            /// All refusals, by number.
            pub const ALL: &'static [Self] = &[$(Self::$name,)*];

            /// Its name, as in the code.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self { $(Self::$name => stringify!($name),)* }
            }

            /// The refusal of that number.
            #[must_use]
            pub const fn from_number(number: u16) -> Option<Self> {
                match number { $($number => Some(Self::$name),)* _ => None }
            }

            /// What is in the way.
            #[must_use]
            pub const fn what(self) -> &'static str {
                match self { $(Self::$name => concat!($($what),+).trim_ascii(),)* }
            }

            /// What to do.
            #[must_use]
            pub const fn remedy(self) -> &'static str {
                match self { $(Self::$name => $remedy,)* }
            }
        }
    };
}

refusals! {
    /// No session is open: the axis was switched on since.
    NoSession = 1, "Say hello, then repeat the request in the new session.";
    /// Another session was opened after this one.
    OtherSession = 2, "Close the other tool, then say hello anew.";
    /// A later request was taken before this one.
    Late = 3, "Ask for the status, and repeat the request with a new sequence if it is still wanted.";
    /// The message is not known, or not whole.
    NotUnderstood = 4, "Compare the versions in the hello: use a tool of the firmware's version.";
    /// The session does not hold the control lease, or does not any more.
    LeaseRequired = 5, "Take the lease and renew it well within its time.";
    /// Another session holds the control lease.
    LeaseHeld = 6, "Wait until it is given back, or lapses: 100 ms after the last renewal.";
    /// The tick that the renewal tells of is as old as a lease, or still to come.
    StaleRenewal = 7, "Renew with the tick of the latest reply; a line with delays of 100 ms cannot hold a lease.";
    /// The axis is not under control.
    NotEnabled = 8, "Enable the axis and wait until it is ready.";
    /// A fault is latched.
    FaultLatched = 9, "Read the fault, remove its cause, disable, clear it, then enable.";
    /// The feed is zero or above the largest feed of the axis.
    FeedOutOfRange = 10, "Choose a feed up to motion.max_feed_mm_per_min.";
    /// The target is farther than any axis reaches.
    TargetOutOfRange = 11, "Choose a target within 1 km of the origin.";
    /// The target lies beyond the soft limits.
    BeyondTravel = 12, "Choose a target between motion.travel_low_mm and motion.travel_high_mm.";
    /// The override is above 200 %.
    OverrideOutOfRange = 13, "Choose an override of 0 to 200 %.";
    /// The move takes too many ticks.
    MoveTooLong = 14, "Raise the feed, or shorten the move.";
    /// The axis is homing, cuts a thread, or has not begun the order before.
    Busy = 15, "Wait for its end, or stop it; an order before this one begins within a few ticks.";
    /// Another source of setpoints is selected.
    OtherSource = 16, "Select planned moves first.";
    /// The axis is being stopped.
    Stopping = 17, "Wait until it stands.";
    /// The axis is not ready to be homed.
    NotReady = 18, "Enable it, clear faults and let it come to rest, then home it.";
    /// There is no index to home to.
    NoIndex = 19, "Set motion.counts_per_revolution to the counts from index to index.";
    /// Enable is still asked for.
    EnableRequested = 20, "Disable the axis first.";
    /// The axis still moves.
    StillMoving = 21, "Stop it and wait until it stands.";
    /// What brought the fault about is still there.
    CausePersists = 22, "Do what the fault's own remedy says, then clear it.";
    /// There is no such parameter.
    UnknownParameter = 23, "List the parameters; a name is section and name, with a point between them.";
    /// The value is not within the parameter's range.
    ParameterOutOfRange = 24, "Read the parameter: its reply says the range.";
    /// The axis is on: parameters are set while it is off.
    AxisOn = 25, "Disable the axis and wait until its drive is off.";
    /// The value does not go with the other parameters; it was not taken.
    Inconsistent = 26, "Look at the parameters it depends on in docs/parameters.md, and change them first.";
    /// The axis has no room for another request.
    QueueFull = 27, "Repeat the request a few ticks later.";
    /// This board, or this axis, cannot do that.
    NotSupported = 28, "See the capabilities in the hello.";
    /// The start of the move has passed before the axis saw it.
    TooLate = 29, "Repeat the request; tell of it if it happens often: the axis's planner is too slow.";
    /// The control rate, the edge timer or what the inputs' filter has to pass was set to another value.
    RestartNeeded = 30, "Save the parameters and restart the axis.";
    /// The parameter is not one of the words.
    UnknownWord = 31, "See docs/parameters.md for its words.";
    /// The parameter is a number, or it is a word.
    WrongType = 32, "Set a number as a number and a word as a word.";
    /// There is no edit under way.
    NoEdit = 33, "Open an edit first; enabling the axis drops one.";
    /// The work memory is lent to something else.
    WorkMemoryLent = 34, "End the scope, the experiment or the learning that has it.";
    /// The program has as many segments as it may have, or none.
    WrongProgram = 35, "State the bounds, then 1 to 8 segments, then start.";
    /// The axis moves at zero command.
    NotAtRest = 36, "Set the offset of the drive so that it stands, or wait until it does.";
    /// An experiment runs, or was not ended.
    ExperimentRuns = 37, "Wait for its end, then end it.";
    /// There is no such signal, or there are too many.
    UnknownSignal = 38, "Choose up to 8 signals of the table in docs/scope.md.";
    /// The scope cannot be set up so.
    WrongScope = 39, "Ask for a sample every tick or more rarely, for fewer samples, and for fewer before the trigger than in all.";
    /// The scope is not complete.
    ScopeNotReady = 40, "Wait for its trigger, trigger it, or end it.";
    /// Nothing is being learned, or no map was made.
    NotLearning = 41, "Begin learning, run it, finish it, then ask.";
    /// The learner refused; its own reason tells more.
    LearningRefused = 42, "Ask how the learning stands: its reply has the reason.";
    /// There is no such kind of content in the store.
    UnknownKind = 43, "1 parameters, 2 encoder map, 3 screw table.";
    /// Nothing is saved of that kind, or not so much.
    NothingStored = 44, "Save it first.";
    /// The bytes to be saved are not those that were sent.
    WrongChecksum = 45, "Send them anew.";
    /// The bytes to be saved are no content of that kind.
    WrongContent = 46, "Send what a backup of that kind gave, of the same version.";
    /// The store is full.
    StoreFull = 47, "Erase what is not needed: an encoder map, a screw table.";
    /// The store cannot be used, or its flash failed.
    StoreFailed = 48, "Erase all of it; if that fails, the flash is worn out: change the board.";
    /// The memory for maps is taken until the next restart.
    MapMemoryTaken = 49, "Restart the axis: a saved map is in use then. On a board with room for one map, erase the saved one first.";
    /// A gear is engaged, or a thread is armed.
    Engaged = 50, "Disengage it first.";
    /// The encoder would be faster at full command than the board's inputs can follow; it was not taken.
    TooFastForInputs = 51, "Lower motion.full_command_feed_mm_per_min or motion.counts_per_mm, or raise tick_hz; docs/board.md has the limits.";
    /// The target is where the axis stands.
    NoWay = 52, "Choose a target at least a count away.";
    /// At that feed the axis would go on too far after a touch.
    TooMuchOvertravel = 53, "Probe slower, or raise probe.max_overtravel_mm as far as the probe allows.";
}

impl core::fmt::Display for Refusal {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "{} {}", self.what(), self.remedy())
    }
}

impl core::error::Error for Refusal {}
