//! Our own axis on a machine.

use leadscrew::axis::{Axis, Inputs, Outputs};
use leadscrew::encoder_map::EncoderMap;
use leadscrew::hal::Encoder;
use leadscrew::params::AxisParams;
use leadscrew::setpoint::profile::{Limits, Profile};
use leadscrew::units::{AxisScale, Position};
use leadscrew_hal_mock::machine::{Machine, MachineParams};
use leadscrew_hal_mock::scenario::ScenarioError;

use super::error::TrackingError;
use super::trace::{Tick, Trace};

/// Way over the index before a run, mm: the encoder map is then in use, as homing sees to on a machine.
const APPROACH_MM: f64 = 12.0;
/// Feed on that way, mm/min.
const APPROACH_MM_PER_MIN: f64 = 1200.0;
/// Rest between moves, s: the standing error is judged for a second.
const DWELL_S: f64 = 1.2;
/// Rest at the end of a run, s: limit cycles are looked for in 10 s.
const REST_S: f64 = 11.0;

/// An axis on its machine.
pub struct Rig<'m> {
    machine: Machine,
    axis: Axis<'m>,
    params: AxisParams,
    scale: AxisScale,
    outputs: Outputs,
    trace: Trace,
}

impl<'m> Rig<'m> {
    /// An axis of `params` with an encoder `map` on the machine `actual` drawn by `seed`, which has gone over the
    /// index and back.
    ///
    /// # Errors
    /// A parameter out of range, or a fault.
    pub fn new(
        params: &AxisParams,
        actual: &MachineParams,
        seed: u64,
        map: EncoderMap<'m>,
    ) -> Result<Self, TrackingError> {
        let mut axis = Axis::new(params.validate()?);
        axis.set_map(Some(map));
        let mut rig = Self {
            machine: Machine::new(actual, params.tick_hz, seed)?,
            axis,
            params: *params,
            scale: AxisScale::new(params.motion.counts_per_mm, params.tick_hz)?,
            outputs: Outputs::default(),
            trace: Trace::new(),
        };
        rig.rest(0.2)?;
        for way in [APPROACH_MM, -APPROACH_MM] {
            rig.travel(way, APPROACH_MM_PER_MIN)?;
            rig.rest(DWELL_S)?;
        }
        rig.trace.clear();
        Ok(rig)
    }

    /// A rest, a move by `way` mm, a rest, the way back, and a long rest.
    ///
    /// # Errors
    /// A move that cannot be planned, or a fault.
    pub fn there_and_back(
        mut self,
        way: f64,
        feed_mm_per_min: f64,
    ) -> Result<Trace, TrackingError> {
        self.rest(DWELL_S)?;
        self.travel(way, feed_mm_per_min)?;
        self.rest(DWELL_S)?;
        self.travel(-way, feed_mm_per_min)?;
        self.rest(REST_S)?;
        Ok(self.trace)
    }

    /// A rest and a move by `way` mm at a feed.
    ///
    /// # Errors
    /// A move that cannot be planned, or a fault.
    pub fn feed(mut self, way: f64, feed_mm_per_min: f64) -> Result<Trace, TrackingError> {
        self.rest(DWELL_S)?;
        self.travel(way, feed_mm_per_min)?;
        Ok(self.trace)
    }

    /// Stands for a time, s.
    fn rest(&mut self, time_s: f64) -> Result<(), TrackingError> {
        self.ticks((time_s * self.params.tick_hz) as u32)
    }

    fn travel(&mut self, way: f64, feed_mm_per_min: f64) -> Result<(), TrackingError> {
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
        self.ticks(notice + profile.ticks() - 1)
    }

    fn ticks(&mut self, ticks: u32) -> Result<(), TrackingError> {
        for _ in 0..ticks {
            self.machine
                .step(self.outputs.command, self.outputs.enabled);
            let inputs = Inputs::of(self.machine.capture(), true);
            self.outputs = *self.axis.step(&inputs);
            if let Some(fault) = self.outputs.fault {
                return Err(TrackingError::Fault {
                    fault,
                    tick: self.outputs.tick,
                });
            }
            self.trace.push(self.tick());
        }
        Ok(())
    }

    fn tick(&self) -> Tick {
        let truth = self.machine.truth();
        let setpoint: f64 = self.outputs.setpoint.position.to_num();
        let behind: f64 = self.outputs.following_error.to_num();
        Tick {
            setpoint,
            shaft: truth.shaft.position,
            seen: setpoint - behind,
            carriage: truth.carriage.position,
            command: self.outputs.command.to_num(),
        }
    }
}
