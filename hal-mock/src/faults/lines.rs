//! The levels of A and B, and what a decoder makes of their changes.

use super::fault::Channel;

/// Levels of the two lines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lines {
    a: bool,
    b: bool,
}

/// What a decoder makes of a change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Transition {
    /// Nothing changed.
    None,
    /// One line changed: a count up or down.
    Step(i8),
    /// Both changed.
    Illegal,
}

impl Lines {
    /// The levels at a count: A changes at odd boundaries, B at even ones.
    pub const fn at(count: i32) -> Self {
        Self {
            a: (count.wrapping_add(1) >> 1) & 1 == 1,
            b: (count >> 1) & 1 == 1,
        }
    }

    /// A changed over.
    pub const fn with_a_flipped(self) -> Self {
        Self { a: !self.a, ..self }
    }

    /// Both changed over.
    pub const fn flipped(self) -> Self {
        Self {
            a: !self.a,
            b: !self.b,
        }
    }

    /// These levels, but for a channel at the level it has in `held`.
    pub const fn holding(self, channel: Channel, held: Self) -> Self {
        match channel {
            Channel::A => Self { a: held.a, ..self },
            Channel::B => Self { b: held.b, ..self },
        }
    }

    /// What a decoder sees when these levels become `next`.
    pub const fn transition(self, next: Self) -> Transition {
        match (next.place() - self.place()) & 3 {
            0 => Transition::None,
            1 => Transition::Step(1),
            3 => Transition::Step(-1),
            _ => Transition::Illegal,
        }
    }

    /// The count modulo 4.
    const fn place(self) -> i32 {
        2 * (self.b as i32) + (self.a != self.b) as i32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_up_and_down_are_steps_and_two_at_once_illegal() {
        for count in [-9, -2, -1, 0, 1, 2, 3, 4, 2_147_483_600] {
            let lines = Lines::at(count);
            assert_eq!(lines.transition(lines), Transition::None);
            assert_eq!(lines.transition(Lines::at(count + 1)), Transition::Step(1));
            assert_eq!(lines.transition(Lines::at(count - 1)), Transition::Step(-1));
            assert_eq!(lines.transition(Lines::at(count + 2)), Transition::Illegal);
            assert_eq!(lines.transition(lines.flipped()), Transition::Illegal);
            // From an even count, A is next going up; from an odd one going down.
            let step = if count % 2 == 0 { 1 } else { -1 };
            assert_eq!(
                lines.transition(lines.with_a_flipped()),
                Transition::Step(step)
            );
        }
    }
}
