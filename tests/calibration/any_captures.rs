//! Nothing that a board may deliver makes the learner panic.

use leadscrew::calibration::{Requirements, RunPlan};
use leadscrew::hal::Latch;

use crate::generator::{Memory, Tick, learn};
use crate::motion::Dice;

#[test]
fn captures_of_whatever_kind_are_refused_or_taken_without_panic() {
    let mut dice = Dice::new(3);
    let mut drawn = |most: f64| (dice.uniform() * most) as u32;
    let mut memory = Memory::new(512);
    let mut learner = memory.learner();
    for _ in 0..2000 {
        // Now a clean revolution, now anything.
        let (stride, wild) = (drawn(900.0), drawn(4.0) == 0);
        let mut tick = Tick::default();
        let run: Vec<Tick> = (0..drawn(60.0))
            .map(|_| {
                let from = tick.sampled_at;
                tick.count += i64::from(stride);
                tick.sampled_at = from.wrapping_add(1 + drawn(4e9));
                tick.times = (0..stride)
                    .map(|edge| from.wrapping_add(edge * 10))
                    .collect();
                let index = Latch {
                    count: (tick.count / 512 * 512) as u32,
                    time: from,
                };
                tick.index = (drawn(3.0) > 0).then_some(index);
                if wild {
                    tick.count ^= i64::from(drawn(2.0).wrapping_mul(drawn(4e9)));
                    tick.overrun = drawn(9.0) == 0;
                }
                tick.clone()
            })
            .collect();
        let _ = learn(&mut learner, RunPlan::steady(12), run.into_iter());
    }
    let _ = learner.finish(&Requirements::default());
}
