//! `probe` on the simulated axis.

use super::Bench;
use crate::Folder;

#[test]
fn the_part_of_the_simulated_axis_is_touched_as_often_as_asked() {
    let bench = Bench::commissioned();
    let json =
        bench.json("probe --enable --towards 20 --feed 300 --retract 0.5 --repeat 3 --csv t.csv");
    let touches = json["touches"].as_array().unwrap();
    assert_eq!(touches.len(), 3);
    let mean = json["mean_mm"].as_f64().unwrap();
    // The carriage stands beside the shaft by the screw's error and by what its probe scatters.
    assert!((mean - 15.0).abs() < 0.02, "{mean}");
    let two_sigma = json["two_sigma_mm"].as_f64().unwrap();
    assert!(two_sigma < 0.01, "{two_sigma}");
    assert!(touches[0]["edges"].as_u64().unwrap() > 20);
    assert_eq!(json["schema"], "leadscrew/probe/1");
    let csv = std::fs::read_to_string(bench.0.path("t.csv")).unwrap();
    assert_eq!(csv.lines().count(), 4);
}

#[test]
fn what_cannot_be_probed_is_told() {
    let bench = Bench::commissioned();
    let none = bench.refused(1, "probe --enable --towards 2 --feed 300");
    assert!(
        none.contains("there was no touch on the whole way"),
        "{none}"
    );
    let fast = bench.refused(1, "probe --enable --towards 20 --feed 5000");
    assert!(fast.contains("Probe slower"), "{fast}");
    let usage = bench.refused(2, "probe --towards 20 --feed 0");
    assert!(usage.contains("--feed 0"), "{usage}");
    let usage = bench.refused(2, "probe --towards 20 --feed 10 --retract 0 --repeat 2");
    assert!(usage.contains("--retract"), "{usage}");
    let off = bench.refused(1, "probe --towards 20 --feed 100");
    assert!(off.contains("leadscrew serve"), "{off}");
}

/// Factory settings on the machine with friction: the loop cannot creep, and the way out is told.
#[test]
fn a_loop_of_the_factory_that_cannot_creep_is_told_to_be_commissioned() {
    let folder = Folder::new();
    let output = folder.run("--port sim probe --enable --towards 20 --feed 100");
    assert_eq!(output.status.code(), Some(1));
    let error = crate::text(&output.stderr);
    assert!(error.contains("FollowingError"), "{error}");
    assert!(
        error.contains("commission the axis by `leadscrew setup`"),
        "{error}"
    );
}
