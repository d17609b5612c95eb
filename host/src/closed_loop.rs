//! The observer in the loop: moves on machines that are, or are not, what it was tuned on.
//!
//! The mechanics are those of the bare machine, or of the full one; the encoder is "real" with a map learned by
//! the product's own calibration. The observer states no lag, so errors are those at the sampling instant, over all
//! ticks in which a move runs, its S-curves included, once the index has been passed and the map is in use: on
//! a machine homing sees to that. The way back and its ramps lie wholly behind it.

use leadscrew::axis::Axis;
use leadscrew::controller::tuning::DriveModel;
use leadscrew::encoder_map::EncoderMap;
use leadscrew::encoder_map::tie::MapState;
use leadscrew::estimator::EstimatorConfig;
use leadscrew::estimator::observer::{self, ObserverParams};
use leadscrew::units::AxisScale;
use leadscrew_hal_mock::encoder::EncoderModel;
use leadscrew_hal_mock::machine::{Machine, MachineParams};
use leadscrew_hal_mock::scenario::{MoveAndBack, ScenarioError, Script, Simulation};

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
        let mut params = scenario.axis_params(&self.nominal, self.observer()?)?;
        let drive = &self.nominal.drive;
        let model = DriveModel {
            natural_period_s: drive.natural_period_s,
            damping: drive.damping,
        };
        params.controller = model.place_poles(self.bandwidth_rad_per_s)?;
        let config = params.validate()?;
        let script = Script::new(&scenario, params.motion.counts_per_mm, &config)?;
        let mut axis = Axis::new(config);
        axis.set_map(Some(map));
        let machine = Machine::new(&self.machine(), TICK_HZ, seed)?;
        let mut simulation = Simulation::new(machine, axis, script);
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

    /// An observer tuned on the nominal machine, for an encoder with a map.
    fn observer(&self) -> Result<EstimatorConfig, ScenarioError> {
        let drive = &self.nominal.drive;
        let params = ObserverParams {
            full_command_feed_mm_per_min: drive.full_command_feed_mm_per_min,
            natural_period_s: drive.natural_period_s,
            damping: drive.damping,
            delay_s: drive.delay_s,
            offset: drive.offset,
            ..ObserverParams::default()
        };
        let scale = AxisScale::new(self.nominal.mount.counts_per_mm, TICK_HZ)?;
        Ok(EstimatorConfig::Observer(observer::Config::new(
            &params, scale,
        )?))
    }
}
