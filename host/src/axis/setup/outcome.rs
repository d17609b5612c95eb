//! What a commissioning came to.

use leadscrew::tuning::DriveModel;
use leadscrew::tuning::autotune::Report;
use serde::Serialize;

use crate::axis::Follows;

/// What was found and set.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Outcome {
    /// The steps that were made.
    pub steps: Vec<&'static str>,
    /// Command that proved the sign, of full command.
    pub proof_level: Option<f64>,
    /// Counts from index to index.
    pub counts_per_revolution: Option<f64>,
    /// Feed at full command, mm/min.
    pub full_command_feed_mm_per_min: Option<f64>,
    /// Offset of the drive, of full command.
    pub offset: Option<f64>,
    /// The loop.
    pub tuned: Option<TunedFigures>,
    /// What a map leaves of an edge's place, d rms.
    pub map_edge_d: Option<f64>,
    /// Ripple of the estimated velocity without the map and with it, d/tick rms.
    pub ripple_d_per_tick: Option<[f64; 2]>,
    /// Following errors of the last test move.
    pub follows: Option<Follows>,
    /// What was left of the offset for the loop, before and after, of full command.
    pub offset_left: Option<[f64; 2]>,
    /// Where the axis stood after it was homed, mm.
    pub homed_at_mm: Option<f64>,
}

/// A loop that was made.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct TunedFigures {
    /// Radius of its poles, rad/s.
    pub bandwidth_rad_per_s: f64,
    /// Least phase margin at the corners, degrees.
    pub phase_margin_deg: f64,
    /// Largest feed, mm/min.
    pub max_feed_mm_per_min: f64,
}

impl TunedFigures {
    pub(super) fn new(report: &Report, max_feed_mm_per_min: f64) -> Self {
        Self {
            bandwidth_rad_per_s: report.bandwidth_rad_per_s,
            phase_margin_deg: report.worst.phase_deg,
            max_feed_mm_per_min,
        }
    }
}

/// A drive in a sentence.
pub(super) fn told(model: &DriveModel) -> String {
    format!(
        "the drive: {:.0} mm/min at full command, offset {:.2} %, friction {:.0} mm/min ({:.0} and {:.0} to break away), period \
         {:.1} ms, damping {:.2}, delay {:.1} ms, {:.2} m/s² at least",
        model.full_command_feed_mm_per_min,
        100.0 * model.offset,
        model.friction_forward_mm_per_min,
        model.breakaway_forward_mm_per_min,
        model.breakaway_backward_mm_per_min,
        1e3 * model.natural_period_s,
        model.damping,
        1e3 * model.delay_s,
        model.max_acceleration_m_s2,
    )
}
