//! The files for LinuxCNC, read by LinuxCNC: a simulated machine of two joints, one with a file of type 0, the other with one of
//! type 1, both of the same table. Its motion controller has to send both motors to place − error. Runs where `linuxcnc` is
//! installed, with `LEADSCREW_LONG` set: it takes wall-clock seconds and there can be one on a computer.

use std::path::Path;
use std::process::{Command, Stdio};

use leadscrew_process::axis_calibration::linuxcnc::CompType;
use leadscrew_process::axis_calibration::{ErrorPoint, ErrorTable};

use crate::assert_near;

const CONFIGURATION: &str = "
[EMC]
VERSION = 1.1
[DISPLAY]
DISPLAY = ./measure.py
[TASK]
TASK = milltask
CYCLE_TIME = 0.001
[RS274NGC]
PARAMETER_FILE = machine.var
[EMCMOT]
EMCMOT = motmod
COMM_TIMEOUT = 4.0
SERVO_PERIOD = 1000000
[EMCIO]
EMCIO = io
CYCLE_TIME = 0.1
TOOL_TABLE = tools.tbl
[HAL]
HALFILE = machine.hal
[TRAJ]
COORDINATES = X Y
LINEAR_UNITS = mm
ANGULAR_UNITS = degree
MAX_LINEAR_VELOCITY = 200
[KINS]
KINEMATICS = trivkins coordinates=XY
JOINTS = 2
";

const HAL: &str = "
loadrt [KINS]KINEMATICS
loadrt [EMCMOT]EMCMOT servo_period_nsec=[EMCMOT]SERVO_PERIOD num_joints=[KINS]JOINTS
addf motion-command-handler servo-thread
addf motion-controller servo-thread
net x joint.0.motor-pos-cmd => joint.0.motor-pos-fb
net y joint.1.motor-pos-cmd => joint.1.motor-pos-fb
net estop iocontrol.0.user-enable-out iocontrol.0.emc-enable-in
net prepare iocontrol.0.tool-prepare iocontrol.0.tool-prepared
net change iocontrol.0.tool-change iocontrol.0.tool-changed
";

/// Homes, goes to every place up and down again, and writes where the motors are sent.
const MEASURE: &str = r#"#!/usr/bin/env python3
import linuxcnc, subprocess, time
command, status = linuxcnc.command(), linuxcnc.stat()

def until(done):
    for _ in range(1500):
        status.poll()
        if done():
            return
        time.sleep(0.02)
    raise SystemExit("LinuxCNC did not come to it")

def pin(name):
    return float(subprocess.check_output(["halcmd", "-s", "getp", name]).split()[0])

for order in (linuxcnc.STATE_ESTOP_RESET, linuxcnc.STATE_ON):
    command.state(order)
    command.wait_complete()
command.mode(linuxcnc.MODE_MANUAL)
command.wait_complete()
for joint in (0, 1):
    command.home(joint)
    until(lambda: status.homed[joint])
command.mode(linuxcnc.MODE_MDI)
command.wait_complete()
places = [float(place) for place in open("places.txt").read().split()]
with open("motors.txt", "w") as out:
    for place in places + places[-2::-1]:
        command.mdi("G53 G0 X%f Y%f" % (place, place))
        command.wait_complete(30)
        until(lambda: status.inpos)
        time.sleep(0.2)
        pins = ["joint.%d.%s" % (joint, name) for joint in (0, 1) for name in ("pos-cmd", "motor-pos-cmd")]
        out.write(" ".join("%.9f" % pin(name) for name in pins) + "\n")
"#;

fn table() -> ErrorTable {
    let points = [
        (0.0, [0.0, -10.0]),
        (10.0, [20.0, 5.0]),
        (60.0, [-30.0, -12.0]),
        (100.0, [50.0, 30.0]),
    ];
    let point = |(position_mm, error_um): (f64, [f64; 2])| ErrorPoint {
        position_mm,
        error_um,
    };
    ErrorTable {
        points: points.map(point).into(),
    }
}

/// Error of the table at a place, linear between its points, held outside; mm.
fn error_at(table: &ErrorTable, place: f64, way: usize) -> f64 {
    let points = &table.points;
    let after = points.iter().position(|point| point.position_mm > place);
    let um = match after {
        Some(0) => points[0].error_um[way],
        None => points[points.len() - 1].error_um[way],
        Some(after) => {
            let (from, to) = (&points[after - 1], &points[after]);
            let share = (place - from.position_mm) / (to.position_mm - from.position_mm);
            from.error_um[way] + share * (to.error_um[way] - from.error_um[way])
        }
    };
    um / 1000.0
}

fn run_linuxcnc(folder: &Path) {
    let write = |name: &str, text: &str| std::fs::write(folder.join(name), text).unwrap();
    let mut configuration = CONFIGURATION.to_owned();
    for (joint, axis, comp_type) in [(0, "X", CompType::Places), (1, "Y", CompType::Trims)] {
        let file = format!("{axis}.comp");
        write(&file, &table().to_linuxcnc(comp_type));
        let limits =
            "MAX_VELOCITY = 200\nMAX_ACCELERATION = 5000\nMIN_LIMIT = -20\nMAX_LIMIT = 200\n";
        configuration += &format!(
            "[AXIS_{axis}]\n{limits}[JOINT_{joint}]\nTYPE = LINEAR\nHOME = 0\n{limits}BACKLASH = 0.5\nHOME_SEQUENCE = 0\n\
             COMP_FILE = {file}\nCOMP_FILE_TYPE = {}\n",
            comp_type.number()
        );
    }
    write("machine.ini", &configuration);
    write("machine.hal", HAL);
    write("tools.tbl", "");
    write("places.txt", "5 10 35 60 80 100 120");
    write("measure.py", MEASURE);
    let set = Command::new("chmod")
        .arg("-R")
        .arg("a+rwX,u+x")
        .arg(folder)
        .status()
        .unwrap();
    assert!(set.success());
    // Its real-time part refuses to run as root without another user to become.
    let is_root = Command::new("id")
        .arg("-u")
        .output()
        .is_ok_and(|output| output.stdout == b"0\n");
    let mut command = Command::new("timeout");
    command
        .args(["120", "linuxcnc", "-r", "machine.ini"])
        .current_dir(folder);
    if is_root {
        command.env("RTAPI_UID", "65534");
    }
    command.env("RTAPI_FIFO_PATH", folder.join("fifo"));
    let log = std::fs::File::create(folder.join("log.txt")).unwrap();
    let other = log.try_clone().unwrap();
    let ended = command
        .stdin(Stdio::null())
        .stdout(log)
        .stderr(other)
        .status()
        .unwrap();
    let log = std::fs::read_to_string(folder.join("log.txt")).unwrap();
    assert!(ended.success(), "{log}");
}

#[test]
fn both_types_send_the_motor_to_the_place_less_the_error() {
    let is_there = Command::new("linuxcnc").arg("-h").output().is_ok();
    if std::env::var_os("LEADSCREW_LONG").is_none() || !is_there {
        println!("not run: LEADSCREW_LONG is not set, or linuxcnc is not installed");
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    run_linuxcnc(folder.path());
    let text = std::fs::read_to_string(folder.path().join("motors.txt")).unwrap();
    let rows: Vec<Vec<f64>> = text
        .lines()
        .map(|line| {
            line.split_whitespace()
                .map(|field| field.parse().unwrap())
                .collect()
        })
        .collect();
    assert_eq!(rows.len(), 13, "{text}");
    let table = table();
    for (number, row) in rows.iter().enumerate() {
        let way = usize::from(number >= 7);
        let [x, x_motor, y, y_motor] = row[..] else {
            panic!("{text}")
        };
        for (place, motor) in [(x, x_motor), (y, y_motor)] {
            assert_near(motor, place - error_at(&table, place, way), 1e-6);
        }
    }
}
