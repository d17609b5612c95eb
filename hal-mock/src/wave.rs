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

#[cfg(test)]
mod tests {
    use super::{phase, sine};

    #[test]
    fn sine_is_the_sine() {
        for step in -4000..4000 {
            let turns = f64::from(step) / 1000.0;
            let exact = libm::sin(turns * core::f64::consts::TAU);
            let found = f64::from(sine(phase(turns)));
            assert!((found - exact).abs() < 2e-7, "at {turns}: {found}");
        }
    }
}
