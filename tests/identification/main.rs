//! Identification of simulated drives, through the axis.

mod support;

use support::Bench;

#[test]
fn look() {
    for (name, bench) in [("bare", Bench::bare()), ("full", Bench::full())] {
        let begin = std::time::Instant::now();
        let outcome = bench.run();
        println!(
            "{name}: {:?} ticks {} far {} cmd {} {:#?}",
            begin.elapsed(),
            outcome.ticks,
            outcome.furthest_d,
            outcome.largest_command,
            outcome.result
        );
    }
}
