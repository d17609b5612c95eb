//! The fastest change of velocity in whole ticks, as segments.
//!
//! It is what a [`follower`](crate::setpoint::follower) does tick by tick, in closed form. With
//! G(a) = Σₖ max(a − k·j, 0), odd, and E = target − v − a/2, each tick takes the largest acceleration a′ with
//! G(a′) ≤ E; E then falls by a′. So the acceleration climbs by j a tick as long as
//!
//! f(k) = E − (k − 1)·a − j·k(k − 1)/2 − G(a + k·j) ≥ 0,
//!
//! which holds up to some k and not from there on; at its limit it stays for ⌊(E − G)/a_max⌋ + 1 ticks; one tick
//! goes to the solution of G(a′) = E; from there it falls by j a tick to zero, the last tick by the rest. What the
//! solution leaves by rounding is some units of velocity, less than 2⁻²⁶ d/tick.

use super::state::{Segment, State};
use super::{MAX_SEGMENTS, MAX_TICKS, STATE_FRAC};
use crate::setpoint::limits::Limits;
use crate::units::{Acceleration, Jerk};

/// The largest change of velocity, d/tick.
const LARGEST_CHANGE: f64 = 4096.0;

/// Largest acceleration and jerk, 2⁻⁴⁸ d.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ramp {
    acceleration: i128,
    jerk: i128,
}

/// Segments and the state after them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Course {
    pub(super) segments: [Segment; MAX_SEGMENTS],
    used: usize,
    pub(super) ticks: u32,
    pub(super) state: State,
}

impl Course {
    pub(super) fn new(state: State) -> Self {
        Self {
            segments: [Segment::default(); MAX_SEGMENTS],
            used: 0,
            ticks: 0,
            state,
        }
    }

    /// How finely velocities of such courses can be chosen, 2⁻⁴⁸ d/tick: the solved acceleration is even and counts
    /// (n + 1) times.
    pub(super) fn grain(&self) -> i128 {
        let bent = self.segments.iter().filter(|segment| segment.jerk != 0);
        let longest = bent.map(|segment| segment.ticks).max().unwrap_or_default();
        i128::from(longest).wrapping_add(1).wrapping_mul(4)
    }

    /// Goes on for `ticks` with `jerk`; `None` if that is too long.
    // Functions of 128-bit numbers are long, and out of the tick a call costs nothing.
    #[inline(never)]
    pub(super) fn run(&mut self, ticks: i128, jerk: i128) -> Option<()> {
        if ticks == 0 {
            return Some(());
        }
        let segment = Segment {
            ticks: u32::try_from(ticks).ok()?,
            jerk: i64::try_from(jerk).ok()?,
        };
        self.ticks = self.ticks.checked_add(segment.ticks)?;
        if self.ticks > MAX_TICKS {
            return None;
        }
        self.state = self.state.after(&segment, segment.ticks);
        *self.segments.get_mut(self.used)? = segment;
        self.used = self.used.wrapping_add(1);
        Some(())
    }
}

impl Ramp {
    pub(super) fn new(limits: &Limits) -> Self {
        // A greater acceleration is of no use to any change of velocity within the format, nor is a greater jerk
        // than the one that goes from one end to the other in a tick.
        let useful = libm::sqrt(2.0 * LARGEST_CHANGE * limits.jerk().to_num::<f64>());
        let useful = libm::ldexp(useful, Acceleration::FRAC_NBITS.cast_signed()) as i64;
        let acceleration = i128::from(useful.min(i64::from(limits.acceleration().to_bits())))
            .wrapping_shl(STATE_FRAC - Acceleration::FRAC_NBITS);
        let jerk = i128::from(limits.jerk().to_bits()).wrapping_shl(STATE_FRAC - Jerk::FRAC_NBITS);
        Self {
            acceleration,
            jerk: jerk.min(acceleration.wrapping_mul(2)),
        }
    }

    /// The velocity of `state` once its acceleration is taken back to zero.
    pub(super) fn coast(&self, state: &State) -> i64 {
        let acceleration = i128::from(state.acceleration);
        let gain = self
            .hill(acceleration)
            .wrapping_sub(acceleration.wrapping_shr(1));
        i128::from(state.velocity).wrapping_add(gain) as i64
    }

    /// Takes `course` to the velocity `target` without acceleration; `None` if that is too long.
    pub(super) fn change(&self, course: &mut Course, target: i64) -> Option<()> {
        let (mut acceleration, mut gap, mut sign) = self.folded(&course.state, target);
        if acceleration > self.acceleration {
            self.come_back(course, acceleration, sign)?;
            (acceleration, gap, sign) = self.folded(&course.state, target);
        }
        let climb = self.climb(acceleration, gap)?;
        course.run(climb.ticks, self.jerk.wrapping_mul(sign))?;
        (acceleration, gap) = (climb.acceleration, climb.gap);

        let hill = self.hill(self.acceleration);
        if climb.to_the_limit && gap >= hill {
            if acceleration < self.acceleration {
                let rest = self.acceleration.wrapping_sub(acceleration);
                course.run(1, rest.wrapping_mul(sign))?;
                acceleration = self.acceleration;
                gap = gap.wrapping_sub(acceleration);
            }
            if gap >= hill {
                let ticks = gap
                    .wrapping_sub(hill)
                    .checked_div(acceleration)?
                    .wrapping_add(1);
                course.run(ticks, 0)?;
                gap = gap.wrapping_sub(acceleration.wrapping_mul(ticks));
            }
        }
        let next = self.solved(gap)?;
        if (acceleration, next) != (0, 0) {
            course.run(1, next.wrapping_sub(acceleration).wrapping_mul(sign))?;
        }
        let fall = next.signum().wrapping_mul(sign).wrapping_neg();
        let size = next.wrapping_abs();
        course.run(size.checked_div(self.jerk)?, self.jerk.wrapping_mul(fall))?;
        let rest = size.checked_rem(self.jerk)?;
        if rest > 0 {
            course.run(1, rest.wrapping_mul(fall))?;
        }
        Some(())
    }

    /// Acceleration and gap as seen in the direction in which the acceleration has to go, and that direction.
    #[inline(never)]
    fn folded(&self, state: &State, target: i64) -> (i128, i128, i128) {
        let acceleration = i128::from(state.acceleration);
        let gap = i128::from(target)
            .wrapping_sub(i128::from(state.velocity))
            .wrapping_sub(acceleration.wrapping_shr(1));
        if gap >= self.hill(acceleration) {
            (acceleration, gap, 1)
        } else {
            (acceleration.wrapping_neg(), gap.wrapping_neg(), -1)
        }
    }

    /// From an acceleration beyond the limit back to it.
    #[inline(never)]
    fn come_back(&self, course: &mut Course, acceleration: i128, sign: i128) -> Option<()> {
        let over = acceleration.wrapping_sub(self.acceleration);
        let back = sign.wrapping_neg();
        course.run(over.checked_div(self.jerk)?, self.jerk.wrapping_mul(back))?;
        let rest = over.checked_rem(self.jerk)?;
        if rest > 0 {
            course.run(1, rest.wrapping_mul(back))?;
        }
        Some(())
    }

    /// As many ticks of full jerk as fit, from `acceleration` not above its limit.
    #[inline(never)]
    fn climb(&self, acceleration: i128, gap: i128) -> Option<Climb> {
        let room = self.acceleration.wrapping_sub(acceleration);
        let most = room.checked_div(self.jerk)?;
        let gap_before = |ticks: i128| {
            let fewer = ticks.wrapping_sub(1);
            let triangle = ticks.wrapping_mul(fewer).wrapping_shr(1);
            gap.wrapping_sub(acceleration.wrapping_mul(fewer))
                .wrapping_sub(self.jerk.wrapping_mul(triangle))
        };
        let reached = |ticks: i128| acceleration.wrapping_add(self.jerk.wrapping_mul(ticks));
        let (mut low, mut high) = (0, most.min(i128::from(MAX_TICKS)));
        while low < high {
            let middle = low.wrapping_add(high).wrapping_add(1).wrapping_shr(1);
            if gap_before(middle) >= self.hill(reached(middle)) {
                low = middle;
            } else {
                high = middle.wrapping_sub(1);
            }
        }
        Some(Climb {
            ticks: low,
            acceleration: reached(low),
            gap: gap_before(low.wrapping_add(1)),
            to_the_limit: low == most,
        })
    }

    /// G: what the velocity gains from `acceleration` on, half of the first tick taken out.
    #[inline(never)]
    fn hill(&self, acceleration: i128) -> i128 {
        let size = acceleration.wrapping_abs();
        let whole = size.checked_div(self.jerk).unwrap_or_default();
        let next = whole.wrapping_add(1);
        let triangle = whole.wrapping_mul(next).wrapping_shr(1);
        next.wrapping_mul(size)
            .wrapping_sub(self.jerk.wrapping_mul(triangle))
            .wrapping_mul(acceleration.signum())
    }

    /// The acceleration with G = `gap`, rounded towards zero to an even one.
    #[inline(never)]
    fn solved(&self, gap: i128) -> Option<i128> {
        let size = gap.wrapping_abs();
        let ratio = size as f64 / self.jerk as f64;
        let mut whole = ((libm::sqrt(1.0 + 8.0 * ratio) - 1.0) / 2.0) as i128;
        let triangle = |whole: i128| {
            self.jerk
                .wrapping_mul(whole.wrapping_mul(whole.wrapping_add(1)).wrapping_shr(1))
        };
        // The root is right to a part in 2⁵⁰.
        if triangle(whole) > size {
            whole = whole.wrapping_sub(1);
        } else if triangle(whole.wrapping_add(1)) <= size {
            whole = whole.wrapping_add(1);
        }
        let acceleration = size
            .wrapping_add(triangle(whole))
            .checked_div(whole.wrapping_add(1))?;
        Some((acceleration & !1).wrapping_mul(gap.signum()))
    }
}

/// Where a climb ends.
struct Climb {
    ticks: i128,
    acceleration: i128,
    gap: i128,
    /// No further tick fits below the limit of acceleration.
    to_the_limit: bool,
}
