//! The bound on its own scene: an ideal encoder with white noise on each edge, no map.
//!
//! The acceleration of a least-squares quadratic over W ticks with n edges a tick of white noise σ has
//! √(720·σ²/(n·W⁵)). It is stated where n·W ≥ 15.

use leadscrew::estimator::EstimatorConfig;
use leadscrew::estimator::polynomial::{self, Answer};
use leadscrew_hal_mock::encoder::EncoderModel;
use leadscrew_hal_mock::scene::{Motion, Ripple};
use serde::Serialize;

use super::error::AccuracyError;
use super::rows::Row;
use super::run::RunSpec;
use crate::parallel;

/// σ_a of a fit on the bound's scene.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct BoundFigure {
    /// Velocity, d/tick: edges a tick.
    pub velocity: f64,
    /// Window, ticks.
    pub window: u32,
    /// σ_a, d/tick².
    pub sigma_a: f64,
    /// σ_a over the bound.
    pub to_bound: f64,
}

const EDGE_NOISE_D: f64 = 0.005;
const VELOCITIES: [f64; 6] = [1.3, 2.0, 2.3, 5.3, 50.0, 150.0];
const WINDOWS: [u32; 2] = [15, 8];
/// Fewest edges in a window for which the bound is stated.
const MIN_EDGES: f64 = 15.0;
/// Estimates within a window are much the same: this many of them are as good as thousands.
const TICKS: u32 = 40_000;

/// Measures the bound's scene.
///
/// # Errors
/// Never with the scenes built in.
pub fn bound() -> Result<Vec<BoundFigure>, AccuracyError> {
    let scenes: Vec<_> = VELOCITIES
        .into_iter()
        .flat_map(|velocity| WINDOWS.map(|window| (velocity, window)))
        .filter(|(velocity, window)| velocity * f64::from(*window) >= MIN_EDGES)
        .collect();
    let figures = parallel::map(&scenes, |(velocity, window)| figure(*velocity, *window));
    figures.into_iter().collect()
}

fn figure(velocity: f64, window: u32) -> Result<BoundFigure, AccuracyError> {
    let spec = RunSpec {
        row: Row {
            name: "bound",
            motion: Motion::Steady { velocity },
            start_d: 0.25,
            warm_up_ticks: 100,
            ticks: TICKS,
            limits: [None; 4],
        },
        model: EncoderModel::white(EDGE_NOISE_D),
        seed: 1,
        map: None,
        residue: None,
        ripple: Ripple::NONE,
        every_edge: true,
    };
    let config = polynomial::Config::new(window, Answer::Centre)?;
    let figures = spec.run(&[EstimatorConfig::Polynomial(config)], &[])?;
    let sigma_a = figures.estimators[0].acceleration.error.rms();
    let bound = EDGE_NOISE_D * (720.0 / (velocity * f64::from(window).powi(5))).sqrt();
    Ok(BoundFigure {
        velocity,
        window,
        sigma_a,
        to_bound: sigma_a / bound,
    })
}
