//! The real command against the real firmware in QEMU, over lines that real boards have. Time here is the wall's, and the
//! computer may be busy: what is asserted is what the axis does and refuses, never how soon.

mod commissioning;
mod faults;
mod lines;
mod modbus;
#[path = "../support/shuttle.rs"]
mod shuttle;
#[path = "../support/watch.rs"]
mod watch;

use std::process::{Command, Output, Stdio};

use leadscrew_qemu::{Carrier, Endpoint, Guest, Start, build};
use serde_json::Value;

/// Orders that a lease which lapsed on a busy computer may spoil, before the test gives up.
const TRIES: u32 = 8;

/// The axis on its link, no faster than the wall.
fn guest(link: Carrier, modbus: Option<Carrier>) -> Guest {
    let start = Start::new(build("linked", "firmware").unwrap());
    let start = start.paced().link(link);
    let start = modbus.map_or_else(|| start.clone(), |carrier| start.clone().modbus(carrier));
    start.start().unwrap()
}

/// The address as the command takes it.
fn port(endpoint: Option<&Endpoint>) -> String {
    match endpoint {
        Some(Endpoint::Tcp(address)) => format!("tcp:{address}"),
        Some(Endpoint::Pty(path)) => path.display().to_string(),
        None => panic!("the guest has no such line"),
    }
}

fn command(port: &str, words: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_leadscrew"));
    command.args(["--port", port]).args(words);
    command.stdin(Stdio::null());
    command
}

fn leadscrew(port: &str, words: &[&str]) -> Output {
    command(port, words).output().unwrap()
}

fn text(output: &Output) -> String {
    let out = String::from_utf8_lossy(&output.stdout);
    let err = String::from_utf8_lossy(&output.stderr);
    format!("{}\n{out}{err}", output.status)
}

fn status(port: &str) -> Value {
    let output = leadscrew(port, &["status", "--json"]);
    assert!(output.status.success(), "{}", text(&output));
    serde_json::from_slice(&output.stdout).unwrap()
}

/// Does it, if need be with the axis enabled anew: a lease may lapse where the computer is busy.
fn done(port: &str, words: &[&str]) {
    let mut told = String::new();
    for _ in 0..TRIES {
        let output = leadscrew(port, words);
        if output.status.success() {
            return;
        }
        told = text(&output);
        let at = status(port);
        let is_on = at["enabled"].as_bool().unwrap();
        assert!(told.contains("lease") || !is_on, "{words:?}: {told}\n{at}");
        leadscrew(port, &["enable"]);
    }
    panic!("{words:?} was not done: {told}");
}
