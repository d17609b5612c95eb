//! The figures of a machine, as they are told.

use serde::Serialize;

use super::board::BoardVerdict;
use super::cycle::{Kinematics, Limit, RationalCycle};

/// All figures of a machine.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MachinePlan {
    /// Its name.
    pub machine: String,
    /// Where its data are from.
    pub source: Option<String>,
    /// Tick rate, Hz.
    pub tick_hz: f64,
    /// Chord error allowed, d.
    pub allowed_d: f64,
    /// Its linear axes.
    pub axes: Vec<AxisPlan>,
    /// Its spindles.
    pub spindles: Vec<SpindlePlan>,
    /// Of its linear axes the largest of everything.
    pub largest: Kinematics,
    /// The rational cycle of all of them.
    pub cycle: RationalCycle,
    /// Where the firmware runs at that.
    pub boards: Vec<BoardVerdict>,
}

/// Figures of a linear axis.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct AxisPlan {
    /// Its name.
    pub name: String,
    /// What no source says.
    pub assumed: Option<String>,
    /// Limits and resolution.
    pub kinematics: Kinematics,
    /// Overload at the largest acceleration, g, and the other end of its range where there is one.
    pub overload_g: f64,
    /// The other end of the overload's range where a source gives one, g.
    pub least_overload_g: Option<f64>,
    /// One discrete, mm (P1, 8).
    pub discrete_mm: f64,
    /// What measures it.
    pub encoder: EncoderPlan,
    /// Velocity at the largest feed, d/tick (P1, 3), which is the step H of a cycle, d (P3, 2).
    pub velocity_d_per_tick: f64,
    /// Largest acceleration, d/tick² (P1, 4).
    pub acceleration_d_per_tick2: f64,
    /// Largest jerk, d/tick³.
    pub jerk_d_per_tick3: Option<f64>,
    /// Radius below which jerk rules and above which acceleration does, R*, mm.
    pub crossover_radius_mm: Option<f64>,
    /// Radius from which on the largest feed is allowed, mm.
    pub full_feed_radius_mm: f64,
    /// What holds the feed down right below it.
    pub full_feed_limit: Limit,
    /// Its rational cycle.
    pub cycle: RationalCycle,
    /// Radius by radius.
    pub contours: Vec<Contour>,
}

/// Edges at the largest feed or speed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct EncoderPlan {
    /// The encoder, if one is told.
    pub name: Option<String>,
    /// Its lines, Z.
    pub lines: Option<f64>,
    /// Its speed, rpm.
    pub rpm: Option<f64>,
    /// Its highest speed, rpm.
    pub max_rpm: Option<f64>,
    /// Frequency of a channel, Hz (P1, 5).
    pub line_hz: f64,
    /// Edges of both channels, Hz: four times that.
    pub edge_hz: f64,
    /// Highest frequency of a channel f_I, Hz.
    pub max_line_hz: f64,
    /// Whether that is the encoder's own; else it is the one asked with.
    pub is_max_line_own: bool,
    /// Most lines that f_I leaves (P1, 6 and 7).
    pub largest_lines: Option<f64>,
    /// Whether it is slow enough for the encoder.
    pub is_within: bool,
}

/// A contour of one radius at its allowed feed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Contour {
    /// Radius, mm.
    pub radius_mm: f64,
    /// Feed that the acceleration allows, mm/min (P3, 9).
    pub feed_by_acceleration_mm_per_min: f64,
    /// Feed that the jerk allows, mm/min (P3, 11).
    pub feed_by_jerk_mm_per_min: Option<f64>,
    /// Feed allowed, mm/min.
    pub feed_mm_per_min: f64,
    /// What holds it there.
    pub limit: Limit,
    /// Step of a tick, d (P3, 2).
    pub step_d: f64,
    /// Chord error of a tick, d (P3, 1); none where a tick goes further than across the circle.
    pub chord_error_d: Option<f64>,
    /// Least frequency for the allowed chord error, Hz (P3, 4).
    pub frequency_hz: f64,
}

/// Figures of a spindle.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SpindlePlan {
    /// Its name.
    pub name: String,
    /// What no source says.
    pub assumed: Option<String>,
    /// Highest speed, rpm.
    pub max_rpm: f64,
    /// Discretes of a turn.
    pub counts_per_revolution: f64,
    /// What measures it.
    pub encoder: EncoderPlan,
    /// Velocity at the highest speed, d/tick.
    pub velocity_d_per_tick: f64,
}
