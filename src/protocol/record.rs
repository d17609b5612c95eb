//! Records of ticks on the telemetry channel.

use crate::telemetry::Record;

/// Takes `N` bytes from the front of `rest`.
fn take<const N: usize>(rest: &mut &[u8]) -> Option<[u8; N]> {
    let (field, behind) = rest.split_first_chunk::<N>()?;
    *rest = behind;
    Some(*field)
}

/// The record that [`Record::to_bytes`] made these bytes of; `None` unless they are [`Record::SIZE`].
#[must_use]
pub fn record_from_bytes(bytes: &[u8]) -> Option<Record> {
    let rest = &mut &*bytes;
    let record = Record {
        tick: u32::from_le_bytes(take(rest)?),
        count: u32::from_le_bytes(take(rest)?),
        position: i64::from_le_bytes(take(rest)?),
        velocity: i32::from_le_bytes(take(rest)?),
        acceleration: i32::from_le_bytes(take(rest)?),
        setpoint_position: i64::from_le_bytes(take(rest)?),
        setpoint_velocity: i32::from_le_bytes(take(rest)?),
        setpoint_acceleration: i32::from_le_bytes(take(rest)?),
        following_error: i32::from_le_bytes(take(rest)?),
        command: i32::from_le_bytes(take(rest)?),
        flags: u32::from_le_bytes(take(rest)?),
    };
    rest.is_empty().then_some(record)
}

/// Counts the records that did not arrive, by the gaps in their sequence.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Gaps {
    next: Option<u16>,
    lost: u32,
}

impl Gaps {
    /// Takes the sequence of a record; false for one that came twice or after a later one.
    pub const fn take(&mut self, sequence: u16) -> bool {
        if let Some(next) = self.next {
            let missing = sequence.wrapping_sub(next);
            if missing > i16::MAX as u16 {
                return false;
            }
            self.lost = self.lost.saturating_add(missing as u32);
        } else {
            // A session counts from 0.
            self.lost = sequence as u32;
        }
        self.next = Some(sequence.wrapping_add(1));
        true
    }

    /// Records lost so far.
    #[must_use]
    pub const fn lost(&self) -> u32 {
        self.lost
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_record_is_read_back_from_its_bytes_and_from_no_others() {
        let bytes: [u8; Record::SIZE] = core::array::from_fn(|index| index as u8 ^ 0x5a);
        assert_eq!(record_from_bytes(&bytes).unwrap().to_bytes(), bytes);
        assert_eq!(record_from_bytes(&bytes[1..]), None);
        assert_eq!(record_from_bytes(&[0; Record::SIZE + 1]), None);
    }

    #[test]
    fn gaps_are_counted_and_what_comes_late_is_not_taken() {
        let mut gaps = Gaps::default();
        assert!(gaps.take(0) && gaps.take(1) && gaps.take(4));
        assert_eq!(gaps.lost(), 2);
        assert!(!gaps.take(4) && !gaps.take(2));
        assert!(gaps.take(5));
        assert_eq!(gaps.lost(), 2);
        let mut wrapped = Gaps {
            next: Some(u16::MAX),
            lost: 0,
        };
        assert!(wrapped.take(1));
        assert_eq!(wrapped.lost(), 2);
        let mut first = Gaps::default();
        assert!(first.take(3));
        assert_eq!(first.lost(), 3, "from the beginning of the session");
    }
}
