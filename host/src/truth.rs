//! True motion between ticks, for comparing an estimate with the instant it is for.

use leadscrew_hal_mock::arc::{Arc, State};

/// The shaft's state at every tick of a run.
#[derive(Clone, Debug, Default)]
pub struct TruthTrack {
    states: Vec<State>,
}

impl TruthTrack {
    /// Adds the state of the next tick.
    pub fn push(&mut self, state: State) {
        self.states.push(state);
    }

    /// The state `lag` ticks before tick `tick`; `None` before the first tick.
    ///
    /// Between ticks the motion is the cubic of constant jerk that the simulator moved by.
    #[must_use]
    pub fn before(&self, tick: usize, lag: f64) -> Option<State> {
        let instant = tick as f64 - lag;
        if instant < 0.0 {
            return None;
        }
        let start = self.states.get(instant as usize)?;
        let within = instant.fract();
        if within == 0.0 {
            return Some(*start);
        }
        let end = self.states.get(instant as usize + 1)?;
        Some(
            Arc {
                start: *start,
                jerk: end.acceleration - start.acceleration,
            }
            .at(within),
        )
    }
}
