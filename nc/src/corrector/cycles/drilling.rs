//! Drilling cycles: over X and Y, down to Z, up again.

use super::super::Task;
use super::super::instruction::{Found, Said, parameter};
use super::super::refusal::Reason;
use super::super::state::axis;
use crate::coordinates::{AXES, Axis, Coordinates};
use crate::dialect::{Cycle, CycleEnd};
use crate::path::arc::Plane;
use crate::terms::Approach;

impl Task<'_> {
    /// Drilling: over X and Y, down to Z, up again.
    pub fn drilling(&mut self, cycle: &Cycle) -> Result<(), Found> {
        let at = self.at();
        if self.now.modes.plane != Plane::Xy {
            return Err((
                at,
                Reason::Unsupported("a drilling cycle is known in plane X, Y (G17) alone"),
            ));
        }
        self.check_repeats()?;
        let goals = self.goals()?;
        let z = Axis::Z.index();
        let Some(held) = self.hold(Axis::Z, &goals[z]) else {
            return Err((
                at,
                Reason::MissingWord {
                    letter: 'Z',
                    of: "the cycle",
                },
            ));
        };
        self.hold_retract()?;
        self.check_mode(held.as_way)?;
        let said_retract = self.now.cycle.retract;
        if let Some((_, as_way)) = said_retract {
            self.check_mode(as_way)?;
        }
        let said_retract = said_retract.map(|(said, _)| said);
        let state = self.now.axes[z];
        // R counts from where the tool stands, Z from R, where words are ways.
        let retract = if self.now.modes.incremental {
            let way = said_retract.unwrap_or(0.0);
            state.program.map(|from| from + way)
        } else {
            said_retract
        };
        let mut bottom = goals;
        if held.as_way {
            let way = said_retract.unwrap_or(0.0) + held.said;
            bottom[z].program = state.program.map(|from| from + way);
            bottom[z].machine = state.machine.map(|from| from + way);
        } else {
            self.reach(Axis::Z, &held, &mut bottom[z]);
        }
        // The tool goes down last.
        bottom[z].way = -1.0;
        let place = self.place(&bottom, at)?;
        let with = self.circumstances(&bottom);
        let k = self.correction(&place, &with, at)?;
        for index in (0..AXES).filter(|index| *index != z) {
            let axis = axis(index);
            if let Some(wanted) = self.wanted(axis, &goals[index], k[axis], false)? {
                self.write_axis(axis, &wanted)?;
            }
        }
        let value = if held.as_way {
            held.said + k[Axis::Z] - state.applied
        } else {
            held.said + k[Axis::Z] - state.bias()
        };
        self.write_held(Axis::Z, &goals[z], value)?;
        let mut over = goals;
        (over[z].program, over[z].machine) = (state.program, state.machine);
        self.arrive(&over);
        self.rise(cycle, retract, with.approach);
        Ok(())
    }

    fn hold_retract(&mut self) -> Result<(), Found> {
        match parameter(self.block, b'R') {
            Said::Nothing => Ok(()),
            Said::Number(number) => {
                let said = self.scale(Axis::Z).read(number);
                self.now.cycle.retract = Some((said, self.now.modes.incremental));
                Ok(())
            }
            Said::Unknown => Err((self.at(), Reason::Expression('R'))),
        }
    }

    /// Repeated ways go on from hole to hole.
    fn check_repeats(&self) -> Result<(), Found> {
        for letter in [b'L', b'K'] {
            let once = match parameter(self.block, letter) {
                Said::Nothing => true,
                Said::Number(number) => number.whole() == Some(1),
                Said::Unknown => false,
            };
            if !once && self.now.modes.incremental {
                let what = "a cycle repeated by ways: write the holes one by one";
                return Err((self.at(), Reason::Unsupported(what)));
            }
        }
        Ok(())
    }

    /// Where a drilling cycle leaves Z: at R, which stays as it is written, or where it began, if that is higher.
    fn rise(&mut self, cycle: &Cycle, retract: Option<f64>, approach: Approach) {
        let up = Coordinates::ZERO.with(Axis::Z, 1.0);
        self.now.approach = approach.after(&up);
        if cycle.end == CycleEnd::Height {
            return;
        }
        let to_retract = self.now.modes.return_to_retract;
        let state = &mut self.now.axes[Axis::Z.index()];
        if self.now.modes.incremental {
            // R is a way from where the control stands: what it has more stays.
            if let (Some(from), Some(to)) = (state.program, retract)
                && (to_retract || from < to)
            {
                state.by(to - from);
            }
            return;
        }
        let (Some(retract), true) = (retract, to_retract || state.program.is_some()) else {
            // It went back to where it was, or to R: unknown either way.
            state.program = None;
            state.machine = None;
            return;
        };
        // What the program means, and what the control does, which stands elsewhere and reads R as it is written.
        let from = state
            .program
            .filter(|_| !to_retract)
            .unwrap_or(f64::NEG_INFINITY);
        let bias = state.bias();
        let stands = (from + state.applied - bias).max(retract);
        let meant = from.max(retract);
        state.at_program(meant);
        state.applied = stands + bias - meant;
    }
}
