//! From the bits of signals to the units of people.

use leadscrew::scope::{Signal, Unit};

/// What the signals of an axis are in millimetres and seconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    /// Control rate, Hz.
    pub tick_hz: f64,
    /// Counts of the encoder in a millimetre.
    pub counts_per_mm: f64,
}

/// A unit of people, and what one bit of a signal is in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Physical {
    /// Its symbol; empty for numbers and bits.
    pub unit: &'static str,
    /// What one bit is.
    pub bit: f64,
}

impl Physical {
    /// A value in the unit.
    #[must_use]
    pub fn value(&self, bits: i64) -> f64 {
        bits as f64 * self.bit
    }

    /// The bits of a value, rounded; [`Self::value`] read back gives the same ones, up to 2⁵¹.
    #[must_use]
    pub fn bits(&self, value: f64) -> i64 {
        (value / self.bit).round() as i64
    }
}

impl Scale {
    /// Unit and size of a bit of a signal: mm, mm/min, m/s², m/s³, % of full command. Counts stay counts.
    #[must_use]
    pub fn of(&self, signal: Signal) -> Physical {
        let one = (-f64::from(signal.frac())).exp2();
        let per_mm = self.counts_per_mm;
        let (unit, factor) = match (signal, signal.unit()) {
            (Signal::Count | Signal::MasterCount, _) => ("d", 1.0),
            (Signal::MasterVelocity, _) => ("d/s", self.tick_hz),
            (_, Unit::None) => ("", 1.0),
            (_, Unit::Tick) => ("ticks", 1.0),
            (_, Unit::D) => ("mm", 1.0 / per_mm),
            (_, Unit::DPerTick) => ("mm/min", 60.0 * self.tick_hz / per_mm),
            (_, Unit::DPerTick2) => ("m/s²", self.tick_hz.powi(2) / per_mm / 1e3),
            (_, Unit::DPerTick3) => ("m/s³", self.tick_hz.powi(3) / per_mm / 1e3),
            (_, Unit::FullCommand) => ("%", 100.0),
        };
        Physical {
            unit,
            bit: one * factor,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCALE: Scale = Scale {
        tick_hz: 2500.0,
        counts_per_mm: 1666.7,
    };

    #[test]
    fn a_velocity_is_told_in_millimetres_a_minute() {
        let bits = 7 << 20;
        let found = SCALE.of(Signal::Velocity).value(bits);
        assert!(
            (found - 7.0 * 2500.0 / 1666.7 * 60.0).abs() < 1e-9,
            "{found}"
        );
    }

    #[test]
    fn every_bit_is_read_back_from_the_shortest_decimal() {
        for &signal in Signal::ALL {
            let physical = SCALE.of(signal);
            for bits in [0, 1, -1, 12_345_678_901, -(1 << 50), (1 << 51) - 1] {
                let text = physical.value(bits).to_string();
                let back: f64 = text.parse().unwrap();
                assert_eq!(physical.bits(back), bits, "{signal}");
            }
        }
    }
}
