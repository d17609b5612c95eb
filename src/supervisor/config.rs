//! Parameters of the supervisor in physical units, and what the tick makes of them.

use super::monitor::{against, disabled, encoder_loss, following, index, leaky};
use super::sequence::Times;
use crate::parameter_table;
use crate::parameter_table::ParameterTable;
use crate::units::{AxisScale, Command, RangeError, Velocity};

parameter_table! {
    /// What the axis is watched for, and the times of enabling and stopping.
    pub struct SupervisorParams {
        /// Following error allowed at rest
        following_error_mm: 1.0, "mm", 0.001..=1e6;
        /// Growth of that limit with the setpoint's velocity
        following_error_per_feed_s: 0.01, "s", 0.0..=10.0;
        /// Share of the limit from which on a warning is given
        following_warning_share: 0.5, "of the limit", 0.0..=1.0;
        /// Following error allowed while the setpoint rests
        standstill_mm: 0.2, "mm", 0.001..=1e6;
        /// Rest before that counts
        standstill_after_s: 0.5, "s", 0.0..=60.0;
        /// Way allowed while the drive is off
        disabled_mm: 0.1, "mm", 0.001..=1e9;
        /// Time to run out before that counts
        disabled_after_s: 1.0, "s", 0.0..=60.0;
        /// 1: motion while the drive is off is a fault; 0: a warning
        disabled_is_fault: 0.0, "0 or 1", 0.0..=1.0;
        /// Command above which motion against it counts
        against_level: 0.03, "of full command", 0.0..=1.0;
        /// Way allowed against the command
        against_mm: 0.3, "mm", 0.001..=1e6;
        /// Time allowed against the command
        against_time_s: 0.03, "s", 0.0..=60.0;
        /// Command above which the encoder has to move
        encoder_loss_level: 0.05, "of full command", 0.0..=1.0;
        /// Time for which it may stand
        encoder_loss_time_s: 0.05, "s", 0.0..=60.0;
        /// Way that the command stands for, for which it may stand
        encoder_loss_mm: 0.5, "mm", 0.001..=1e6;
        /// An encoder that moves less stands
        encoder_loss_counts: 4.0, "d", 1.0..=1e6;
        /// Illegal transitions allowed at once
        illegal_limit: 10.0, "transitions", 0.0..=1e9;
        /// Illegal transitions forgiven
        illegal_forgiven_per_s: 10.0, "1/s", 0.001..=1e5;
        /// Counts between two indexes may be so far off from whole revolutions
        index_tolerance_d: 2.0, "d", 0.0..=1e6;
        /// Way in which an index must come
        index_within_revolutions: 1.25, "revolutions", 1.01..=1000.0;
        /// Velocity allowed, as a share of the largest feed; 5 % of the full-command feed come on top
        overspeed_share: 1.1, "of the largest feed", 1.0..=1e6;
        /// Time allowed at the limit of the output
        saturated_time_s: 1.0, "s", 0.0..=1e5;
        /// Difference allowed between read-back and command
        readback_tolerance: 0.02, "of full command", 0.0..=2.0;
        /// Missed ticks allowed at once
        missed_limit: 3.0, "ticks", 0.0..=1e9;
        /// Missed ticks forgiven
        missed_forgiven_per_s: 1.0, "1/s", 0.001..=1e5;
        /// Feed below which the axis stands: for limit switches and the clearing of faults
        still_feed_mm_per_min: 120.0, "mm/min", 0.001..=1e5;
        /// Longest time from enable to a ready drive
        ready_timeout_s: 1.0, "s", 0.001..=600.0;
        /// Time for which the loop holds before the brake is released
        hold_before_release_s: 0.0, "s", 0.0..=60.0;
        /// Time from the brake's release until the axis may move
        brake_release_s: 0.0, "s", 0.0..=60.0;
        /// Time for which the axis is held while the brake closes
        brake_delay_s: 0.0, "s", 0.0..=60.0;
        /// Longest controlled stop; after that 0 V
        stop_timeout_s: 2.0, "s", 0.0..=600.0;
        /// Time for which enable is kept at 0 V
        zero_volts_s: 0.5, "s", 0.0..=60.0;
    }
}

impl SupervisorParams {
    /// Every monitor as wide as its range allows: for trials with inputs that no machine gives. Stops are
    /// immediate.
    #[must_use]
    pub fn widest() -> Self {
        Self {
            following_error_mm: 1e6,
            following_warning_share: 1.0,
            standstill_mm: 1e6,
            disabled_mm: 1e9,
            against_level: 1.0,
            against_mm: 1e6,
            encoder_loss_level: 1.0,
            encoder_loss_mm: 1e6,
            illegal_limit: 1e9,
            illegal_forgiven_per_s: 1e5,
            overspeed_share: 1e6,
            saturated_time_s: 1e5,
            readback_tolerance: 2.0,
            missed_limit: 1e9,
            missed_forgiven_per_s: 1e5,
            stop_timeout_s: 0.0,
            zero_volts_s: 0.0,
            ..Self::default()
        }
    }

    /// Checks and quantises, for an axis with a full-command speed of `full_velocity` and a largest velocity of
    /// `max_velocity`, d/tick, whose encoder has an index every `counts_per_revolution` d (0: none).
    ///
    /// # Errors
    /// [`RangeError`] for the first parameter that is out of range.
    pub fn quantise(
        &self,
        scale: AxisScale,
        full_velocity: f64,
        max_velocity: f64,
        counts_per_revolution: f64,
    ) -> Result<Config, RangeError> {
        self.check()?;
        let d = |mm: f64| scale.counts_from_mm(mm);
        let ticks = |time_s: f64| libm::round(time_s * scale.tick_hz()) as u32;
        let forgive = |per_s: f64| ticks(1.0 / per_s).max(1);
        let q16 = |value: f64| libm::round(value * 65_536.0) as i32;
        let share = |share: f64| Command::saturating_from_num(share).to_bits();
        let velocity = |value: f64| Velocity::saturating_from_num(value).to_bits();
        let revolution = libm::round(counts_per_revolution);
        let overspeed = self.overspeed_share * max_velocity + 0.05 * full_velocity;
        Ok(Config {
            following: following::Limits {
                base: q16(d(self.following_error_mm)),
                per_velocity: q16(self.following_error_per_feed_s * scale.tick_hz()),
                warning_share: (self.following_warning_share * 32_768.0) as u32,
                standstill: q16(d(self.standstill_mm)),
                standstill_after: ticks(self.standstill_after_s),
                quiet: 0,
                quiet_at_rest: 0,
            }
            .with_quiet(),
            disabled: disabled::Limits {
                way: d(self.disabled_mm) as i64,
                after: ticks(self.disabled_after_s),
                is_fault: self.disabled_is_fault >= 0.5,
            },
            against: against::Limits {
                level: share(self.against_level),
                way: d(self.against_mm) as i32,
                ticks: ticks(self.against_time_s),
            },
            encoder_loss: encoder_loss::Limits {
                level: share(self.encoder_loss_level),
                ticks: ticks(self.encoder_loss_time_s),
                way: libm::round(d(self.encoder_loss_mm) / full_velocity * 32_768.0) as u32,
                full_velocity: libm::round(full_velocity * 65_536.0) as u32,
                counts: self.encoder_loss_counts as u32,
            },
            illegal: leaky::Limits {
                limit: self.illegal_limit as u32,
                forgive_ticks: forgive(self.illegal_forgiven_per_s),
            },
            missed: leaky::Limits {
                limit: self.missed_limit as u32,
                forgive_ticks: forgive(self.missed_forgiven_per_s),
            },
            index: index::Limits {
                counts_per_revolution: revolution as i32,
                tolerance: self.index_tolerance_d as i32,
                within: if revolution >= 1.0 {
                    (revolution * self.index_within_revolutions) as u32
                } else {
                    u32::MAX
                },
            },
            overspeed: velocity(overspeed),
            saturated_ticks: ticks(self.saturated_time_s),
            readback_tolerance: share(self.readback_tolerance),
            still: velocity(scale.velocity_from_feed(self.still_feed_mm_per_min)?),
            times: Times {
                ready_timeout: ticks(self.ready_timeout_s).max(1),
                hold: ticks(self.hold_before_release_s),
                brake_release: ticks(self.brake_release_s),
                brake_delay: ticks(self.brake_delay_s),
                stop_timeout: ticks(self.stop_timeout_s),
                zero_volts: ticks(self.zero_volts_s),
            },
        })
    }
}

/// The quantised configuration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Config {
    pub(super) following: following::Limits,
    pub(super) disabled: disabled::Limits,
    pub(super) against: against::Limits,
    pub(super) encoder_loss: encoder_loss::Limits,
    pub(super) illegal: leaky::Limits,
    pub(super) missed: leaky::Limits,
    pub(super) index: index::Limits,
    /// Q11.20 d/tick.
    pub(super) overspeed: i32,
    pub(super) saturated_ticks: u32,
    /// Q.30.
    pub(super) readback_tolerance: i32,
    /// Q11.20 d/tick.
    pub(super) still: i32,
    pub(super) times: Times,
}
