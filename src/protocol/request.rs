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
    }
}

impl Request<'_> {
    /// True for what changes the axis: it needs the control lease. What only stops needs none.
    #[must_use]
    pub const fn needs_lease(&self) -> bool {
        matches!(
            self,
            Self::ReleaseLease {}
                | Self::Enable {}
                | Self::ClearFault {}
                | Self::ClearWarnings {}
                | Self::Home {}
                | Self::Move { .. }
                | Self::Jog { .. }
                | Self::Resume {}
                | Self::Override { .. }
                | Self::SetParameter { .. }
        )
    }

    /// True for what only asks: twice is as good as once.
    #[must_use]
    pub const fn is_query(&self) -> bool {
        matches!(
            self,
            Self::Hello { .. }
                | Self::Status {}
                | Self::Link {}
                | Self::ParameterAt { .. }
                | Self::Parameter { .. }
        )
    }
}
