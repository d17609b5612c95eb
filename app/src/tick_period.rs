//! The period of a tick in a 16-bit timer.

/// A rate as divider and reload of a timer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TickPeriod {
    /// Clocks of a count of the timer, 1 or more.
    pub divider: u16,
    /// Counts of a period, 2 or more.
    pub counts: u16,
}

/// Dividers that are tried above the smallest for one that goes without a rest.
const TRIED: u32 = 64;

impl TickPeriod {
    /// The nearest to `tick_hz` with a timer of `clock_hz`; exact where a divider makes it so. `None` for rates below
    /// `clock_hz`/2³¹ or above `clock_hz`/2.
    #[must_use]
    pub fn nearest(clock_hz: u32, tick_hz: f64) -> Option<Self> {
        let exact = f64::from(clock_hz) / tick_hz;
        if !(2.0..f64::from(u32::MAX / 2)).contains(&exact) {
            return None;
        }
        let clocks = libm::round(exact) as u32;
        let least = clocks.div_ceil(u16::MAX.into()).max(1);
        let divider = (least..least + TRIED)
            .find(|divider| clocks.is_multiple_of(*divider))
            .unwrap_or(least);
        let counts = (clocks + divider / 2) / divider;
        Some(Self {
            divider: u16::try_from(divider).ok()?,
            counts: u16::try_from(counts).ok().filter(|counts| *counts > 1)?,
        })
    }

    /// Clocks from tick to tick.
    #[must_use]
    pub const fn clocks(self) -> u32 {
        self.divider as u32 * self.counts as u32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CLOCK_HZ: u32 = 168_000_000;

    #[test]
    fn usual_rates_are_exact() {
        for tick_hz in [100, 250, 400, 1_000, 2_000, 2_500, 5_000, 10_000, 20_000, 35_000, 40_000] {
            let period = TickPeriod::nearest(CLOCK_HZ, f64::from(tick_hz)).unwrap();
            assert_eq!(period.clocks() * tick_hz, CLOCK_HZ, "{period:?}");
        }
    }

    #[test]
    fn every_rate_is_met_to_120_ppm() {
        for tick_hz in 100..=40_000 {
            let period = TickPeriod::nearest(CLOCK_HZ, f64::from(tick_hz)).unwrap();
            let error = f64::from(period.clocks()) * f64::from(tick_hz) / f64::from(CLOCK_HZ) - 1.0;
            // Half a clock of 4 200 at the highest rate; half a count of 32 768 or more where divided.
            assert!(error.abs() <= 1.2e-4, "{tick_hz} Hz: {error}");
        }
    }

    #[test]
    fn what_no_timer_can_do_is_refused() {
        for tick_hz in [0.0, -1.0, 0.05, 1e9, f64::NAN, f64::INFINITY] {
            assert_eq!(TickPeriod::nearest(CLOCK_HZ, tick_hz), None, "{tick_hz}");
        }
    }
}
