//! From a blank flash to an axis that is set up, by commands alone; then a power cycle, and it is still set up. Every
//! command switches the axis on anew, so that nothing is left but what was saved.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

/// An axis that is switched on for each command.
struct Workshop<'f> {
    port: &'f str,
    folder: &'f Path,
}

impl Workshop<'_> {
    /// What the command prints, which is to end well.
    fn leadscrew(&self, words: &[&str]) -> String {
        let output = Command::new(env!("CARGO_BIN_EXE_leadscrew"))
            .current_dir(self.folder)
            .args(["--port", self.port, "--flash", "flash"])
            .args(words)
            .stdin(Stdio::null())
            .output()
            .unwrap();
        let error = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{words:?}: {error}");
        String::from_utf8(output.stdout).unwrap()
    }

    fn script(&self, text: &str) -> String {
        fs::write(self.folder.join("script"), text).unwrap();
        self.leadscrew(&["run", "script"])
    }

    /// Parameters and calibration, as a backup has them.
    fn backup(&self, name: &str) -> [Vec<u8>; 2] {
        let file = format!("{name}.toml");
        self.leadscrew(&["params", "backup", &file, "--calibration"]);
        let read = |file: String| fs::read(self.folder.join(file)).unwrap();
        [read(file), read(format!("{name}.map"))]
    }
}

/// Arrives and stands within some counts at the largest feed: a machine of 1 000 counts a mm.
const MOVES: &str = "
expect no fault
enable
home
move 100 feed 9000
move 0 feed 9000
move 200 feed 9000
wait 0.3s
expect position 200 within 0.003
expect following-error within 0.003
move 0 feed 1000
wait 0.3s
expect position 0 within 0.003
expect no fault
";

/// Sets the axis on `port` up by commands and looks at it after a power cycle.
pub fn is_commissioned(port: &str) {
    let folder = tempfile::tempdir().unwrap();
    let workshop = Workshop {
        port,
        folder: folder.path(),
    };
    // Its home switch is at the low end.
    let few = ["--set", "revolutions=12", "--set", "home_switch=-1"];
    workshop.leadscrew(&["setup", "--yes", "--skip", "encoder,offset"]);
    workshop.leadscrew(
        &[
            &["setup", "--yes", "--from", "encoder", "--skip", "offset"],
            &few[..],
        ]
        .concat(),
    );
    let set = workshop.leadscrew(&["params", "diff"]);
    for name in [
        "controller.position_gain_per_s",
        "motion.full_command_feed_mm_per_min",
        "observer.natural_period_s",
        "homing.search_direction",
    ] {
        assert!(set.contains(name), "{name}: {set}");
    }
    let before = workshop.backup("before");
    assert!(before[1].len() > 10_000, "a map of 10 000 edges");
    workshop.script(MOVES);
    assert_eq!(workshop.leadscrew(&["params", "diff"]), set);
    assert_eq!(workshop.backup("after"), before);
}
