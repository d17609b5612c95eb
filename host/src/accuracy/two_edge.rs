//! The method of the best open peer, to compare with: hostmot2's velocity from the last edge of each tick.
//!
//! V = (count − count before)/(time of the last edge − time of the last edge before), for the middle between the two
//! edges. Without a new edge V stays as it is, held below one discrete over the time since the last edge. The peer
//! has no acceleration; here it is the difference of V over a tick.

use leadscrew::capture::Observation;

/// What the method says after a tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TwoEdgeEstimate {
    /// Velocity, d/tick.
    pub velocity: f64,
    /// How far back its instant lies, ticks.
    pub lag_v: f64,
    /// Acceleration, d/tick².
    pub acceleration: f64,
    /// How far back its instant lies, ticks.
    pub lag_a: f64,
}

/// The method's state.
#[derive(Clone, Debug)]
pub struct TwoEdge {
    clocks_per_tick: f64,
    /// Time of the last edge, clocks, and the place it stands for.
    last: Option<(i64, i64)>,
    newest: TwoEdgeEstimate,
}

impl TwoEdge {
    /// The method on a timer with that many clocks a tick.
    #[must_use]
    pub fn new(clocks_per_tick: f64) -> Self {
        Self {
            clocks_per_tick,
            last: None,
            newest: TwoEdgeEstimate::default(),
        }
    }

    /// Takes a tick.
    pub fn update(&mut self, observation: &Observation<'_>) -> TwoEdgeEstimate {
        let before = self.newest;
        self.newest.lag_v += 1.0;
        match observation.since_last_edge() {
            Some(age) => self.edge(observation, age),
            None => self.wait(observation),
        }
        self.newest.acceleration = self.newest.velocity - before.velocity;
        self.newest.lag_a = 0.5 * (self.newest.lag_v + before.lag_v + 1.0);
        self.newest
    }

    fn edge(&mut self, observation: &Observation<'_>, age: u32) {
        let time = observation.sampled_at - i64::from(age);
        // Going backward the edge is the upper end of the discrete.
        let place = observation.count + i64::from(observation.delta < 0);
        if let Some((time_before, place_before)) = self.last.replace((time, place))
            && time > time_before
        {
            let span = (time - time_before) as f64 / self.clocks_per_tick;
            self.newest.velocity = (place - place_before) as f64 / span;
            self.newest.lag_v = f64::from(age) / self.clocks_per_tick + 0.5 * span;
        }
    }

    fn wait(&mut self, observation: &Observation<'_>) {
        if let Some((time, _)) = self.last {
            let most = self.clocks_per_tick / (observation.sampled_at - time).max(1) as f64;
            self.newest.velocity = self.newest.velocity.clamp(-most, most);
        }
    }
}
