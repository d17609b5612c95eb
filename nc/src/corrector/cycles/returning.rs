//! Cycles that end where they began: a thread, a box, a pecking cycle of a lathe.

use super::super::Task;
use super::super::instruction::Found;
use super::super::places::Goals;
use super::super::refusal::Reason;
use crate::coordinates::{AxisSet, Coordinates};
use crate::dialect::Cycle;
use crate::path::{PathError, line};
use crate::terms::Shape;

impl Task<'_> {
    /// A cycle that ends where it began: a thread, a box, a pecking cycle of a lathe.
    pub fn returning(&mut self, cycle: &Cycle) -> Result<(), Found> {
        let goals = self.goals()?;
        let mut ends = goals;
        let mut targets = AxisSet::NONE;
        for axis in cycle.targets.iter() {
            let Some(held) = self.hold(axis, &goals[axis.index()]) else {
                continue;
            };
            if !held.as_way {
                self.check_mode(false)?;
            }
            targets = targets.with(axis);
            self.reach(axis, &held, &mut ends[axis.index()]);
        }
        if targets.is_empty() {
            return Ok(());
        }
        let at = self.at();
        let place = self.place(&ends, at)?;
        let with = self.circumstances(&ends);
        let k = self.correction(&place, &with, at)?;
        self.check_along(&ends, targets, &place, &k)?;
        for axis in targets.iter() {
            let state = &self.now.axes[axis.index()];
            let Some(held) = self.now.cycle.held[axis.index()] else {
                continue;
            };
            let value = if held.as_way {
                held.said + k[axis] - state.applied
            } else {
                held.said + k[axis] - state.bias()
            };
            if held.as_way
                && goals[axis.index()].word.is_none()
                && !self.scale(axis).says(held.written, value)
            {
                let what = "a way of a cycle that holds would have to change: write its word in every block";
                return Err((at, Reason::Unsupported(what)));
            }
            self.write_held(axis, &goals[axis.index()], value)?;
        }
        // It comes back to its start against the way it went.
        let back = Coordinates::new(ends.map(|end| -end.way));
        self.now.approach = with.approach.after(&back);
        Ok(())
    }

    /// The cuts of a cycle are led by its end alone: K must not change along them by more than the tolerance.
    fn check_along(
        &self,
        ends: &Goals,
        targets: AxisSet,
        end: &Coordinates,
        k: &Coordinates,
    ) -> Result<(), Found> {
        if self.known.shape <= Shape::Constant {
            return Ok(());
        }
        let at = self.at();
        let applied = self.applied();
        let from = self.place(&self.standing(), at)?;
        for along in targets.iter() {
            let corner = end.with(along, from[along]);
            let by = Coordinates::ZERO.with(along, ends[along.index()].way);
            let with = crate::terms::Circumstances {
                approach: self.now.approach.after(&by),
                ..self.standing_circumstances()
            };
            let at_corner = self.correction(&corner, &with, at)?;
            let mut off = Coordinates::ZERO;
            for axis in self.known.corrects.iter() {
                let stands = if axis != along && targets.contains(axis) {
                    k[axis]
                } else {
                    applied[axis]
                };
                let at_end = if targets.contains(axis) {
                    0.0
                } else {
                    k[axis] - stands
                };
                let here = at_corner[axis] - stands;
                off[axis] = if here.abs() > at_end.abs() {
                    here
                } else {
                    at_end
                };
            }
            let mut share = self.known.tolerance.share(&off);
            let pieces = line::split(
                &corner,
                end,
                &at_corner,
                &self.known.terms,
                &with,
                &self.known.tolerance,
            );
            if pieces
                .map_err(|error: PathError| (at, Reason::Path(error)))?
                .len()
                > 1
            {
                share = share.max(1.1);
            }
            if share > 1.0 {
                return Err((
                    at,
                    Reason::Changes {
                        what: "cut of the cycle",
                        share,
                    },
                ));
            }
        }
        Ok(())
    }
}
