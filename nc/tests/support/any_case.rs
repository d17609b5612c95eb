//! What a program of any bytes is run with: dialect, terms, state of the machine, tolerance, chosen by four bytes.

use leadscrew_nc::coordinates::Axis;
use leadscrew_nc::corrector::Corrector;
use leadscrew_nc::dialect::Dialect;
use leadscrew_nc::machine_state::MachineState;
use leadscrew_nc::path::Tolerance;
use leadscrew_nc::setup::Setup;
use leadscrew_nc::terms::{Shape, Terms};

use super::polynomial::Polynomial;
use super::shop;

/// Bytes that choose.
pub const CHOICES: usize = 4;
/// mm, or degrees.
const TOLERANCES: [f64; 3] = [0.01, 0.001, 0.1];
const STATES: usize = 4;

const fn polynomial(corrects: Axis, over: Axis, k0: f64, k1: f64, k2: f64) -> Polynomial {
    Polynomial {
        corrects,
        over,
        k0,
        k1,
        k2,
    }
}

/// A correction that has to be followed and changes nothing.
pub const NOTHING: [Polynomial; 1] = [polynomial(Axis::X, Axis::X, 0.0, 0.0, 0.0)];

/// Corrections of X, Y, Z that the simple control can be held against.
const POLYNOMIALS: [&[Polynomial]; 3] = [
    &[
        polynomial(Axis::X, Axis::X, 0.1, 0.0, 0.0),
        polynomial(Axis::Y, Axis::Y, -0.037, 0.0, 0.0),
        polynomial(Axis::Z, Axis::Z, 0.0123, 0.0, 0.0),
    ],
    &[
        polynomial(Axis::X, Axis::Z, 0.1, 1e-3, 0.0),
        polynomial(Axis::Y, Axis::X, 0.0, -7e-4, 0.0),
        polynomial(Axis::Z, Axis::Y, 0.0, 3e-4, 0.0),
    ],
    &[
        polynomial(Axis::X, Axis::Z, 0.1, 1e-3, 1e-5),
        polynomial(Axis::Z, Axis::X, 0.0, 0.0, -1e-5),
    ],
];

/// Corrections of every other kind, as setups write them.
const SETUPS: [&str; 3] = [
    // Screw maps with lost motion, growth.
    r#"screw_map = "program"
[[terms.screw]]
axis = "X"
points = [
  { position_mm = -300, forward_um = -40, backward_um = -28 },
  { position_mm = 0, forward_um = 0, backward_um = 15 },
  { position_mm = 300, forward_um = 30, backward_um = 35 },
]
[[terms.screw]]
axis = "Z"
points = [
  { position_mm = -300, forward_um = 10, backward_um = 4 },
  { position_mm = 300, forward_um = -20, backward_um = -25 },
]
[[terms.thermal]]
name = "warm"
axis = "Y"
grows = "screw"
expansion_um_per_m_k = 11.5
fixed_point_mm = 50.0
temperature_c = 29.0
"#,
    // A turned workpiece, worn tools.
    r#"[[terms.workpiece]]
name = "clamping"
point_mm = { X = 10, Y = -20, Z = 30 }
a_mm = 0.05
gamma_rad = 0.001
beta_rad = -0.0007
[[terms.wear]]
tool = 1
offset_mm = { Z = -0.012 }
[[terms.wear]]
tool = 2
offset_mm = { X = 0.02, Z = 0.01 }
"#,
    // Coefficients that are functions, a rotary axis.
    r#"[[terms.affine]]
name = "lean"
constant_mm = { Y = -0.021 }
constant_deg = { B = 0.036 }
coefficient = [
  { corrects = "Y", by = "X", mm_per_mm = 3e-4 },
  { corrects = "Z", by = "X", over = "Z", places_mm = [-300, 0, 300], mm_per_mm = [-6e-4, 0, 6e-4] },
  { corrects = "B", by = "X", deg_per_mm = -2e-4 },
]
"#,
];

/// What is run.
pub struct Case {
    pub dialect: &'static str,
    /// Number of the terms: those of [`POLYNOMIALS`], then those of [`SETUPS`].
    terms: usize,
    state: usize,
    pub tolerance: f64,
}

impl Case {
    pub fn of(choices: [usize; CHOICES]) -> Self {
        let [dialect, terms, state, tolerance] = choices;
        let count = Dialect::names().count();
        Self {
            dialect: Dialect::names().nth(dialect % count).unwrap_or("iso-mill"),
            terms: terms % (POLYNOMIALS.len() + SETUPS.len()),
            state: state % STATES,
            tolerance: TOLERANCES[tolerance % TOLERANCES.len()],
        }
    }

    pub fn dialect(&self) -> Dialect {
        shop::dialect(self.dialect)
    }

    pub fn terms(&self) -> Terms {
        if let Some(polynomials) = POLYNOMIALS.get(self.terms) {
            return shop::terms(polynomials);
        }
        let text = SETUPS[self.terms - POLYNOMIALS.len()];
        let setup = Setup::read(text, &|name| Err(name.to_owned()));
        setup.unwrap_or_else(|error| panic!("{text}{error}")).terms
    }

    /// All is known; nothing is; or all, and the control begins otherwise.
    pub fn machine(&self) -> MachineState {
        let dialect = self.dialect();
        let mut state = shop::state(&dialect);
        let has_offsets = !dialect.work_offsets().is_empty();
        match self.state {
            1 => state = MachineState::default(),
            2 => {
                state.inches = dialect.numbers().increment_inch.map(|_| true);
                state.diameter = dialect.diameter().map(|_| !dialect.diameter_at_start());
                state.block_delete = Some(true);
                state.tool_offset = Some(1);
                state.work_offsets.external.insert(Axis::X, 3.5);
            }
            3 => {
                state.block_delete = None;
                state.work_offsets.active = has_offsets.then(|| "G55".into());
                state.work_offsets.shift.insert(Axis::Y, -12.5);
                state.radius_tolerance_mm = Some(0.00127);
            }
            _ => {}
        }
        state
    }

    pub fn corrector(&self, terms: Terms, state: &MachineState) -> Corrector {
        let tolerance = Tolerance {
            mm: self.tolerance,
            degrees: self.tolerance,
        };
        let corrector = Corrector::new(self.dialect(), state, terms, tolerance);
        corrector.unwrap_or_else(|error| panic!("{error}"))
    }

    /// A correction by less than can be written, for which arcs are worked out where the terms need that.
    pub fn less_than_a_step(&self) -> Terms {
        if self.terms().shape() <= Shape::Constant {
            return shop::terms(&NOTHING);
        }
        let slope = |corrects, over| polynomial(corrects, over, 0.0, 1e-30, 0.0);
        shop::terms(&[slope(Axis::X, Axis::X), slope(Axis::Z, Axis::Z)])
    }

    /// The terms, if they are such as the simple control can be held against, and all is known that it has to know.
    pub fn polynomials(&self) -> Option<&'static [Polynomial]> {
        let is_known = self.state == 0 && !["micrometre", "linuxcnc-lathe"].contains(&self.dialect);
        POLYNOMIALS.get(self.terms).copied().filter(|_| is_known)
    }
}
