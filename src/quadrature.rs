//! Software x4 quadrature decoding: two channel levels to a count of −1, 0, +1, or an illegal step.
//!
//! Forward is A leading B: 00 → 10 → 11 → 01 → 00 (levels written A B).

/// What one sample of the two channels did to the count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// The same levels as before.
    None,
    /// One edge forward: count + 1.
    Forward,
    /// One edge backward: count − 1.
    Backward,
    /// Both channels changed at once: an edge was missed, the direction is unknown, the count stays.
    Illegal,
}

impl Step {
    /// Change of the count: −1, 0 or +1; 0 for an illegal step.
    #[must_use]
    pub const fn counts(self) -> i32 {
        match self {
            Self::Forward => 1,
            Self::Backward => -1,
            Self::None | Self::Illegal => 0,
        }
    }
}

/// Place of the levels in the forward cycle 00, 10, 11, 01.
const fn phase(a: bool, b: bool) -> u8 {
    match (a, b) {
        (false, false) => 0,
        (true, false) => 1,
        (true, true) => 2,
        (false, true) => 3,
    }
}

/// A decoder that remembers the last levels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Decoder {
    phase: u8,
}

impl Decoder {
    /// A decoder at rest on the levels `a`, `b`.
    #[must_use]
    pub const fn new(a: bool, b: bool) -> Self {
        Self { phase: phase(a, b) }
    }

    /// Place of the levels in the forward cycle, 0 to 3: what the two low bits of a count shall be.
    #[must_use]
    pub const fn phase(&self) -> u8 {
        self.phase
    }

    /// Takes the next levels and says what they did to the count.
    pub const fn step(&mut self, a: bool, b: bool) -> Step {
        let next = phase(a, b);
        let turned = next.wrapping_sub(self.phase) & 3;
        self.phase = next;
        match turned {
            0 => Step::None,
            1 => Step::Forward,
            3 => Step::Backward,
            _ => Step::Illegal,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Decoder, Step};

    const FORWARD_CYCLE: [(bool, bool); 4] =
        [(false, false), (true, false), (true, true), (false, true)];

    #[test]
    fn all_sixteen_transitions() {
        let expected = [Step::None, Step::Forward, Step::Illegal, Step::Backward];
        for (from, &(a0, b0)) in FORWARD_CYCLE.iter().enumerate() {
            for (to, &(a1, b1)) in FORWARD_CYCLE.iter().enumerate() {
                let step = Decoder::new(a0, b0).step(a1, b1);
                assert_eq!(step, expected[(to + 4 - from) % 4], "{a0}{b0} -> {a1}{b1}");
            }
        }
    }

    #[test]
    fn an_illegal_step_does_not_move_the_count_and_decoding_goes_on() {
        let mut decoder = Decoder::new(false, false);
        assert_eq!(decoder.step(true, true), Step::Illegal);
        assert_eq!(Step::Illegal.counts(), 0);
        assert_eq!(decoder.step(false, true), Step::Forward);
    }
}
