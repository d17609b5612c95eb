//! The person at the panel: plans what is asked of the axis, outside the tick.

use leadscrew::axis::{Axis, Request};
use leadscrew::identification::program::{Bounds, Program, Segment, command};
use leadscrew::params::{AxisConfig, AxisParams};
use leadscrew::probe::ProbeOrder;
use leadscrew::setpoint::planner::{Planner, Timed};
use leadscrew::setpoint::sources::Source;
use leadscrew::setpoint::thread::{ThreadOrder, ThreadPhase};
use leadscrew::setpoint::travel::TravelLimits;
use leadscrew::supervisor::State;
use leadscrew::telemetry::Record;
use leadscrew::units::{AxisScale, Position, Velocity, checked};

use super::action::{Ask, Pulse};
use super::error::ScenarioError;

/// Farthest position and longest move, mm.
const MAX_TRAVEL_MM: f64 = 1e6;

/// What the operator knows of the axis, as the last tick left it.
#[derive(Clone, Copy, Debug, Default)]
pub struct Seen {
    /// Where it is told to be, d.
    pub commanded: Position,
    /// The raw position of coordinate 0, if it is homed.
    pub origin: Option<Position>,
    /// It follows its plans, or could: nothing else moves it.
    pub is_planned: bool,
}

impl Seen {
    /// What a record tells, of an axis that only plans move and that is not homed.
    #[must_use]
    pub fn in_record(record: &Record) -> Self {
        let state = record.state();
        Self {
            commanded: Position::from_bits(record.setpoint_position),
            origin: None,
            is_planned: state == State::Ready as u8 || state == State::Moving as u8,
        }
    }

    /// What there is to see of `axis`.
    #[must_use]
    pub fn of(axis: &Axis<'_>) -> Self {
        let in_control = matches!(axis.outputs().state, State::Ready | State::Moving);
        Self {
            commanded: axis.commanded().position,
            origin: axis.homing().origin(),
            is_planned: in_control
                && !axis.homing().is_active()
                && !axis.probe().is_active()
                && axis.source() == Source::Trajectory
                && axis.thread_phase() == ThreadPhase::Idle
                && axis.experiment().is_none(),
        }
    }
}

/// What comes of what is asked.
#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(
    clippy::large_enum_variant,
    reason = "it lives for a moment, and there is no heap"
)]
pub enum Order {
    /// The axis is to be under control, or not.
    Enable(bool),
    /// A request to the axis.
    Axis(Request),
    /// Nothing for now: it is remembered.
    Nothing,
}

/// The operator.
#[derive(Clone, Debug)]
pub struct Operator {
    scale: AxisScale,
    fastest: f64,
    planner: Planner,
    /// Where the axis stood in its first tick, d.
    start: Option<Position>,
    /// Something else than the planner's plans moved the axis.
    is_stale: bool,
}

impl Operator {
    /// An operator of the axis of `params` and `config`, who has not enabled it.
    ///
    /// # Errors
    /// A resolution or a rate out of range.
    pub fn new(params: &AxisParams, config: &AxisConfig) -> Result<Self, ScenarioError> {
        let mut planner = Planner::new(config.limits, Position::ZERO, 0);
        planner.set_notice(config.controller.notice_ticks());
        Ok(Self {
            scale: AxisScale::new(params.motion.counts_per_mm, params.tick_hz)?,
            fastest: params.motion.max_feed_mm_per_min,
            planner,
            start: None,
            is_stale: true,
        })
    }

    /// Looks at the axis after every tick.
    pub fn look(&mut self, seen: &Seen) {
        self.start.get_or_insert(seen.commanded);
        self.is_stale |= !seen.is_planned;
    }

    /// What is to be done for `ask` at tick `start`, the next one or later.
    ///
    /// # Errors
    /// The planner refuses it; the axis goes on as it was.
    pub fn order(&mut self, ask: &Ask, start: u32, seen: &Seen) -> Result<Order, ScenarioError> {
        if self.is_stale && seen.is_planned {
            self.planner.begin(seen.commanded, start.wrapping_sub(1));
            self.is_stale = false;
        }
        let planned = match *ask {
            Ask::Enable => return Ok(Order::Enable(true)),
            Ask::Disable => return Ok(Order::Enable(false)),
            Ask::ClearFault => return Ok(Order::Axis(Request::ClearFault)),
            Ask::ClearWarnings => return Ok(Order::Axis(Request::ClearWarnings)),
            Ask::Home => return Ok(Order::Axis(Request::Home)),
            Ask::Probe {
                towards_mm,
                feed_mm_per_min,
                retract_mm,
            } => {
                return Ok(Order::Axis(Request::Probe(ProbeOrder {
                    target: self.raw(seen, "towards_mm", towards_mm)?,
                    feed: self.feed(feed_mm_per_min)?,
                    retract: self.distance("retract_mm", retract_mm)?,
                })));
            }
            Ask::Select(source) => return Ok(Order::Axis(Request::Select(source))),
            Ask::Engage(engaged) => return Ok(Order::Axis(Request::Engage(engaged))),
            Ask::ArmThread(order) => {
                return Ok(Order::Axis(Request::ArmThread(self.placed(&order, seen))));
            }
            Ask::Experiment(pulse) => {
                let program = self.program(&pulse)?;
                return Ok(Order::Axis(Request::StartExperiment(program)));
            }
            Ask::EndExperiment => return Ok(Order::Axis(Request::ReleaseExperiment)),
            Ask::SetTravel { low_mm, high_mm } => {
                let low = self.raw(seen, "low_mm", low_mm)?;
                let high = self.raw(seen, "high_mm", high_mm)?;
                let travel = Some(TravelLimits::new(low, high).map_err(ScenarioError::Travel)?);
                self.planner.set_travel(travel);
                return Ok(Order::Axis(Request::Travel(travel)));
            }
            Ask::MoveTo {
                position_mm,
                feed_mm_per_min,
            } => {
                let target = self.raw(seen, "position_mm", position_mm)?;
                self.planner
                    .move_to(target, self.feed(feed_mm_per_min)?, start)
            }
            Ask::MoveBy {
                distance_mm,
                feed_mm_per_min,
            } => {
                let from = self.planner.target();
                let from = from.unwrap_or_else(|| self.planner.state_at(start).position());
                let target = from.saturating_add(self.distance("distance_mm", distance_mm)?);
                self.planner
                    .move_to(target, self.feed(feed_mm_per_min)?, start)
            }
            Ask::Jog { feed_mm_per_min } => {
                let feed = self.feed(feed_mm_per_min.max(-feed_mm_per_min))?;
                let velocity = if feed_mm_per_min < 0.0 { -feed } else { feed };
                self.planner.jog(velocity, start)
            }
            Ask::Hold => self.planner.hold(start),
            Ask::Resume => self.planner.resume(start),
            Ask::Override { percent } => self.planner.set_override(percent, start),
            Ask::Stop => self.planner.stop(start),
        };
        let as_request = |Timed { plan, start }| Order::Axis(Request::Queue { plan, start });
        planned
            .map(|timed| timed.map_or(Order::Nothing, as_request))
            .map_err(ScenarioError::Planner)
    }

    /// The axis refused the order: what was planned for it does not count.
    pub fn withdraw(&mut self, order: &Order) {
        if matches!(order, Order::Axis(Request::Queue { .. })) {
            self.planner.withdraw();
        }
    }

    /// A pass whose positions are from the origin of the axis: that of homing, or raw position 0.
    fn placed(&self, order: &ThreadOrder, seen: &Seen) -> ThreadOrder {
        let start = match seen.origin {
            Some(_) => Position::ZERO,
            None => self.start.unwrap_or_default(),
        };
        let from_raw = |mm| mm + self.scale.mm_from_counts(start.to_num());
        ThreadOrder {
            start_mm: from_raw(order.start_mm),
            from_mm: from_raw(order.from_mm),
            to_mm: from_raw(order.to_mm),
            ..*order
        }
    }

    /// The raw position of a coordinate.
    fn raw(&self, seen: &Seen, name: &'static str, mm: f64) -> Result<Position, ScenarioError> {
        let origin = seen.origin.or(self.start).unwrap_or_default();
        Ok(origin.saturating_add(self.distance(name, mm)?))
    }

    fn distance(&self, name: &'static str, mm: f64) -> Result<Position, ScenarioError> {
        let mm = checked(name, mm, -MAX_TRAVEL_MM, MAX_TRAVEL_MM)?;
        Ok(Position::saturating_from_num(self.scale.counts_from_mm(mm)))
    }

    /// The program of an experiment, no faster than the axis may go.
    fn program(&self, pulse: &Pulse) -> Result<Program, ScenarioError> {
        let ticks = |seconds: f64| (seconds * self.scale.tick_hz()) as u32;
        let (length, rest) = (ticks(pulse.length_s), ticks(pulse.rest_s));
        let segments = [Segment::level(pulse.level, length), Segment::rest(rest)];
        let bounds = Bounds {
            window_d: self.scale.counts_from_mm(pulse.window_mm) as u32,
            speed_d_per_tick: libm::ceil(self.scale.velocity_from_feed(self.fastest)?) as u32,
            ticks: length.saturating_add(rest).saturating_add(1),
            command: command(pulse.level.max(-pulse.level)),
        };
        let program = Program::new(&segments, bounds);
        Ok(if pulse.is_closed {
            program.closed()
        } else {
            program
        })
    }

    /// A feed; 0 stands for the largest.
    fn feed(&self, feed_mm_per_min: f64) -> Result<Velocity, ScenarioError> {
        let feed = match checked("feed_mm_per_min", feed_mm_per_min, 0.0, self.fastest)? {
            0.0 => self.fastest,
            feed => feed,
        };
        let velocity = self.scale.velocity_from_feed(feed)?;
        Ok(Velocity::saturating_from_num(velocity))
    }
}
