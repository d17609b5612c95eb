//! Counts events of which some are forgiven as time goes by.

/// What is allowed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Events allowed at once.
    pub limit: u32,
    /// One is forgiven in so many ticks; at least 1.
    pub forgive_ticks: u32,
}

/// The count.
#[derive(Clone, Copy, Debug, Default)]
pub struct Leaky {
    level: u32,
    /// Tick up to which has been forgiven.
    forgiven_at: u32,
}

impl Leaky {
    /// Adds `events` at tick `tick`; true if they are too many.
    #[cold]
    pub fn add(&mut self, limits: &Limits, events: u32, tick: u32) -> bool {
        let since = tick.wrapping_sub(self.forgiven_at);
        let forgiven = since.checked_div(limits.forgive_ticks).unwrap_or(0);
        self.level = self.level.saturating_sub(forgiven);
        self.forgiven_at = if self.level == 0 {
            tick
        } else {
            self.forgiven_at
                .wrapping_add(forgiven.wrapping_mul(limits.forgive_ticks))
        };
        self.level = self.level.saturating_add(events);
        self.level > limits.limit
    }

    /// Events that are not forgiven.
    pub const fn level(&self) -> u32 {
        self.level
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn events_at_the_forgiven_rate_never_add_up_and_faster_ones_do() {
        let limits = Limits {
            limit: 3,
            forgive_ticks: 100,
        };
        let mut slow = Leaky::default();
        assert!((0..1000).all(|event| !slow.add(&limits, 1, u32::MAX.wrapping_add(event * 100))));
        let mut fast = Leaky::default();
        let seen: [bool; 5] = core::array::from_fn(|event| fast.add(&limits, 1, event as u32 * 10));
        assert_eq!(seen, [false, false, false, true, true]);
        let mut burst = Leaky::default();
        assert!(burst.add(&limits, 65_535, 7));
        assert_eq!(burst.level(), 65_535);
    }
}
