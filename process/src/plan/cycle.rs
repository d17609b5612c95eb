//! The rational frequency of the control cycle (P3): the least at which a polygon of one chord a cycle leaves no contour by
//! more than the discrete that the axis resolves anyway.
//!
//! With v = F/60, mm/s, and Δ the allowed chord error, d, formula 4 reads
//!
//! ```text
//!     f(R, F) = v·k / (2·√(2·R·k·Δ − Δ²)),   R·k ≥ Δ
//! ```
//!
//! (a chord of a smaller circle cannot leave it by Δ). It grows with F, so on every radius the largest allowed feed counts:
//! min(F_max, 60·√(R·A), 60·∛(J·R²)). By ln f along R:
//!
//! ```text
//!     F_max rules:         f falls
//!     acceleration rules:  f² = A·k²/4Δ · R/(2·R·k − Δ) falls, towards A·k/8Δ: the closed form
//!     jerk rules:          (ln f)′ = (R·k − 2Δ) / (3R·(2·R·k − Δ)): falls up to R = 2Δ/k, then rises
//! ```
//!
//! so the largest f lies where jerk ceases to rule, at min(R*, R_F) with R* = A³/J² and R_F = √(v_max³/J), or at the smallest
//! radius, Δ/k. Both are looked at.

use leadscrew::units::{RangeError, checked};
use serde::Serialize;

/// What an axis, or the fastest of a machine's axes, may do.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Kinematics {
    max_feed_mm_per_min: f64,
    max_acceleration_m_s2: f64,
    max_jerk_m_s3: Option<f64>,
    counts_per_mm: f64,
}

/// Which limit holds the feed down.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Limit {
    /// The largest feed.
    Feed,
    /// The largest acceleration, by P3 (9).
    Acceleration,
    /// The largest jerk, by P3 (11).
    Jerk,
}

impl Limit {
    /// Its name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Feed => "feed",
            Self::Acceleration => "acceleration",
            Self::Jerk => "jerk",
        }
    }
}

/// The rational frequency and where it is needed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct RationalCycle {
    /// By the full formula, Hz (P3, 4 to 6).
    pub frequency_hz: f64,
    /// √(A·k/8Δ), Hz: what acceleration alone asks for on any radius but the smallest.
    pub closed_form_hz: f64,
    /// Radius that asks for it, mm.
    pub radius_mm: f64,
    /// Feed on that radius, mm/min.
    pub feed_mm_per_min: f64,
    /// The limit that rules: the acceleration, unless the jerk holds the axis back until its feed is reached.
    pub ruled_by: Limit,
}

/// Largest feeds, mm/min.
pub(super) const FEED_MM_PER_MIN: (f64, f64) = (1e-3, 1e6);
/// Largest accelerations, m/s².
pub(super) const ACCELERATION_M_S2: (f64, f64) = (1e-6, 1e4);
/// Largest jerks, m/s³.
pub(super) const JERK_M_S3: (f64, f64) = (1e-6, 1e7);
/// Resolutions, d/mm.
pub(super) const COUNTS_PER_MM: (f64, f64) = (1e-3, 1e7);
/// Radii of a contour, mm.
pub const RADIUS_MM: (f64, f64) = (1e-6, 1e7);
/// Chord errors that may be allowed, d.
pub const ALLOWED_D: (f64, f64) = (1e-3, 1e6);

impl Kinematics {
    /// Limits of motion and resolution. Without a jerk none is watched.
    ///
    /// # Errors
    /// [`RangeError`]: feeds of 0.001 to 1e6 mm/min, accelerations of 1e-6 to 1e4 m/s², jerks of 1e-6 to 1e7 m/s³, 0.001 to 1e7 d/mm.
    pub fn new(
        max_feed_mm_per_min: f64,
        max_acceleration_m_s2: f64,
        max_jerk_m_s3: Option<f64>,
        counts_per_mm: f64,
    ) -> Result<Self, RangeError> {
        let within = |name, value, (min, max): (f64, f64)| -> Result<f64, RangeError> {
            checked(name, value, min, max)
        };
        Ok(Self {
            max_feed_mm_per_min: within(
                "max_feed_mm_per_min",
                max_feed_mm_per_min,
                FEED_MM_PER_MIN,
            )?,
            max_acceleration_m_s2: within(
                "max_acceleration_m_s2",
                max_acceleration_m_s2,
                ACCELERATION_M_S2,
            )?,
            max_jerk_m_s3: max_jerk_m_s3
                .map(|jerk| within("max_jerk_m_s3", jerk, JERK_M_S3))
                .transpose()?,
            counts_per_mm: within("counts_per_mm", counts_per_mm, COUNTS_PER_MM)?,
        })
    }

    /// Of several axes the largest of everything, as P3 asks; no jerk is watched if one axis watches none.
    #[must_use]
    pub fn largest(axes: &[Self]) -> Option<Self> {
        axes.iter().copied().reduce(|one, other| Self {
            max_feed_mm_per_min: one.max_feed_mm_per_min.max(other.max_feed_mm_per_min),
            max_acceleration_m_s2: one.max_acceleration_m_s2.max(other.max_acceleration_m_s2),
            max_jerk_m_s3: one
                .max_jerk_m_s3
                .zip(other.max_jerk_m_s3)
                .map(|(one, other)| one.max(other)),
            counts_per_mm: one.counts_per_mm.max(other.counts_per_mm),
        })
    }

    /// Largest feed F_max, mm/min.
    #[must_use]
    pub const fn max_feed_mm_per_min(&self) -> f64 {
        self.max_feed_mm_per_min
    }

    /// Largest acceleration A, m/s².
    #[must_use]
    pub const fn max_acceleration_m_s2(&self) -> f64 {
        self.max_acceleration_m_s2
    }

    /// Largest jerk J, m/s³.
    #[must_use]
    pub const fn max_jerk_m_s3(&self) -> Option<f64> {
        self.max_jerk_m_s3
    }

    /// Resolution k, d/mm.
    #[must_use]
    pub const fn counts_per_mm(&self) -> f64 {
        self.counts_per_mm
    }

    /// Feed that the acceleration allows on a radius, mm/min (P3, 9).
    #[must_use]
    pub fn feed_by_acceleration(&self, radius_mm: f64) -> f64 {
        60.0 * (radius_mm * 1000.0 * self.max_acceleration_m_s2).sqrt()
    }

    /// Feed that the jerk allows on a radius, mm/min (P3, 11); none if no jerk is watched.
    #[must_use]
    pub fn feed_by_jerk(&self, radius_mm: f64) -> Option<f64> {
        let jerk = 1000.0 * self.max_jerk_m_s3?;
        Some(60.0 * (jerk * radius_mm * radius_mm).cbrt())
    }

    /// Feed allowed on a radius, mm/min, and the limit that holds it there.
    #[must_use]
    pub fn allowed_feed(&self, radius_mm: f64) -> (f64, Limit) {
        let by_jerk = self.feed_by_jerk(radius_mm).map(|feed| (feed, Limit::Jerk));
        [
            (self.feed_by_acceleration(radius_mm), Limit::Acceleration),
            (self.max_feed_mm_per_min, Limit::Feed),
        ]
        .into_iter()
        .fold(by_jerk, |least, other| match least {
            Some(least) if least.0 <= other.0 => Some(least),
            _ => Some(other),
        })
        .unwrap_or((self.max_feed_mm_per_min, Limit::Feed))
    }

    /// Radius below which jerk rules and above which acceleration does, R* = A³/J², mm.
    #[must_use]
    pub fn crossover_radius_mm(&self) -> Option<f64> {
        let jerk = self.max_jerk_m_s3?;
        Some(1000.0 * self.max_acceleration_m_s2.powi(3) / (jerk * jerk))
    }

    /// Radius from which on the largest feed is allowed, mm, and the limit that rules below.
    #[must_use]
    pub fn full_feed_radius_mm(&self) -> (f64, Limit) {
        let speed = self.max_feed_mm_per_min / 60.0;
        let by_acceleration = speed * speed / (1000.0 * self.max_acceleration_m_s2);
        let by_jerk = self
            .max_jerk_m_s3
            .map_or(0.0, |jerk| (speed.powi(3) / (1000.0 * jerk)).sqrt());
        if by_jerk >= by_acceleration {
            (by_jerk, Limit::Jerk)
        } else {
            (by_acceleration, Limit::Acceleration)
        }
    }

    /// The rational frequency for a chord error of `allowed_d`.
    ///
    /// # Errors
    /// [`RangeError`] for an allowed error outside 0.001 to 1e6 d.
    pub fn rational_cycle(&self, allowed_d: f64) -> Result<RationalCycle, RangeError> {
        let allowed_d = checked("allowed_chord_error_d", allowed_d, ALLOWED_D.0, ALLOWED_D.1)?;
        let smallest = allowed_d / self.counts_per_mm;
        let (full_feed, rules_below) = self.full_feed_radius_mm();
        let crossover = self.crossover_radius_mm().unwrap_or(0.0);
        let (jerk_ends, ruled_by) = match rules_below {
            Limit::Jerk if crossover > full_feed => (full_feed, Limit::Jerk),
            _ => (crossover, Limit::Acceleration),
        };
        let at = |radius_mm: f64, ruled_by| {
            let (feed_mm_per_min, _) = self.allowed_feed(radius_mm);
            RationalCycle {
                frequency_hz: frequency_hz(
                    feed_mm_per_min,
                    radius_mm,
                    self.counts_per_mm,
                    allowed_d,
                ),
                closed_form_hz: self.closed_form_hz(allowed_d),
                radius_mm,
                feed_mm_per_min,
                ruled_by,
            }
        };
        let least = at(smallest, self.allowed_feed(smallest).1);
        if jerk_ends <= smallest {
            return Ok(least);
        }
        let candidate = at(jerk_ends, ruled_by);
        Ok(if least.frequency_hz > candidate.frequency_hz {
            least
        } else {
            candidate
        })
    }

    /// √(A·k/8Δ), Hz: formula 4 with the feed of formula 9, for radii of many discretes.
    #[must_use]
    pub fn closed_form_hz(&self, allowed_d: f64) -> f64 {
        (1000.0 * self.max_acceleration_m_s2 * self.counts_per_mm / (8.0 * allowed_d)).sqrt()
    }
}

/// The least frequency, Hz, at which chords leave a circle by `allowed_d` at most (P3, 4); on circles smaller than that 0, as
/// none of their chords does.
#[must_use]
pub fn frequency_hz(
    feed_mm_per_min: f64,
    radius_mm: f64,
    counts_per_mm: f64,
    allowed_d: f64,
) -> f64 {
    let radius_d = radius_mm * counts_per_mm;
    // A hair, lest the smallest radius itself is lost to rounding.
    if radius_d < allowed_d * (1.0 - 1e-12) {
        return 0.0;
    }
    // (R·k)² − (R·k − Δ)² without the cancellation.
    let half_chord_d = (allowed_d * (2.0 * radius_d - allowed_d)).sqrt();
    feed_mm_per_min * counts_per_mm / (120.0 * half_chord_d)
}

/// By how much the chord of one cycle leaves a circle, d (P3, 1); none where the cycle goes further than the circle's diameter.
#[must_use]
pub fn chord_error_d(
    feed_mm_per_min: f64,
    radius_mm: f64,
    counts_per_mm: f64,
    cycle_hz: f64,
) -> Option<f64> {
    let radius_d = radius_mm * counts_per_mm;
    let half_step_d = step_d(feed_mm_per_min, counts_per_mm, cycle_hz) / 2.0;
    // As formula 1, without the difference of two large numbers.
    let left = radius_d * radius_d - half_step_d * half_step_d;
    (left >= 0.0).then(|| half_step_d * half_step_d / (radius_d + left.sqrt()))
}

/// Way of one cycle H, d (P3, 2): the velocity in d/tick of P1 (3).
#[must_use]
pub fn step_d(feed_mm_per_min: f64, counts_per_mm: f64, cycle_hz: f64) -> f64 {
    feed_mm_per_min * counts_per_mm / (60.0 * cycle_hz)
}
