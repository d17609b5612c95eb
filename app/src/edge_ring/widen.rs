//! Words of 16-bit timers made 32 bits wide.

/// A 16-bit timer that runs on the clock of a 32-bit one, apart from it by a constant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Clock16 {
    offset: u16,
}

impl Clock16 {
    /// From readings of both timers at one instant.
    #[must_use]
    pub const fn new(narrow: u16, wide: u32) -> Self {
        Self {
            offset: narrow.wrapping_sub(wide as u16),
        }
    }

    /// The wide timer's time at a stamp of the narrow one, which is less than 2¹⁶ clocks before `now` of the wide timer: 780 µs
    /// at 84 MHz. An older one comes out later than it was by a multiple of that.
    #[inline]
    #[must_use]
    pub const fn extend16(self, stamp: u16, now: u32) -> u32 {
        let narrow_now = (now as u16).wrapping_add(self.offset);
        now.wrapping_sub(narrow_now.wrapping_sub(stamp) as u32)
    }
}

/// A wrapping 32-bit count made of a 16-bit one that is read often.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Counter16 {
    count: u32,
}

impl Counter16 {
    /// A counter that starts at `reading`.
    #[must_use]
    pub const fn new(reading: u16) -> Self {
        Self {
            count: reading as u32,
        }
    }

    /// The count now. Readings lie at most 32 767 counts apart: 13 M counts/s read at 400 Hz.
    #[inline]
    pub const fn update(&mut self, reading: u16) -> u32 {
        self.count = self.at(reading);
        self.count
    }

    /// The count that a latch of the 16-bit counter stands for, at most 32 767 counts from the last reading.
    #[inline]
    #[must_use]
    pub const fn at(&self, latched: u16) -> u32 {
        let moved = latched.wrapping_sub(self.count as u16).cast_signed();
        self.count.wrapping_add(moved as u32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stamp_of_any_age_below_a_lap_is_found_at_any_phase() {
        for wide in [0, 1, 0x7fff, 0xffff, 0x1_0000, u32::MAX - 5] {
            for narrow in [0, 3, 0x8000, 0xfffe] {
                let clock = Clock16::new(narrow, wide);
                for passed in [0_u32, 1, 70_000, 0xdead_beef] {
                    let now = wide.wrapping_add(passed);
                    let narrow_now = narrow.wrapping_add(passed as u16);
                    for age in [0_u16, 1, 0x7fff, 0x8000, 0xffff] {
                        let stamp = narrow_now.wrapping_sub(age);
                        let time = now.wrapping_sub(u32::from(age));
                        assert_eq!(clock.extend16(stamp, now), time);
                    }
                }
            }
        }
    }

    #[test]
    fn a_16_bit_count_goes_on_over_its_ends_both_ways() {
        let mut counter = Counter16::new(0xfff0);
        assert_eq!(counter.update(0x0010), 0x1_0010);
        assert_eq!(counter.at(0xfffe), 0xfffe);
        assert_eq!(counter.update(0xfff0), 0xfff0);
        assert_eq!(counter.update(0x8000), 0x8000);
        assert_eq!(counter.update(0x0001), 1);
        assert_eq!(counter.update(0xffff), u32::MAX);
        assert_eq!(counter.at(0x7ffe), 0x7ffe);
        assert_eq!(counter.update(0), 0);
    }

    #[test]
    fn many_laps_keep_the_exact_total() {
        let mut counter = Counter16::new(0);
        for step in 1..=10_000_u32 {
            let total = step.wrapping_mul(32_767);
            assert_eq!(counter.update(total as u16), total);
        }
    }
}
