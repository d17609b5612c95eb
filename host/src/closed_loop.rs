//! The observer in the loop: moves on machines that are, or are not, what it was tuned on.
//!
//! The mechanics are those of the bare machine, or of the full one; the encoder is "real" with a map learned by
//! the product's own calibration. The observer states no lag, so errors are those at the sampling instant, over all
//! ticks in which a move runs, its S-curves included, once the index has been passed and the map is in use: on
//! a machine homing sees to that. The way back and its ramps lie wholly behind it.

use leadscrew::encoder_map::EncoderMap;
use leadscrew::encoder_map::tie::MapState;
use leadscrew::estimator::EstimatorConfig;
use leadscrew::estimator::observer;
use leadscrew::tuning::DriveModel;
use leadscrew_hal_mock::encoder::EncoderModel;
use leadscrew_hal_mock::machine::MachineParams;
use leadscrew_hal_mock::scenario::{MoveAndBack, ScenarioError, Setup, Simulation};

use crate::statistics::Spread;

/// A machine to move, and how it differs from what axis and observer count on.
#[derive(Clone, Copy, Debug)]
pub struct LoopCase {
    /// What it is called in a table.
    pub name: &'static str,
    /// The machine that axis and observer are tuned on.
    pub nominal: MachineParams,
    /// Gain and natural period of the actual drive over the nominal ones.
    pub actual: (f64, f64),
    /// Feed of the move, mm/min.
    pub feed_mm_per_min: f64,
    /// Where the poles of the loop are placed, rad/s.
    pub bandwidth_rad_per_s: f64,
    /// Largest rms error of acceleration that is aimed at, d/tick²; none for rows that are shown only.
    pub limit: Option<f64>,
}

/// What a case came to.
#[derive(Clone, Copy, Debug, Default)]
pub struct LoopFigures {
    /// Velocity less that of the shaft, d/tick.
    pub velocity: Spread,
    /// Acceleration less that of the shaft, d/tick².
    pub acceleration: Spread,
    /// Following error at the encoder, d.
    pub following: Spread,
}

/// The machine with the encoder "real".
fn with_real_encoder(machine: MachineParams) -> MachineParams {
    MachineParams {
        encoder: EncoderModel::real(),
        ..machine
    }
}

/// Control rate of all cases, Hz.
const TICK_HZ: f64 = 1000.0;

impl LoopCase {
    /// The cases of the table: nominal and off nominal, at the bandwidth of the standard loop and a faster one.
    #[must_use]
    pub fn all() -> Vec<Self> {
        let bare = with_real_encoder(MachineParams::z_16k20f3().bare());
        let case = |name, actual, feed_mm_per_min, bandwidth_rad_per_s, limit| Self {
            name,
            nominal: bare,
            actual,
            feed_mm_per_min,
            bandwidth_rad_per_s,
            limit,
        };
        let full = Self {
            nominal: MachineParams::z_16k20f3(),
            ..case("full", (1.0, 1.0), 9000.0, 35.0, None)
        };
        vec![
            case("bare", (1.0, 1.0), 9000.0, 35.0, Some(0.01)),
            case("bare", (1.0, 1.0), 9000.0, 100.0, Some(0.01)),
            case("-20 %/+30 %", (0.8, 1.3), 6000.0, 35.0, Some(0.05)),
            case("-20 %/+30 %", (0.8, 1.3), 6000.0, 100.0, Some(0.05)),
            case("+20 %/-25 %", (1.2, 0.75), 9000.0, 35.0, Some(0.05)),
            case("+20 %/-25 %", (1.2, 0.75), 9000.0, 80.0, Some(0.05)),
            full,
            Self {
                bandwidth_rad_per_s: 100.0,
                ..full
            },
        ]
    }

    /// Moves there and back with the encoder that `seed` draws, corrected by its `map`.
    ///
    /// # Errors
    /// A parameter out of range, or a move that cannot be planned.
    pub fn run(&self, seed: u64, map: EncoderMap<'_>) -> Result<LoopFigures, ScenarioError> {
        let scenario = MoveAndBack {
            feed_mm_per_min: self.feed_mm_per_min,
            ..MoveAndBack::standard(TICK_HZ)
        };
        let observer = EstimatorConfig::Observer(observer::Config::of_16k20f3()?);
        let observer = scenario.tuned(&self.nominal, observer, true)?;
        let mut params = scenario.axis_params(&self.nominal, observer)?;
        let drive = &self.nominal.drive;
        let model = DriveModel::second_order(drive.natural_period_s, drive.damping);
        params.controller = model.place_poles(self.bandwidth_rad_per_s)?;
        let setup = Setup::with_axis(&scenario, &self.machine(), &params, seed)?;
        let mut simulation = Simulation::from(setup);
        simulation.axis.set_map(Some(map));
        let mut figures = LoopFigures::default();
        while let Some(outputs) = simulation.step()? {
            let shaft = simulation.machine.truth().shaft;
            figures.following.push(outputs.following_error.to_num());
            let is_tied = simulation.axis.map_state() == Some(MapState::Tied);
            if outputs.moving && is_tied {
                let estimate = &outputs.estimate;
                let velocity: f64 = estimate.velocity.to_num();
                let acceleration: f64 = estimate.acceleration.to_num();
                figures.velocity.push(velocity - shaft.velocity);
                figures.acceleration.push(acceleration - shaft.acceleration);
            }
        }
        Ok(figures)
    }

    /// The machine as it is.
    fn machine(&self) -> MachineParams {
        let mut machine = self.nominal;
        machine.drive.full_command_feed_mm_per_min *= self.actual.0;
        machine.drive.natural_period_s *= self.actual.1;
        machine
    }
}
