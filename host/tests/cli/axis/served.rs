//! An axis that goes on running, several commands one after the other, and Ctrl-C. Real processes on real time: what is
//! asserted is what they do, not when.

use std::thread;
use std::time::Duration;

use serde_json::Value;

use super::{Bench, interrupt};
use crate::{assert_says, number, text};

/// Long enough for a jog to be seen.
const A_WHILE: Duration = Duration::from_millis(300);

#[test]
fn commands_reach_the_same_axis_one_after_the_other() {
    let bench = Bench::commissioned();
    let served = bench.serve();
    assert_eq!(served.json("enable")["state"], "ready");
    let there = served.json("move 5 --feed 3000");
    assert!((number(&there, "/setpoint_mm") - 5.0).abs() < 1e-6);
    let back = served.json("move --by -2 --feed 3000");
    assert!((number(&back, "/setpoint_mm") - 3.0).abs() < 1e-6);
    let jogged = served.json_of_jog("jog -600 --for 0.2");
    assert!(number(&jogged, "/setpoint_mm") < 2.5, "{jogged}");
    assert_eq!(served.json("override 50")["override_percent"], 50);
    let set = served.command("params set estimator simple").output();
    let set = set.expect("it starts");
    assert_eq!(set.status.code(), Some(1));
    assert_says(&text(&set.stderr), &["The axis is on", "Disable the axis"]);
    assert_eq!(served.json("disable")["state"], "disabled");
    served.json("params set estimator simple");
    assert_eq!(served.json("params get estimator")["word"], "simple");
    served.json("restart");
    assert_eq!(served.json("params get estimator")["word"], "exponential");
}

#[test]
fn ctrl_c_stops_the_axis_first() {
    let bench = Bench::commissioned();
    let served = bench.serve();
    served.json("enable");
    let jog = served.jog("3000");
    thread::sleep(A_WHILE);
    interrupt(&jog);
    let output = jog.wait_with_output().expect("it ends");
    assert_eq!(output.status.code(), Some(0));
    let stood: Value = serde_json::from_str(&text(&output.stdout)).expect("JSON alone");
    assert_eq!(stood["moving"], false);
    assert_eq!(stood["state"], "ready");
    let later = served.json("status");
    assert_eq!(later["state"], "ready", "it is stopped, not off");
    assert!(number(&later, "/setpoint_mm") > 1.0, "it has moved");
    let creep = number(&later, "/setpoint_mm") - number(&stood, "/setpoint_mm");
    assert!(creep.abs() < 1e-6, "it stands: {creep} mm");
}

#[test]
fn ctrl_c_in_a_script_stops_and_disables() {
    let bench = Bench::commissioned();
    bench
        .0
        .write("long", "enable\nprint under way\nmove 1000 feed 3000\n");
    let served = bench.serve();
    let mut run = served.command("run long");
    let run = run
        .stdout(std::process::Stdio::piped())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .expect("it starts");
    thread::sleep(4 * A_WHILE);
    interrupt(&run);
    let output = run.wait_with_output().expect("it ends");
    assert_eq!(output.status.code(), Some(1));
    assert_says(
        &text(&output.stderr),
        &["long:3:", "interrupted: the axis stands"],
    );
    let mut status = served.json("status");
    for _ in 0..100 {
        if status["state"] == "disabled" {
            break;
        }
        thread::sleep(Duration::from_millis(20));
        status = served.json("status");
    }
    assert_eq!(status["state"], "disabled");
    assert!(number(&status, "/setpoint_mm") < 900.0, "{status}");
}

#[test]
fn an_axis_that_is_lost_in_mid_move_is_told_with_its_exit_code() {
    let bench = Bench::commissioned();
    let mut served = bench.serve();
    served.json("enable");
    let jog = served.jog("600");
    thread::sleep(A_WHILE);
    served.child.kill().expect("the server is killed");
    let output = jog.wait_with_output().expect("it ends");
    assert_eq!(output.status.code(), Some(3));
    assert_says(
        &text(&output.stderr),
        &["error: ", "is gone", "stops by itself", "connect anew"],
    );
}

#[test]
fn another_tool_takes_over_and_the_axis_stops() {
    let bench = Bench::commissioned();
    let served = bench.serve();
    served.json("enable");
    let jog = served.jog("600");
    thread::sleep(A_WHILE);
    let stopped = served.json("stop");
    assert_eq!(stopped["moving"], false);
    let output = jog.wait_with_output().expect("it ends");
    assert_eq!(output.status.code(), Some(3));
}

#[test]
fn ctrl_c_switches_a_served_axis_off() {
    let bench = Bench::new();
    let mut served = bench.serve();
    assert_eq!(served.json("status")["state"], "disabled");
    interrupt(&served.child);
    let ended = served.child.wait().expect("it ends");
    assert_eq!(ended.code(), Some(0));
    let message = served
        .folder
        .refused(1, &format!("--port {} status", served.port));
    assert_says(&message, &["Nobody listens there"]);
}
