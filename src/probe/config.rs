//! How the axis probes.

use crate::parameter_table;
use crate::parameter_table::ParameterTable;
use crate::setpoint::Setpoint;
use crate::setpoint::follower;
use crate::setpoint::profile::Limits;
use crate::units::{AxisScale, Position, RangeError, Velocity};

parameter_table! {
    /// Probing: to the first touch of a touch probe.
    pub struct ProbeParams {
        /// How long the probe's level must stay for a touch; the latch is that of the first edge all the same
        debounce_s: 0.001, "s", 0.0..=0.1;
        /// From the contact to the edge at the board's input, as calibrated; taken off the time of the latch
        trigger_delay_s: 0.0, "s", 0.0..=0.01;
        /// Standard deviation of that delay, for the uncertainty that is stated
        trigger_jitter_s: 1e-5, "s", 0.0..=0.001;
        /// Farthest that the axis may go on after a touch: a feed that needs more is refused
        max_overtravel_mm: 1.0, "mm", 0.001..=100.0;
        /// What of the overtravel is left for following error and overshoot of the loop
        following_allowance_mm: 0.02, "mm", 0.0..=10.0;
        /// Feed of the way back, at most the axis's largest
        retract_feed_mm_per_min: 500.0, "mm/min", 0.001..=1e6;
        /// A touch while something else moves the axis: 1 stops it, 0 only notes it; an input that nobody wired may not stop it
        stop_on_touch: 0.0, "0 or 1", 0.0..=1.0;
    }
}

/// A touch is decided on within so many times the debounce: what bounces longer than that is one.
pub const DECISION: u32 = 4;
/// Fractional bits of times in the history, ticks.
pub const TIME_FRAC: u32 = 20;
/// Fractional bits of the trigger's jitter, ticks.
const JITTER_FRAC: u32 = 24;
/// A sample of the history is the mean of the edges in so much time at least, s.
const SAMPLE_S: f64 = 0.001;
/// The loop has come to rest so long after its setpoint, s.
const SETTLE_S: f64 = 0.02;
/// Slowest feed, d/tick.
const SLOWEST: f64 = 1e-4;

/// The quantised configuration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Config {
    /// Ticks that the level must stay, at least 1.
    pub(super) debounce: u32,
    /// Trigger delay, ticks with [`TIME_FRAC`].
    pub(super) delay: i32,
    /// Standard deviation of the trigger delay, ticks with [`JITTER_FRAC`].
    pub(super) jitter: u32,
    pub(super) max_overtravel: Position,
    allowance: Position,
    pub(super) retract: Velocity,
    pub(super) stops_others: bool,
    /// Time of a sample, ticks with [`TIME_FRAC`].
    pub(super) sample: u32,
    pub(super) settle: u32,
    /// Counts of a revolution over 2π: what a slope of the encoder's slow error comes to as a place, d.
    pub(super) slope_reach: u32,
    pub(super) fastest: Velocity,
    pub(super) follower: follower::Config,
}

impl ProbeParams {
    /// The configuration for motion within `limits` on an encoder with `counts_per_revolution` d from index to index (0:
    /// none).
    ///
    /// # Errors
    /// [`RangeError`] for a parameter, or what it comes to in d and ticks, out of range.
    pub fn quantise(
        &self,
        scale: AxisScale,
        limits: &Limits,
        counts_per_revolution: f64,
    ) -> Result<Config, RangeError> {
        self.check()?;
        let ticks = |seconds: f64| seconds * scale.tick_hz();
        let way = |mm| Position::saturating_from_num(libm::ceil(scale.counts_from_mm(mm)));
        let retract = scale.velocity_from_feed(self.retract_feed_mm_per_min)?;
        Ok(Config {
            debounce: (libm::ceil(ticks(self.debounce_s)) as u32).max(1),
            delay: libm::round(libm::ldexp(
                ticks(self.trigger_delay_s),
                TIME_FRAC.cast_signed(),
            )) as i32,
            jitter: libm::ceil(libm::ldexp(
                ticks(self.trigger_jitter_s),
                JITTER_FRAC.cast_signed(),
            )) as u32,
            max_overtravel: way(self.max_overtravel_mm),
            allowance: way(self.following_allowance_mm),
            retract: Velocity::saturating_from_num(retract)
                .max(Velocity::from_num(SLOWEST))
                .min(limits.velocity()),
            stops_others: self.stop_on_touch >= 0.5,
            sample: libm::ldexp(ticks(SAMPLE_S).max(1.0), TIME_FRAC.cast_signed()) as u32,
            settle: libm::ceil(ticks(SETTLE_S)) as u32,
            slope_reach: libm::ceil(counts_per_revolution / core::f64::consts::TAU) as u32,
            fastest: limits.velocity(),
            follower: follower::Config::new(limits),
        })
    }
}

impl Config {
    /// Ticks from the contact to the begin of the stop at the latest: trigger delay, the time in which a touch is decided
    /// on, and a tick each for seeing and for acting.
    #[must_use]
    pub const fn reaction_ticks(&self) -> u32 {
        let delay = (self.delay.unsigned_abs() >> TIME_FRAC).saturating_add(1);
        delay
            .saturating_add(self.debounce.saturating_mul(DECISION))
            .saturating_add(2)
    }

    /// Farthest that the axis goes on after a contact at `feed`, d: the way at that feed until the stop begins, the
    /// jerk-limited stop, and the allowance for the loop. Not negative.
    #[must_use]
    pub fn overtravel(&self, feed: Velocity) -> Position {
        let feed = feed.saturating_abs();
        let reaction = i64::from(feed.to_bits())
            .wrapping_mul(i64::from(self.reaction_ticks()))
            .wrapping_shr(Velocity::FRAC_NBITS - Position::FRAC_NBITS);
        let stop = self.follower.stopping_distance(&Setpoint {
            velocity: feed,
            ..Setpoint::default()
        });
        Position::from_bits(reaction)
            .saturating_add(stop)
            .saturating_add(self.allowance)
    }

    /// Variance that the trigger's jitter makes of a place at `velocity`, 2⁻⁴⁸ d².
    pub(super) fn jitter_variance(&self, velocity: Velocity) -> u64 {
        let error = u64::from(velocity.to_bits().unsigned_abs())
            .wrapping_mul(u64::from(self.jitter))
            .wrapping_shr(Velocity::FRAC_NBITS + JITTER_FRAC - 24)
            .min(u64::from(u32::MAX));
        error.wrapping_mul(error)
    }
}
