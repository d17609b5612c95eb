//! What leaves the tick: one fixed-width record of every stage, raw.

use crate::axis::Outputs;
use crate::units::Command;

/// Bit of [`Record::flags`]: the axis is enabled.
const ENABLED: u32 = 1;
/// Bit of [`Record::flags`]: the brake is to be released.
const BRAKE_RELEASED: u32 = 1 << 5;

/// One tick, in the bits of the formats in [`crate::units`]; 52 bytes on the wire.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Record {
    /// Tick number; wraps.
    pub tick: u32,
    /// Low word of the unwrapped count.
    pub count: u32,
    /// Estimated position, Q48.16 d.
    pub position: i64,
    /// Estimated velocity, Q12.20 d/tick.
    pub velocity: i32,
    /// Estimated acceleration, Q8.24 d/tick².
    pub acceleration: i32,
    /// Setpoint position, Q48.16 d.
    pub setpoint_position: i64,
    /// Setpoint velocity, Q12.20 d/tick.
    pub setpoint_velocity: i32,
    /// Setpoint acceleration, Q8.24 d/tick².
    pub setpoint_acceleration: i32,
    /// Following error, Q16.16 d.
    pub following_error: i32,
    /// Command, Q2.30 of full command.
    pub command: i32,
    /// Bit 0 enabled, 1 limited high, 2 limited low, 3 limited by slew, 4 moving, 5 brake released; bits 8 to 15 the
    /// [`State`](crate::supervisor::State), bits 16 to 23 the number of the [`Fault`](crate::supervisor::Fault), 0
    /// for none.
    pub flags: u32,
}

impl Record {
    /// Bytes of a record on the wire.
    pub const SIZE: usize = 52;

    /// The record of a tick.
    #[must_use]
    pub fn new(outputs: &Outputs) -> Self {
        Self {
            tick: outputs.tick,
            count: outputs.count as u32,
            position: outputs.estimate.position.to_bits(),
            velocity: outputs.estimate.velocity.to_bits(),
            acceleration: outputs.estimate.acceleration.to_bits(),
            setpoint_position: outputs.setpoint.position.to_bits(),
            setpoint_velocity: outputs.setpoint.velocity.to_bits(),
            setpoint_acceleration: outputs.setpoint.acceleration.to_bits(),
            following_error: outputs.following_error.to_bits(),
            command: outputs.command.to_bits(),
            flags: flags(outputs),
        }
    }

    /// What the drive was to do in this tick: the command, and whether it was enabled.
    #[must_use]
    pub const fn drive(&self) -> (Command, bool) {
        (Command::from_bits(self.command), self.flags & ENABLED != 0)
    }

    /// The number of the [`State`](crate::supervisor::State).
    #[must_use]
    pub const fn state(&self) -> u8 {
        self.flags.to_le_bytes()[1]
    }

    /// What was put out in this tick, for whoever moves a machine by it: command, enable and brake.
    #[must_use]
    pub fn put_out(&self) -> Outputs {
        let (command, enabled) = self.drive();
        Outputs {
            command,
            enabled,
            brake_released: self.flags & BRAKE_RELEASED != 0,
            ..Outputs::default()
        }
    }

    /// The record as little-endian bytes, fields in order.
    #[must_use]
    pub fn to_bytes(&self) -> [u8; Self::SIZE] {
        let mut bytes = [0; Self::SIZE];
        let mut rest = bytes.as_mut_slice();
        put(&mut rest, &self.tick.to_le_bytes());
        put(&mut rest, &self.count.to_le_bytes());
        put(&mut rest, &self.position.to_le_bytes());
        put(&mut rest, &self.velocity.to_le_bytes());
        put(&mut rest, &self.acceleration.to_le_bytes());
        put(&mut rest, &self.setpoint_position.to_le_bytes());
        put(&mut rest, &self.setpoint_velocity.to_le_bytes());
        put(&mut rest, &self.setpoint_acceleration.to_le_bytes());
        put(&mut rest, &self.following_error.to_le_bytes());
        put(&mut rest, &self.command.to_le_bytes());
        put(&mut rest, &self.flags.to_le_bytes());
        bytes
    }
}

/// [`Record::flags`] of a tick.
#[must_use]
#[inline]
pub fn flags(outputs: &Outputs) -> u32 {
    let limits = outputs.limits;
    u32::from(outputs.enabled)
        | u32::from(limits.high) << 1
        | u32::from(limits.low) << 2
        | u32::from(limits.slew) << 3
        | u32::from(outputs.moving) << 4
        | u32::from(outputs.brake_released) << 5
        | u32::from(outputs.state as u8) << 8
        | u32::from(outputs.fault.map_or(0, |fault| fault as u8)) << 16
}

/// Writes `field` at the front of `rest` and moves on.
fn put(rest: &mut &mut [u8], field: &[u8]) {
    if let Some((place, after)) = core::mem::take(rest).split_at_mut_checked(field.len()) {
        place.copy_from_slice(field);
        *rest = after;
    }
}

#[cfg(test)]
mod tests {
    use super::Record;

    #[test]
    fn every_byte_of_a_record_is_used() {
        let record = Record {
            tick: u32::MAX,
            count: u32::MAX,
            position: -1,
            velocity: -1,
            acceleration: -1,
            setpoint_position: -1,
            setpoint_velocity: -1,
            setpoint_acceleration: -1,
            following_error: -1,
            command: -1,
            flags: u32::MAX,
        };
        assert_eq!(record.to_bytes(), [0xff; Record::SIZE]);
    }
}
