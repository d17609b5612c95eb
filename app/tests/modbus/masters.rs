//! Masters that others wrote, as programs: `mbpoll`, `pymodbus`, LinuxCNC's `mb2hal`. `cargo xtask setup` installs the
//! first two; where one is missing its test says so and passes.

use std::path::PathBuf;
use std::process::{Command, Output};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use leadscrew::protocol::service::Seen;
use leadscrew::supervisor::State;
use leadscrew::units::{Position, Velocity};
use leadscrew_app::modbus::{ProbeLatch, View};

use crate::fake::{Fake, UNIT, view};
use crate::terminal::{Served, on_tcp, on_terminal};

/// Where `cargo xtask setup` puts pymodbus.
const PYTHON: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../target/pymodbus/bin/python");
/// The example of docs/modbus.md.
pub const MB2HAL: &str = include_str!("mb2hal.ini");
const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/modbus");

/// An axis at −123.456 789 mm, at rest, off.
fn standing() -> Fake {
    let seen = Seen {
        tick: 0x0001_0002,
        reported: Position::from_num(-123_456.789),
        commanded: Position::from_num(-123_456.5),
        velocity: Velocity::from_num(500),
        following_error: -0x8000,
        origin: Some(Position::ZERO),
        warnings: 1 << 4,
        ..Seen::default()
    };
    Fake {
        view: View {
            seen,
            probe: Some(ProbeLatch {
                count: 3,
                position_nm: -7_000_000_001,
            }),
            ..view()
        },
        ..Fake::default()
    }
}

fn is_there(program: &str) -> bool {
    let found = std::env::var_os("PATH").is_some_and(|path| {
        std::env::split_paths(&path).any(|folder| folder.join(program).is_file())
    });
    if !found {
        eprintln!("skipped: {program} is not installed; `cargo xtask setup` tries to");
    }
    found
}

/// First register of `motion.counts_per_mm`.
fn place_of_scale() -> usize {
    let names = crate::page::names();
    let index = names.iter().position(|name| name == "motion.counts_per_mm");
    1000 + 4 * index.unwrap()
}

/// What it printed, both ways; with how it ended.
fn text(output: Output) -> String {
    let out = String::from_utf8_lossy(&output.stdout);
    let err = String::from_utf8_lossy(&output.stderr);
    format!("{}\n{out}{err}", output.status)
}

fn mbpoll(served: &Served, words: &[&str]) -> String {
    let unit = UNIT.to_string();
    let (before, values) = words.split_at(words.iter().take_while(|word| **word != "--").count());
    let mut call = Command::new("mbpoll");
    call.args([
        "-m", "rtu", "-b", "19200", "-P", "none", "-0", "-B", "-1", "-o", "2",
    ]);
    call.args(["-a", &unit]).args(before).arg(&served.address);
    text(call.args(values.iter().skip(1)).output().unwrap())
}

#[test]
fn mbpoll_reads_and_writes() {
    if !is_there("mbpoll") {
        return;
    }
    let served = on_terminal(standing());
    let shown = |words: &[&str], expected: &[&str]| {
        let text = mbpoll(&served, words);
        for part in expected {
            assert!(
                text.contains(part),
                "no {part} in what {words:?} gave:\n{text}"
            );
        }
    };
    shown(&["-t", "3:float", "-r", "20"], &["[20]: \t-123.457"]);
    shown(&["-t", "3:int", "-r", "16"], &["[16]: \t30000000"]);
    shown(&["-t", "3", "-r", "31"], &["[31]: \t65535 (-1)"]);
    shown(&["-t", "4", "-r", "33"], &["[33]: \t3"]);
    shown(
        &["-t", "3:hex", "-r", "6", "-c", "2"],
        &["[6]: \t0x0001", "[7]: \t0x0002"],
    );
    shown(
        &["-t", "1", "-r", "0", "-c", "16"],
        &["[2]: \t1", "[3]: \t0", "[8]: \t1", "[9]: \t1"],
    );
    shown(&["-t", "1", "-r", "204"], &["[204]: \t1"]);
    shown(&["-t", "3", "-r", "86"], &["Illegal data address"]);
    shown(&["-t", "0", "-r", "0"], &["Illegal data address"]);

    // 2 000.5, as its four words.
    let place = place_of_scale().to_string();
    let value = ["-t", "4", "-r", &place, "--", "16543", "16896", "0", "0"];
    shown(&value, &["Written 4 references"]);
    assert_eq!(
        served
            .panel
            .lock()
            .unwrap()
            .settings
            .axis
            .motion
            .counts_per_mm,
        2000.5
    );
    shown(
        &["-t", "4", "-r", &place, "--", "1"],
        &["Illegal data address"],
    );
    shown(
        &["-t", "4", "-r", "5000", "--", "23130"],
        &["Written 1 references"],
    );
    assert_eq!(served.panel.lock().unwrap().saved, 1);
    served.panel.lock().unwrap().view.seen.state = State::Ready;
    shown(&value, &["Slave device or server is busy"]);
    shown(&["-t", "3", "-r", "81"], &["[81]: \t25"]);
}

/// Runs the script against a line; its own assertions say what was wrong.
fn pymodbus(served: &Served, kind: &str) {
    let place = place_of_scale();
    let run = |part: &str| {
        let output = Command::new(PYTHON)
            .arg(format!("{FOLDER}/master.py"))
            .args([kind, &served.address, &UNIT.to_string(), part])
            .arg(place.to_string())
            .arg(crate::page::list_checksum().to_string())
            .output()
            .unwrap();
        let text = text(output);
        assert!(
            text.contains("exit status: 0") && text.contains("all right"),
            "{text}"
        );
    };
    run("off");
    let mut panel = served.panel.lock().unwrap();
    assert_eq!(panel.settings.axis.motion.counts_per_mm, 1234.5678901234567);
    assert_eq!(panel.saved, 1);
    panel.view.seen.enabled = true;
    drop(panel);
    if kind == "serial" {
        run("on");
    }
}

fn pymodbus_is_there() -> bool {
    let is_there = PathBuf::from(PYTHON).is_file();
    if !is_there {
        eprintln!(
            "skipped: pymodbus is not under target/pymodbus; `cargo xtask setup` tries to install it"
        );
    }
    is_there
}

/// The pins of a HAL that asks once.
fn mb2hal(served: &Served) -> String {
    let folder = tempfile::tempdir().unwrap();
    let ini = MB2HAL.replace("/dev/ttyUSB0", &served.address);
    let [config, script] = ["mb2hal.ini", "mb2hal.hal"].map(|name| folder.path().join(name));
    std::fs::write(&config, ini).unwrap();
    let load = format!("loadusr -W mb2hal config={}", config.display());
    // The first round of the transactions takes a moment.
    let script_text = format!("{load}\nloadusr -w sleep 2\nshow pin mb2hal\n");
    std::fs::write(&script, script_text).unwrap();
    // Root needs to say whose it is.
    let mut call = Command::new("halrun");
    text(call.env("RTAPI_UID", "0").arg(&script).output().unwrap())
}

#[test]
fn mb2hal_shows_the_axis_on_pins() {
    if !is_there("mb2hal") || !is_there("halrun") {
        return;
    }
    let served = on_terminal(standing());
    let text = mb2hal(&served);
    let lines: Vec<Vec<&str>> = text
        .lines()
        .map(|line| line.split_whitespace().collect())
        .collect();
    let pin = |name: &str| {
        let line = lines.iter().find(|line| line.last() == Some(&name));
        let line = line.unwrap_or_else(|| panic!("no {name} in\n{text}"));
        line[line.len() - 2]
    };
    for bit in 0..12 {
        let name = format!("mb2hal.is.{bit:02}");
        let is_on = [2, 8, 9, 10, 11].contains(&bit);
        assert_eq!(pin(&name), if is_on { "TRUE" } else { "FALSE" }, "{name}");
    }
    assert_eq!(pin("mb2hal.axis.state.int"), "0");
    let [high, low] =
        [-123_457_i32 >> 16, -123_457_i32 & 0xffff].map(|word| (word as u16).to_string());
    assert_eq!(pin("mb2hal.motion.position-um-high.int"), high);
    assert_eq!(pin("mb2hal.motion.position-um-low.int"), low);
    assert_eq!(pin("mb2hal.motion.velocity.int"), "30000");
    for name in ["is", "axis", "motion"] {
        assert_eq!(pin(&format!("mb2hal.{name}.num_errors")), "0x00000000");
    }
}

#[test]
fn pymodbus_reads_and_writes_over_a_terminal() {
    if pymodbus_is_there() {
        pymodbus(&on_terminal(standing()), "serial");
    }
}

#[test]
fn pymodbus_reads_and_writes_over_tcp() {
    if pymodbus_is_there() {
        pymodbus(&on_tcp(standing()), "tcp");
    }
}

/// The script that looks at a running axis, on one whose ticks go on.
#[test]
fn a_running_axis_agrees_with_itself() {
    if !pymodbus_is_there() {
        return;
    }
    let served = on_tcp(standing());
    let panel = served.panel.clone();
    let is_over = AtomicBool::new(false);
    let output = std::thread::scope(|scope| {
        scope.spawn(|| {
            while !is_over.load(Ordering::Relaxed) {
                panel.lock().unwrap().view.seen.tick += 1;
                std::thread::sleep(Duration::from_millis(1));
            }
        });
        let output = Command::new(PYTHON)
            .arg(format!("{FOLDER}/live.py"))
            .args(["tcp", &served.address, &UNIT.to_string()])
            .arg(place_of_scale().to_string())
            .arg(crate::page::list_checksum().to_string())
            .output();
        is_over.store(true, Ordering::Relaxed);
        output.unwrap()
    });
    let text = text(output);
    assert!(text.contains("all right: off"), "{text}");
}
