//! The latch: found between the edges, the delay taken off, whatever bounces or glitches come.

use leadscrew::probe::{ProbeEnd, ProbeParams, Stage};

use crate::follower::Follower;

#[test]
fn a_touch_is_found_between_the_edges_and_the_axis_goes_back() {
    for target in [3000.0, -3000.0] {
        let mut follower = Follower::new(ProbeParams::default());
        let start = follower.position;
        let bound: f64 = follower.probe(target, 200.0).unwrap().to_num();
        follower.run(400);
        let place = follower.touch();
        follower.touching = true;
        follower.reach(Stage::Retract);
        follower.run(5);
        follower.touching = false;
        follower.finish();
        let report = *follower.axis.probe().report();
        assert_eq!(report.end, Some(ProbeEnd::Touched));
        let touch = report.touch.unwrap();
        let raw: f64 = touch.raw.to_num();
        assert!((raw - place).abs() < 0.01, "{raw} instead of {place}");
        assert_eq!(touch.position, touch.raw, "no origin, no compensation");
        let overtravel: f64 = touch.overtravel.to_num();
        assert!(
            overtravel > 20.0 && overtravel <= bound,
            "{overtravel} {bound}"
        );
        let way = if target > 0.0 { 1.0 } else { -1.0 };
        let back = place + way * (overtravel - 200.0) - follower.position;
        // A tick of the way back is 8.3 d: one by which the stop comes early, and one by which it is foreseen.
        assert!(back.abs() < 2.0 * 8.4, "{back}");
        assert!(way * (place - start) > 500.0);
        assert!(touch.edges > 20);
    }
}

#[test]
fn the_trigger_delay_is_taken_off_in_time() {
    let delayed = ProbeParams {
        trigger_delay_s: 0.005,
        ..ProbeParams::default()
    };
    let mut follower = Follower::new(delayed);
    follower.probe(3000.0, 0.0).unwrap();
    follower.run(400);
    let place = follower.touch() - 5.0 * 1.67;
    follower.touching = true;
    follower.finish();
    let raw: f64 = follower.axis.probe().report().touch.unwrap().raw.to_num();
    assert!((raw - place).abs() < 0.01, "{raw} instead of {place}");
}

#[test]
fn the_latch_is_that_of_the_first_edge_whatever_bounces_after_it() {
    let debounced = ProbeParams {
        debounce_s: 0.003,
        ..ProbeParams::default()
    };
    // Level in the ticks after the edge: what is not here stays.
    for bounces in [
        vec![],
        vec![false, true, false, true],
        vec![true, false, true, false, false, true],
        vec![false, false, true, false, false, true, false, false, true],
    ] {
        let mut follower = Follower::new(debounced);
        follower.probe(3000.0, 0.0).unwrap();
        follower.run(400);
        let place = follower.touch();
        let latched_in = follower.outputs.tick.wrapping_add(1);
        follower.touching = true;
        follower.step();
        for &level in &bounces {
            follower.touching = level;
            if level {
                follower.touch();
            }
            follower.step();
        }
        follower.touching = true;
        follower.finish();
        let touch = follower.axis.probe().report().touch.unwrap();
        let raw: f64 = touch.raw.to_num();
        assert!((raw - place).abs() < 0.01, "{bounces:?}: {raw} {place}");
        assert_eq!(touch.tick, latched_in);
        assert_eq!(follower.axis.probe().report().glitches, 0);
    }
}

#[test]
fn a_glitch_is_counted_and_the_next_edge_is_the_touch() {
    let mut follower = Follower::new(ProbeParams::default());
    follower.probe(3000.0, 0.0).unwrap();
    for _ in 0..3 {
        follower.run(100);
        follower.touch();
        follower.run(5);
    }
    assert_eq!(follower.axis.probe().stage(), Stage::Approach);
    follower.run(100);
    let place = follower.touch();
    follower.touching = true;
    follower.finish();
    let report = *follower.axis.probe().report();
    assert_eq!((report.glitches, report.touches), (3, 1));
    let raw: f64 = report.touch.unwrap().raw.to_num();
    assert!((raw - place).abs() < 0.01);
}
