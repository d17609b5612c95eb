//! The axis that the prove-out probes with: the core's probing cycle on a simulated machine.
//!
//! One simulated axis stands for all of them, one after the other. A touch is run where the surface stands within a revolution of the
//! encoder, whose errors matter, and somewhere in the travel, which does not.

use leadscrew::encoder_map::EncoderMap;
use leadscrew::estimator::EstimatorConfig;
use leadscrew::params::AxisParams;
use leadscrew::probe::ProbeParams;
use leadscrew_hal_mock::board::TouchProbeParams;
use leadscrew_hal_mock::encoder::EncoderModel;
use leadscrew_hal_mock::machine::MachineParams;
use leadscrew_hal_mock::scenario::MoveAndBack;
use leadscrew_hal_mock::touching::{TouchBench, plant_with_probe};
use leadscrew_process::prove_out::Touching;

use crate::calibration::{Procedure, learn_simulated};

const TICK_HZ: f64 = 1000.0;
/// Feeds of the approach and of the touch, mm/min.
const APPROACH: f64 = 2000.0;
const TOUCH: f64 = 100.0;
/// From where, and how far beyond the surface, a touch goes, mm.
const BEFORE_MM: f64 = 0.6;
const BEYOND_MM: f64 = 0.5;
/// Travel of the screw a revolution, mm, and whole revolutions away from where the axis starts.
const REVOLUTION_MM: f64 = 10.0;
const AWAY_MM: f64 = 20.0;
/// Trigger delay of the simulated probe, s, as calibrated.
const DELAY_S: f64 = 5e-4;
/// Its jitter, s.
const JITTER_S: f64 = 1e-5;
/// 2σ of the latch itself with a learned map, mm.
const LATCH_2S_MM: f64 = 1e-4;
/// How far a probe is withdrawn until it is released: so many 2σ at the least. Two triggers in a row lie no farther apart than 3.45
/// of them, or the probe would touch anew on its way back.
const RELEASE_2S: f64 = 4.0;
/// Touches that the axis is referenced by.
const REFERENCE_TOUCHES: u32 = 25;

/// The map of the simulated encoder of a seed, learned by the product's own calibration.
///
/// # Errors
/// A calibration that fails.
pub fn learned_map(seed: u64) -> Result<Vec<u8>, String> {
    let procedure = Procedure {
        tick_hz: TICK_HZ,
        ..Procedure::default()
    };
    learn_simulated(&EncoderModel::real(), seed, &procedure).map_err(|error| error.to_string())
}

/// A simulated axis with its probe.
pub struct ProbedAxis<'m> {
    bench: TouchBench<'m>,
    sigma_mm: f64,
    /// What the axis reads too much, everywhere alike, mm.
    zero_mm: f64,
}

impl<'m> ProbedAxis<'m> {
    /// An axis with a learned map and a probe of so much repeatability, 2σ in mm. It is referenced once on a surface whose place is
    /// known, as machines are after their map was learned: where a map puts the encoder's zero is its own choice.
    ///
    /// # Errors
    /// An axis that does not become ready or does not touch.
    pub fn new(map: &'m [u8], repeatability_2s_mm: f64, seed: u64) -> Result<Self, String> {
        let machine = MachineParams::z_16k20f3();
        let base = TouchProbeParams::default();
        let probe = TouchProbeParams {
            surface_mm: AWAY_MM,
            at_shaft: 1.0,
            delay_s: DELAY_S,
            jitter_s: JITTER_S,
            repeatability_2s_mm,
            release_mm: base.release_mm.max(RELEASE_2S * repeatability_2s_mm),
            ..base
        };
        let said = |error: &dyn std::fmt::Display| error.to_string();
        let map = EncoderMap::from_bytes(map).map_err(|error| said(&error))?;
        let params = params(&machine)?;
        let plant = plant_with_probe(machine, probe);
        let mut bench =
            TouchBench::new(&plant, &params, Some(map), seed).map_err(|error| said(&error))?;
        // Over the index, for the map.
        bench
            .go_to(1.2 * REVOLUTION_MM, APPROACH)
            .map_err(|error| said(&error))?;
        let mut axis = Self {
            bench,
            sigma_mm: 0.5 * repeatability_2s_mm.hypot(LATCH_2S_MM),
            zero_mm: 0.0,
        };
        axis.zero_mm = axis.reference()?;
        Ok(axis)
    }

    /// The mean of touches of a surface at 0, from both sides in turn.
    fn reference(&mut self) -> Result<f64, String> {
        let mut sum = 0.0;
        for number in 0..REFERENCE_TOUCHES {
            let from_mm = if number % 2 == 0 { -1.0 } else { 1.0 };
            sum += self.touch(0.0, from_mm)?;
        }
        Ok(sum / f64::from(REFERENCE_TOUCHES))
    }
}

fn params(machine: &MachineParams) -> Result<AxisParams, String> {
    let estimator = EstimatorConfig::by_name("exponential")
        .ok()
        .flatten()
        .ok_or("there is no exponential estimator")?;
    let params = MoveAndBack::standard(TICK_HZ).axis_params(machine, estimator);
    Ok(AxisParams {
        probe: ProbeParams {
            trigger_delay_s: DELAY_S,
            trigger_jitter_s: JITTER_S,
            ..ProbeParams::default()
        },
        ..params.map_err(|error| error.to_string())?
    })
}

impl Touching for ProbedAxis<'_> {
    fn touch(&mut self, contact_mm: f64, from_mm: f64) -> Result<f64, String> {
        let way = (contact_mm - from_mm).signum();
        let here = AWAY_MM + contact_mm.rem_euclid(REVOLUTION_MM);
        self.bench
            .go_to(here - BEFORE_MM * way, APPROACH)
            .map_err(|error| error.to_string())?;
        let touched = self
            .bench
            .touch(here, here + BEYOND_MM * way, TOUCH, BEYOND_MM)
            .map_err(|error| error.to_string())?;
        let touch = touched
            .report
            .touch
            .filter(|_| touched.report.is_good())
            .ok_or_else(|| format!("probing ended with {:?}", touched.report.end))?;
        let latched = 1e-3 * touch.raw.to_num::<f64>();
        Ok(contact_mm + latched - here - self.zero_mm)
    }

    fn sigma_mm(&self) -> f64 {
        self.sigma_mm
    }
}
