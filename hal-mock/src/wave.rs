//! A sine of basic operations, for the same bits on every machine.

/// sin(2π·`turns`), right to 2e-7; |turns| < 2⁶².
pub fn sine(turns: f64) -> f64 {
    let phase = turns - (turns as i64) as f64;
    // To ±1/4 turn by the symmetry about the crests.
    let phase = if phase > 0.5 {
        phase - 1.0
    } else if phase < -0.5 {
        phase + 1.0
    } else {
        phase
    };
    let phase = if phase > 0.25 {
        0.5 - phase
    } else if phase < -0.25 {
        -0.5 - phase
    } else {
        phase
    };
    let angle = phase * core::f64::consts::TAU;
    let square = angle * angle;
    // Taylor to the 11th power: the next term is below 6e-8 at a quarter turn.
    let series = 1.0 - square / 110.0;
    let series = 1.0 - square / 72.0 * series;
    let series = 1.0 - square / 42.0 * series;
    let series = 1.0 - square / 20.0 * series;
    angle * (1.0 - square / 6.0 * series)
}

#[cfg(test)]
mod tests {
    #[test]
    fn sine_is_the_sine() {
        for step in -4000..4000 {
            let turns = f64::from(step) / 1000.0;
            let exact = libm::sin(turns * core::f64::consts::TAU);
            assert!((super::sine(turns) - exact).abs() < 2e-7, "at {turns}");
        }
    }
}
