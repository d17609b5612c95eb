//! What P1 (3 to 8) and P3 say of a machine of the catalogue.

use leadscrew::units::{
    AxisScale, RangeError, TICK_HZ, checked, line_frequency_hz, lines_for_feed, lines_for_rotation,
};
use leadscrew_app::input_filter::line_hz;

use super::board::boards;
use super::catalogue::{FittedEncoder, Machine, MachineAxis, Spindle};
use super::cycle::{Kinematics, RADIUS_MM, chord_error_d, frequency_hz, step_d};
use super::results::{AxisPlan, Contour, EncoderPlan, MachinePlan, SpindlePlan};

/// What the figures are asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct Question {
    /// Tick rate, Hz.
    pub tick_hz: f64,
    /// Chord error allowed, d.
    pub allowed_d: f64,
    /// Highest frequency of a channel where the encoder's is not known, Hz.
    pub max_line_hz: f64,
    /// Radii of contours, mm.
    pub radii_mm: Vec<f64>,
}

impl Default for Question {
    fn default() -> Self {
        Self {
            tick_hz: 1000.0,
            allowed_d: 1.0,
            max_line_hz: 300e3,
            radii_mm: vec![0.25, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0],
        }
    }
}

impl Question {
    fn check(&self) -> Result<(), RangeError> {
        checked("tick_hz", self.tick_hz, TICK_HZ.0, TICK_HZ.1)?;
        for radius in &self.radii_mm {
            checked("radius_mm", *radius, RADIUS_MM.0, RADIUS_MM.1)?;
        }
        Ok(())
    }

    /// The figures of a machine.
    ///
    /// # Errors
    /// [`RangeError`] for a tick rate, radius, line frequency or chord error out of range, or a machine without an axis.
    pub fn machine(&self, machine: &Machine) -> Result<MachinePlan, RangeError> {
        self.check()?;
        let kinematics: Vec<_> = machine.axes.iter().map(|axis| axis.kinematics).collect();
        let no_axes = RangeError {
            name: "axes",
            value: 0.0,
            min: 1.0,
            max: f64::INFINITY,
        };
        let largest = Kinematics::largest(&kinematics).ok_or(no_axes)?;
        let cycle = largest.rational_cycle(self.allowed_d)?;
        Ok(MachinePlan {
            machine: machine.name.clone(),
            source: machine.source.clone(),
            tick_hz: self.tick_hz,
            allowed_d: self.allowed_d,
            axes: machine
                .axes
                .iter()
                .map(|axis| self.axis(axis))
                .collect::<Result<_, _>>()?,
            spindles: machine
                .spindles
                .iter()
                .map(|spindle| self.spindle(spindle))
                .collect::<Result<_, _>>()?,
            largest,
            cycle,
            boards: boards()
                .iter()
                .map(|board| board.verdict_from(&kinematics, cycle.frequency_hz))
                .collect(),
        })
    }

    /// The figures of one axis.
    ///
    /// # Errors
    /// As of [`Self::machine`].
    pub fn axis(&self, axis: &MachineAxis) -> Result<AxisPlan, RangeError> {
        let kinematics = axis.kinematics;
        let scale = AxisScale::new(kinematics.counts_per_mm(), self.tick_hz)?;
        let feed = kinematics.max_feed_mm_per_min();
        let (full_feed_radius_mm, full_feed_limit) = kinematics.full_feed_radius_mm();
        Ok(AxisPlan {
            name: axis.name.clone(),
            assumed: axis.assumed.clone(),
            kinematics,
            overload_g: axis.overload_g(),
            least_overload_g: axis.least_overload_g,
            discrete_mm: scale.mm_from_counts(1.0),
            encoder: self.axis_encoder(&kinematics, axis.encoder.as_ref())?,
            velocity_d_per_tick: scale.velocity_from_feed(feed)?,
            acceleration_d_per_tick2: scale
                .acceleration_from_m_s2(kinematics.max_acceleration_m_s2()),
            jerk_d_per_tick3: kinematics
                .max_jerk_m_s3()
                .map(|jerk| scale.jerk_from_m_s3(jerk)),
            crossover_radius_mm: kinematics.crossover_radius_mm(),
            full_feed_radius_mm,
            full_feed_limit,
            cycle: kinematics.rational_cycle(self.allowed_d)?,
            contours: self
                .radii_mm
                .iter()
                .map(|radius| self.contour(&kinematics, *radius))
                .collect(),
        })
    }

    fn contour(&self, axis: &Kinematics, radius_mm: f64) -> Contour {
        let (feed, limit) = axis.allowed_feed(radius_mm);
        let counts_per_mm = axis.counts_per_mm();
        Contour {
            radius_mm,
            feed_by_acceleration_mm_per_min: axis.feed_by_acceleration(radius_mm),
            feed_by_jerk_mm_per_min: axis.feed_by_jerk(radius_mm),
            feed_mm_per_min: feed,
            limit,
            step_d: step_d(feed, counts_per_mm, self.tick_hz),
            chord_error_d: chord_error_d(feed, radius_mm, counts_per_mm, self.tick_hz),
            frequency_hz: frequency_hz(feed, radius_mm, counts_per_mm, self.allowed_d),
        }
    }

    fn axis_encoder(
        &self,
        axis: &Kinematics,
        fitted: Option<&FittedEncoder>,
    ) -> Result<EncoderPlan, RangeError> {
        let feed = axis.max_feed_mm_per_min();
        let Some(fitted) = fitted else {
            return Ok(self.edges(line_hz(feed, axis.counts_per_mm()), None));
        };
        let rpm = feed / fitted.travel_mm;
        let mut plan = self.edges(line_frequency_hz(rpm, fitted.lines)?, Some((fitted, rpm)));
        plan.largest_lines = Some(lines_for_feed(plan.max_line_hz, fitted.travel_mm, feed)?);
        Ok(plan)
    }

    fn spindle(&self, spindle: &Spindle) -> Result<SpindlePlan, RangeError> {
        let fitted = &spindle.encoder;
        let line_hz = line_frequency_hz(spindle.max_rpm, fitted.lines)?;
        let mut encoder = self.edges(line_hz, Some((fitted, spindle.max_rpm)));
        encoder.largest_lines = Some(lines_for_rotation(encoder.max_line_hz, spindle.max_rpm)?);
        Ok(SpindlePlan {
            name: spindle.name.clone(),
            assumed: spindle.assumed.clone(),
            max_rpm: spindle.max_rpm,
            counts_per_revolution: 4.0 * fitted.lines,
            velocity_d_per_tick: encoder.edge_hz / self.tick_hz,
            encoder,
        })
    }

    fn edges(&self, line_hz: f64, fitted: Option<(&FittedEncoder, f64)>) -> EncoderPlan {
        let encoder = fitted.map(|(fitted, _)| &fitted.encoder);
        let rpm = fitted.map(|(_, rpm)| rpm);
        let max_rpm = encoder.and_then(|encoder| encoder.max_rpm);
        let own = encoder.and_then(|encoder| encoder.max_line_hz);
        let max_line_hz = own.unwrap_or(self.max_line_hz);
        let is_slow = max_rpm.zip(rpm).is_none_or(|(max, rpm)| rpm <= max);
        EncoderPlan {
            name: encoder.map(|encoder| encoder.name.clone()),
            lines: fitted.map(|(fitted, _)| fitted.lines),
            rpm,
            max_rpm,
            line_hz,
            edge_hz: 4.0 * line_hz,
            max_line_hz,
            is_max_line_own: own.is_some(),
            largest_lines: None,
            is_within: is_slow && line_hz <= max_line_hz,
        }
    }
}
