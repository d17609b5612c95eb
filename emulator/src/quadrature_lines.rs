//! The lines of an encoder: from counts to the levels of A, B and Z.

use crate::emulator::Pin;

/// Which pins see the lines.
#[derive(Clone, Copy, Debug)]
pub struct Wiring {
    /// Channel A.
    pub a: &'static [Pin],
    /// Channel B.
    pub b: &'static [Pin],
    /// Index.
    pub z: &'static [Pin],
}

/// The axis encoder: every line at the counter and at the edge timer.
pub const AXIS: Wiring = Wiring {
    a: &[Pin::a(0), Pin::a(15)],
    b: &[Pin::a(1), Pin::b(3)],
    z: &[Pin::b(10), Pin::a(3)],
};

/// The second encoder.
pub const MASTER: Wiring = Wiring {
    a: &[Pin::b(4)],
    b: &[Pin::b(5)],
    z: &[Pin::b(0)],
};

/// The lines of an encoder at a count.
#[derive(Clone, Debug)]
pub struct Lines {
    wiring: Wiring,
    count: i32,
    edges_per_revolution: i32,
    index_width: i32,
}

impl Lines {
    /// Lines at rest.
    pub const fn new(
        wiring: Wiring,
        count: i32,
        edges_per_revolution: i32,
        index_width: i32,
    ) -> Self {
        Self {
            wiring,
            count,
            edges_per_revolution,
            index_width,
        }
    }

    /// The x4 count.
    pub const fn count(&self) -> i32 {
        self.count
    }

    /// Levels of A, B and Z: 00, 10, 11, 01 of A and B for the counts 0 to 3, Z from boundary 0 of the revolution on.
    const fn levels(&self) -> [bool; 3] {
        let low = self.count & 3;
        let of_turn = self.count.rem_euclid(self.edges_per_revolution);
        [low == 1 || low == 2, low >= 2, of_turn < self.index_width]
    }

    /// Tells all levels.
    pub fn announce(&self, clock: u64, changes: &mut Vec<(u64, Pin, bool)>) {
        self.tell([None; 3], clock, changes);
    }

    /// Passes an edge in a direction, +1 or −1.
    pub fn pass(&mut self, direction: i8, clock: u64, changes: &mut Vec<(u64, Pin, bool)>) {
        let before = self.levels().map(Some);
        self.count = self.count.wrapping_add(direction.into());
        self.tell(before, clock, changes);
    }

    fn tell(&self, before: [Option<bool>; 3], clock: u64, changes: &mut Vec<(u64, Pin, bool)>) {
        let pins = [self.wiring.a, self.wiring.b, self.wiring.z];
        for ((level, before), pins) in self.levels().into_iter().zip(before).zip(pins) {
            if before != Some(level) {
                changes.extend(pins.iter().map(|&pin| (clock, pin, level)));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_line_changes_an_edge_and_a_leads_b_forward() {
        let mut lines = Lines::new(AXIS, 0, 400, 3);
        let mut changes = Vec::new();
        lines.pass(1, 5, &mut changes);
        assert_eq!(changes, [(5, Pin::a(0), true), (5, Pin::a(15), true)]);
        changes.clear();
        lines.pass(1, 6, &mut changes);
        assert_eq!(changes, [(6, Pin::a(1), true), (6, Pin::b(3), true)]);
        changes.clear();
        lines.pass(1, 7, &mut changes);
        // A falls, and the index ends.
        let falls = [Pin::a(0), Pin::a(15), Pin::b(10), Pin::a(3)];
        assert_eq!(changes, falls.map(|pin| (7, pin, false)));
    }
}
