//! Maps to test with: random ones, and the true one of a simulated disc.

use leadscrew::encoder_map::encode::{MapContent, encode};
use leadscrew::encoder_map::format::image_len;
use leadscrew::encoder_map::{Form, Residual};
use leadscrew_hal_mock::disc::Disc;
use leadscrew_hal_mock::encoder::EncoderModel;
use proptest::prelude::*;

/// What a map is made of, errors in Q.16 d.
#[derive(Clone, Debug)]
pub struct Errors {
    pub edges: Vec<i32>,
    pub phases: [[i32; 4]; 2],
    pub fronts: [Option<i16>; 2],
}

pub const RESIDUAL: Residual = Residual {
    short_wave_d: 0.002,
    slope: 1e-5,
    curvature_per_d: 1e-8,
    noise_d: 0.005,
    noise_s: 2e-8,
    hysteresis_d: 0.03,
};

impl Errors {
    pub fn encode(&self, form: Form) -> Vec<u8> {
        let error = |edge: u32| self.edges[edge as usize];
        let mut image = vec![0; image_len(self.edges.len() as u32, form)];
        let written = encode(&self.content(&error), form, &mut image).expect("it fits");
        assert_eq!(written, image.len());
        image
    }

    pub fn content<'c>(&self, error: &'c dyn Fn(u32) -> i32) -> MapContent<'c> {
        MapContent {
            edges: self.edges.len() as u32,
            error,
            phases: self.phases,
            fronts: self.fronts,
            residual: RESIDUAL,
        }
    }

    /// What a perfect learning finds on the disc of `model` drawn by `seed`.
    pub fn true_of(model: &EncoderModel, seed: u64) -> Self {
        let disc = Disc::new(&model.disc, seed).expect("in range");
        let encoder = &model.encoder;
        // Odd boundaries are edges of A.
        let hysteresis =
            [encoder.hysteresis_b_d, encoder.hysteresis_a_d].map(|d| (d * 65536.0).round() as i32);
        let forward = |edge: usize| (disc.error_q32(edge) >> 16) as i32;
        let phase_mean = |phase: usize| {
            let lines = (phase..disc.edges()).step_by(4);
            let sum: i64 = lines.map(|edge| i64::from(forward(edge))).sum();
            (sum / (disc.edges() as i64 / 4)) as i32
        };
        let phases: [i32; 4] = std::array::from_fn(phase_mean);
        Self {
            edges: (0..disc.edges())
                .map(|edge| forward(edge) - hysteresis[edge % 2] / 2)
                .collect(),
            phases: [
                phases,
                std::array::from_fn(|phase| phases[phase] - hysteresis[phase % 2]),
            ],
            fronts: [Some(0), Some(encoder.index_width_d as i16 - 1)],
        }
    }
}

/// Random errors: an eccentric disc, lines and phases.
pub fn errors() -> impl Strategy<Value = Errors> {
    let phase = -60_000..60_000_i32;
    (
        prop_oneof![4..20_u32, 20..200_u32, 2_490..2_510_u32],
        0.0..3.5_f64,
        0.0..std::f64::consts::TAU,
        0..40_000_i32,
        prop::array::uniform2(prop::array::uniform4(phase)),
        any::<u64>(),
    )
        .prop_map(|(lines, eccentricity, turn, spread, phases, seed)| {
            let edges = lines * 4;
            let mut random = seed | 1;
            let mean = |edge: u32| {
                let at = (edge % 4) as usize;
                (phases[0][at] + phases[1][at]) / 2
            };
            let edges = (0..edges)
                .map(|edge| {
                    random ^= random << 13;
                    random ^= random >> 7;
                    random ^= random << 17;
                    let at = f64::from(edge) / f64::from(edges) * std::f64::consts::TAU + turn;
                    // Within a turn of less than a segment even the eccentricity is the bytes'.
                    let slow = if edges < 400 { 0.0 } else { eccentricity };
                    (slow * at.sin() * 65536.0) as i32
                        + mean(edge)
                        + (random % (spread as u64 + 1)) as i32
                        - spread / 2
                })
                .collect();
            Errors {
                edges,
                phases,
                fronts: [Some(-2), None],
            }
        })
}
