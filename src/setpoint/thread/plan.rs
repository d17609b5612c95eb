//! Planning of a pass, outside the tick.
//!
//! With c the count of the spindle, C counts a revolution and c₀ = index + C·(θ₀/360° + k/starts), the line is
//! x = L/C·(c − c₀). The run-in follows the spindle by a [weight](crate::setpoint::run_up) that goes from 0 to 1 over
//! the angle R: it makes half of the way that the line makes, so it ends on the line wherever it began with
//! x_start = L/C·(c_s + R/2 − c₀). That fixes c_s, up to whole revolutions, whatever the speed and however it changes.

use super::order::{SpindleWay, ThreadFigures, ThreadOrder, ThreadParams, ThreadRefusal};
use super::reach::{Reach, Standing};
use crate::estimator::saturate;
use crate::parameter_table::ParameterTable;
use crate::setpoint::master::Master;
use crate::setpoint::profile::{Limits, Profile};
use crate::setpoint::ratio::Factor;
use crate::setpoint::run_up;
use crate::units::{AxisScale, Position, RangeError, Velocity, checked};

/// Fractional bits of the slope of the line.
pub(super) const SLOPE_FRAC: u32 = 48;
/// Fractional bits of 1/R, R in 2⁻¹⁶ d.
pub(super) const PER_RAMP_FRAC: u32 = 78;
/// Shortest run-in, d of the spindle; its reciprocal then fits.
const LEAST_RAMP: f64 = 16.0;
/// Slowest spindle that is taken for turning, d/tick.
const LEAST_SPEED: f64 = 0.01;

/// What the axis is, for planning.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Config {
    scale: AxisScale,
    limits: Limits,
    params: ThreadParams,
}

impl ThreadParams {
    /// Validates, for an axis with `limits`.
    ///
    /// # Errors
    /// [`RangeError`] naming the parameter that is out of range.
    pub fn quantise(&self, scale: AxisScale, limits: Limits) -> Result<Config, RangeError> {
        self.check()?;
        Ok(Config {
            scale,
            limits,
            params: *self,
        })
    }
}

/// A pass, quantised. Angles are d of the spindle from where the run-in begins, counted the way it turns, Q.16.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Plan {
    /// 1 or −1: the way that the spindle turns.
    pub(super) way: i64,
    /// Where the run-in begins, d of the spindle, Q.16.
    pub(super) begin: i64,
    /// A revolution.
    pub(super) turn: i64,
    /// Where the axis waits.
    pub(super) start: Position,
    /// Where the axis comes to rest.
    pub(super) rest: Position,
    /// d of the axis for each d of the spindle along its way, Q.48.
    pub(super) slope: i64,
    /// The same for the spindle's own direction, for velocity and acceleration.
    pub(super) factor: Factor,
    /// R, of run-in and run-out.
    pub(super) ramp: i64,
    /// 2⁷⁸ over that.
    pub(super) per_ramp: i64,
    /// The way of the line over R, Q.16 d.
    pub(super) ramp_way: i64,
    /// Where retraction is requested, and where the run-out begins.
    pub(super) retract: i64,
    pub(super) end: i64,
    /// Slowest and fastest spindle, 2⁻²⁰ d/tick.
    pub(super) speeds: (i32, i32),
    /// Ticks at rest before the run-in.
    pub(super) settle: u32,
    /// To the far end of the take-up, and from there to the start.
    pub(super) approach: [Profile; 2],
}

/// What a pass comes to in d and ticks before it is quantised.
struct Sketch {
    /// d of the spindle a tick, along its way.
    speed: f64,
    fastest: f64,
    /// d of the axis for each d of the spindle along its way.
    slope: f64,
    per_turn: f64,
    ramp: f64,
}

impl Config {
    /// Plans the pass `order` for an axis that stands as `standing` says, by the spindle as it turns now.
    ///
    /// # Errors
    /// [`ThreadRefusal`] with the figures that it is about.
    pub fn plan(
        &self,
        order: &ThreadOrder,
        master: &Master,
        standing: &Standing,
    ) -> Result<(Plan, ThreadFigures), ThreadRefusal> {
        order.check()?;
        let way = match order.spindle {
            SpindleWay::Forward => 1.0,
            SpindleWay::Backward => -1.0,
        };
        let index = self.turning(master, way)?;
        let sketch = self.sketch(order, master, way)?;
        let figures = self.figures(order, &sketch)?;

        let start_d = self.scale.counts_from_mm(order.start_mm);
        let start = standing.origin.saturating_add(position(start_d));
        let direction = if sketch.slope < 0.0 { -1.0 } else { 1.0 };
        let take_up = self.scale.counts_from_mm(self.params.thread_take_up_mm) * direction;
        let take_up = start.saturating_sub(position(take_up));

        let part = order.angle_deg / 360.0 + f64::from(order.start) / f64::from(order.starts);
        // From the index, so that nothing is lost after many revolutions.
        let begin = part * sketch.per_turn + way * (start_d / sketch.slope - sketch.ramp / 2.0);
        let length = self.scale.counts_from_mm(order.to_mm - order.start_mm) / sketch.slope;
        let end = length + sketch.ramp / 2.0;
        let retract = end - order.retract_deg / 360.0 * sketch.per_turn;
        let ramp_way = fixed(sketch.slope * sketch.ramp, Position::FRAC_NBITS);
        let leg = |from: Position, to: Position| {
            Profile::plan(to.saturating_sub(from), &self.limits).map_err(ThreadRefusal::Approach)
        };
        let mut plan = Plan {
            way: way as i64,
            begin: index
                .wrapping_shl(Position::FRAC_NBITS)
                .wrapping_add(fixed(begin, Position::FRAC_NBITS)),
            turn: master.per_turn().wrapping_shl(Position::FRAC_NBITS),
            start,
            rest: Position::ZERO,
            slope: fixed(sketch.slope, SLOPE_FRAC),
            factor: Factor::new(sketch.slope * way),
            ramp: fixed(sketch.ramp, Position::FRAC_NBITS),
            per_ramp: fixed(1.0 / sketch.ramp, PER_RAMP_FRAC - Position::FRAC_NBITS),
            ramp_way,
            retract: fixed(retract, Position::FRAC_NBITS),
            end: fixed(end, Position::FRAC_NBITS),
            speeds: (
                velocity(sketch.speed * (1.0 - self.params.thread_speed_drop)),
                velocity(sketch.fastest),
            ),
            settle: (self.params.thread_settle_s * self.scale.tick_hz()) as u32,
            approach: [leg(standing.position, take_up)?, leg(take_up, start)?],
        };
        plan.rest = plan
            .line(plan.end)
            .saturating_add(Position::from_bits(ramp_way.wrapping_shr(1)));
        if let Some(travel) = &standing.travel {
            let rest = plan.rest;
            let reach = Reach {
                take_up,
                start,
                rest,
            };
            reach.check(travel, standing.origin, self.scale)?;
        }
        plan.bring_ahead(master);
        Ok((plan, figures))
    }

    /// The place of the index of a spindle that turns as it should.
    fn turning(&self, master: &Master, way: f64) -> Result<i64, ThreadRefusal> {
        if !master.is_present() {
            return Err(ThreadRefusal::NoSignal);
        }
        let speed = master.estimate().velocity.to_num::<f64>() * way;
        if libm::fabs(speed) < LEAST_SPEED {
            return Err(ThreadRefusal::SpindleStands);
        }
        if speed < 0.0 {
            return Err(ThreadRefusal::WrongWay);
        }
        master
            .index()
            .filter(|index| index.is_forward == (way > 0.0))
            .map(|index| index.place)
            .ok_or(ThreadRefusal::NoIndex)
    }

    /// Slope and run-in at the fastest speed that is allowed for.
    fn sketch(
        &self,
        order: &ThreadOrder,
        master: &Master,
        way: f64,
    ) -> Result<Sketch, ThreadRefusal> {
        let per_turn = master.per_turn() as f64;
        let lead = self.scale.counts_from_mm(order.lead_mm) / per_turn;
        checked("d of the axis for a d of the spindle", lead, 1e-5, 1000.0)?;
        let slope = if order.to_mm < order.start_mm {
            -lead
        } else {
            lead
        };
        let speed = master.estimate().velocity.to_num::<f64>() * way;
        let fastest = speed * (1.0 + self.params.thread_speed_rise);
        let share = self.params.thread_limit_share;
        let ticks = run_up::ticks(
            lead * fastest,
            self.limits.acceleration().to_num::<f64>() * share,
            self.limits.jerk().to_num::<f64>() * share,
        );
        Ok(Sketch {
            speed,
            fastest,
            slope,
            per_turn,
            ramp: (ticks * fastest).max(LEAST_RAMP),
        })
    }

    /// What the pass needs, against what there is.
    fn figures(
        &self,
        order: &ThreadOrder,
        sketch: &Sketch,
    ) -> Result<ThreadFigures, ThreadRefusal> {
        let lead = libm::fabs(sketch.slope);
        let rpm = sketch.speed * self.scale.tick_hz() * 60.0 / sketch.per_turn;
        let largest = self.limits.velocity().to_num::<f64>();
        if lead * sketch.fastest > largest {
            return Err(ThreadRefusal::TooFast {
                feed_mm_per_min: self.scale.feed_from_velocity(lead * sketch.fastest),
                max_feed_mm_per_min: self.scale.feed_from_velocity(largest),
                rpm,
                max_rpm: rpm * largest / (lead * sketch.fastest),
            });
        }
        let settle = self.params.thread_settle_s * self.scale.tick_hz() * sketch.fastest;
        let needed_mm = self
            .scale
            .mm_from_counts(lead * (sketch.ramp / 2.0 + settle));
        let available_mm = libm::fabs(order.from_mm - order.start_mm);
        if needed_mm > available_mm {
            return Err(ThreadRefusal::RunInTooShort {
                needed_mm,
                available_mm,
            });
        }
        let run_out_mm = self.scale.mm_from_counts(sketch.slope * sketch.ramp / 2.0);
        Ok(ThreadFigures {
            rpm,
            feed_mm_per_min: self.scale.feed_from_velocity(lead * sketch.speed),
            run_in_mm: needed_mm,
            rest_mm: order.to_mm + run_out_mm,
        })
    }
}

impl Plan {
    /// The way from where the axis stood to the far end of the take-up.
    #[must_use]
    pub const fn first_leg(&self) -> &Profile {
        let [first, _] = &self.approach;
        first
    }

    /// The line at an angle from where the run-in begins.
    pub(super) fn line(&self, angle: i64) -> Position {
        let along = i128::from(angle.wrapping_sub(self.ramp.wrapping_shr(1)));
        let way = along
            .wrapping_mul(i128::from(self.slope))
            .wrapping_shr(SLOPE_FRAC);
        self.start.wrapping_add(Position::from_bits(way as i64))
    }

    /// Puts the begin less than a revolution ahead of the spindle.
    fn bring_ahead(&mut self, master: &Master) {
        let past = master
            .estimate()
            .position
            .to_bits()
            .wrapping_sub(self.begin)
            .wrapping_mul(self.way);
        let turns = past.div_euclid(self.turn.max(1)).wrapping_add(1);
        self.begin = self
            .begin
            .wrapping_add(turns.wrapping_mul(self.turn).wrapping_mul(self.way));
    }
}

/// `value`·2^`frac`, to nearest; saturates.
fn fixed(value: f64, frac: u32) -> i64 {
    libm::round(libm::ldexp(value, frac.cast_signed())) as i64
}

// Not `saturating_from_num`, which panics on NaN.
fn position(value: f64) -> Position {
    Position::from_bits(fixed(value, Position::FRAC_NBITS))
}

fn velocity(value: f64) -> i32 {
    saturate(fixed(value, Velocity::FRAC_NBITS))
}
