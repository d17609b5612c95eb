//! The cruising velocity with which a motion ends at its target.

use super::ramp::{Course, Ramp};
use super::state::State;
use crate::narrowing::within_or_high;

/// A creep that is small enough to stop looking for a better velocity, 2⁻⁴⁸ d/tick (2e-10 d/tick).
const FINE_CREEP: i128 = 1 << 16;

/// Velocities as close as that cover the same way but for a fine creep, 2⁻⁴⁸ d/tick.
const FINE_VELOCITY: i128 = 1 << 8;
/// How often a cruise is made longer to meet the target; the ticks that are added grow, so that it ends.
const LONGER_CRUISES: u32 = 64;

/// The search for a cruising velocity, turned so that it is not negative.
pub(super) struct Search {
    pub(super) ramp: Ramp,
    pub(super) start: State,
    pub(super) way: i128,
}

impl Search {
    /// To `velocity`, `ticks` of cruise, and to rest.
    pub(super) fn course(&self, velocity: i64, ticks: i128) -> Option<Course> {
        let mut course = Course::new(self.start);
        self.ramp.change(&mut course, velocity)?;
        course.run(ticks, 0)?;
        // What the first change leaves of its target by rounding would be a change by itself.
        if velocity != 0 {
            self.ramp.change(&mut course, 0)?;
        }
        Some(course)
    }

    /// What `course` leaves of the way, 2⁻⁴⁸ d; negative if it goes too far.
    pub(super) fn missing(&self, course: &Course) -> i128 {
        self.start
            .position
            .wrapping_add(self.way)
            .wrapping_sub(course.state.position)
    }

    /// The course that ends at the target, with velocities up to `top`.
    pub(super) fn solve(&self, top: i64) -> Option<Course> {
        let mut above = Guess {
            velocity: top,
            course: self.course(top, 0)?,
        };
        let mut cruise = 0;
        let missing = self.missing(&above.course);
        if missing > 0 {
            let top = i128::from(top);
            let up = missing.wrapping_add(top).wrapping_sub(1);
            cruise = up.checked_div(top)?.max(1);
            above.course = self.course(above.velocity, cruise)?;
        }
        let mut below = self.least(top, cruise)?;
        for attempt in 0..LONGER_CRUISES {
            if self.narrow(&mut below, &mut above, cruise)? {
                return Some(below.course);
            }
            // A greater velocity takes a tick more to reach, and in that tick the way grows by a jump: the target
            // lies in it. A tick more of cruise at a lower velocity meets it.
            cruise = cruise.wrapping_add(1 << (attempt / 4));
            above = Guess {
                velocity: below.velocity,
                course: self.course(below.velocity, cruise)?,
            };
            below = self.least(above.velocity, cruise)?;
        }
        None
    }

    /// The least cruising velocity to look at. Between zero and the velocity to which the acceleration at the start
    /// leads by itself the way does not grow steadily: to slow down twice takes longer than once. If the target is
    /// beyond the way with that velocity, the faster solution lies above it.
    fn least(&self, top: i64, cruise: i128) -> Option<Guess> {
        let coast = self.ramp.coast(&self.start);
        if coast > 0 && coast < top {
            let course = self.course(coast, cruise)?;
            if self.missing(&course) >= 0 {
                return Some(Guess {
                    velocity: coast,
                    course,
                });
            }
        }
        Some(Guess {
            velocity: 0,
            course: self.course(0, 0)?,
        })
    }

    /// Brings `below`, which does not go too far, up to the target; false if the way jumps over it.
    fn narrow(&self, below: &mut Guess, above: &mut Guess, cruise: i128) -> Option<bool> {
        // Every other step halves what is left, so that 128 are enough for any function.
        for step in 0..128 {
            let rest = self.missing(&below.course);
            let grain = below.course.grain();
            let fine = FINE_CREEP
                .max(grain)
                .wrapping_mul(i128::from(below.course.ticks));
            if rest <= fine {
                return Some(true);
            }
            let width = above.velocity.wrapping_sub(below.velocity);
            if i128::from(width) <= FINE_VELOCITY.max(grain) {
                break;
            }
            let part = if step % 2 == 0 {
                let span = rest.wrapping_sub(self.missing(&above.course));
                // A little below the line, where the course does not go too far.
                let share = rest as f64 / span as f64 * (1.0 - 1e-9);
                within_or_high((width as f64 * share) as i64, 1, width.wrapping_sub(1))
            } else {
                width.wrapping_shr(1)
            };
            let velocity = below.velocity.wrapping_add(part);
            let guess = Guess {
                velocity,
                course: self.course(velocity, cruise)?,
            };
            if self.missing(&guess.course) >= 0 {
                *below = guess;
            } else {
                *above = guess;
            }
        }
        Some(false)
    }
}

/// A cruising velocity and what comes of it.
struct Guess {
    velocity: i64,
    course: Course,
}
