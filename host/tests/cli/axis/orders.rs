//! Orders and reports of an axis in the tool's own process.

use super::Bench;
use crate::{assert_says, number};

#[test]
fn an_axis_tells_what_it_is_and_how_it_stands() {
    let bench = Bench::new();
    let identity = bench.json("identity");
    assert_eq!(identity["board"], "simulated");
    assert_eq!(identity["tick_hz"], 1000);
    assert_eq!(bench.json("status")["state"], "disabled");
    let counters = bench.json("counters");
    assert_eq!(counters["late_ticks"], 0);
    assert!(number(&counters, "/ticks") > 0.0);
    assert_says(&bench.printed("identity"), &["homing", "1000 Hz", "sim"]);
    assert_says(&bench.printed("counters"), &["took too long", "indexes"]);
}

#[test]
fn a_fault_is_told_with_figures_cause_and_remedy_and_is_cleared() {
    let bench = Bench::new();
    assert_eq!(bench.printed("faults"), "no fault\n");
    bench.0.write("fault", "enable\nhome\n");
    let served = bench.serve();
    // Homing away from the switch runs into the limit, or finds nothing.
    let failed = served.command("run fault --keep").output();
    assert_eq!(failed.expect("it starts").status.code(), Some(1));
    let faults = served.json("faults");
    let fault = &faults["fault"];
    assert!(fault["remedy"].as_str().is_some_and(|text| text.len() > 10));
    assert!(fault["cause"].as_str().is_some_and(|text| text.len() > 10));
    assert!(number(&faults, "/fault/ago_s") >= 0.0);
    let position = number(&faults, "/fault/position/mm");
    let counts = number(&faults, "/fault/position/d");
    assert!((counts / 1000.0 - position).abs() < 1e-6);
    assert_eq!(served.json("status")["state"], "in fault");
    let refused = served.command("enable").output().expect("it starts");
    assert_says(
        &crate::text(&refused.stderr),
        &["A fault is latched", "disable, clear it, then enable"],
    );
    served.json("disable");
    let cleared = served.json("clear");
    assert!(cleared["fault"].is_null(), "{cleared}");
    assert_eq!(cleared["state"], "disabled");
}
