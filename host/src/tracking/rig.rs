//! An axis on its machine, tick by tick.
//!
//! Before anything is measured the axis makes a move there and back over the index, so that its encoder map is in use: on a
//! machine homing sees to that.

use leadscrew::axis::{Axis, Inputs, Outputs};
use leadscrew::encoder_map::EncoderMap;
use leadscrew::hal::Encoder;
use leadscrew::params::AxisParams;
use leadscrew::setpoint::profile::{Limits, Profile};
use leadscrew::units::{AxisScale, Position};
use leadscrew_hal_mock::machine::{Machine, MachineParams};
use leadscrew_hal_mock::scenario::ScenarioError;

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

    pub(super) const fn scale(&self) -> AxisScale {
        self.scale
    }

    pub(super) fn ticks(&self, seconds: f64) -> u32 {
        (seconds * self.params.tick_hz) as u32
    }

    /// A revolution and a bit there and back, for the index.
    pub(super) fn approach(&mut self) -> Result<(), ScenarioError> {
        self.rest(0.2, |_, _| ());
        for way in [APPROACH_MM, -APPROACH_MM] {
            let (mut sum, mut count) = (0.0, 0.0);
            self.travel(way, APPROACH_MM_PER_MIN, |rig, _| {
                sum += rig.misplaced();
                count += 1.0;
            })?;
            self.origin_d = sum / count;
            self.rest(DWELL_S, |_, _| ());
        }
        Ok(())
    }

    /// Stands for a time, s; `take` gets the rig and the error after each tick.
    pub(super) fn rest(&mut self, time_s: f64, mut take: impl FnMut(&Self, f64)) {
        for _ in 0..self.ticks(time_s) {
            let (error, _) = self.tick();
            take(self, error);
        }
    }

    /// A move of `way` mm; `take` gets the rig and the error after each of its ticks.
    pub(super) fn travel(
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
}

/// Way over the index, mm.
const APPROACH_MM: f64 = 12.0;
/// Feed on that way, mm/min.
const APPROACH_MM_PER_MIN: f64 = 1200.0;
/// Rest after it, s.
const DWELL_S: f64 = 1.2;
