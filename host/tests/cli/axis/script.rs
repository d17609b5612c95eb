//! Scripts of moves and checks.

use super::Bench;
use crate::{assert_says, number, text};

/// The script of docs/commissioning.md.
const ACCEPTANCE: &str = include_str!("../../../../docs/acceptance.script");

#[test]
fn the_script_of_the_documents_passes() {
    let bench = Bench::commissioned();
    bench.0.write("acceptance.script", ACCEPTANCE);
    assert_says(
        &bench.printed("run acceptance.script --check"),
        &["nothing is wrong"],
    );
    let report = bench.json("run acceptance.script");
    assert_eq!(report["passed"], true, "{report}");
    let steps = report["steps"].as_array().expect("steps");
    let passes = steps.iter().filter(|step| step["step"] == "repeat 3");
    assert_eq!(passes.count(), 3);
    let times: Vec<f64> = steps.iter().map(|step| number(step, "/time_s")).collect();
    assert!(times.is_sorted(), "{times:?}");
    assert!(times.last().is_some_and(|last| *last > 5.0), "{times:?}");
    let again = bench.json("run acceptance.script");
    assert_eq!(report, again, "the same run twice");
}

#[test]
fn an_expectation_that_fails_ends_the_run_with_the_axis_off() {
    let bench = Bench::commissioned();
    bench.0.write(
        "wrong",
        "enable\nmove 5 feed 1000\nwait 0.3s # settles\nexpect position 6 within 0.5\nmove 0 feed 1000\n",
    );
    let served = bench.serve();
    let output = served.command("run wrong").output().expect("it starts");
    assert_eq!(output.status.code(), Some(1));
    assert_says(
        &text(&output.stderr),
        &[
            "wrong:4:",
            "`expect position 6 within 0.5`",
            "position is",
            "mm off",
        ],
    );
    assert_says(&text(&output.stdout), &["move 5 feed 1000"]);
    assert_eq!(served.json("status")["state"], "disabled");
    let kept = served
        .command("run wrong --keep")
        .output()
        .expect("it starts");
    assert_eq!(kept.status.code(), Some(1));
    assert_eq!(served.json("status")["state"], "ready");
}

#[test]
fn a_failed_run_is_told_in_json_too() {
    let bench = Bench::new();
    bench.0.write("fails", "expect state ready\n");
    let output = bench.run("run fails --json");
    assert_eq!(output.status.code(), Some(1));
    let report: serde_json::Value =
        serde_json::from_str(&text(&output.stdout)).expect("JSON alone");
    assert_eq!(report["passed"], false);
    assert_eq!(report["failed"]["line"], 1);
    assert_says(&text(&output.stderr), &["the axis is disabled"]);
}

#[test]
fn a_script_is_checked_whole_before_anything_moves() {
    let bench = Bench::commissioned();
    for (script, parts) in [
        (
            "enable\nmove 5 fed 1000\n",
            &["s:2:", "move MM feed MM_PER_MIN"][..],
        ),
        (
            "enable\n\nmoove 5 feed 1000\n",
            &["s:3:", "did you mean `move`?"],
        ),
        ("enable\nrepeat 2\nhome\n", &["s:2:", "no `end`"]),
        (
            "enable\nset motion.max_fed_mm_per_min 1\n",
            &["s:2:", "did you mean `motion.max_feed_mm_per_min`?"],
        ),
        (
            "enable\nrepeat 2\n  set motion.counts_per_mm 1m\nend\n",
            &["s:3:", "its unit is d/mm"],
        ),
        (
            "enable\nexpect parameter nonsense 1\n",
            &["s:2:", "no parameter `nonsense`"],
        ),
    ] {
        bench.0.write("s", script);
        // Nothing is printed: no step was done.
        let message = bench.refused(2, "run s");
        assert_says(&message, parts);
    }
}

#[test]
fn a_wrong_state_is_told_with_its_line() {
    let bench = Bench::commissioned();
    for (script, parts) in [
        (
            "move 5 feed 1000\n",
            &["s:1:", "not under control", "Enable the axis"][..],
        ),
        (
            "enable\nset estimator simple\n",
            &["s:2:", "set while it is off", "Disable the axis"],
        ),
        (
            "enable\nmove 5 feed 50000\n",
            &["s:2:", "max_feed_mm_per_min is 9000 mm/min"],
        ),
        (
            "enable\nsave\n",
            &["s:2:", "Saving the parameters was refused"],
        ),
        ("enable\nrestart\n", &["s:2:", "The restart was refused"]),
    ] {
        bench.0.write("s", script);
        let output = bench.run("run s");
        assert_eq!(output.status.code(), Some(1), "{script}");
        assert_says(&text(&output.stderr), parts);
    }
}
