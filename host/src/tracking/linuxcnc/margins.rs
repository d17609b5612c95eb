//! Stability margins of the law on a drive, by frequency response.
//!
//! Opened at the command: L = e^(−iω(T_d + T/2))·H·(P/(iω) + I/(iω)² + D·e^(−iωT/2)), with the drive
//! H = ω_n²/(ω_n² − ω² + 2iζω_nω), its delay T_d, the hold of half a tick T, and the half tick by which
//! hostmot2's velocity is late.

use std::f64::consts::{PI, TAU};

use leadscrew_hal_mock::drive::DriveParams;

use super::PidParams;
use super::bench::PERIOD_S;

/// Gain that must be in hand, and phase, rad: 6 dB and 30°, as is asked of our own tuning.
const LEAST_GAIN: f64 = 2.0;
const LEAST_PHASE: f64 = PI / 6.0;
/// Frequencies that are looked at, rad/s, up to half the tick rate.
const LOWEST: f64 = 0.1;
const FREQUENCIES: u32 = 3000;

/// What a loop has in hand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Margins {
    /// Least factor by which the gain may change, up or down, as one above 1.
    pub gain: f64,
    /// Least angle at a crossover of the gain, rad; negative in a loop that is not stable.
    pub phase: f64,
}

impl Margins {
    /// Of the law with `params` on `drive`, whose gain it counts on.
    #[must_use]
    pub fn of(params: &PidParams, drive: &DriveParams) -> Self {
        let highest = PI / PERIOD_S;
        let ratio = (highest / LOWEST).powf(1.0 / f64::from(FREQUENCIES));
        let mut margins = Self {
            gain: f64::INFINITY,
            phase: f64::INFINITY,
        };
        let mut before: Option<(f64, f64)> = None;
        let mut omega = LOWEST;
        for _ in 0..=FREQUENCIES {
            let (size, angle) = open_loop(params, drive, omega);
            let (size_before, angle_before) = before.unwrap_or((size, begun(angle)));
            // Continuous: no step of more than half a turn between neighbours.
            let angle = angle - TAU * ((angle - angle_before) / TAU).round();
            if (size < 1.0) != (size_before < 1.0) {
                margins.phase = margins.phase.min(PI + 0.5 * (angle + angle_before));
            }
            if (angle < -PI) != (angle_before < -PI) {
                margins.gain = margins.gain.min(size.max(1.0 / size));
            }
            before = Some((size, angle));
            omega *= ratio;
        }
        margins
    }

    /// 6 dB and 30° at least.
    #[must_use]
    pub fn suffice(&self) -> bool {
        self.gain >= LEAST_GAIN && self.phase >= LEAST_PHASE
    }
}

/// The angle at the lowest frequency, where integrators make it −90° or about −180°.
fn begun(angle: f64) -> f64 {
    if angle > 0.5 * PI { angle - TAU } else { angle }
}

/// Size and angle of L.
fn open_loop(params: &PidParams, drive: &DriveParams, omega: f64) -> (f64, f64) {
    // P/(iω) + I/(iω)² + D·e^(−iωT/2).
    let half = 0.5 * PERIOD_S * omega;
    let real = -params.i / (omega * omega) + params.d * half.cos();
    let imaginary = -params.p / omega - params.d * half.sin();
    let natural = TAU / drive.natural_period_s;
    let (down, across) = (
        natural * natural - omega * omega,
        2.0 * drive.damping * natural * omega,
    );
    let size = real.hypot(imaginary) * natural * natural / down.hypot(across);
    let late = omega * (drive.delay_s + 0.5 * PERIOD_S);
    (size, imaginary.atan2(real) - across.atan2(down) - late)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A drive so quick that the loop is an integrator with a delay: L = P·e^(−iωτ)/(iω).
    fn integrator(p: f64) -> Margins {
        let drive = DriveParams {
            natural_period_s: 0.001,
            damping: 0.7,
            delay_s: 0.1,
            ..DriveParams::default().bare()
        };
        let params = PidParams {
            p,
            ..PidParams::default()
        };
        Margins::of(&params, &drive)
    }

    #[test]
    fn of_an_integrator_with_delay_they_are_known() {
        // τ = 0.1 s, half a tick, and 2ζ/ω_n of the drive.
        let late = 0.1 + 0.0005 + 1.4 / (TAU / 0.001);
        for p in [2.0, 5.0, 10.0] {
            let margins = integrator(p);
            assert!(
                (margins.phase - (0.5 * PI - p * late)).abs() < 0.01,
                "{margins:?}"
            );
            assert!(
                (margins.gain / (0.5 * PI / (p * late)) - 1.0).abs() < 0.01,
                "{margins:?}"
            );
        }
        assert!(integrator(5.0).suffice());
        assert!(!integrator(9.0).suffice());
        assert!(integrator(20.0).phase < 0.0);
    }

    #[test]
    fn a_fast_integral_costs_phase() {
        let drive = DriveParams::default();
        let of = |i| {
            Margins::of(
                &PidParams {
                    p: 20.0,
                    i,
                    ..PidParams::default()
                },
                &drive,
            )
        };
        assert!(of(0.0).suffice());
        assert!(of(100.0).phase < of(0.0).phase);
        assert!(!of(400.0).suffice());
    }
}
