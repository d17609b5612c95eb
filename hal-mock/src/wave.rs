//! A sine of basic operations, for the same bits on every machine.

/// An angle in 2⁻³² of a turn; it wraps as turns do.
pub type Phase = u32;

/// The phase of `turns`; |turns| < 2³¹.
pub fn phase(turns: f64) -> Phase {
    crate::track::to_q32(turns) as Phase
}

/// sin(2π·`phase`/2³²), right to 2e-7.
pub fn sine(phase: Phase) -> f32 {
    let phase = phase.cast_signed();
    // To ±1/4 turn by the symmetry about the crests.
    let phase = if phase.unsigned_abs() > 1 << 30 {
        i32::MIN.wrapping_sub(phase)
    } else {
        phase
    };
    let angle = phase as f32 * (core::f32::consts::TAU / 4_294_967_296.0);
    let square = angle * angle;
    // Taylor to the 11th power: the next term is below 6e-8 at a quarter turn.
    let series = 1.0 / 362_880.0 - square * (1.0 / 39_916_800.0);
    let series = 1.0 / 5_040.0 - square * series;
    let series = 1.0 / 120.0 - square * series;
    let series = 1.0 / 6.0 - square * series;
    angle * (1.0 - square * series)
}

/// A point on the unit circle that goes round by the same angle each tick.
#[derive(Clone, Copy, Debug, Default)]
pub struct Rotor {
    at: Direction,
    step: Direction,
}

/// An angle by its functions.
#[derive(Clone, Copy, Debug, Default)]
struct Direction {
    sine: f64,
    cosine: f64,
}

impl Rotor {
    /// A point at `turns` that goes `turns_per_tick`.
    pub fn new(turns: f64, turns_per_tick: f64) -> Self {
        Self {
            at: Direction::new(turns),
            step: Direction::new(turns_per_tick),
        }
    }

    /// Goes round by one tick; a million of them make it wrong by 1e-10 at most.
    pub fn turn(&mut self) {
        let Self { at, step } = *self;
        self.at = Direction {
            sine: at.sine * step.cosine + at.cosine * step.sine,
            cosine: at.cosine * step.cosine - at.sine * step.sine,
        };
    }

    /// Sine of where it is.
    pub const fn sine(&self) -> f64 {
        self.at.sine
    }

    /// Cosine of where it is.
    pub const fn cosine(&self) -> f64 {
        self.at.cosine
    }
}

impl Direction {
    /// The direction of `turns`, |turns| < 2⁶³, by the Taylor series.
    fn new(turns: f64) -> Self {
        // What is left of whole turns, and at most a half of one.
        let part = turns - (turns as i64) as f64;
        let part = part - ((2.0 * part) as i64) as f64;
        let angle = part * core::f64::consts::TAU;
        let (mut sine, mut cosine, mut term) = (0.0, 1.0, 1.0);
        for power in 1..TAYLOR_TERMS {
            term *= angle / f64::from(power);
            match power % 4 {
                1 => sine += term,
                2 => cosine -= term,
                3 => sine -= term,
                _ => cosine += term,
            }
        }
        Self { sine, cosine }
    }
}

/// π to this power over its factorial is below 1e-17.
const TAYLOR_TERMS: u32 = 34;

#[cfg(test)]
mod tests {
    use super::{Rotor, phase, sine};

    #[test]
    fn sine_is_the_sine() {
        for step in -4000..4000 {
            let turns = f64::from(step) / 1000.0;
            let exact = libm::sin(turns * core::f64::consts::TAU);
            let found = f64::from(sine(phase(turns)));
            assert!((found - exact).abs() < 2e-7, "at {turns}: {found}");
        }
    }

    #[test]
    fn a_rotor_goes_round_and_round() {
        for (turns, per_tick) in [
            (0.0, 0.0025),
            (0.3, 1.0 / 90.0),
            (-0.9, -0.1234),
            (0.75, 0.5),
        ] {
            let mut rotor = Rotor::new(turns, per_tick);
            for tick in 0..20_000 {
                let angle = core::f64::consts::TAU * (turns + per_tick * f64::from(tick));
                // The angle itself is rounded, and so is each of the steps.
                let tolerance = 1e-14 + 4e-16 * f64::from(tick);
                let error = (rotor.sine() - libm::sin(angle)).abs()
                    + (rotor.cosine() - libm::cos(angle)).abs();
                assert!(
                    error < tolerance.max(1e-15 * angle.abs()) * 4.0,
                    "{error:e} at {tick}"
                );
                rotor.turn();
            }
        }
    }
}
