//! The drive and its shaft in ticks: what a command held for a tick does to position, velocity and acceleration.

use core::f64::consts::TAU;

/// Three numbers, one for each of x, v, a in d and ticks.
pub type Vector = [f64; 3];
/// Rows.
pub type Matrix = [Vector; 3];

/// s₊ = F·s + g·u with s = (x, v, a), for a drive of second order under a command that is held over the tick: exact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plant {
    /// F.
    pub transition: Matrix,
    /// g, per full command.
    pub input: Vector,
}

impl Plant {
    /// The drive v″ + 2ζω·v′ + ω²·v = ω²·G·u with G = `full_velocity` in d/tick and ω in rad/tick.
    ///
    /// By the series of the exponential of [0 1 0 0; 0 0 1 0; 0 −ω² −2ζω ω²G; 0 0 0 0]; 40 terms are enough up to
    /// ω = 0.8 at ζ = 10.
    #[must_use]
    pub fn new(omega: f64, damping: f64, full_velocity: f64) -> Self {
        let (square, double) = (omega * omega, 2.0 * damping * omega);
        let column = |start: [f64; 4]| {
            let mut sum = start;
            let mut term = start;
            for order in 1..=60_u32 {
                let [_, v, a, u] = term;
                let share = 1.0 / f64::from(order);
                term = [
                    v * share,
                    a * share,
                    (square * (full_velocity * u - v) - double * a) * share,
                    0.0,
                ];
                for (sum, term) in sum.iter_mut().zip(term) {
                    *sum += term;
                }
            }
            let [x, v, a, _] = sum;
            [x, v, a]
        };
        let [[xx, vx, ax], [xv, vv, av], [xa, va, aa]] = [
            column([1.0, 0.0, 0.0, 0.0]),
            column([0.0, 1.0, 0.0, 0.0]),
            column([0.0, 0.0, 1.0, 0.0]),
        ];
        Self {
            transition: [[xx, xv, xa], [vx, vv, va], [ax, av, aa]],
            input: column([0.0, 0.0, 0.0, 1.0]),
        }
    }

    /// A plant of natural period `period_ticks`.
    #[must_use]
    pub fn with_period(period_ticks: f64, damping: f64, full_velocity: f64) -> Self {
        Self::new(TAU / period_ticks, damping, full_velocity)
    }

    /// The state a tick later under `command`.
    #[must_use]
    pub fn step(&self, state: &Vector, command: f64) -> Vector {
        let mut next = [0.0; 3];
        for ((next, row), input) in next.iter_mut().zip(&self.transition).zip(self.input) {
            *next = dot(row, state) + input * command;
        }
        next
    }

    /// `gains`·F: gains on the state of now that are those on the state a tick later.
    #[must_use]
    pub fn earlier(&self, gains: &Vector) -> Vector {
        let [rows_x, rows_v, rows_a] = &self.transition;
        let [x, v, a] = *gains;
        let mut sum = [0.0; 3];
        for (((sum, by_x), by_v), by_a) in sum.iter_mut().zip(rows_x).zip(rows_v).zip(rows_a) {
            *sum = x * by_x + v * by_v + a * by_a;
        }
        sum
    }

    /// What a feedback that is to act `ticks` later takes: its gains on the state of now, and the taps on the commands
    /// on their way, the newest first: K·F^D and K·F^(i−1)·g. A tap beyond the last is dropped.
    #[must_use]
    pub fn predicted<const N: usize>(&self, gains: &Vector, ticks: usize) -> (Vector, [f64; N]) {
        let mut taps = [0.0; N];
        let mut gains = *gains;
        for tap in taps.iter_mut().take(ticks) {
            *tap = dot(&gains, &self.input);
            gains = self.earlier(&gains);
        }
        (gains, taps)
    }
}

fn dot(one: &Vector, other: &Vector) -> f64 {
    one.iter().zip(other).map(|(one, other)| one * other).sum()
}

#[cfg(test)]
mod tests {
    use super::Plant;

    #[test]
    fn a_tick_is_what_many_short_ones_come_to() {
        let (omega, damping, full) = (0.0698, 0.5, 160.0);
        let tick = Plant::new(omega, damping, full);
        let mut state = [3.0, -2.0, 0.5];
        let whole = tick.step(&state, 0.3);
        let parts = 100_000;
        let step = 1.0 / f64::from(parts);
        for _ in 0..parts {
            let [x, v, a] = state;
            let jerk = omega * omega * (full * 0.3 - v) - 2.0 * damping * omega * a;
            state = [
                x + step * v + step * step * a / 2.0,
                v + step * a + step * step * jerk / 2.0,
                a + step * jerk,
            ];
        }
        for (seen, expected) in whole.into_iter().zip(state) {
            assert!((seen - expected).abs() < 1e-5, "{seen} of {expected}");
        }
    }

    #[test]
    fn the_predicted_feedback_is_that_on_the_state_when_the_command_arrives() {
        let plant = Plant::with_period(90.0, 0.5, 160.0);
        let gains = [0.01, 0.02, 0.3];
        let (now, taps): (_, [f64; 4]) = plant.predicted(&gains, 3);
        let commands = [0.2, -0.1, 0.4];
        let start = [1.0, -0.5, 0.2];
        // The oldest arrives first.
        let later = commands
            .iter()
            .rev()
            .fold(start, |state, command| plant.step(&state, *command));
        let by = |gains: &[f64; 3], state: &[f64; 3]| -> f64 {
            gains
                .iter()
                .zip(state)
                .map(|(gain, value)| gain * value)
                .sum()
        };
        let seen = by(&now, &start)
            + taps
                .iter()
                .zip(commands)
                .map(|(tap, command)| tap * command)
                .sum::<f64>();
        assert!((seen - by(&gains, &later)).abs() < 1e-12);
        assert_eq!(taps[3], 0.0);
    }
}
