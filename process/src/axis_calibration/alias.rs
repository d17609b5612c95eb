//! Targets at multiples of the pitch: a periodic error then is the same at all of them and is not seen, or stands as a shift.

use std::fmt;

use serde::Serialize;

/// Targets that meet a periodic error of the screw at the same phase.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Alias {
    /// Length of the error that is not seen, mm: the pitch, or half of it.
    pub period_mm: f64,
    /// Whether it is the pitch itself.
    pub is_pitch: bool,
    /// The targets, mm.
    pub targets_mm: Vec<f64>,
    /// Length of the mean of exp(2πi·target/period) over the targets: 1 where all have one phase, near 0 where they are spread.
    pub coherence: f64,
}

/// Coherence from which on targets count as of one phase. Of 5 targets at random offsets fewer than 1 in 50 sets reach it.
pub const COHERENT: f64 = 0.9;

impl Alias {
    /// What the targets do not see of a screw of `pitch_mm`: errors once a turn, or only those twice a turn.
    #[must_use]
    pub fn of(targets_mm: &[f64], pitch_mm: f64) -> Option<Self> {
        let periods = [(pitch_mm, true), (pitch_mm / 2.0, false)];
        let aliases = periods.map(|(period_mm, is_pitch)| Self {
            period_mm,
            is_pitch,
            targets_mm: targets_mm.to_vec(),
            coherence: coherence(targets_mm, period_mm),
        });
        let mut aliases = aliases.into_iter();
        aliases.find(|alias| alias.coherence >= COHERENT)
    }
}

/// Length of the mean of exp(2πi·target/period).
#[must_use]
pub fn coherence(targets_mm: &[f64], period_mm: f64) -> f64 {
    let phases = || {
        targets_mm
            .iter()
            .map(|target| std::f64::consts::TAU * (target / period_mm).rem_euclid(1.0))
    };
    let [cosine, sine]: [f64; 2] = [phases().map(f64::cos).sum(), phases().map(f64::sin).sum()];
    cosine.hypot(sine) / targets_mm.len().max(1) as f64
}

impl fmt::Display for Alias {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let targets: Vec<_> = self.targets_mm.iter().map(ToString::to_string).collect();
        let what = if self.is_pitch {
            "the pitch"
        } else {
            "half the pitch"
        };
        write!(
            f,
            "the targets lie at multiples of {what}, {} mm (coherence {:.2}), and do not see an error of that period: {} mm. \
             Put each at a random offset within the pitch",
            self.period_mm,
            self.coherence,
            targets.join(", ")
        )
    }
}
