//! From factory settings to a tuned, calibrated, saved axis.

use leadscrew_host::axis::setup::{Answers, Steps, setup};
use leadscrew_host::simulated_axis::FlashImage;

use crate::support::{Agreeing, bench};

#[test]
fn an_axis_with_a_blank_flash_is_commissioned_and_keeps_it() {
    let flash = FlashImage::blank();
    let mut bench = bench(&flash);
    let mut guide = Agreeing::default();
    let outcome = setup(
        &mut bench.tool,
        &mut guide,
        Answers::default(),
        &Steps::default(),
    );
    println!("ticks {}", bench.machine.borrow().ticks());
    println!("{outcome:?}");
    outcome.unwrap();
}
