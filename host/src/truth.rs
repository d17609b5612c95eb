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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn motion_of_constant_jerk_is_met_between_ticks() {
        let motion = Arc {
            start: State {
                position: 5.0,
                velocity: -3.0,
                acceleration: 0.25,
            },
            jerk: 0.125,
        };
        let mut track = TruthTrack::default();
        (0..10).for_each(|tick| track.push(motion.at(f64::from(tick))));
        for (tick, lag) in [
            (0, 0.0),
            (3, 0.0),
            (3, 0.5),
            (9, 4.75),
            (9, 9.0),
            (8, -0.75),
        ] {
            let expected = motion.at(tick as f64 - lag);
            let found = track.before(tick, lag).expect("within the track");
            let errors = [
                found.position - expected.position,
                found.velocity - expected.velocity,
                found.acceleration - expected.acceleration,
            ];
            assert!(
                errors.iter().all(|error| error.abs() < 1e-12),
                "{tick}, {lag}"
            );
        }
        assert_eq!(track.before(2, 2.5), None);
        assert_eq!(track.before(9, -0.5), None);
        assert_eq!(track.before(10, 0.0), None);
    }
}
