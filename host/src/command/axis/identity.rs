//! `leadscrew identity`: what the axis is.

use leadscrew::protocol::reply::{
    CAN_EXPERIMENT, CAN_HOME, CAN_LEARN, CAN_PROBE, CAN_RECORD, CAN_SAVE, CAN_SCOPE, CAN_SET,
};
use leadscrew_client::Axis;
use serde::Serialize;

use crate::cli::JsonArgs;
use crate::command::{print, print_json};
use crate::error::CommandError;

const CAN: [(u32, &str); 8] = [
    (CAN_HOME, "homing"),
    (CAN_SET, "parameters"),
    (CAN_RECORD, "records"),
    (CAN_SAVE, "store"),
    (CAN_EXPERIMENT, "experiments"),
    (CAN_SCOPE, "scope"),
    (CAN_LEARN, "map learning"),
    (CAN_PROBE, "probing"),
];

/// What an axis is.
#[derive(Debug, Serialize)]
struct Report {
    port: String,
    protocol: u16,
    firmware: String,
    build: String,
    board: String,
    tick_hz: u32,
    lease_ticks: u32,
    work_memory_bytes: u32,
    can: Vec<&'static str>,
}

/// Runs the command.
///
/// # Errors
/// The report cannot be printed.
pub fn run(axis: &mut Axis, args: &JsonArgs) -> Result<(), CommandError> {
    let port = axis.connection().port();
    let identity = axis.identity();
    let can = CAN
        .iter()
        .filter(|(bit, _)| identity.capabilities & bit != 0);
    let report = Report {
        port,
        protocol: identity.protocol,
        firmware: identity.firmware.clone(),
        build: identity.build.clone(),
        board: identity.board.clone(),
        tick_hz: identity.tick_hz,
        lease_ticks: identity.lease_ticks,
        work_memory_bytes: identity.work_memory,
        can: can.map(|(_, name)| *name).collect(),
    };
    if args.json {
        return print_json(&report);
    }
    print(&format!(
        "firmware         {} ({})\n\
         board            {}\n\
         port             {}\n\
         protocol         version {}\n\
         control rate     {} Hz\n\
         control lease    {} ticks\n\
         work memory      {} bytes\n\
         can              {}\n",
        report.firmware,
        report.build,
        report.board,
        report.port,
        report.protocol,
        report.tick_hz,
        report.lease_ticks,
        report.work_memory_bytes,
        report.can.join(", "),
    ))
}
