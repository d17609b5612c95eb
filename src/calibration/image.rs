//! From what was learned to the image of a map.

use super::bands::{Bands, ORDERS};
use super::learned::Learned;
use super::report::Noise;
use crate::encoder_map::encode::{MapContent, encode};
use crate::encoder_map::error::EncodeError;
use crate::encoder_map::{Direction, Form, Residual};

impl Learned<'_> {
    /// Writes the image of a map to the beginning of `out` and returns its length,
    /// [`crate::encoder_map::format::image_len`]. A map of [`Form::Phases`] needs no index and has no fronts.
    ///
    /// # Errors
    /// [`EncodeError`]; `out` is then no map.
    pub fn encode(&self, form: Form, out: &mut [u8]) -> Result<usize, EncodeError> {
        const BOTH: [Direction; 2] = [Direction::Forward, Direction::Backward];
        let fronts = match form {
            Form::Full | Form::Coarse => BOTH.map(|direction| self.index_front(direction)),
            Form::Phases => [None; 2],
        };
        let content = MapContent {
            edges: self.edges_per_revolution() as u32,
            error: &|edge| self.placement(edge as usize),
            phases: BOTH.map(|direction| self.phases(direction)),
            fronts,
            residual: self.residual(form),
        };
        encode(&content, form, out)
    }

    /// What a map of this form leaves of the encoder's errors.
    ///
    /// The hysteresis that all four phases have in common cannot be seen from steady feeds, which shift with it;
    /// it is stated as 0.
    #[must_use]
    pub fn residual(&self, form: Form) -> Residual {
        let report = self.report();
        let (learned, errors) = (&report.residual, &report.errors);
        let short_wave_d = match form {
            Form::Full => learned.edge_sigma_d,
            Form::Coarse | Form::Phases => libm::hypot(errors.lines, errors.edges),
        };
        let (slope, curvature_per_d) = match form {
            Form::Full | Form::Coarse => (learned.standing_slope, learned.standing_curvature_per_d),
            Form::Phases => {
                let edges = self.edges_per_revolution() as f64;
                (
                    derivative(errors, edges, 1.0),
                    derivative(errors, edges, 2.0),
                )
            }
        };
        let noise = self.noise();
        Residual {
            short_wave_d: short_wave_d as f32,
            slope: slope as f32,
            curvature_per_d: curvature_per_d as f32,
            noise_d: noise.place_d as f32,
            noise_s: noise.time_s as f32,
            hysteresis_d: 0.0,
        }
    }

    /// Noise of place and time; at one speed all of it counts as place.
    fn noise(&self) -> Noise {
        let runs = self.report().runs();
        let squares: f64 = runs
            .iter()
            .map(|run| run.pass_sigma_d * run.pass_sigma_d)
            .sum();
        let all = Noise {
            place_d: libm::sqrt(squares / runs.len().max(1) as f64),
            time_s: 0.0,
        };
        self.report().noise.unwrap_or(all)
    }
}

/// Rms of a derivative of the long waves along the revolution. What a band holds is laid into its highest order.
fn derivative(errors: &Bands, edges: f64, times: f64) -> f64 {
    let waves = [
        (1.0, errors.first),
        (2.0, errors.second),
        (10.0, errors.third_to_tenth),
        (ORDERS as f64, errors.eleventh_to_32nd),
    ];
    let squares = waves.map(|(order, rms)| {
        let wave_number = core::f64::consts::TAU * order / edges;
        let steep = rms * libm::pow(wave_number, times);
        steep * steep
    });
    libm::sqrt(squares.iter().sum())
}
