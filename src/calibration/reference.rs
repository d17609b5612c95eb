//! The motion that edges are compared with: a smooth position as a function of time.

/// Fractional bits of a position, d.
pub const POSITION_FRAC: u32 = 16;
/// Bits of the mantissa of a velocity.
const MANTISSA_BITS: i32 = 30;
/// Fractional bits of the change of the mantissa in a clock.
const CHANGE_FRAC: i32 = 30;
/// Velocities that the mantissa's shift can carry, as exponents of two of d/clock.
const EXPONENTS: core::ops::RangeInclusive<i32> = -30..=10;
/// Most that the velocity may change in a revolution, as a part of it.
const LARGEST_CHANGE: f64 = 0.25;

/// Constant acceleration, evaluated from the start of the present revolution on.
///
/// The start moves on by theory, not by what was seen, so the reference is one smooth function over the run.
#[derive(Clone, Copy, Debug)]
pub struct Reference {
    edges: f64,
    velocity: f64,
    acceleration: f64,
    /// Start of the revolution, clocks from the start of the run.
    start: f64,
    /// The timer at the start of the run.
    origin: u32,
    // What an edge needs, made anew each revolution:
    /// The timer at the start of the revolution, rounded down.
    start_time: u32,
    /// Position at `start_time`, Q.16 d; what rounding down left.
    offset: i64,
    mantissa: i64,
    mantissa_change: i64,
    shift: u32,
}

impl Reference {
    /// A motion that at the timer's `origin` begins a revolution of `edges` with `velocity` d/clock and
    /// `acceleration` d/clock²; `None` if that is too slow, too fast or changes too much.
    pub fn new(edges: u32, origin: u32, velocity: f64, acceleration: f64) -> Option<Self> {
        let mut reference = Self {
            edges: f64::from(edges),
            velocity,
            acceleration,
            start: 0.0,
            origin,
            start_time: origin,
            offset: 0,
            mantissa: 0,
            mantissa_change: 0,
            shift: 0,
        };
        reference.prepare()?;
        Some(reference)
    }

    /// Clocks from the start of the run to that of the revolution.
    pub const fn elapsed(&self) -> f64 {
        self.start
    }

    /// Goes on to the next revolution; `None` if the motion does not come so far.
    pub fn next_revolution(&mut self) -> Option<()> {
        let duration = self.duration();
        self.start += duration;
        self.velocity += self.acceleration * duration;
        self.prepare()
    }

    /// Position at the timer's `time`, within half the timer's range of the revolution's start, Q.16 d from
    /// the revolution's first boundary.
    #[inline]
    pub fn position(&self, time: u32) -> i64 {
        let since = i64::from(time.wrapping_sub(self.start_time).cast_signed());
        let change = since.wrapping_mul(self.mantissa_change) >> CHANGE_FRAC;
        let mantissa = self.mantissa.wrapping_add(change);
        (since.wrapping_mul(mantissa) >> self.shift).wrapping_add(self.offset)
    }

    /// Clocks of the present revolution.
    fn duration(&self) -> f64 {
        let squared = self.velocity * self.velocity + 2.0 * self.acceleration * self.edges;
        2.0 * self.edges / (self.velocity + libm::sqrt(squared))
    }

    fn prepare(&mut self) -> Option<()> {
        let duration = self.duration();
        let change = self.acceleration * duration / self.velocity;
        // The first comparison fails for a number that is none, too.
        let sound = libm::fabs(change) <= LARGEST_CHANGE && self.velocity > 0.0;
        let (_, exponent) = libm::frexp(self.velocity);
        if !sound || !EXPONENTS.contains(&exponent) {
            return None;
        }
        let scale = MANTISSA_BITS.wrapping_sub(exponent);
        self.mantissa = libm::ldexp(self.velocity, scale) as i64;
        self.shift = scale
            .wrapping_sub(POSITION_FRAC.cast_signed())
            .cast_unsigned();
        let change_scale = scale.wrapping_add(CHANGE_FRAC);
        self.mantissa_change = libm::ldexp(self.acceleration / 2.0, change_scale) as i64;
        let whole = libm::floor(self.start);
        let behind = (self.start - whole) * self.velocity;
        self.offset = -libm::ldexp(behind, POSITION_FRAC.cast_signed()) as i64;
        self.start_time = self.origin.wrapping_add(whole as u64 as u32);
        Some(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positions_follow_the_formula_over_many_revolutions() {
        for (velocity, acceleration) in
            [(1.2e-3, 0.0), (6e-5, 0.0), (1.8e-3, -8.5e-13), (0.2, 1e-9)]
        {
            let origin = 0xffff_0000;
            let mut reference = Reference::new(10_000, origin, velocity, acceleration).unwrap();
            for revolution in 0..40 {
                let begin = reference.start;
                for part in -1..=10 {
                    let time = libm::floor(begin + reference.duration() * f64::from(part) / 10.0);
                    let exact = velocity * time + acceleration * time * time / 2.0
                        - f64::from(revolution) * 10_000.0;
                    let seen = reference.position(origin.wrapping_add(time as i64 as u32)) as f64
                        / f64::from(1 << POSITION_FRAC);
                    assert!((seen - exact).abs() < 1e-4, "{velocity}: {seen} {exact}");
                }
                reference.next_revolution().unwrap();
            }
        }
    }

    #[test]
    fn motion_that_ends_is_refused() {
        let mut coast = Reference::new(10_000, 0, 2.4e-4, -8.5e-13).unwrap();
        let revolutions = (0..10)
            .take_while(|_| coast.next_revolution().is_some())
            .count();
        assert!(revolutions < 4, "{revolutions}");
        for velocity in [0.0, -1.0, f64::NAN, 1e-12, 1e6] {
            assert!(
                Reference::new(10_000, 0, velocity, 0.0).is_none(),
                "{velocity}"
            );
        }
    }
}
