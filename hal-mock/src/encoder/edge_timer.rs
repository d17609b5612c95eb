//! The timer that stamps edges.

use crate::random::{Noise, bell_scale_q32};
use crate::track::to_q32;

/// Fractional bits of the noise's scale below those of [`EdgeTimer`]'s clocks.
const SCALE_FRAC: u32 = 8;
/// Bits of a tick in fractions of a clock: noise of 1e-5 s at 40 kHz then stays below 2³¹.
const TICK_BITS: u32 = 29;

/// A free-running 32-bit timer, and the noise of what it stamps.
#[derive(Clone, Debug)]
pub struct EdgeTimer {
    noise: Noise,
    /// Scale of the noise, in 2⁻⁸ fractions of a clock.
    noise_scale: i32,
    /// Clocks of a tick, Q.32.
    per_tick: u64,
    /// Fractions of a clock in 4 ticks, so that a Q.30 time gives them in Q.32; 2^`fraction_bits` of them
    /// are a clock.
    scale: u32,
    fraction_bits: u32,
    /// Start of the tick in clocks, Q.32; wraps.
    start: u64,
    /// What of a clock has passed by then, in fractions, Q.32.
    begun: u64,
    /// The newest stamp, in clocks from the start of the tick; none is older than `i32::MIN`.
    newest: i32,
}

impl EdgeTimer {
    /// A timer of `timer_hz` and ticks of `tick_hz`, noise of standard deviation `noise_s`.
    pub fn new(timer_hz: f64, tick_hz: f64, noise_s: f64, noise: Noise) -> Self {
        let per_tick = to_q32(timer_hz / tick_hz).cast_unsigned();
        let fraction_bits = TICK_BITS + per_tick.leading_zeros() - 32;
        let fractions = f64::from(1_u32 << fraction_bits);
        let noise_clocks = noise_s * timer_hz;
        Self {
            noise,
            noise_scale: (bell_scale_q32(noise_clocks * fractions) >> (32 - SCALE_FRAC)) as i32,
            per_tick,
            scale: (per_tick >> (30 - fraction_bits)) as u32,
            fraction_bits,
            start: 0,
            begun: 0,
            newest: i32::MIN,
        }
    }

    /// The timer at the end of the tick, Q.32.
    pub const fn end(&self) -> u64 {
        self.start.wrapping_add(self.per_tick)
    }

    /// Stamps an edge at a time within the tick, Q.30. Stamps never run backward, whatever the noise.
    pub fn stamp(&mut self, time: i32) -> u32 {
        let passed = u64::from(time.cast_unsigned()) * u64::from(self.scale);
        let fractions = ((self.begun + passed) >> 32) as i32 + self.noise();
        let clocks = (fractions >> self.fraction_bits).max(self.newest);
        self.newest = clocks;
        self.whole_start().wrapping_add_signed(clocks)
    }

    /// Goes on to the next tick.
    pub const fn end_tick(&mut self) {
        let before = self.whole_start();
        self.start = self.end();
        self.begun = (self.start & 0xffff_ffff) << self.fraction_bits;
        let clocks = self.whole_start().wrapping_sub(before).cast_signed();
        self.newest = self.newest.saturating_sub(clocks);
    }

    /// The timer when a share of the tick last ended was over.
    pub fn time_at(&self, share: f64) -> u32 {
        let back = (1.0 - share) * self.per_tick as f64;
        (self.start.wrapping_sub((back as i64).cast_unsigned()) >> 32) as u32
    }

    const fn whole_start(&self) -> u32 {
        (self.start >> 32) as u32
    }

    /// Noise in fractions of a clock.
    fn noise(&mut self) -> i32 {
        if self.noise_scale == 0 {
            return 0;
        }
        let product = i64::from(self.noise.bell()) * i64::from(self.noise_scale);
        (product >> SCALE_FRAC) as i32
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::track::TICK;

    const RATES: [(f64, f64); 5] = [
        (84e6, 1000.0),
        (84e6, 2500.0),
        (250e6, 100.0),
        (1e6, 40_000.0),
        (250e6, 40_000.0),
    ];

    fn timer(timer_hz: f64, tick_hz: f64, noise_s: f64) -> EdgeTimer {
        EdgeTimer::new(timer_hz, tick_hz, noise_s, Noise::new(1, 4))
    }

    #[test]
    fn a_stamp_is_the_last_whole_clock() {
        for (timer_hz, tick_hz) in RATES {
            // A rate that does not divide the clock: ticks start anywhere in one.
            let tick_hz = tick_hz * 0.999_7 + 1.0;
            let mut timer = timer(timer_hz, tick_hz, 0.0);
            for tick in 0..200 {
                for part in 0..=100 {
                    let time = f64::from(tick) + f64::from(part) / 100.0;
                    let exact = time * timer_hz / tick_hz;
                    let seen =
                        f64::from(timer.stamp((f64::from(part) / 100.0 * f64::from(TICK)) as i32));
                    assert!(
                        seen <= exact + 0.01 && seen > exact - 1.01,
                        "{timer_hz}/{tick_hz}: {seen} instead of {exact}"
                    );
                }
                timer.end_tick();
            }
        }
    }

    #[test]
    fn noise_has_its_deviation_at_every_rate() {
        for (timer_hz, tick_hz) in RATES {
            for clocks in [0.1, 2.0, 100.0_f64] {
                let noise_s = (clocks / timer_hz).min(1e-5);
                let mut timer = timer(timer_hz, tick_hz, noise_s);
                let mut squares = 0.0;
                let scale = f64::from(1_u32 << timer.fraction_bits);
                for _ in 0..4000 {
                    let noise = f64::from(timer.noise()) / scale;
                    squares += noise * noise;
                }
                let sigma = libm::sqrt(squares / 4000.0) / timer_hz;
                assert!(
                    (sigma / noise_s - 1.0).abs() < 0.05,
                    "{timer_hz}: {sigma} for {noise_s}"
                );
            }
        }
    }

    #[test]
    fn stamps_never_run_backward() {
        for (timer_hz, tick_hz) in RATES {
            let mut timer = timer(timer_hz, tick_hz, 1e-5);
            let mut newest = 0_u32;
            for tick in 0..2000 {
                for part in 0..8 {
                    let at = timer.stamp(TICK / 8 * part);
                    let later = at.wrapping_sub(newest).cast_signed();
                    assert!(later >= 0 || (tick == 0 && newest == 0), "{later}");
                    newest = at;
                }
                timer.end_tick();
            }
        }
    }
}
