//! An arc as a control finds it: from its ends and its centre in whole steps.

use std::f64::consts::{PI, TAU};

use super::super::refusal::Reason;

/// Ends nearer to each other than this, mm, are one place.
const SAME_MM: f64 = 1e-9;
/// LinuxCNC takes an arc that turns through less, rad, for a full circle.
const FULL_CIRCLE_BELOW: f64 = 1e-6;

/// What ends in one place are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum SameEnds {
    /// A full circle: I, J, K.
    FullCircle,
    /// No arc: R.
    NoArc,
}

/// An arc as a control finds it, in its plane.
#[derive(Clone, Copy, Debug)]
pub(super) struct WrittenArc {
    /// Where it starts, seen from its centre, mm.
    pub start: [f64; 2],
    /// Where it ends, seen from there.
    pub end: [f64; 2],
    /// Steps of the words of its end, mm.
    pub steps: [f64; 2],
    pub same_ends: SameEnds,
}

impl WrittenArc {
    /// Radii at its start and its end, mm.
    pub fn radii(&self) -> [f64; 2] {
        [self.start, self.end].map(|[x, y]| x.hypot(y))
    }

    /// Refuses it where the control turns through another angle than is meant, rad, positive for G3: a full circle for a short
    /// arc, or next to nothing for a full circle. Whole turns of P do not matter.
    pub fn check_sweep(&self, meant: f64) -> Result<(), Reason> {
        let turns = (meant.abs() / TAU - 1e-9).floor();
        let way = meant.abs() - turns * TAU;
        let mut found = self.sweep(meant.signum());
        if (found - way).abs() <= PI {
            let may_be_one = self.may_be_one_place() || found < FULL_CIRCLE_BELOW;
            match self.same_ends {
                SameEnds::FullCircle if may_be_one && way < PI => found = TAU,
                SameEnds::NoArc if may_be_one => found = 0.0,
                _ => return Ok(()),
            }
        }
        Err(Reason::Sweep {
            meant_deg: way.to_degrees(),
            found_deg: found.to_degrees(),
        })
    }

    /// Angle between the ends as they are, rad.
    fn sweep(&self, sense: f64) -> f64 {
        let [dx, dy] = self.way();
        if dx.hypot(dy) <= SAME_MM {
            return TAU;
        }
        let angle = |[x, y]: [f64; 2]| y.atan2(x);
        (sense * (angle(self.end) - angle(self.start))).rem_euclid(TAU)
    }

    /// True where a control that works in steps may round both ends to one place.
    fn may_be_one_place(&self) -> bool {
        let mut axes = self.way().into_iter().zip(self.steps);
        axes.all(|(way, step)| way.abs() < step * (1.0 - 1e-6))
    }

    fn way(&self) -> [f64; 2] {
        [self.end[0] - self.start[0], self.end[1] - self.start[1]]
    }
}
