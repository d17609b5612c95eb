//! Motion within one tick: a cubic in time.

/// State of motion, in d and ticks.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct State {
    /// Position, d.
    pub position: f64,
    /// Velocity, d/tick.
    pub velocity: f64,
    /// Acceleration, d/tick².
    pub acceleration: f64,
}

/// Motion of one tick under constant jerk, from its start on.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Arc {
    /// State at the start of the tick.
    pub start: State,
    /// Jerk, d/tick³.
    pub jerk: f64,
}

impl Arc {
    /// The state after a fraction `time` of the tick.
    #[must_use]
    pub fn at(&self, time: f64) -> State {
        let State {
            position,
            velocity,
            acceleration,
        } = self.start;
        let bend = acceleration + self.jerk * time * (1.0 / 3.0);
        State {
            position: position + time * (velocity + time * 0.5 * bend),
            velocity: velocity + time * (acceleration + time * 0.5 * self.jerk),
            acceleration: acceleration + time * self.jerk,
        }
    }

    /// The state at the end of the tick.
    #[must_use]
    pub fn end(&self) -> State {
        self.at(1.0)
    }

    /// The arc that joins two positions with the given velocities at its ends (cubic Hermite).
    #[must_use]
    pub fn joining(from: (f64, f64), to: (f64, f64)) -> Self {
        let (position, velocity) = from;
        let way = to.0 - position - velocity;
        let gain = to.1 - velocity;
        Self {
            start: State {
                position,
                velocity,
                acceleration: 6.0 * way - 2.0 * gain,
            },
            jerk: 6.0 * gain - 12.0 * way,
        }
    }
}
