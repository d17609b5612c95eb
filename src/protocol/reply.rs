//! What an axis answers. Numbers are only ever appended, and a message never changes.

use super::describe::messages;

/// The axis is enabled.
pub const ENABLED: u16 = 1;
/// A motion is commanded.
pub const MOVING: u16 = 1 << 1;
/// The origin is known.
pub const HOMED: u16 = 1 << 2;
/// A feed hold is on.
pub const HELD: u16 = 1 << 3;
/// Somebody holds the control lease.
pub const LEASED: u16 = 1 << 4;
/// It is this session that holds it.
pub const LEASED_HERE: u16 = 1 << 5;
/// Planned moves are what moves the axis, or may.
pub const PLANNED: u16 = 1 << 6;

/// The axis can be homed.
pub const CAN_HOME: u32 = 1;
/// Parameters can be read and set.
pub const CAN_SET: u32 = 1 << 1;
/// Records can be subscribed to.
pub const CAN_RECORD: u32 = 1 << 2;

messages! {
    /// A reply.
    pub enum Reply<'a> {
        /// It was done, or is under way.
        Ack = 0 {
            /// The last tick.
            tick: u32,
        }
        /// It was not done, and the axis goes on as it was.
        Refused = 1 {
            /// The last tick.
            tick: u32,
            /// Number of the [`Refusal`](super::refusal::Refusal).
            reason: u16,
        }
        /// What the axis is.
        Hello = 2 {
            /// Version of the protocol that the axis speaks.
            protocol: u16,
            /// The nonce of the request.
            nonce: u32,
            /// The session that is open now.
            session: u32,
            /// Control rate, ticks a second, rounded.
            tick_hz: u32,
            /// How long the control lease lasts, ticks.
            lease_ticks: u32,
            /// The last tick.
            tick: u32,
            /// What it can do: bit 0 homing, 1 parameters, 2 telemetry records; other bits are of later versions.
            capabilities: u32,
            /// Room for what is recorded, bytes.
            work_memory: u32,
            /// Version of the firmware.
            firmware: &'a str,
            /// What it was built from.
            build: &'a str,
            /// What it runs on.
            board: &'a str,
        }
        /// How the axis stands.
        Status = 3 {
            /// The last tick.
            tick: u32,
            /// Number of the [`State`](crate::supervisor::State).
            state: u8,
            /// Number of the [`Fault`](crate::supervisor::Fault), 0 for none.
            fault: u8,
            /// Bit n: the warning of number n.
            warnings: u32,
            /// Bit 0 enabled, 1 moving, 2 homed, 3 feed hold, 4 leased, 5 leased by this session, 6 moved by plans.
            flags: u16,
            /// Feed override, %.
            percent: u16,
            /// Where the axis is, nm from the origin.
            position_nm: i64,
            /// Where it should be, nm from the origin.
            setpoint_nm: i64,
            /// How fast it is, µm/min.
            velocity_um_per_min: i32,
            /// Setpoint less position, nm.
            following_error_nm: i32,
        }
        /// What the axis dropped of this link since it was switched on.
        Link = 4 {
            /// Frames whose stuffing was wrong.
            torn: u32,
            /// Frames too long.
            too_long: u32,
            /// Frames too short.
            too_short: u32,
            /// Frames with a wrong checksum.
            checksum: u32,
            /// Messages not known.
            unknown: u32,
            /// Requests that came twice or too late.
            late: u32,
            /// Records that found no room on their way out.
            records_lost: u32,
        }
        /// A parameter.
        Parameter = 5 {
            /// Its place in the list.
            index: u16,
            /// How many there are.
            count: u16,
            /// Its section.
            section: &'a str,
            /// Its name, unit included.
            name: &'a str,
            /// Its unit, for people.
            unit: &'a str,
            /// Its value.
            value: f64,
            /// Smallest value allowed.
            min: f64,
            /// Largest value allowed.
            max: f64,
            /// What it is if nobody sets it.
            default: f64,
        }
    }
}
