//! What a block of a long program costs: how often K is asked for, which is what takes the time of short lines. Counted, not timed.

use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};

use leadscrew_nc::coordinates::{Axis, AxisSet, Coordinates};
use leadscrew_nc::corrector::Corrector;
use leadscrew_nc::dialect::Dialect;
use leadscrew_nc::machine_state::{MachineState, Places};
use leadscrew_nc::path::Tolerance;
use leadscrew_nc::terms::{Circumstances, Region, Shape, Steepness, Term, TermError, Terms};

/// K of Z by a parabola over X, and how often it was asked for.
#[derive(Debug)]
struct Counted {
    shape: Shape,
    asked: Arc<AtomicU32>,
}

impl Term for Counted {
    fn name(&self) -> &'static str {
        "counted"
    }

    fn correction(&self, at: &Coordinates, _: &Circumstances) -> Result<Coordinates, TermError> {
        self.asked.fetch_add(1, Ordering::Relaxed);
        Ok(Coordinates::ZERO.with(Axis::Z, 1e-6 * at[Axis::X] * at[Axis::X]))
    }

    fn corrects(&self) -> AxisSet {
        AxisSet::of(Axis::Z)
    }

    fn depends_on(&self) -> AxisSet {
        AxisSet::of(Axis::X)
    }

    fn shape(&self) -> Shape {
        self.shape
    }

    fn steepness(&self, within: &Region) -> Steepness {
        Steepness {
            slope: 2e-6 * within.farthest_from(Axis::X, 0.0),
            bend: 2e-6,
        }
    }
}

/// How often K is asked for over a thousand blocks, once a program is under way.
fn asked(shape: Shape, block: impl Fn(u32) -> String) -> u32 {
    let zero: Places = Axis::ALL.into_iter().map(|axis| (axis, 0.0)).collect();
    let mut state = MachineState {
        start: zero.clone(),
        ..MachineState::default()
    };
    state.work_offsets.origins.insert("G54".into(), zero);
    let asked = Arc::new(AtomicU32::new(0));
    let terms = Terms::none().with(Counted {
        shape,
        asked: Arc::clone(&asked),
    });
    let tolerance = Tolerance {
        mm: 0.001,
        degrees: 0.001,
    };
    let dialect = Dialect::named("linuxcnc-mill").unwrap();
    let mut corrector = Corrector::new(dialect, &state, terms, tolerance).unwrap();
    let mut out = Vec::new();
    corrector.block(b"G1 X0 Y0 F100\n", &mut out).unwrap();
    corrector.block(block(0).as_bytes(), &mut out).unwrap();
    let before = asked.load(Ordering::Relaxed);
    for number in 1..=1000 {
        corrector.block(block(number).as_bytes(), &mut out).unwrap();
    }
    assert!(out.starts_with(b"G1 X0 Y0 F100\n"));
    asked.load(Ordering::Relaxed) - before
}

#[test]
fn a_short_line_asks_for_k_once() {
    let line = |number: u32| format!("X{:.1} Y0.{}\n", f64::from(number) * 0.1, number % 7);
    assert_eq!(asked(Shape::Affine, line), 1000);
    // Y turns round twice in seven lines, and K at its start might be another one then.
    assert_eq!(asked(Shape::Curved, line), 1285);
}

#[test]
fn a_rapid_asks_for_k_once() {
    let rapid = |number: u32| format!("G0 X{:.3} Y{:.3}\n", f64::from(number) * 0.1, number % 7);
    assert_eq!(asked(Shape::Curved, rapid), 1000);
}
