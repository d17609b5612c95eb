//! What a tool asks of an axis. Numbers are only ever appended, and a message never changes.
//!
//! Positions are whole nanometres of the machine and feeds whole µm/min: a tool needs no scale to say them, and a scale
//! that was changed in between cannot make another way of them. A whole number has one representation, neither NaN
//! nor a rounding of its own; the axis turns it into its own 2⁻¹⁶ d once.

use super::describe::messages;

messages! {
    /// A request.
    pub enum Request<'a> {
        /// Opens a session: the axis answers [`Hello`](super::reply::Reply::Hello) with its number, which all further
        /// requests carry. A session before it ends.
        Hello = 0 {
            /// Version of the protocol that the tool speaks.
            protocol: u16,
            /// Any number that the tool did not use before: the same one again is the same session, not a new one.
            nonce: u32,
        }
        /// Asks for [`Status`](super::reply::Reply::Status).
        Status = 1 {}
        /// Asks for what the axis dropped of this link: [`Link`](super::reply::Reply::Link).
        Link = 2 {}
        /// Takes the control lease, if nobody else holds it.
        TakeLease = 3 {}
        /// Renews it.
        RenewLease = 4 {
            /// The latest tick that the axis told of: one that is as old as a lease renews nothing, so that requests which
            /// waited somewhere on their way keep no axis moving.
            seen: u32,
        }
        /// Gives it back while the axis stands; what is enabled stays so.
        ReleaseLease = 5 {}
        /// Puts the axis under control.
        Enable = 6 {}
        /// Takes it out: a controlled stop, brake, drive off. Needs no lease.
        Disable = 7 {}
        /// Clears the fault.
        ClearFault = 8 {}
        /// Forgets the warnings.
        ClearWarnings = 9 {}
        /// Finds the origin.
        Home = 10 {}
        /// Goes to a place.
        Move = 11 {
            /// The place, nm from the origin; from where the encoder counts while none is known.
            target_nm: i64,
            /// Feed, µm/min.
            feed_um_per_min: u32,
        }
        /// Moves until it is stopped, at most as long as the lease lasts, or to the soft limit on that side.
        Jog = 12 {
            /// Feed, µm/min; 0 stops.
            feed_um_per_min: i32,
        }
        /// Feed hold: stops and remembers the target. Needs no lease.
        Hold = 13 {}
        /// Ends a feed hold.
        Resume = 14 {}
        /// Feed override.
        Override = 15 {
            /// Of the feed, %: 0 to 200.
            percent: u16,
        }
        /// Stops whatever moves the axis and forgets the target; where something else than its plans moves the axis, it is
        /// disabled. Needs no lease.
        Stop = 16 {}
        /// Asks for a parameter by its place in the list: [`Parameter`](super::reply::Reply::Parameter).
        ParameterAt = 17 {
            /// From 0.
            index: u16,
        }
        /// Asks for a parameter by its name.
        Parameter = 18 {
            /// Section and name, with a point between them.
            name: &'a str,
        }
        /// Sets a parameter, while the axis is off; with all others it is validated and taken, or nothing is changed.
        SetParameter = 19 {
            /// Section and name, with a point between them.
            name: &'a str,
            /// The value, in the parameter's unit.
            value: f64,
        }
        /// Asks for records of ticks on the telemetry channel, until another session opens.
        Subscribe = 20 {
            /// A record in so many ticks; 0 ends them.
            every: u16,
        }
        /// Opens an edit of the parameters: what is set from now on changes a copy, until it is taken or dropped.
        EditParameters = 21 {}
        /// Validates the copy as a whole and takes it.
        TakeParameters = 22 {}
        /// Drops the copy.
        DropParameters = 23 {}
        /// Sets a parameter that is one of a few words.
        SetWord = 24 {
            /// Section and name, with a point between them; the name alone where there is no section.
            name: &'a str,
            /// The word.
            word: &'a str,
        }
        /// Asks for the fault that is latched, with its context: [`Fault`](super::reply::Reply::Fault).
        FaultPage = 25 {}
        /// Asks for what the tick counted: [`Counters`](super::reply::Reply::Counters).
        Counters = 26 {}
        /// Starts the firmware anew, while the axis is off: what was not saved is lost, the origin too.
        Restart = 27 {}
        /// Saves the parameters in force, while the axis is off.
        SaveParameters = 28 {}
        /// Asks for what is saved of a kind: [`Stored`](super::reply::Reply::Stored).
        Stored = 29 {
            /// 1 parameters, 2 encoder map, 3 screw table.
            kind: u8,
        }
        /// Asks for bytes of what is saved: [`Bytes`](super::reply::Reply::Bytes).
        ReadStored = 30 {
            /// As of Stored.
            kind: u8,
            /// From where on.
            offset: u32,
        }
        /// Puts bytes into the work memory, to be saved by [`SaveBytes`](Request::SaveBytes).
        WriteBytes = 31 {
            /// Where to, bytes; a multiple of 4.
            offset: u32,
            /// The bytes, a multiple of 4 of them but for the last ones.
            bytes: &'a [u8],
        }
        /// Saves what was put into the work memory, while the axis is off. It is in use after a restart.
        SaveBytes = 32 {
            /// 2 encoder map, 3 screw table.
            kind: u8,
            /// How many bytes.
            length: u32,
            /// Their CRC-32, that of frames.
            crc: u32,
        }
        /// Erases what is saved of a kind, while the axis is off; 0: all of it. It is out of use after a restart.
        Erase = 33 {
            /// As of Stored, or 0.
            kind: u8,
        }
        /// Begins the program of an experiment: its bounds.
        Program = 34 {
            /// Travel to either side of the centre, d.
            window_d: u32,
            /// Largest speed, d/tick.
            speed_d_per_tick: u32,
            /// Longest duration, ticks.
            ticks: u32,
            /// Largest command, 2⁻³⁰ of full command.
            command: i32,
            /// Its command is added to that of the loop, which stays closed.
            is_closed: bool,
            /// Count at the centre of the window; none: where it begins.
            centre: Option<i64>,
            /// Segments end after whole multiples of so many ticks.
            aligned_to: u32,
        }
        /// Adds a segment to the program.
        Segment = 35 {
            /// 0 rest, 1 level, 2 ramp, 3 chirp.
            shape: u8,
            /// Level, slope a tick, or centre of the chirp, 2⁻³⁰ of full command.
            level: i32,
            /// Amplitude of the chirp, 2⁻³⁰ of full command.
            amplitude: i32,
            /// Step of the chirp's phase in the first tick, 2⁻³² of a cycle.
            phase_step: u32,
            /// What the step grows by in a tick, 2⁻³² of a cycle.
            phase_gain: u32,
            /// It ends after so many ticks.
            ticks: u32,
            /// It ends earlier with so much travel in the direction of its command, d.
            travel_d: Option<u32>,
            /// Travel against the command counts as well.
            either_way: bool,
        }
        /// Begins the experiment of the program, recorded into the work memory.
        StartExperiment = 36 {
            /// Ticks of a record; 0: records go on behind those before, as these were.
            record_ticks: u32,
        }
        /// Gives the axis back to its loop, and ends an experiment under way.
        EndExperiment = 37 {}
        /// Asks how the experiment stands: [`Experiment`](super::reply::Reply::Experiment).
        Experiment = 38 {}
        /// Asks for words of the work memory: [`Words`](super::reply::Reply::Words).
        ReadWork = 39 {
            /// From which word on.
            offset: u32,
        }
        /// Arms the scope, on the work memory.
        ArmScope = 40 {
            /// Numbers of the signals, 8 at most.
            signals: &'a [u8],
            /// A sample in so many ticks.
            every: u16,
            /// Samples in all.
            samples: u32,
            /// Samples of these before the trigger.
            before: u32,
            /// 0 at once, 1 only when told, 2 above the level, 3 below it, 4 rising through it, 5 falling through it, 6 either way,
            /// 7 a fault, 8 a warning, 9 a motion begins.
            trigger: u8,
            /// Number of the signal that is compared with the level; number of the fault, 0 for any.
            source: u8,
            /// The level, in the bits of the signal, all of a wide one.
            level: i64,
        }
        /// Triggers the scope now.
        TriggerScope = 41 {}
        /// Ends the scope: what it has is there to be read.
        EndScope = 42 {}
        /// Asks how the scope stands: [`Scope`](super::reply::Reply::Scope).
        Scope = 43 {}
        /// Asks for samples of the scope, once it is complete: [`Samples`](super::reply::Reply::Samples).
        ReadScope = 44 {
            /// From which sample on.
            index: u32,
        }
        /// Asks for samples of signals on the telemetry channel, until another session opens.
        Stream = 45 {
            /// A sample in so many ticks; 0 ends them.
            every: u16,
            /// Numbers of the signals, 8 at most.
            signals: &'a [u8],
        }
        /// Begins to learn the encoder, on the work memory.
        Learn = 46 {
            /// Edges of a revolution.
            edges: u32,
        }
        /// Begins a run of the learning: the axis is to feed steadily from now on until it is complete.
        /// Then it is to stand, and the run to be ended.
        LearnRun = 47 {
            /// Revolutions to average over.
            revolutions: u32,
        }
        /// Asks how the learning stands: [`Learning`](super::reply::Reply::Learning).
        Learning = 48 {}
        /// Makes the map of the runs; whether it serves, [`Learned`](super::reply::Reply::Learned) tells.
        FinishLearning = 49 {}
        /// Asks what was learned: [`Learned`](super::reply::Reply::Learned).
        Learned = 50 {}
        /// Takes the learned map into use, while the axis is off. It is not saved yet.
        TakeMap = 51 {}
        /// Ends learning; what was learned and not taken is lost.
        EndLearning = 52 {}
        /// Selects what gives the setpoint, while the axis stands.
        Select = 53 {
            /// Number of the [`Source`](crate::setpoint::sources::Source): 0 planned moves.
            source: u8,
        }
        /// Saves the map that was taken into use, while the axis is off.
        SaveMap = 54 {}
        /// Ends a run of the learning that is complete and adds it to those before, while the axis stands: it may take a second.
        EndRun = 55 {}
        /// Asks why the firmware was last started anew without being asked to: [`Reset`](super::reply::Reply::Reset).
        LastReset = 56 {}
        /// Engages the gear, or disengages it, while [`Source::Gearing`](crate::setpoint::sources::Source) is selected.
        Engage = 57 {
            /// 0: disengages; 1: engages.
            engaged: u8,
        }
        /// Goes towards a place until the probe touches, then back: what came of it is asked for by
        /// [`Touch`](Request::Touch).
        Probe = 58 {
            /// How far to go for a touch, as of a move.
            target_nm: i64,
            /// Feed, µm/min.
            feed_um_per_min: u32,
            /// How far back after the touch, nm.
            retract_nm: u32,
        }
        /// Asks what probing came to: [`Touch`](super::reply::Reply::Touch).
        Touch = 59 {}
    }
}

impl Request<'_> {
    /// True for what changes the axis: it needs the control lease. What only stops, or only looks, needs none.
    #[must_use]
    pub const fn needs_lease(&self) -> bool {
        !self.is_query()
            && !matches!(
                self,
                Self::TakeLease { .. }
                    | Self::RenewLease { .. }
                    | Self::Disable { .. }
                    | Self::Hold { .. }
                    | Self::Stop { .. }
                    | Self::Subscribe { .. }
                    | Self::Stream { .. }
                    | Self::ArmScope { .. }
                    | Self::TriggerScope { .. }
                    | Self::EndScope { .. }
            )
    }

    /// True for what the axis may compute or write for longer than a lease lasts.
    #[must_use]
    pub const fn takes_long(&self) -> bool {
        matches!(
            self,
            Self::SetParameter { .. }
                | Self::SetWord { .. }
                | Self::TakeParameters { .. }
                | Self::SaveParameters { .. }
                | Self::SaveBytes { .. }
                | Self::Erase { .. }
                | Self::FinishLearning { .. }
                | Self::EndRun { .. }
                | Self::TakeMap { .. }
                | Self::SaveMap { .. }
        )
    }

    /// True for what only asks: twice is as good as once.
    #[must_use]
    pub const fn is_query(&self) -> bool {
        matches!(
            self,
            Self::Hello { .. }
                | Self::Status { .. }
                | Self::Link { .. }
                | Self::ParameterAt { .. }
                | Self::Parameter { .. }
                | Self::FaultPage { .. }
                | Self::Counters { .. }
                | Self::LastReset { .. }
                | Self::Stored { .. }
                | Self::ReadStored { .. }
                | Self::Experiment { .. }
                | Self::ReadWork { .. }
                | Self::Scope { .. }
                | Self::ReadScope { .. }
                | Self::Learning { .. }
                | Self::Learned { .. }
                | Self::Touch { .. }
        )
    }
}
