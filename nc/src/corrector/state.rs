//! Where the axes are, as the program means it and as the control has it.

use super::refusal::Lost;
use crate::coordinates::{AXES, Axis};
use crate::path::arc::Plane;

/// One of the offsets between program and machine.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Part {
    /// As the program means it, mm or degrees; none where unknown.
    pub value: Option<f64>,
    /// What the control has more than that: it was set where the tool stood corrected.
    pub bias: f64,
}

impl Part {
    pub const ZERO: Self = Self {
        value: Some(0.0),
        bias: 0.0,
    };

    pub const fn of(value: Option<f64>) -> Self {
        Self { value, bias: 0.0 }
    }
}

/// The offsets, in the order they are asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Offset {
    Work,
    Shift,
    Local,
    Tool,
}

/// One axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct AxisState {
    /// Place in the coordinates of the program as it means it.
    pub program: Option<f64>,
    /// The same place in machine coordinates.
    pub machine: Option<f64>,
    /// Where the control really stands, less that place.
    pub applied: f64,
    /// The program has said where it is.
    pub placed: bool,
    /// Why the place is unknown, where it is.
    pub lost: Lost,
    /// Work, shift, local, tool.
    pub offsets: [Part; 4],
}

impl AxisState {
    pub const UNKNOWN: Self = Self {
        program: None,
        machine: None,
        applied: 0.0,
        placed: false,
        lost: Lost::Start,
        offsets: [Part::of(None), Part::ZERO, Part::ZERO, Part::ZERO],
    };

    /// Machine less program coordinate, as the program means it.
    pub fn offset(&self) -> Option<f64> {
        let [a, b, c, d] = self.offsets;
        Some(a.value? + b.value? + c.value? + d.value?)
    }

    /// What the control's offsets have more.
    pub fn bias(&self) -> f64 {
        self.offsets.iter().map(|part| part.bias).sum()
    }

    /// Stands at a place of the program.
    pub fn at_program(&mut self, place: f64) {
        self.program = Some(place);
        self.machine = self.offset().map(|offset| place + offset);
        self.placed = true;
        self.lost = Lost::Offset;
    }

    /// Went by a way.
    pub fn by(&mut self, way: f64) {
        self.program = self.program.map(|place| place + way);
        self.machine = self.machine.map(|place| place + way);
    }

    /// The control stands at a place of the machine, whatever the program means.
    pub fn at_machine(&mut self, place: Option<f64>, lost: Lost) {
        self.machine = place;
        self.program = place
            .zip(self.offset())
            .map(|(place, offset)| place - offset);
        self.applied = 0.0;
        self.placed = true;
        self.lost = lost;
    }

    /// Another offset comes into force, and nothing moves.
    pub fn set(&mut self, which: Offset, part: Part) {
        let before = std::mem::replace(&mut self.offsets[which as usize], part);
        self.program = match (
            self.machine.zip(self.offset()),
            before.value.zip(part.value),
        ) {
            (Some((machine, offset)), _) => Some(machine - offset),
            (None, Some((old, new))) => self.program.map(|place| place - (new - old)),
            (None, None) => None,
        };
        if self.program.is_none() {
            self.lost = Lost::Offset;
        }
    }

    /// The offset gets a value so that the tool stands at a place of the program.
    pub fn set_here(&mut self, which: Offset, place: f64) {
        self.offsets[which as usize] = self.part_here(which, place);
        self.program = Some(place);
        self.placed = true;
    }

    /// The value that [`AxisState::set_here`] gives.
    pub fn part_here(&self, which: Offset, place: f64) -> Part {
        let mut others = *self;
        others.offsets[which as usize] = Part::ZERO;
        Part {
            value: self
                .machine
                .zip(others.offset())
                .map(|(machine, offset)| machine - offset - place),
            bias: self.applied - others.bias(),
        }
    }
}

/// How the axes move where a block does not say it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Motion {
    None,
    Rapid,
    Line,
    Arc { clockwise: bool },
    Spline,
    Thread,
    Probe,
    Cycle(u8),
}

impl Motion {
    pub const fn name(self) -> &'static str {
        match self {
            Self::None => "no movement",
            Self::Rapid => "positioning",
            Self::Line => "a line",
            Self::Arc { .. } => "an arc",
            Self::Spline => "a spline",
            Self::Thread => "a thread",
            Self::Probe => "probing",
            Self::Cycle(_) => "a cycle",
        }
    }
}

/// What is in force until something else is.
#[derive(Clone, Copy, Debug)]
pub(super) struct Modes {
    pub motion: Motion,
    /// What goes on when a cycle ends.
    pub before_cycle: Motion,
    pub plane: Plane,
    pub inches: bool,
    pub incremental: bool,
    pub centre_absolute: bool,
    pub diameter: bool,
    /// Compensation is on, with the number its radius is looked up by.
    pub compensation: bool,
    pub inverse_time: bool,
    pub return_to_retract: bool,
    /// Work offset in force, tenths.
    pub work: u16,
}

impl Modes {
    pub const START: Self = Self {
        motion: Motion::None,
        before_cycle: Motion::None,
        plane: Plane::Xy,
        inches: false,
        incremental: false,
        centre_absolute: false,
        diameter: false,
        compensation: false,
        inverse_time: false,
        return_to_retract: false,
        work: 540,
    };

    /// True where the words of a line count as they do in other modes.
    pub fn count_as(&self, other: &Self) -> bool {
        let of = |modes: &Self| {
            let Self {
                inches,
                incremental,
                diameter,
                inverse_time,
                work,
                ..
            } = *modes;
            (inches, incremental, diameter, inverse_time, work)
        };
        of(self) == of(other)
    }
}

/// All axes.
pub(super) type AxisStates = [AxisState; AXES];

/// The axis of an index.
pub(super) fn axis(index: usize) -> Axis {
    Axis::ALL[index]
}
