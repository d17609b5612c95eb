//! How the axis looks for its home.

use crate::parameter_table;
use crate::parameter_table::ParameterTable;
use crate::setpoint::follower;
use crate::setpoint::profile::Limits;
use crate::units::{AxisScale, Position, RangeError, Velocity};

parameter_table! {
    /// Homing: to a switch, then to the encoder's index.
    pub struct HomingParams {
        /// Where the switch is sought, and from where it and the index are approached: negative downwards, else upwards
        search_direction: 1.0, "1 or -1", -1.0..=1.0;
        /// Feed of the search for the switch, at most the axis's largest
        search_feed_mm_per_min: 1000.0, "mm/min", 0.001..=1e6;
        /// Feed of the approach to the switch, and from there to the index, at most the axis's largest
        approach_feed_mm_per_min: 120.0, "mm/min", 0.001..=1e6;
        /// How far behind the switch the approach begins
        back_off_mm: 1.0, "mm", 0.0..=1000.0;
        /// Longest way of the search, and of the way back
        max_search_mm: 1200.0, "mm", 0.01..=1e6;
        /// Longest time of the whole homing
        max_time_s: 180.0, "s", 0.1..=3600.0;
        /// Coordinate of the index at which the axis is homed
        home_position_mm: 0.0, "mm", -1e6..=1e6;
    }
}

/// The index may come so much of a revolution after the switch at the earliest and at the latest: nearer to it
/// the switch's own scatter decides which index it is.
pub const INDEX_SHARES: (f64, f64) = (0.1, 0.9);
/// Slowest search or approach, d/tick.
const SLOWEST: f64 = 1e-4;

/// The quantised configuration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Config {
    /// 1 or −1.
    pub(super) direction: i64,
    /// Speed of the search, not negative.
    pub(super) search: Velocity,
    /// Speed of the approach, not negative.
    pub(super) approach: Velocity,
    pub(super) back_off: i64,
    pub(super) max_way: i64,
    pub(super) max_ticks: u32,
    /// Index to index, and a tenth more.
    pub(super) index_way: i64,
    /// Earliest and latest index after the switch.
    pub(super) index_window: (i64, i64),
    pub(super) revolution: i64,
    /// Coordinate of the index, Q48.16 d.
    pub(super) home_position: i64,
    pub(super) follower: follower::Config,
}

impl HomingParams {
    /// The configuration for motion within `limits` and an encoder with an index every `counts_per_revolution` d (0:
    /// none, and no homing).
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
        // Defaults must do for any axis: a search is never faster than the axis, nor does it stand.
        let feed = |feed_mm_per_min| -> Result<Velocity, RangeError> {
            let velocity = scale.velocity_from_feed(feed_mm_per_min)?;
            let slowest = Velocity::from_num(SLOWEST);
            Ok(Velocity::saturating_from_num(velocity)
                .max(slowest)
                .min(limits.velocity()))
        };
        let direction = if self.search_direction < 0.0 { -1 } else { 1 };
        let way = |way_mm| libm::ceil(scale.counts_from_mm(way_mm)) as i64;
        let revolution = libm::round(counts_per_revolution);
        let (earliest, latest) = INDEX_SHARES;
        Ok(Config {
            direction,
            search: feed(self.search_feed_mm_per_min)?,
            approach: feed(self.approach_feed_mm_per_min)?,
            back_off: way(self.back_off_mm),
            max_way: way(self.max_search_mm),
            max_ticks: (self.max_time_s * scale.tick_hz()) as u32,
            index_way: libm::ceil(1.1 * revolution) as i64,
            index_window: (
                libm::ceil(earliest * revolution) as i64,
                libm::floor(latest * revolution) as i64,
            ),
            revolution: revolution as i64,
            home_position: Position::saturating_from_num(
                scale.counts_from_mm(self.home_position_mm),
            )
            .to_bits(),
            follower: follower::Config::new(limits),
        })
    }
}

impl Config {
    /// True if the encoder has an index to home to.
    pub(crate) const fn has_index(&self) -> bool {
        self.revolution > 0
    }

    /// `count` in the direction of the search.
    pub(super) const fn onward(&self, count: i64) -> i64 {
        count.wrapping_mul(self.direction)
    }

    /// A speed in the direction of the search, or back.
    pub(super) const fn towards(&self, speed: Velocity, back: bool) -> Velocity {
        let bits = speed.to_bits();
        if (self.direction < 0) == back {
            Velocity::from_bits(bits)
        } else {
            Velocity::from_bits(bits.wrapping_neg())
        }
    }
}
