//! From a blank flash to an axis that is set up, by commands alone; then a power cycle, and it is still set up. Every
//! command switches the axis on anew.

use std::path::Path;
use std::process::Command;

/// What the command prints, which is to end well.
fn leadscrew(flash: &Path, words: &[&str]) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_leadscrew"))
        .args(["--port", "sim", "--flash"])
        .arg(flash)
        .args(words)
        .output()
        .unwrap();
    let error = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{words:?}: {error}");
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn a_blank_axis_is_commissioned_and_stays_so() {
    let folder = tempfile::tempdir().unwrap();
    let flash = folder.path().join("flash");
    leadscrew(&flash, &["setup", "--yes"]);
    // Its home switch is at the low end.
    let low = "homing.search_direction=-1";
    leadscrew(&flash, &["params", "set", "--save", low]);
    let set = leadscrew(&flash, &["params", "diff"]);
    for name in [
        "controller.position_gain_per_s",
        "motion.full_command_feed_mm_per_min",
    ] {
        assert!(set.contains(name), "{set}");
    }
    // It moves, and is where it was sent.
    let script = folder.path().join("script");
    std::fs::write(
        &script,
        "enable\nhome\nmove 100 feed 9000\nmove 0 feed 9000\n",
    )
    .unwrap();
    leadscrew(&flash, &["run", &script.display().to_string()]);
    assert_eq!(leadscrew(&flash, &["params", "diff"]), set);
}
