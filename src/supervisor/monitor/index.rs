//! The index: whole revolutions between two of them, and one in every revolution.

use super::super::fault::Fault;
use super::super::record::Trip;

/// What is allowed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// d; 0 where there is no index to watch.
    pub counts_per_revolution: i32,
    /// d.
    pub tolerance: i32,
    /// Way without an index, d; `u32::MAX` where none is watched.
    pub within: u32,
}

/// The monitor. Forward and backward an index has its front at different counts, so each direction has its own.
#[derive(Clone, Copy, Debug, Default)]
pub struct Index {
    /// A place of the index passed forward and backward, by the first one seen.
    places: [Option<i64>; 2],
    /// Count at the last index, or where watching began.
    last: i64,
}

impl Index {
    /// Takes notice of an index at `count` in a tick that moved by `delta`.
    #[cold]
    #[inline(never)]
    pub fn note(&mut self, limits: &Limits, count: i64, delta: i32) -> Option<Trip> {
        self.last = count;
        // A tick that turned round does not tell in which direction its index was passed.
        if limits.counts_per_revolution == 0 || delta == 0 {
            return None;
        }
        let [forward, backward] = &mut self.places;
        let place = if delta > 0 { forward } else { backward };
        let Some(known) = *place else {
            *place = Some(count);
            return None;
        };
        let way = count.wrapping_sub(known);
        let Ok(way) = i32::try_from(way) else {
            // Further than any axis goes: begin anew.
            *place = Some(count);
            return None;
        };
        let off = remainder(way, limits.counts_per_revolution);
        if off.saturating_abs() > limits.tolerance {
            let (off, limit) = (i64::from(off), i64::from(limits.tolerance));
            return Some(Trip::counted(Fault::IndexInconsistent, off, limit));
        }
        // By whole revolutions, so that the error does not creep.
        *place = Some(count.wrapping_sub(i64::from(off)));
        None
    }

    /// Way since the last index, d. It is judged long before it wraps.
    #[inline(always)]
    pub const fn way(&self, count: i64) -> i32 {
        (count as i32).wrapping_sub(self.last as i32)
    }

    /// Judges it.
    pub fn check(&self, limits: &Limits, count: i64) -> Option<Trip> {
        let way = self.way(count);
        (way.unsigned_abs() > limits.within)
            .then(|| Trip::counted(Fault::IndexNotFound, way.into(), limits.within.into()))
    }

    /// Forgets the places of the index.
    pub const fn restart(&mut self) {
        self.places = [None; 2];
    }

    /// The way without an index counts from `count` on.
    pub const fn watch_from(&mut self, count: i64) {
        self.last = count;
    }
}

/// The smallest remainder of `way` / `whole` in size.
fn remainder(way: i32, whole: i32) -> i32 {
    let off = way.checked_rem(whole).unwrap_or(0);
    let half = whole.wrapping_shr(1);
    if off > half {
        off.wrapping_sub(whole)
    } else if off < half.wrapping_neg() {
        off.wrapping_add(whole)
    } else {
        off
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMITS: Limits = Limits {
        counts_per_revolution: 100,
        tolerance: 2,
        within: 125,
    };

    #[test]
    fn remainders_are_the_nearest_ones() {
        for (way, off) in [
            (0, 0),
            (49, 49),
            (51, -49),
            (-49, -49),
            (-51, 49),
            (-298, 2),
            (1001, 1),
        ] {
            assert_eq!(remainder(way, 100), off);
        }
    }

    #[test]
    fn a_count_lost_in_each_revolution_adds_up() {
        let mut index = Index::default();
        let seen: [bool; 5] =
            core::array::from_fn(|turn| index.note(&LIMITS, turn as i64 * 99, 9).is_some());
        assert_eq!(seen, [false, false, false, true, true]);
    }

    #[test]
    fn each_direction_has_its_own_place() {
        let mut index = Index::default();
        assert_eq!(index.note(&LIMITS, 100, 5), None);
        assert_eq!(index.note(&LIMITS, 105, -5), None);
        assert_eq!(index.note(&LIMITS, 200, 5), None);
        assert_eq!(index.note(&LIMITS, 4, -5), None);
        assert_eq!(
            index.note(&LIMITS, 306, 5),
            Some(Trip::counted(Fault::IndexInconsistent, 6, 2))
        );
        assert_eq!(index.check(&LIMITS, 431), None);
        assert_eq!(
            index.check(&LIMITS, 432),
            Some(Trip::counted(Fault::IndexNotFound, 126, 125))
        );
    }
}
