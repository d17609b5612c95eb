//! Whether indexes come whole revolutions apart.

use crate::capture::UnwrappedLatch;
use crate::encoder_map::Direction;

/// How far an index may come off its place: a count for its edge, one for a slow passage.
const TOLERANCE: i32 = 2;

/// The last index in either direction, low words of the counts.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct IndexWatch {
    forward: Option<i32>,
    backward: Option<i32>,
}

impl IndexWatch {
    /// Nothing seen so far.
    pub const fn new() -> Self {
        Self {
            forward: None,
            backward: None,
        }
    }

    /// Takes an index for right.
    pub const fn note(&mut self, direction: Direction, count: i64) {
        match direction {
            Direction::Forward => self.forward = Some(count as i32),
            Direction::Backward => self.backward = Some(count as i32),
        }
    }

    /// Whether an index came where it must, in a tick that moved by `delta`. The two directions have their own
    /// fronts of the pulse.
    #[cold]
    pub fn agrees(&mut self, delta: i32, latch: UnwrappedLatch, revolution: i64) -> bool {
        if delta == 0 {
            return true;
        }
        let direction = Direction::of(delta);
        let last = match direction {
            Direction::Forward => self.forward,
            Direction::Backward => self.backward,
        };
        self.note(direction, latch.count);
        let Some(last) = last else {
            return true;
        };
        let way = (latch.count as i32).wrapping_sub(last);
        let Some(over) = way.checked_rem(revolution as i32) else {
            return true;
        };
        let over = over.unsigned_abs() as i32;
        over.min((revolution as i32).wrapping_sub(over)) <= TOLERANCE
    }
}
