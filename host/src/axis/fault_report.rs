//! A fault in the units of people.

use leadscrew::supervisor::Fault;
use leadscrew::supervisor::fault::Description;
use leadscrew_client::{Axis, Error, FaultPage, Status};
use serde::Serialize;

use crate::fault_names::{STATES, fault_name};

/// A place or a way, in counts of the encoder and in mm.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Way {
    /// d.
    pub d: f64,
    /// mm.
    pub mm: f64,
}

/// What is known of the fault that stopped the axis.
#[derive(Clone, Debug, Serialize)]
pub struct FaultReport {
    /// Its number.
    pub number: u8,
    /// Its name.
    pub name: &'static str,
    /// What happened.
    pub what: &'static str,
    /// What value and limit are, with their unit.
    pub figure: &'static str,
    /// What was seen.
    pub value: f64,
    /// What is allowed.
    pub limit: f64,
    /// Both in the units of the machine, where they are ways or speeds.
    pub in_machine_units: Option<MachineUnits>,
    /// Tick in which it was found.
    pub tick: u32,
    /// How long ago that is, s.
    pub ago_s: f64,
    /// State before.
    pub state: &'static str,
    /// Where the axis was by the encoder.
    pub position: Way,
    /// Where it should have been.
    pub setpoint: Way,
    /// Setpoint less position.
    pub following_error: Way,
    /// How fast it was, mm/min.
    pub velocity_mm_per_min: f64,
    /// How fast it should have been, mm/min.
    pub setpoint_velocity_mm_per_min: f64,
    /// What was put out, % of full command.
    pub command_percent: f64,
    /// Faults that came later.
    pub later: Vec<&'static str>,
    /// What brings it about.
    pub cause: &'static str,
    /// What to do.
    pub remedy: &'static str,
}

/// Value and limit in the units of the machine.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct MachineUnits {
    /// mm or mm/min.
    pub unit: &'static str,
    /// What was seen.
    pub value: f64,
    /// What is allowed.
    pub limit: f64,
}

/// A warning that is on.
#[derive(Clone, Debug, Serialize)]
pub struct WarningReport {
    /// Its name.
    pub name: &'static str,
    /// What happened.
    pub what: &'static str,
    /// What brings it about.
    pub cause: &'static str,
    /// What to do.
    pub remedy: &'static str,
}

/// Fault and warnings.
#[derive(Clone, Debug, Serialize)]
pub struct Faults {
    /// The fault; none is latched without.
    pub fault: Option<FaultReport>,
    /// The warnings that are on.
    pub warnings: Vec<WarningReport>,
}

impl Faults {
    /// Asks the axis.
    ///
    /// # Errors
    /// Of a lost axis.
    pub fn read(axis: &mut Axis) -> Result<Self, Error> {
        let status = axis.status()?;
        let scale = Scale::read(axis)?;
        let page = axis.fault_page()?;
        Ok(Self {
            fault: page.map(|page| FaultReport::of(&page, &status, scale)),
            warnings: status.warnings().map(warning).collect(),
        })
    }
}

fn warning(fault: Fault) -> WarningReport {
    let says = fault.description();
    WarningReport {
        name: fault_name(fault),
        what: says.what,
        cause: says.cause,
        remedy: says.remedy,
    }
}

/// From counts and ticks to mm and s.
#[derive(Clone, Copy, Debug)]
struct Scale {
    counts_per_mm: f64,
    tick_hz: f64,
}

impl Scale {
    fn read(axis: &mut Axis) -> Result<Self, Error> {
        let number = |axis: &mut Axis, name: &str| match axis.parameter(name) {
            Ok(parameter) => Ok(parameter.number()),
            // An axis of another kind: its figures stay in d.
            Err(Error::UnknownParameter { .. }) => Ok(None),
            Err(error) => Err(error),
        };
        let counts_per_mm = number(axis, "motion.counts_per_mm")?.unwrap_or(f64::NAN);
        let tick_hz = f64::from(axis.identity().tick_hz);
        Ok(Self {
            counts_per_mm,
            tick_hz,
        })
    }

    fn way(&self, d: f64) -> Way {
        let mm = d / self.counts_per_mm;
        Way { d, mm }
    }

    fn feed(&self, d_per_tick: f64) -> f64 {
        d_per_tick * self.tick_hz * 60.0 / self.counts_per_mm
    }

    /// Value and limit of a figure, whose unit stands at its end in the table of faults.
    fn figure(&self, page: &FaultPage, figure: &str) -> Option<MachineUnits> {
        let of = |unit, to: &dyn Fn(f64) -> f64| {
            Some(MachineUnits {
                unit,
                value: to(page.value),
                limit: to(page.limit),
            })
        };
        if figure.ends_with(", d") {
            of("mm", &|value| self.way(value).mm)
        } else if figure.ends_with(", d/tick") {
            of("mm/min", &|value| self.feed(value))
        } else {
            None
        }
    }
}

/// What is said of a fault of a later version.
const UNKNOWN: Description = Description {
    what: "This tool does not know the fault.",
    reaction: leadscrew::supervisor::Reaction::Off,
    condition: "",
    bound: "",
    figure: "in the fault's unit",
    cause: "The firmware is newer than this tool.",
    remedy: "Use the tool of the firmware's version, or look the number up in its docs/faults.md.",
};

impl FaultReport {
    fn of(page: &FaultPage, status: &Status, scale: Scale) -> Self {
        let says = page.fault().map_or(UNKNOWN, Fault::description);
        let came_later = |fault: &&Fault| {
            let bit = page.later.checked_shr(u32::from(**fault as u8));
            bit.is_some_and(|bits| bits & 1 != 0)
        };
        let state = STATES
            .iter()
            .find(|(state, _)| *state as u8 == page.state_number);
        Self {
            number: page.fault_number,
            name: page.fault().map_or("unknown", fault_name),
            what: says.what,
            figure: says.figure,
            value: page.value,
            limit: page.limit,
            in_machine_units: scale.figure(page, says.figure),
            tick: page.tick,
            ago_s: f64::from(status.tick.wrapping_sub(page.tick)) / scale.tick_hz,
            state: state.map_or("unknown", |(_, name)| name),
            position: scale.way(page.position_d),
            setpoint: scale.way(page.setpoint_d),
            following_error: scale.way(page.following_error_d),
            velocity_mm_per_min: scale.feed(page.velocity_d_per_tick),
            setpoint_velocity_mm_per_min: scale.feed(page.setpoint_d_per_tick),
            command_percent: page.command * 100.0,
            later: Fault::ALL
                .iter()
                .filter(came_later)
                .map(|fault| fault_name(*fault))
                .collect(),
            cause: says.cause,
            remedy: says.remedy,
        }
    }
}
