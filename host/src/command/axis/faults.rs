//! `leadscrew faults` and `leadscrew clear`.

use std::fmt::Write as _;

use leadscrew_client::Axis;

use super::status;
use crate::axis::fault_report::{FaultReport, Faults, Way};
use crate::axis::script;
use crate::cli::JsonArgs;
use crate::command::{print, print_json};
use crate::error::CommandError;

/// `leadscrew faults`.
///
/// # Errors
/// The axis is lost.
pub fn run(axis: &mut Axis, args: &JsonArgs) -> Result<(), CommandError> {
    let faults = Faults::read(axis)?;
    if args.json {
        print_json(&faults)
    } else {
        print(&to_text(&faults))
    }
}

/// `leadscrew clear`.
///
/// # Errors
/// The axis is lost, or refuses: what brought the fault about is still there.
pub fn clear(axis: &mut Axis, args: &JsonArgs) -> Result<(), CommandError> {
    script::clear(axis)?;
    status::run(axis, args)
}

/// Fault and warnings in lines. Writing to a string cannot fail.
fn to_text(faults: &Faults) -> String {
    let mut text = String::new();
    match &faults.fault {
        Some(fault) => of_fault(&mut text, fault),
        None => text.push_str("no fault\n"),
    }
    for warning in &faults.warnings {
        let _ = write!(
            text,
            "\nwarning {}: {}\n\
             cause            {}\n\
             remedy           {}\n",
            warning.name, warning.what, warning.cause, warning.remedy
        );
    }
    if !faults.warnings.is_empty() {
        text.push_str("then             `leadscrew clear` forgets warnings\n");
    }
    text
}

fn of_fault(text: &mut String, fault: &FaultReport) {
    let _ = writeln!(
        text,
        "fault {}, {}: {}",
        fault.number, fault.name, fault.what
    );
    let machine = fault.in_machine_units.map_or_else(String::new, |in_mm| {
        format!(
            ": {:.4} {}, limit {:.4}",
            in_mm.value, in_mm.unit, in_mm.limit
        )
    });
    let _ = write!(
        text,
        "seen             {:.3}, limit {:.3} ({}){machine}\n\
         when             tick {}, {:.3} s ago, while it was {}\n\
         position         {}\n\
         setpoint         {}\n\
         following error  {}\n\
         velocity         {:.1} mm/min of {:.1}, with {:.1} % of full command\n",
        fault.value,
        fault.limit,
        fault.figure,
        fault.tick,
        fault.ago_s,
        fault.state,
        way(fault.position),
        way(fault.setpoint),
        way(fault.following_error),
        fault.velocity_mm_per_min,
        fault.setpoint_velocity_mm_per_min,
        fault.command_percent,
    );
    if !fault.later.is_empty() {
        let _ = writeln!(text, "later            {}", fault.later.join(", "));
    }
    let _ = write!(
        text,
        "cause            {}\n\
         remedy           {}\n\
         then             `leadscrew disable`, `leadscrew clear`, `leadscrew enable`\n",
        fault.cause, fault.remedy
    );
}

/// The count of the encoder, not from the origin.
fn way(way: Way) -> String {
    if way.mm.is_finite() {
        format!("{:.4} mm by the encoder ({:.2} d)", way.mm, way.d)
    } else {
        format!("{:.2} d", way.d)
    }
}
