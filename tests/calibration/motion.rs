//! Motions of a shaft as functions of time, and dice.

/// Small, seeded, independent of the simulator's.
pub struct Dice(u64);

impl Dice {
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 0x1234_5678_9abc_def1)
    }

    pub fn uniform(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Sum of twelve: close enough to normal.
    pub fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.uniform()).sum::<f64>() - 6.0
    }
}

/// Motion in ticks and d; `velocity` may be negative.
#[derive(Clone, Copy)]
pub struct Motion {
    pub start: f64,
    pub velocity: f64,
    pub acceleration: f64,
    /// Loss of velocity a tick as a part of it.
    pub damping: f64,
    pub wobble_d: f64,
    pub wobble_ticks: f64,
    pub wobble_phase: f64,
    pub drift_d: f64,
    pub drift_ticks: f64,
}

impl Motion {
    /// What a calibration meets: a wobble of 1.7 d and 90 ticks, a drift of 3 d over seven revolutions or so.
    pub fn calibrating(velocity: f64, dice: &mut Dice) -> Self {
        Self {
            start: 10_000.0 * dice.uniform(),
            wobble_d: 1.7,
            wobble_phase: dice.uniform(),
            drift_d: 3.0,
            drift_ticks: 70_000.0 / velocity.abs(),
            ..Self::steady(velocity)
        }
    }

    pub const fn steady(velocity: f64) -> Self {
        Self {
            start: 1234.5,
            velocity,
            acceleration: 0.0,
            damping: 0.0,
            wobble_d: 0.0,
            wobble_ticks: 90.0,
            wobble_phase: 0.0,
            drift_d: 0.0,
            drift_ticks: 1000.0,
        }
    }

    fn wave(amplitude: f64, period: f64, phase: f64, t: f64) -> (f64, f64) {
        let turn = std::f64::consts::TAU / period;
        let (sine, cosine) = (t * turn + phase * std::f64::consts::TAU).sin_cos();
        (amplitude * sine, amplitude * turn * cosine)
    }

    /// Position and velocity at a time.
    pub fn at(&self, t: f64) -> (f64, f64) {
        let (wobble, wobbling) = Self::wave(self.wobble_d, self.wobble_ticks, self.wobble_phase, t);
        let (drift, drifting) = Self::wave(self.drift_d, self.drift_ticks, self.wobble_phase, t);
        let (x, v) = if self.damping == 0.0 {
            let v = self.velocity + self.acceleration * t;
            (self.velocity * t + self.acceleration * t * t / 2.0, v)
        } else {
            // dv/dt = a − c·v
            let rest = self.acceleration / self.damping;
            let decay = (-self.damping * t).exp();
            let v = rest + (self.velocity - rest) * decay;
            (
                rest * t + (self.velocity - rest) * (1.0 - decay) / self.damping,
                v,
            )
        };
        (self.start + x + wobble + drift, v + wobbling + drifting)
    }
}
