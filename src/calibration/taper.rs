//! The weights of the average over revolutions: a B-spline that is a partition of unity.
//!
//! The cubic B-spline β (four boxes convolved) stretched to boxes of B whole revolutions, w(u) = β(u/B)/B with
//! u in revolutions, has Σ_m w(u + m) = 1 for every u, and Σ_m w(u + m)·(u + m)^q does not depend on u for
//! q ≤ 3 (Schoenberg's reproduction of polynomials). So what repeats every revolution passes unchanged, a drift
//! of up to third degree becomes a constant, and a wobble of f cycles a revolution leaks into the harmonic h
//! by sinc⁴((f − h)·B).

/// Boxes that are convolved.
pub const ORDER: u32 = 4;
/// Fractional bits of a weight.
pub const WEIGHT_FRAC: u32 = 30;

/// Weights for a run, or for a part of it.
#[derive(Clone, Copy, Debug)]
pub struct Taper {
    box_revolutions: u32,
    /// Revolutions that pass before the first weight.
    begins_at: u32,
}

impl Taper {
    /// A taper over four boxes of `box_revolutions` (≥ 1) that begins at the revolution `begins_at`.
    pub const fn new(box_revolutions: u32, begins_at: u32) -> Self {
        Self {
            box_revolutions,
            begins_at,
        }
    }

    /// Weight at `revolutions` from the start of the run, Q.30.
    pub fn at(&self, revolutions: f64) -> i32 {
        let boxes = f64::from(self.box_revolutions);
        let weight = cubic((revolutions - f64::from(self.begins_at)) / boxes) / boxes;
        libm::round(libm::ldexp(weight, WEIGHT_FRAC.cast_signed())) as i32
    }

    /// Σ w² over the passes of one edge: what the average leaves of the variance of white noise.
    /// The integral of β² is 151/315.
    pub fn noise_gain(&self) -> f64 {
        151.0 / (315.0 * f64::from(self.box_revolutions))
    }
}

/// Part of a disturbance of f cycles a revolution that an average over `revolutions` leaves in the harmonic h,
/// for a `detuning` of |f − h| cycles a revolution.
///
/// A period of n ticks at v d/tick makes f = N/(n·v). Seen over position instead of time the tremble has a weak
/// second harmonic of its own, so a third of a cycle off is better than half a cycle.
#[must_use]
pub fn leakage(revolutions: u32, detuning: f64) -> f64 {
    let phase = core::f64::consts::PI * detuning * f64::from(revolutions / ORDER);
    if phase == 0.0 {
        return 1.0;
    }
    libm::pow(libm::fabs(libm::sin(phase) / phase), f64::from(ORDER))
}

/// The cubic B-spline on 0 to 4.
fn cubic(at: f64) -> f64 {
    let from_end = at.min(4.0 - at);
    let t = from_end.clamp(0.0, 2.0);
    if t < 1.0 {
        t * t * t / 6.0
    } else {
        let s = t - 1.0;
        (1.0 + 3.0 * s + 3.0 * s * s - 3.0 * s * s * s) / 6.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn weight(taper: &Taper, at: f64) -> f64 {
        f64::from(taper.at(at)) / f64::from(1 << WEIGHT_FRAC)
    }

    #[test]
    fn weights_sum_to_one_and_turn_cubics_into_constants() {
        for box_revolutions in [1, 3, 10, 25] {
            let taper = Taper::new(box_revolutions, 2);
            let length = 4 * box_revolutions;
            let sums = |part: f64| {
                let mut sums = [0.0; 4];
                for revolution in 0..length + 4 {
                    let at = f64::from(revolution) + part;
                    let centred = at - 2.0 - f64::from(length) / 2.0;
                    for (power, sum) in sums.iter_mut().enumerate() {
                        *sum += weight(&taper, at) * libm::pow(centred, power as f64);
                    }
                }
                sums
            };
            let first = sums(0.0);
            assert!((first[0] - 1.0).abs() < 1e-7, "{first:?}");
            // Third moments of a box of one sample need the spline's own smoothness: B ≥ 1 suffices.
            for part in [0.1, 0.37, 0.5, 0.93] {
                for (power, (seen, first)) in sums(part).iter().zip(first).enumerate() {
                    let scale = libm::pow(f64::from(length), power as f64);
                    assert!(
                        (seen - first).abs() < 1e-7 * scale,
                        "{power}: {seen} {first}"
                    );
                }
            }
        }
    }

    #[test]
    fn a_wobble_leaks_as_stated() {
        let (box_revolutions, detuning) = (10, 0.08);
        let taper = Taper::new(box_revolutions, 0);
        let (mut cosine, mut sine) = (0.0, 0.0);
        for revolution in 0..40 {
            let phase = core::f64::consts::TAU * detuning * f64::from(revolution);
            cosine += weight(&taper, f64::from(revolution)) * libm::cos(phase);
            sine += weight(&taper, f64::from(revolution)) * libm::sin(phase);
        }
        let seen = libm::hypot(cosine, sine);
        assert!((seen / leakage(40, detuning) - 1.0).abs() < 0.05, "{seen}");
        assert!((leakage(40, 0.0) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn the_noise_gain_is_the_sum_of_squares() {
        let taper = Taper::new(10, 0);
        let sum: f64 = (0..40)
            .map(|revolution| weight(&taper, f64::from(revolution) + 0.3))
            .map(|weight| weight * weight)
            .sum();
        assert!((sum / taper.noise_gain() - 1.0).abs() < 1e-3, "{sum}");
    }
}
