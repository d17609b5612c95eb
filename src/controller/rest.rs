//! Rest with a standing error, where static friction holds the axis.
//!
//! Behind static friction an integral grows without effect and then throws the axis, since friction falls with speed.
//! So at rest the error is dealt with by its size ([`State::judge`]): within a band nothing is done; within sixteen of them
//! the axis is pushed; beyond that, or without a known friction, the integral counts.
//!
//! A push takes the place of the law. It starts at half of static friction, or where the law stands if that is more, and
//! rises evenly until the axis lets go, which the first edge shows. Then it stays, until the axis would come to rest at its
//! target by itself: static friction F decelerates it by ω²·F, so from v it goes on by v·D + v²/(2·ω²·F). Then the command lets go and the
//! axis settles, before it is judged again.
//!
//! The second change of the error's side doubles the band, and so does every fourth push, four times at most, until the next
//! motion: no swing goes on. Each change of side also halves the rise, three times at most.

use crate::narrowing::within_or_high;
use crate::units::{Command, RangeError, Velocity, checked};

/// What rest is made of; lengths in d, times in ticks, the rest in fractions of full command.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rest {
    /// Following error within which nothing is done; 0: the integral counts always.
    pub band: f64,
    /// Static friction, the larger of both directions; 0: not known.
    pub held: f64,
    /// Ticks in which a push rises by static friction; 0: it does not.
    pub lift_ticks: f64,
    /// Delay of a command.
    pub delay_ticks: f64,
    /// Command per d/tick³ of jerk, 1/(G·ω²).
    pub per_jerk: f64,
}

/// Quantised.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Config {
    /// Q15.16 d; below zero: none.
    band: i32,
    /// Q.30.
    held: i32,
    /// In a tick, Q.30.
    rise: i32,
    /// D, Q.8.
    delay: u32,
    /// 1/(2·ω²·F), tick²/d, Q.8.
    per_deceleration: u32,
}

/// Largest error that is pushed against, in bands: 2ⁿ.
const REACH: u32 = 4;
/// Doublings of the band.
const MOST_DOUBLINGS: u32 = 4;
/// Halvings of a push's rise.
const MOST_HALVINGS: u32 = 3;
/// What is left for what the estimate of a slip that has just begun is short of, Q15.16: 1 d.
const SLACK: i32 = 1 << 16;
/// Ticks without a count after which it is held again, and those for which it settles.
const STILL_TICKS: u32 = 32;
const SETTLING_TICKS: u32 = 16;
/// Fastest slip that is reckoned with, Q11.20: 8 d/tick.
const FASTEST: u32 = 8 << Velocity::FRAC_NBITS;

impl Config {
    /// Quantises `rest`.
    ///
    /// # Errors
    /// [`RangeError`] for a band beyond 1 000 d, friction beyond full command, a rise of more than 1e6 ticks.
    pub fn new(rest: &Rest) -> Result<Self, RangeError> {
        let fixed = |value: f64, frac: u32| libm::round(libm::ldexp(value, frac.cast_signed()));
        let band = checked("rest_band_d", rest.band, 0.0, 1000.0)?;
        let held = checked("static friction", rest.held, 0.0, 1.0)?;
        let lift = checked("friction_lift_ticks", rest.lift_ticks, 0.0, 1e6)?;
        let delay = checked("feedforward_lead_ticks", rest.delay_ticks, 0.0, 1e4)?;
        let rise = if lift == 0.0 { 0.0 } else { held / lift };
        let per_deceleration = if held > 0.0 {
            rest.per_jerk / (2.0 * held)
        } else {
            0.0
        };
        Ok(Self {
            band: if band > 0.0 {
                fixed(band, 16) as i32
            } else {
                -1
            },
            held: fixed(held, Command::FRAC_NBITS) as i32,
            rise: fixed(rise, Command::FRAC_NBITS) as i32,
            delay: fixed(delay, 8) as u32,
            per_deceleration: fixed(per_deceleration.min(1e5), 8) as u32,
        })
    }

    /// The axis is pushed.
    #[inline]
    #[must_use]
    pub const fn pushes(&self) -> bool {
        self.rise != 0
    }

    /// Static friction, Q.30.
    #[inline]
    #[must_use]
    pub const fn held(&self) -> i32 {
        self.held
    }

    /// How far the axis goes on from `velocity` (Q11.20) once it is let go, Q15.16 d.
    fn way_from(&self, velocity: i32) -> i32 {
        let speed = velocity.unsigned_abs().min(FASTEST);
        let by_delay = u64::from(speed)
            .wrapping_mul(u64::from(self.delay))
            .wrapping_shr(Velocity::FRAC_NBITS + 8 - 16);
        // Q.12, so that its square has 30 bits at most.
        let coarse = speed.wrapping_shr(Velocity::FRAC_NBITS - 12);
        let by_friction = u64::from(coarse.wrapping_mul(coarse))
            .wrapping_mul(u64::from(self.per_deceleration))
            .wrapping_shr(24 + 8 - 16);
        by_delay.wrapping_add(by_friction).min(i32::MAX as u64) as i32
    }
}

/// What is to become of a following error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// At rest within the band: nothing.
    Within,
    /// At rest, as small as what static friction holds: the axis is pushed, or without a known friction it is integrated.
    Near,
    /// It is integrated.
    Far,
}

/// An axis at rest, as a push sees it.
#[derive(Clone, Copy, Debug)]
pub struct Standing {
    /// Following error, Q15.16 d.
    pub error: i32,
    /// What is to become of it.
    pub verdict: Verdict,
    /// The law less its bias, Q.30.
    pub law: i32,
    /// Static friction, Q.30.
    pub held: i32,
    /// Estimated velocity, Q11.20.
    pub velocity: i32,
}

/// Where a push is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Phase {
    /// There is none.
    #[default]
    None,
    /// It rises.
    Rising,
    /// The axis has let go.
    Slipping,
    /// It comes to rest.
    Settling,
}

/// State of the rest.
#[derive(Clone, Debug, Default)]
pub struct State {
    /// Sign of the error when it was last beyond the band.
    side: i32,
    /// Changes of that sign since the last motion.
    changes: u32,
    rested: bool,
    phase: Phase,
    /// Sign of the push and its size, Q.30.
    direction: i32,
    push: i32,
    /// Pushes since the last motion.
    pushes: u32,
    /// Counts since the push began or the last of them was seen, and the ticks since then.
    counts: i32,
    still: u32,
}

impl State {
    /// In motion.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            side: 0,
            changes: 0,
            rested: false,
            phase: Phase::None,
            direction: 0,
            pushes: 0,
            push: 0,
            counts: 0,
            still: 0,
        }
    }

    /// The count changed by `delta`.
    #[inline]
    pub const fn note(&mut self, delta: i32) {
        self.counts = self.counts.saturating_add(delta);
    }

    /// A motion begins: true if there was a rest before it.
    #[inline]
    pub fn leave(&mut self) -> bool {
        if !self.rested {
            return false;
        }
        *self = Self::new();
        true
    }

    /// A rest begins or goes on: true at its beginning.
    #[inline]
    pub const fn enter(&mut self) -> bool {
        let begins = !self.rested;
        self.rested = true;
        begins
    }

    /// What is to become of the `error` at rest.
    ///
    /// Static friction, once it lets go, may throw the axis beyond the other end of the band, and back: from the second
    /// time on the band doubles.
    #[inline]
    pub fn judge(&mut self, config: &Config, error: i32) -> Verdict {
        let size = error.saturating_abs();
        let doublings = self
            .changes
            .saturating_sub(1)
            .max(self.pushes.wrapping_shr(2))
            .min(MOST_DOUBLINGS);
        if size.wrapping_shr(doublings) <= config.band {
            return Verdict::Within;
        }
        if config.held != 0 && self.side.wrapping_mul(error.signum()) <= 0 {
            self.changes = self.changes.saturating_add(self.side.unsigned_abs());
            self.side = error.signum();
        }
        if size.wrapping_shr(REACH) <= config.band {
            Verdict::Near
        } else {
            Verdict::Far
        }
    }

    /// One tick of a push: what is to be added to the law, Q.30.
    pub fn push(&mut self, config: &Config, standing: &Standing) -> i32 {
        if self.phase == Phase::None {
            if standing.verdict != Verdict::Near {
                return 0;
            }
            self.begin(standing);
        }
        self.follow(config, standing);
        match self.phase {
            Phase::None => 0,
            Phase::Rising | Phase::Slipping => self
                .push
                .wrapping_mul(self.direction)
                .saturating_sub(standing.law),
            Phase::Settling => {
                let half = standing.held.wrapping_shr(1);
                within_or_high(standing.law, half.wrapping_neg(), half).wrapping_neg()
            }
        }
    }

    fn begin(&mut self, standing: &Standing) {
        self.phase = Phase::Rising;
        self.pushes = self.pushes.saturating_add(1);
        self.direction = standing.error.signum();
        self.counts = 0;
        self.still = 0;
        let towards = standing.law.saturating_mul(self.direction);
        let half = standing.held.wrapping_shr(1);
        let least = half.wrapping_add(towards.min(0));
        self.push = least.max(towards).clamp(0, Command::ONE.to_bits());
    }

    /// From phase to phase.
    fn follow(&mut self, config: &Config, standing: &Standing) {
        self.still = self.still.saturating_add(1);
        if self.counts != 0 {
            self.counts = 0;
            self.still = 0;
            if self.phase == Phase::Rising {
                self.phase = Phase::Slipping;
            }
        }
        match self.phase {
            Phase::Rising if standing.verdict == Verdict::Near => {
                let rise = config.rise.wrapping_shr(self.changes.min(MOST_HALVINGS));
                let most = most_of(standing.held).max(self.push);
                self.push = self.push.saturating_add(rise).min(most);
            }
            Phase::Rising => self.settle(),
            Phase::Slipping => {
                let left = standing.error.wrapping_mul(self.direction);
                let way = config.way_from(standing.velocity);
                if left <= way.saturating_add(SLACK) {
                    self.settle();
                } else if self.still > STILL_TICKS {
                    self.phase = Phase::Rising;
                }
            }
            Phase::Settling if self.still > SETTLING_TICKS => self.phase = Phase::None,
            Phase::Settling | Phase::None => {}
        }
    }

    fn settle(&mut self) {
        self.phase = Phase::Settling;
        self.still = 0;
    }
}

/// Bound of a push that began below it, 13/8 of static friction: it may have grown.
const fn most_of(held: i32) -> i32 {
    held.saturating_add(held.wrapping_shr(1))
        .saturating_add(held.wrapping_shr(3))
}
