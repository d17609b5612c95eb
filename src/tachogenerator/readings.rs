//! The last readings, to be had for any instant between them.

use crate::units::Lag;

/// Readings kept; a power of two.
const KEPT: usize = 64;

/// A ring of readings, Q12.20 d/tick.
#[derive(Clone, Debug)]
pub(super) struct Readings {
    values: [i32; KEPT],
    newest: usize,
    /// Readings there are, up to [`KEPT`].
    count: usize,
}

impl Readings {
    pub(super) const fn new() -> Self {
        Self {
            values: [0; KEPT],
            newest: 0,
            count: 0,
        }
    }

    pub(super) fn push(&mut self, reading: i32) {
        self.newest = self.newest.wrapping_add(1) % KEPT;
        if let Some(place) = self.values.get_mut(self.newest) {
            *place = reading;
        }
        self.count = self.count.wrapping_add(1).min(KEPT);
    }

    /// The reading `age` ticks before the newest, between readings by a straight line.
    pub(super) fn before(&self, age: Lag) -> Option<i32> {
        let whole = usize::try_from(age.to_num::<i32>()).ok()?;
        let later = self.at(whole)?;
        let share = i64::from(age.frac().to_bits());
        if share == 0 {
            return Some(later);
        }
        let earlier = self.at(whole.wrapping_add(1))?;
        let step = i64::from(earlier).wrapping_sub(i64::from(later));
        let part = step.wrapping_mul(share).wrapping_shr(Lag::FRAC_NBITS);
        // Between two readings.
        Some(i64::from(later).wrapping_add(part) as i32)
    }

    fn at(&self, age: usize) -> Option<i32> {
        if age >= self.count {
            return None;
        }
        let place = self.newest.wrapping_add(KEPT).wrapping_sub(age) % KEPT;
        self.values.get(place).copied()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn readings_are_found_by_age_and_interpolated() {
        let mut readings = Readings::new();
        assert_eq!(readings.before(Lag::ZERO), None);
        for tick in 0..200 {
            readings.push(tick * 1000);
        }
        let before = |ticks: f64| readings.before(Lag::from_num(ticks));
        assert_eq!(before(0.0), Some(199_000));
        assert_eq!(before(2.25), Some(196_750));
        assert_eq!(before(63.0), Some(136_000));
        assert_eq!(before(63.5), None);
        assert_eq!(before(-0.5), None);
        let mut two = Readings::new();
        two.push(i32::MIN);
        two.push(i32::MAX);
        assert_eq!(two.before(Lag::from_num(0.5)), Some(-1));
        assert_eq!(two.before(Lag::from_num(1.5)), None);
    }
}
