//! The rows of the table: motions, how long they run, and the figures to reach.

use leadscrew_hal_mock::scene::{Motion, SCurve};

/// A motion to measure on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// What it is called.
    pub name: &'static str,
    /// The motion; run in the other direction as well.
    pub motion: Motion,
    /// Where it starts, d from the index; on the other side of it in the other direction.
    pub start_d: f64,
    /// Ticks until the index was passed and the estimators are settled.
    pub warm_up_ticks: u32,
    /// Ticks that are measured.
    pub ticks: u32,
    /// Figures to reach, a column each; none where the error is only stated.
    pub limits: [Option<f64>; 4],
}

/// The rows, in order.
pub const ROWS: [Row; 7] = [
    steady("50", 50.0, 10, FAST),
    steady("130", 130.0, 26, FAST),
    steady("150", 150.0, 30, FAST),
    steady("5", 5.0, 2, some([0.0003, 0.001, 0.002, 0.02])),
    steady("0.5", 0.5, 1, some([0.0004, 0.002, 0.003, 0.02])),
    S_CURVE,
    SINE,
];

const FAST: [Option<f64>; 4] = some([0.0002, 0.0008, 0.002, 0.01]);

/// Edges a revolution of the encoder "real".
const REVOLUTION_D: f64 = 10_000.0;
/// Distance to the index at the start.
const RUN_UP_D: f64 = 500.0;
/// Longest window, and some.
const SETTLING_TICKS: u32 = 100;

const fn some(limits: [f64; 4]) -> [Option<f64>; 4] {
    let [first, second, third, fourth] = limits;
    [Some(first), Some(second), Some(third), Some(fourth)]
}

/// A steady motion over so many whole revolutions.
const fn steady(
    name: &'static str,
    velocity: f64,
    revolutions: u32,
    limits: [Option<f64>; 4],
) -> Row {
    let ticks = revolutions as f64 * REVOLUTION_D / velocity;
    Row {
        name,
        motion: Motion::Steady { velocity },
        start_d: -RUN_UP_D,
        warm_up_ticks: (1.1 * RUN_UP_D / velocity) as u32 + SETTLING_TICKS,
        ticks: (ticks + 0.999) as u32,
        limits,
    }
}

/// There and back with a rest before each; the first time there and back is to settle.
const S_CURVE: Row = Row {
    name: "S-curve",
    motion: Motion::SCurve(SCurve {
        velocity: 150.0,
        acceleration: 0.9,
        jerk: 0.01,
        cruise_ticks: 200,
        rest_ticks: 50,
        there_and_back: true,
    }),
    start_d: -RUN_UP_D,
    // Rise and fall of the acceleration take 90 ticks each, its stay 77.
    warm_up_ticks: S_CURVE_TICKS,
    ticks: S_CURVE_TICKS,
    limits: [None, Some(0.05), Some(0.05), Some(0.05)],
};

const S_CURVE_TICKS: u32 = 2 * (50 + 2 * (2 * 90 + 77) + 200);

const SINE: Row = Row {
    name: "sine",
    motion: Motion::SINE,
    start_d: -RUN_UP_D,
    warm_up_ticks: 400,
    ticks: 5 * 400,
    limits: [None, None, Some(0.1), Some(0.1)],
};

impl Row {
    /// The same in the other direction.
    #[must_use]
    pub const fn reversed(self) -> Self {
        Self {
            motion: self.motion.reversed(),
            start_d: -self.start_d,
            ..self
        }
    }
}
