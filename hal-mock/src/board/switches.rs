//! Switches that the carriage runs over, and the latch of the home switch.

use leadscrew::hal::{Capture, Latch};
use leadscrew::parameter_table::ParameterTable;
use leadscrew::units::RangeError;

leadscrew::parameter_table! {
    /// Where the switches are, by the carriage; the machine starts at 0 mm. The defaults are out of reach.
    pub struct SwitchParams {
        /// The low limit switch is actuated below this
        limit_low_mm: -1e6, "mm", -1e6..=1e6;
        /// The high limit switch is actuated above this
        limit_high_mm: 1e6, "mm", -1e6..=1e6;
        /// The home switch is actuated below this
        home_mm: -1e6, "mm", -1e6..=1e6;
        /// What a switch needs to be released
        hysteresis_mm: 0.05, "mm", 0.0..=10.0;
    }
}

/// A switch of which one side actuates it.
#[derive(Clone, Copy, Debug)]
struct Switch {
    /// +1 if it is actuated above its place, −1 below it.
    side: f64,
    place: f64,
    hysteresis: f64,
    actuated: bool,
}

impl Switch {
    fn new(side: f64, place: f64, hysteresis: f64, carriage: f64) -> Self {
        Self {
            side,
            place,
            hysteresis,
            actuated: side * (carriage - place) > 0.0,
        }
    }

    /// Follows the carriage to `carriage`, d.
    fn step(&mut self, carriage: f64) {
        let beyond = self.side * (carriage - self.place);
        let threshold = if self.actuated { -self.hysteresis } else { 0.0 };
        self.actuated = beyond > threshold;
    }
}

/// All switches of an axis.
#[derive(Clone, Copy, Debug)]
pub struct Switches {
    low: Switch,
    high: Switch,
    home: Switch,
    carriage: f64,
}

impl Switches {
    /// Switches under a carriage at `carriage` d.
    pub fn new(
        params: &SwitchParams,
        counts_per_mm: f64,
        carriage: f64,
    ) -> Result<Self, RangeError> {
        params.check()?;
        let hysteresis = params.hysteresis_mm * counts_per_mm;
        let switch =
            |side, place_mm: f64| Switch::new(side, place_mm * counts_per_mm, hysteresis, carriage);
        Ok(Self {
            low: switch(-1.0, params.limit_low_mm),
            high: switch(1.0, params.limit_high_mm),
            home: switch(-1.0, params.home_mm),
            carriage,
        })
    }

    /// True on the low limit switch.
    pub const fn low(&self) -> bool {
        self.low.actuated
    }

    /// True on the high limit switch.
    pub const fn high(&self) -> bool {
        self.high.actuated
    }

    /// True on the home switch.
    pub const fn home(&self) -> bool {
        self.home.actuated
    }

    /// Follows the carriage through a tick to `carriage` d; gives the share of the tick at which it ran onto
    /// the home switch. The carriage moves evenly within a tick, to the millionth that its acceleration makes.
    pub fn step(&mut self, carriage: f64) -> Option<f64> {
        let before = core::mem::replace(&mut self.carriage, carriage);
        self.low.step(carriage);
        self.high.step(carriage);
        let was_home = self.home.actuated;
        self.home.step(carriage);
        let way = carriage - before;
        (self.home.actuated && !was_home && way != 0.0)
            .then(|| ((self.home.place - before) / way).clamp(0.0, 1.0))
    }
}

/// The latch of an event at a share of the tick between the sampling instant `before` (count and timer) and
/// `capture`.
pub fn latch(before: (u32, u32), capture: &Capture<'_>, share: f64) -> Latch {
    let elapsed = capture.sampled_at.wrapping_sub(before.1);
    let time = before.1.wrapping_add((f64::from(elapsed) * share) as u32);
    latch_at(before, capture, time)
}

/// The same of an event at a time.
pub fn latch_at(before: (u32, u32), capture: &Capture<'_>, time: u32) -> Latch {
    let (count, sampled_at) = before;
    let moved = capture.count.wrapping_sub(count).cast_signed();
    let edges = capture.edges.into_iter().flatten();
    let (all, passed) = edges.fold((0_u32, 0_i32), |(all, passed), &edge| {
        let is_before =
            capture.sampled_at.wrapping_sub(edge) >= capture.sampled_at.wrapping_sub(time);
        (all + 1, passed + i32::from(is_before))
    });
    // Where the edges do not tell, evenly.
    let gone = if all == moved.unsigned_abs() {
        passed * moved.signum()
    } else {
        let elapsed = capture.sampled_at.wrapping_sub(sampled_at).max(1);
        let share = f64::from(time.wrapping_sub(sampled_at)) / f64::from(elapsed);
        (f64::from(moved) * share) as i32
    };
    Latch {
        count: count.wrapping_add_signed(gone),
        time,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_switch_opens_again_only_beyond_its_hysteresis() {
        let mut switch = Switch::new(1.0, 10.0, 2.0, 0.0);
        for (carriage, actuated) in [
            (9.9, false),
            (10.1, true),
            (8.5, true),
            (7.9, false),
            (9.0, false),
        ] {
            switch.step(carriage);
            assert_eq!(switch.actuated, actuated, "{carriage}");
        }
    }

    #[test]
    fn a_latch_counts_the_edges_before_it() {
        let times = [110, 130, 150, 170];
        let capture = Capture {
            count: 3_u32.wrapping_sub(4),
            sampled_at: 200,
            edges: [&times[..1], &times[1..]],
            ..Capture::default()
        };
        let latch = latch((3, 100), &capture, 0.4);
        assert_eq!((latch.count, latch.time), (1, 140));
    }
}
