//! `leadscrew status`: how the axis stands.

use std::fmt::Write as _;

use leadscrew_client::{Axis, Status};
use serde::Serialize;

use crate::cli::JsonArgs;
use crate::command::{print, print_json};
use crate::error::CommandError;
use crate::fault_names::fault_name;

/// How an axis stands.
#[derive(Debug, Serialize)]
pub struct Report {
    tick: u32,
    state: &'static str,
    fault: Option<&'static str>,
    warnings: Vec<&'static str>,
    enabled: bool,
    moving: bool,
    homed: bool,
    held: bool,
    unsaved: bool,
    override_percent: u16,
    position_mm: f64,
    setpoint_mm: f64,
    velocity_mm_per_min: f64,
    following_error_mm: f64,
}

/// Runs the command.
///
/// # Errors
/// The axis is lost.
pub fn run(axis: &mut Axis, args: &JsonArgs) -> Result<(), CommandError> {
    let report = Report::of(&axis.status()?);
    if args.json {
        print_json(&report)
    } else {
        print(&report.to_text())
    }
}

impl Report {
    /// The report of a status.
    #[must_use]
    pub fn of(status: &Status) -> Self {
        Self {
            tick: status.tick,
            state: status.state_text(),
            fault: status.fault().map(fault_name),
            warnings: status.warnings().map(fault_name).collect(),
            enabled: status.is_enabled,
            moving: status.is_moving,
            homed: status.is_homed,
            held: status.is_held,
            unsaved: status.is_unsaved,
            override_percent: status.override_percent,
            position_mm: status.position_mm,
            setpoint_mm: status.setpoint_mm,
            velocity_mm_per_min: status.velocity_mm_per_min,
            following_error_mm: status.following_error_mm,
        }
    }

    /// The report as text.
    #[must_use]
    pub fn to_text(&self) -> String {
        let mut text = format!("{}\n", self.state);
        if let Some(fault) = self.fault {
            let _ = writeln!(
                text,
                "fault            {fault}: `leadscrew faults` tells more"
            );
        }
        if !self.warnings.is_empty() {
            let _ = writeln!(text, "warnings         {}", self.warnings.join(", "));
        }
        let origin = if self.homed {
            ""
        } else {
            " (not homed: from where the encoder counts)"
        };
        let _ = writeln!(text, "position         {:.4} mm{origin}", self.position_mm);
        let _ = writeln!(text, "setpoint         {:.4} mm", self.setpoint_mm);
        let _ = writeln!(text, "following error  {:.4} mm", self.following_error_mm);
        let _ = writeln!(
            text,
            "velocity         {:.1} mm/min",
            self.velocity_mm_per_min
        );
        if self.override_percent != 100 || self.held {
            let hold = if self.held { ", feed hold" } else { "" };
            let _ = writeln!(text, "override         {} %{hold}", self.override_percent);
        }
        if self.unsaved {
            let _ = writeln!(
                text,
                "parameters       changed, and not saved: `leadscrew params save` keeps them"
            );
        }
        text
    }
}
