//! Masters that others wrote, at UART 1 of the running axis. Where one is missing the test says so and passes.

use std::path::Path;
use std::process::Command;

use leadscrew::estimator::EstimatorConfig;
use leadscrew::settings::{Key, Number, Settings, Values};
use leadscrew_app::modbus::ParameterList;
use leadscrew_qemu::{Carrier, Endpoint};

use crate::{done, guest, port, text};

/// Where `cargo xtask setup` puts pymodbus.
const PYTHON: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../target/pymodbus/bin/python");
const SCRIPT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../app/tests/modbus/live.py");
/// First register of the parameters, and registers of one.
const VALUES: (usize, usize) = (1000, 4);

/// Names of all parameters in their order.
#[derive(Default)]
struct Names(Vec<String>);

impl Values for Names {
    fn number(&mut self, key: Key, _: &Number, value: f64) -> f64 {
        self.0.push(key.to_string());
        value
    }

    fn word(&mut self, key: Key, _: &[&'static str], value: &'static str) -> &'static str {
        self.0.push(key.to_string());
        value
    }
}

/// First register of `motion.counts_per_mm`, and the checksum of the list.
fn place_and_list() -> (usize, u32) {
    let estimator = EstimatorConfig::by_name("exponential").unwrap().unwrap();
    let mut settings = Settings::new(estimator);
    let mut names = Names::default();
    settings.visit(&mut names);
    let index = names
        .0
        .iter()
        .position(|name| name == "motion.counts_per_mm");
    let (first, each) = VALUES;
    (
        first + each * index.unwrap(),
        ParameterList::of(settings).checksum,
    )
}

fn address(endpoint: Option<&Endpoint>) -> String {
    let port = port(endpoint);
    port.strip_prefix("tcp:")
        .map_or(port.clone(), str::to_owned)
}

fn pymodbus(kind: &str, carrier: Carrier) {
    if !Path::new(PYTHON).is_file() {
        eprintln!(
            "skipped: pymodbus is not under target/pymodbus; `cargo xtask setup` tries to install it"
        );
        return;
    }
    let guest = guest(Carrier::Tcp { port: 0 }, Some(carrier));
    let link = port(guest.link());
    let (place, list) = place_and_list();
    let look = |state: &str| {
        let output = Command::new(PYTHON)
            .arg(SCRIPT)
            .args([kind, &address(guest.modbus()), "1"])
            .args([place.to_string(), list.to_string()])
            .output()
            .unwrap();
        let text = text(&output);
        let expected = format!("all right: {state}");
        assert!(
            output.status.success() && text.contains(&expected),
            "{text}"
        );
    };
    look("off");
    done(&link, &["enable"]);
    look("on");
    done(&link, &["disable"]);
}

#[test]
#[ignore = "needs QEMU; run by cargo xtask test"]
fn pymodbus_reads_and_writes_the_running_axis_over_tcp() {
    pymodbus("tcp", Carrier::Tcp { port: 0 });
}

#[test]
#[ignore = "needs QEMU; run by cargo xtask test"]
fn pymodbus_reads_and_writes_the_running_axis_over_a_terminal() {
    pymodbus("serial", Carrier::Pty);
}

#[test]
#[ignore = "needs QEMU; run by cargo xtask test"]
fn mbpoll_reads_the_running_axis() {
    let mut call = Command::new("mbpoll");
    if call.arg("-V").output().is_err() {
        eprintln!("skipped: mbpoll is not installed; `cargo xtask setup` tries to");
        return;
    }
    let guest = guest(Carrier::Tcp { port: 0 }, Some(Carrier::Pty));
    let output = Command::new("mbpoll")
        .args(["-m", "rtu", "-b", "115200", "-P", "none", "-0", "-B", "-1"])
        .args(["-o", "5", "-a", "1", "-t", "3:int", "-r", "40"])
        .arg(address(guest.modbus()))
        .output()
        .unwrap();
    // The control rate.
    assert!(text(&output).contains("[40]: \t1000"), "{}", text(&output));
}
