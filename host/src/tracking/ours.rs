//! Our axis on a simulated machine: what a course comes to.
//!
//! Figures are of the encoder's true shaft against the setpoint. Before the course the axis makes a move there and back
//! over the index, so that its encoder map is in use: on a machine homing sees to that.

use leadscrew::axis::{Axis, Inputs, Outputs};
use leadscrew::encoder_map::EncoderMap;
use leadscrew::estimator::EstimatorConfig;
use leadscrew::estimator::observer::{Config, ObserverParams};
use leadscrew::hal::Encoder;
use leadscrew::params::AxisParams;
use leadscrew::setpoint::profile::{Limits, Profile};
use leadscrew::tuning::autotune::{AutotuneError, EstimatorChoice, Report, autotune};
use leadscrew::units::{AxisScale, Position};
use leadscrew_hal_mock::machine::{Machine, MachineParams};
use leadscrew_hal_mock::scenario::ScenarioError;
pub use leadscrew_hal_mock::scenario::model_of;

use crate::statistics::Spread;

/// What the axis is told to do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Course {
    /// A move there, a rest of 11 s, and back.
    Move {
        /// Distance, mm.
        distance_mm: f64,
        /// Feed, mm/min.
        feed_mm_per_min: f64,
    },
    /// Slow feed for 10 s.
    Creep {
        /// Feed, mm/min; negative backward.
        feed_mm_per_min: f64,
    },
}

/// What came of it.
#[derive(Clone, Copy, Debug, Default)]
pub struct TrackingFigures {
    /// Setpoint less shaft while a move runs, d.
    pub following: Spread,
    /// Setpoint less shaft from 100 ms after the end of a move on, until 1 s after it, d.
    pub standing: Spread,
    /// Peak to peak of the shaft over the 10 s after that, the larger of both ends of the way, d.
    pub rest_swing_d: f64,
    /// Setpoint less shaft over the creep, d; its start, half a d of way, is in `following`.
    pub creep: Spread,
    /// Peak to peak of the creep's error, d.
    pub creep_swing_d: f64,
    /// Peak to peak of the output over the last second of rest, of full command.
    pub output_swing: f64,
}

/// An axis on its machine.
#[derive(Clone, Debug)]
pub struct Rig<'m> {
    machine: Machine,
    axis: Axis<'m>,
    params: AxisParams,
    scale: AxisScale,
    outputs: Outputs,
    /// Where the shaft's origin lies in the axis's coordinate, d: that of the encoder map, or of the count.
    origin_d: f64,
}

/// Smallest and largest.
#[derive(Clone, Copy, Debug)]
struct Extent(f64, f64);

impl Extent {
    const NONE: Self = Self(f64::INFINITY, f64::NEG_INFINITY);

    const fn push(&mut self, value: f64) {
        self.0 = self.0.min(value);
        self.1 = self.1.max(value);
    }

    fn size(self) -> f64 {
        (self.1 - self.0).max(0.0)
    }
}

impl<'m> Rig<'m> {
    /// An axis with `params` and an encoder `map` on the machine `actual`, drawn by `seed`.
    ///
    /// # Errors
    /// A parameter out of range.
    pub fn new(
        actual: &MachineParams,
        params: &AxisParams,
        map: Option<EncoderMap<'m>>,
        seed: u64,
    ) -> Result<Self, ScenarioError> {
        let mut axis = Axis::new(params.validate()?);
        axis.set_map(map);
        Ok(Self {
            machine: Machine::new(actual, params.tick_hz, seed)?,
            axis,
            params: *params,
            scale: AxisScale::new(params.motion.counts_per_mm, params.tick_hz)?,
            outputs: Outputs::default(),
            origin_d: 0.0,
        })
    }

    /// Over the index and back, then `course`.
    ///
    /// # Errors
    /// A move that cannot be planned or queued.
    pub fn run(&mut self, course: &Course) -> Result<TrackingFigures, ScenarioError> {
        self.approach()?;
        let mut figures = TrackingFigures::default();
        match *course {
            Course::Move {
                distance_mm,
                feed_mm_per_min,
            } => {
                for way in [distance_mm, -distance_mm] {
                    self.travel(way, feed_mm_per_min, |_, error| {
                        figures.following.push(error);
                    })?;
                    self.stand(&mut figures);
                }
            }
            Course::Creep { feed_mm_per_min } => self.creep(feed_mm_per_min, &mut figures)?,
        }
        Ok(figures)
    }

    /// The error over the middle fifth of a move, where the feed is steady, d.
    ///
    /// # Errors
    /// A move that cannot be planned or queued.
    pub fn cruise(
        &mut self,
        distance_mm: f64,
        feed_mm_per_min: f64,
    ) -> Result<Spread, ScenarioError> {
        for _ in 0..self.ticks(0.2) {
            self.tick();
        }
        let mut errors = Vec::new();
        self.travel(distance_mm, feed_mm_per_min, |_, error| errors.push(error))?;
        let fifth = errors.len() / 5;
        Ok(errors[2 * fifth..3 * fifth].iter().copied().collect())
    }

    /// One tick; setpoint less shaft after it, d, and the shaft.
    pub fn tick(&mut self) -> (f64, f64) {
        self.machine
            .step(self.outputs.command, self.outputs.enabled);
        let inputs = Inputs::of(self.machine.capture(), true);
        self.outputs = *self.axis.step(&inputs);
        let shaft = self.machine.truth().shaft.position;
        let setpoint: f64 = self.outputs.setpoint.position.to_num();
        (setpoint - shaft - self.origin_d, shaft)
    }

    /// What the loop takes for the position, less the shaft's, d.
    fn misplaced(&self) -> f64 {
        let setpoint: f64 = self.outputs.setpoint.position.to_num();
        let error: f64 = self.outputs.following_error.to_num();
        setpoint - error - self.machine.truth().shaft.position
    }

    /// What the last tick gave.
    #[must_use]
    pub const fn outputs(&self) -> &Outputs {
        &self.outputs
    }

    /// The machine.
    #[must_use]
    pub const fn machine(&self) -> &Machine {
        &self.machine
    }

    /// The axis.
    #[must_use]
    pub const fn axis(&self) -> &Axis<'m> {
        &self.axis
    }

    fn ticks(&self, seconds: f64) -> u32 {
        (seconds * self.params.tick_hz) as u32
    }

    /// A revolution and a bit there and back, for the index.
    fn approach(&mut self) -> Result<(), ScenarioError> {
        for _ in 0..self.ticks(0.2) {
            self.tick();
        }
        for way in [APPROACH_MM, -APPROACH_MM] {
            let (mut sum, mut count) = (0.0, 0.0);
            self.travel(way, APPROACH_MM_PER_MIN, |rig, _| {
                sum += rig.misplaced();
                count += 1.0;
            })?;
            self.origin_d = sum / count;
            for _ in 0..self.ticks(1.0) {
                self.tick();
            }
        }
        Ok(())
    }

    /// A move of `way` mm; `take` gets the rig and the error after each of its ticks.
    fn travel(
        &mut self,
        way: f64,
        feed_mm_per_min: f64,
        mut take: impl FnMut(&Self, f64),
    ) -> Result<(), ScenarioError> {
        let motion = &self.params.motion;
        let limits = Limits::new(
            self.scale.velocity_from_feed(feed_mm_per_min)?,
            self.scale
                .acceleration_from_m_s2(motion.max_acceleration_m_s2),
            self.scale.jerk_from_m_s3(motion.max_jerk_m_s3),
        )?;
        let distance = Position::saturating_from_num(self.scale.counts_from_mm(way));
        let profile = Profile::plan(distance, &limits).map_err(ScenarioError::Plan)?;
        let notice = self.axis.notice_ticks();
        let start = self.outputs.tick.wrapping_add(notice);
        self.axis
            .queue(&profile, start)
            .map_err(ScenarioError::Queue)?;
        for _ in 1..notice {
            self.tick();
        }
        for _ in 0..profile.ticks() {
            let (error, _) = self.tick();
            take(self, error);
        }
        Ok(())
    }

    /// Eleven seconds at rest after a move.
    fn stand(&mut self, figures: &mut TrackingFigures) {
        let (mut place, mut output) = (Extent::NONE, Extent::NONE);
        let settled = self.ticks(0.1);
        let second = self.ticks(1.0);
        let all = self.ticks(11.0);
        for tick in 0..all {
            let (error, shaft) = self.tick();
            if tick < settled {
                figures.following.push(error);
            } else if tick < second {
                figures.standing.push(error);
            } else {
                place.push(shaft);
            }
            if tick >= all - second {
                output.push(self.outputs.command.to_num());
            }
        }
        figures.rest_swing_d = figures.rest_swing_d.max(place.size());
        figures.output_swing = figures.output_swing.max(output.size());
    }

    fn creep(
        &mut self,
        feed_mm_per_min: f64,
        figures: &mut TrackingFigures,
    ) -> Result<(), ScenarioError> {
        let velocity = self.scale.velocity_from_feed(feed_mm_per_min)?;
        let start = (START_D / velocity.abs()) as u32;
        let way = feed_mm_per_min / 60.0 * CREEP_S;
        let (mut tick, mut swing) = (0, Extent::NONE);
        self.travel(way, feed_mm_per_min.abs(), |_, error| {
            tick += 1;
            if tick < start {
                figures.following.push(error);
            } else {
                figures.creep.push(error);
                swing.push(error);
            }
        })?;
        figures.creep_swing_d = swing.size();
        Ok(())
    }
}

/// Way over the index, mm.
const APPROACH_MM: f64 = 12.0;
/// Feed on that way, mm/min.
const APPROACH_MM_PER_MIN: f64 = 1200.0;
/// Way of a creep that counts as its start, d.
const START_D: f64 = 0.5;
/// Time of a creep, s.
const CREEP_S: f64 = 10.0;

/// Our axis tuned on `machine` by [`autotune`], with an observer that counts on a learned map.
///
/// # Errors
/// Nothing that autotune could offer.
pub fn tuned_on(machine: &MachineParams) -> Result<(AxisParams, Report), AutotuneError> {
    let observer = EstimatorConfig::Observer(Config::of_16k20f3()?);
    let base = AxisParams {
        timer_hz: machine.encoder.encoder.timer_hz,
        ..AxisParams::new(observer)
    };
    let choice = EstimatorChoice::Observer(ObserverParams::default());
    autotune(&model_of(machine), &base, &choice)
}
