//! Lost motion: a follower that moves only when the leader has taken up the play.

/// The play operator.
#[derive(Clone, Copy, Debug)]
pub struct Play {
    half_width: f64,
    follower: f64,
}

impl Play {
    /// A follower at `position` in the middle of a play of `width`.
    #[must_use]
    pub const fn new(width: f64, position: f64) -> Self {
        Self {
            half_width: 0.5 * width,
            follower: position,
        }
    }

    /// Where the follower is when the leader has come to `leader`; true if the leader drives it.
    pub fn follow(&mut self, leader: f64) -> (f64, bool) {
        if self.half_width == 0.0 {
            self.follower = leader;
            return (leader, true);
        }
        let lowest = leader - self.half_width;
        let highest = leader + self.half_width;
        let driven = self.follower <= lowest || self.follower >= highest;
        self.follower = if self.follower < lowest {
            lowest
        } else if self.follower > highest {
            highest
        } else {
            self.follower
        };
        (self.follower, driven)
    }
}
