//! The encoder's disc: where the edges of a revolution really lie.

use leadscrew::parameter_table::ParameterTable;
use leadscrew::units::{RangeError, checked};

use crate::random::Noise;
use crate::wave::{phase, sine};

/// Most edges a revolution, a power of two.
pub const MAX_EDGES: usize = 16_384;
/// Units of a placement error in a d.
const UNITS_PER_D: f64 = 4096.0;

leadscrew::parameter_table! {
    /// Systematic placement errors of an encoder. The default is the encoder "real".
    pub struct DiscParams {
        /// Edges a revolution (x4), a multiple of 4
        edges_per_revolution: 10_000.0, "1", 16.0..=16384.0;
        /// Largest offset of each of the four edges of a line, the same all round
        phase_offset_d: 0.12, "d", 0.0..=0.3;
        /// Standard deviation of the place of a line
        line_sigma_d: 0.10, "d", 0.0..=0.5;
        /// Standard deviation of the place of an edge within its line
        edge_sigma_d: 0.03, "d", 0.0..=0.3;
        /// Amplitude of the error once a revolution (eccentricity of the disc)
        eccentricity_d: 1.5, "d", 0.0..=5.0;
        /// Amplitude of the error twice a revolution
        second_harmonic_d: 0.3, "d", 0.0..=2.0;
        /// Largest drift of each of the four offsets, as temperature makes it; the same disc otherwise
        phase_drift_d: 0.0, "d", 0.0..=0.1;
    }
}

/// Placement errors of all edges of a revolution.
#[derive(Clone, Debug)]
pub struct Disc {
    /// Error of each edge in 1/4096 d.
    errors: [i16; MAX_EDGES],
    edges: usize,
}

impl Disc {
    /// The disc that `seed` makes of `params`: random phases of the harmonics, random lines.
    ///
    /// # Errors
    /// A parameter out of range, or edges that are not a multiple of four.
    pub fn new(params: &DiscParams, seed: u64) -> Result<Self, RangeError> {
        params.check()?;
        let edges = whole_lines(params.edges_per_revolution)?;
        let mut noise = Noise::new(seed, 1);
        // A stream of its own: what has drifted is the same disc.
        let mut drift = Noise::new(seed, 5);
        let offsets = [(); 4].map(|()| {
            params.phase_offset_d * noise.uniform() + params.phase_drift_d * drift.uniform()
        });
        let (first_phase, second_phase) = (noise.uniform(), noise.uniform());
        let mut errors = [0; MAX_EDGES];
        let (mut line, mut lowest) = (0.0, -1.0);
        for (edge, error) in errors.iter_mut().enumerate().take(edges) {
            if edge % 4 == 0 {
                line = params.line_sigma_d * noise.normal();
            }
            let turn = edge as f64 / edges as f64;
            let placed = offsets[edge % 4]
                + line
                + params.edge_sigma_d * noise.normal()
                + params.eccentricity_d * f64::from(sine(phase(turn + first_phase)))
                + params.second_harmonic_d * f64::from(sine(phase(2.0 * turn + second_phase)));
            // Edges keep their order, whatever the dice say.
            let kept = if edge > 0 && placed < lowest {
                lowest
            } else {
                placed
            };
            lowest = kept - 1.0 + MIN_SPACING_D;
            *error = (kept * UNITS_PER_D) as i16;
        }
        Ok(Self { errors, edges })
    }

    /// Edges a revolution.
    #[must_use]
    pub const fn edges(&self) -> usize {
        self.edges
    }

    /// Error of edge `edge` (0 ≤ edge < [`Self::edges`]) in Q.32 d.
    #[must_use]
    pub fn error_q32(&self, edge: usize) -> i64 {
        // The mask spares the check of the bound.
        i64::from(self.errors[edge & (MAX_EDGES - 1)]) << (32 - 12)
    }
}

/// Edges of whole lines: a multiple of four.
fn whole_lines(edges: f64) -> Result<usize, RangeError> {
    let whole = (edges as usize) & !3;
    let nearest = whole as f64;
    checked("edges_per_revolution", edges, nearest, nearest)?;
    Ok(whole)
}

/// Least distance between neighbouring edges.
const MIN_SPACING_D: f64 = 0.05;
