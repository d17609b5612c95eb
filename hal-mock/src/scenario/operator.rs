//! The person at the panel: plans what is asked of the axis, outside the tick.

use leadscrew::axis::{Axis, Outputs};
use leadscrew::params::AxisParams;
use leadscrew::setpoint::profile::{Limits, Profile};
use leadscrew::units::{AxisScale, Position, checked};

use super::action::Ask;
use super::error::ScenarioError;

/// Farthest position and longest move, mm.
const MAX_TRAVEL_MM: f64 = 1e6;

/// What the operator knows.
#[derive(Clone, Debug)]
pub struct Operator {
    params: AxisParams,
    scale: AxisScale,
    /// Where the axis stood in its first tick, d.
    origin: Option<Position>,
    enable: bool,
}

impl Operator {
    /// An operator of the axis of `params`, who has not enabled it.
    ///
    /// # Errors
    /// A resolution or a rate out of range.
    pub fn new(params: &AxisParams) -> Result<Self, ScenarioError> {
        let scale = AxisScale::new(params.motion.counts_per_mm, params.tick_hz)?;
        Ok(Self {
            params: *params,
            scale,
            origin: None,
            enable: false,
        })
    }

    /// Takes note of where the axis stands in its first tick.
    pub fn look(&mut self, outputs: &Outputs) {
        self.origin.get_or_insert(outputs.setpoint.position);
    }

    /// The axis is to be under control.
    #[must_use]
    pub const fn enables(&self) -> bool {
        self.enable
    }

    /// Has `ask` done from tick `tick` on, the next one.
    ///
    /// # Errors
    /// The axis, or the planner, refuses it; the axis goes on as it was.
    pub fn ask(&mut self, ask: &Ask, tick: u32, axis: &mut Axis<'_>) -> Result<(), ScenarioError> {
        match *ask {
            Ask::Enable => self.enable = true,
            Ask::Disable => self.enable = false,
            Ask::ClearFault => axis.clear_fault().map_err(ScenarioError::Clear)?,
            Ask::ClearWarnings => axis.supervisor_mut().clear_warnings(),
            Ask::MoveTo {
                position_mm,
                feed_mm_per_min,
            } => {
                let origin = self.origin.unwrap_or_default();
                let target = origin.saturating_add(self.distance("position_mm", position_mm)?);
                let way = target.saturating_sub(axis.outputs().setpoint.position);
                self.start(way, feed_mm_per_min, tick, axis)?;
            }
            Ask::MoveBy {
                distance_mm,
                feed_mm_per_min,
            } => {
                let way = self.distance("distance_mm", distance_mm)?;
                self.start(way, feed_mm_per_min, tick, axis)?;
            }
        }
        Ok(())
    }

    fn distance(&self, name: &'static str, mm: f64) -> Result<Position, ScenarioError> {
        let mm = checked(name, mm, -MAX_TRAVEL_MM, MAX_TRAVEL_MM)?;
        Ok(Position::saturating_from_num(self.scale.counts_from_mm(mm)))
    }

    fn start(
        &self,
        way: Position,
        feed_mm_per_min: f64,
        tick: u32,
        axis: &mut Axis<'_>,
    ) -> Result<(), ScenarioError> {
        let profile =
            Profile::plan(way, &self.limits(feed_mm_per_min)?).map_err(ScenarioError::Plan)?;
        axis.queue(&profile, tick).map_err(ScenarioError::Queue)
    }

    /// Limits of a move at `feed_mm_per_min`.
    fn limits(&self, feed_mm_per_min: f64) -> Result<Limits, ScenarioError> {
        let motion = &self.params.motion;
        let fastest = motion.max_feed_mm_per_min;
        let feed = match checked("feed_mm_per_min", feed_mm_per_min, 0.0, fastest)? {
            0.0 => fastest,
            feed => feed,
        };
        Ok(Limits::new(
            self.scale.velocity_from_feed(feed)?,
            self.scale
                .acceleration_from_m_s2(motion.max_acceleration_m_s2),
            self.scale.jerk_from_m_s3(motion.max_jerk_m_s3),
        )?)
    }
}
