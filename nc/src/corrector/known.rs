//! What does not change with the program: dialect, terms, tables of the control.

use std::collections::BTreeMap;
use std::fmt;

use super::refusal::Lost;
use super::state::{AxisStates, Modes, Offset, Part};
use super::write::Scales;
use super::{NOWHERE, Now, cycles};
use crate::block::Number;
use crate::coordinates::{AXES, Axis, AxisSet, Coordinates};
use crate::dialect::{Code, Dialect, Meaning};
use crate::machine_state::{MachineState, Places, Tool};
use crate::path::Tolerance;
use crate::path::arc::Plane;
use crate::setup::CONTROL;
use crate::source::{Complaint, span_of};
use crate::terms::{Approach, Shape, Terms};

/// What the machine's state says and the dialect does not know.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SetupError {
    /// Key of the value within the machine's state.
    key: Vec<String>,
    message: String,
}

impl SetupError {
    fn new(key: &[&str], message: String) -> Self {
        let key = key.iter().map(|&name| name.to_owned()).collect();
        Self { key, message }
    }

    /// The same with its place in the text of a setup, which has the machine's state under `control`.
    #[must_use]
    pub fn in_setup(&self, text: &str) -> Complaint {
        let key = self.key.iter().map(String::as_str);
        let key: Vec<&str> = [CONTROL].into_iter().chain(key).collect();
        Complaint::at(text, &span_of(text, &key), format!("{CONTROL}.{self}"))
    }
}

impl fmt::Display for SetupError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.key.join("."), self.message)
    }
}

impl std::error::Error for SetupError {}

/// How far radii of an arc may differ where nothing is given, mm.
const RADIUS_TOLERANCE_MM: f64 = 0.01;

/// What does not change with the program, but for the tables that G10 writes.
#[derive(Debug)]
pub(super) struct Known {
    pub dialect: Dialect,
    pub terms: Terms,
    pub tolerance: Tolerance,
    pub shape: Shape,
    pub corrects: AxisSet,
    pub depends_on: AxisSet,
    /// Either of both.
    pub involved: AxisSet,
    pub block_delete: Option<bool>,
    pub radius_tolerance_mm: f64,
    pub tool_change: Places,
    pub references: BTreeMap<u16, Places>,
    pub tools: BTreeMap<u32, Tool>,
    pub origins: BTreeMap<u16, [Part; AXES]>,
    external: Places,
}

impl Known {
    pub fn new(
        dialect: Dialect,
        state: &MachineState,
        terms: Terms,
        tolerance: Tolerance,
    ) -> Result<Self, SetupError> {
        let mut origins = BTreeMap::new();
        for (name, places) in &state.work_offsets.origins {
            origins.insert(
                work_offset(&dialect, name, &["work_offsets", "origins", name])?,
                origin(places, &state.work_offsets.external),
            );
        }
        let mut references = BTreeMap::new();
        for (name, places) in &state.references {
            let reference = matches!(
                code_named(&dialect, name),
                Some((Code::Of(Meaning::Reference), _))
            );
            let tenths = code_named(&dialect, name).filter(|_| reference);
            let Some((_, tenths)) = tenths else {
                let message = format!("{name} goes to no reference in dialect {}", dialect.name());
                return Err(SetupError::new(&["references", name], message));
            };
            references.insert(tenths, places.clone());
        }
        let (corrects, depends_on) = (terms.corrects(), terms.depends_on());
        Ok(Self {
            shape: terms.shape(),
            corrects,
            depends_on,
            involved: corrects
                .union(depends_on)
                .union(terms.depends_on_approach_of()),
            block_delete: state.block_delete,
            radius_tolerance_mm: state.radius_tolerance_mm.unwrap_or(RADIUS_TOLERANCE_MM),
            tool_change: state.tool_change.clone(),
            references,
            tools: state.tools.clone(),
            origins,
            external: state.work_offsets.external.clone(),
            dialect,
            terms,
            tolerance,
        })
    }

    /// How a program begins.
    pub fn start(&self, state: &MachineState) -> Result<Now, SetupError> {
        let mut modes = Modes {
            diameter: state.diameter.unwrap_or(self.dialect.diameter_at_start()),
            ..Modes::START
        };
        for code in self.dialect.start() {
            start_mode(&mut modes, *code);
        }
        if let Some(inches) = state.inches {
            modes.inches = inches;
        }
        if let Some(diameter) = state.diameter {
            modes.diameter = diameter;
        }
        if let Some(active) = &state.work_offsets.active {
            modes.work = work_offset(&self.dialect, active, &["work_offsets", "active"])?;
        }
        let mut axes = NOWHERE;
        for axis in Axis::ALL {
            let one = &mut axes[axis.index()];
            one.offsets[Offset::Work as usize] = self.work_part(modes.work, axis);
            let shift = state.work_offsets.shift.get(&axis).copied().unwrap_or(0.0);
            one.offsets[Offset::Shift as usize] = Part::of(Some(shift));
            if let Some(tool) = state.tool_offset {
                one.offsets[Offset::Tool as usize] = self.tool_part(Some(tool), 1.0, axis);
            }
            if let Some(place) = state.start.get(&axis) {
                one.at_machine(Some(*place), Lost::Start);
            }
        }
        let mut now = Now {
            modes,
            scales: Scales::new(&self.dialect, &modes),
            axes,
            approach: Approach::UNKNOWN,
            last_k: None,
            tool: state.tool,
            selected: state.tool,
            offset_of: state.tool_offset.map(Some),
            tool_offset: None,
            radius_of: state.tool_offset.or(state.tool),
            radius_mm: None,
            cycle: cycles::Sticky::default(),
            profile: None,
            ended: false,
            begun: false,
            spaced: true,
            line_end: b"\n",
        };
        now.tool_offset = tool_offset(&now.axes);
        Ok(now)
    }

    /// Work offset of a code in one axis.
    pub fn work_part(&self, code: u16, axis: Axis) -> Part {
        if self.dialect.work_offsets().is_empty() {
            return Part::ZERO;
        }
        self.origins
            .get(&code)
            .map_or(Part::of(None), |origin| origin[axis.index()])
    }

    /// What G10 sets a work offset to, with the external offset.
    pub fn set_origin(&mut self, code: u16, axis: Axis, part: Part, with_external: bool) {
        let external = if with_external {
            0.0
        } else {
            self.external.get(&axis).copied().unwrap_or(0.0)
        };
        let value = part.value.map(|value| value + external);
        let unknown = [Part::of(None); AXES];
        self.origins.entry(code).or_insert(unknown)[axis.index()] = Part { value, ..part };
    }

    /// Offset of a tool in one axis: with the tool known, axes that are not named have none.
    pub fn tool_part(&self, tool: Option<u32>, sign: f64, axis: Axis) -> Part {
        match tool {
            Some(0) => Part::ZERO,
            Some(tool) => Part::of(
                self.tools
                    .get(&tool)
                    .map(|known| sign * known.offset.get(&axis).copied().unwrap_or(0.0)),
            ),
            None => Part::of(None),
        }
    }
}

/// The tool offset in force; none where unknown.
pub(super) fn tool_offset(axes: &AxisStates) -> Option<Coordinates> {
    let mut offset = Coordinates::ZERO;
    for (axis, state) in Axis::ALL.into_iter().zip(axes) {
        offset[axis] = state.offsets[Offset::Tool as usize].value?;
    }
    Some(offset)
}

fn origin(places: &Places, external: &Places) -> [Part; AXES] {
    Axis::ALL.map(|axis| {
        let external = external.get(&axis).copied().unwrap_or(0.0);
        Part::of(places.get(&axis).map(|place| place + external))
    })
}

fn code_named(dialect: &Dialect, name: &str) -> Option<(Code, u16)> {
    let digits = name.strip_prefix('G')?.as_bytes();
    let (number, len) = Number::read(digits, false).ok()?;
    let code = dialect.code(b'G', number).filter(|_| len == digits.len())?;
    Some((code, u16::try_from(number.tenths()?).ok()?))
}

fn work_offset(dialect: &Dialect, name: &str, key: &[&str]) -> Result<u16, SetupError> {
    match code_named(dialect, name) {
        Some((Code::WorkOffset(tenths), _)) => Ok(tenths),
        _ => {
            let message = format!("{name} is no work offset of dialect {}", dialect.name());
            Err(SetupError::new(key, message))
        }
    }
}

/// Modes that codes of the start bring; what is not a mode does nothing.
fn start_mode(modes: &mut Modes, code: Code) {
    match code {
        Code::WorkOffset(tenths) => modes.work = tenths,
        Code::Of(Meaning::Rapid) => modes.motion = super::Motion::Rapid,
        Code::Of(Meaning::Line) => modes.motion = super::Motion::Line,
        Code::Of(meaning) => {
            mode(modes, meaning);
        }
        Code::Cycle(_) | Code::Refused(_) => {}
    }
}

/// Applies a code that only changes a mode; false where it is none.
pub(super) fn mode(modes: &mut Modes, meaning: Meaning) -> bool {
    match meaning {
        Meaning::PlaneXy => modes.plane = Plane::Xy,
        Meaning::PlaneZx => modes.plane = Plane::Zx,
        Meaning::PlaneYz => modes.plane = Plane::Yz,
        Meaning::Inches => modes.inches = true,
        Meaning::Millimetres => modes.inches = false,
        Meaning::Absolute => modes.incremental = false,
        Meaning::Incremental => modes.incremental = true,
        Meaning::CentreAbsolute => modes.centre_absolute = true,
        Meaning::CentreIncremental => modes.centre_absolute = false,
        Meaning::Diameter => modes.diameter = true,
        Meaning::Radius => modes.diameter = false,
        Meaning::ReturnToStart => modes.return_to_retract = false,
        Meaning::ReturnToRetract => modes.return_to_retract = true,
        Meaning::InverseTime => modes.inverse_time = true,
        Meaning::FeedRate => modes.inverse_time = false,
        _ => return false,
    }
    true
}
