//! Low words made whole.

use super::signal::{Kind, Signal};

/// Makes whole values of the samples of a signal, one after the other.
#[derive(Clone, Copy, Debug)]
pub struct Unwrap {
    kind: Kind,
    value: i64,
}

impl Unwrap {
    /// From the value of the first sample, which [`Recording::bases`](super::Recording::bases) gives.
    #[must_use]
    pub const fn new(signal: Signal, base: i64) -> Self {
        Self {
            kind: signal.kind(),
            value: base,
        }
    }

    /// The whole value of the next sample; the first one may be taken again. A wide value is exact where it moved by less
    /// than 2³¹ since the sample before; see [`Interruption::Jump`](super::Interruption::Jump).
    pub const fn take(&mut self, word: i32) -> i64 {
        self.value = match self.kind {
            Kind::Narrow => word as i64,
            Kind::Word => word.cast_unsigned() as i64,
            Kind::Wide => nearest(self.value, word),
        };
        self.value
    }

    /// Goes on from another value: behind a jump, or from a record that has all bits.
    pub const fn set(&mut self, value: i64) {
        self.value = value;
    }
}

/// The value with that low word that is nearest to `value`.
#[inline]
pub(super) const fn nearest(value: i64, word: i32) -> i64 {
    let step = word.wrapping_sub(value as i32);
    value.wrapping_add(step as i64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn low_words_are_made_whole_across_their_wrap_both_ways() {
        let mut unwrap = Unwrap::new(Signal::Position, (5 << 32) - 10);
        let values = [
            (5_i64 << 32) - 10,
            (5 << 32) + 2_000_000_000,
            (5 << 32) - 100_000_000,
            3 << 32,
        ];
        let found = values.map(|value| unwrap.take(value as i32));
        assert_eq!(found[..3], values[..3]);
        assert_ne!(found[3], values[3], "too far for a low word");
        unwrap.set(values[3]);
        assert_eq!(unwrap.take(-1), (3 << 32) - 1);
    }

    #[test]
    fn what_is_whole_is_taken_as_it_is() {
        let mut signed = Unwrap::new(Signal::Velocity, 7);
        assert_eq!(signed.take(i32::MIN), i64::from(i32::MIN));
        let mut bits = Unwrap::new(Signal::Flags, 7);
        assert_eq!(bits.take(-1), i64::from(u32::MAX));
    }
}
