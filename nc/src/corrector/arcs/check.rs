//! What the control makes of the arc that is written, and the R with which it makes the right one.

use super::super::Task;
use super::super::instruction::Found;
use super::super::places::Goals;
use super::super::refusal::Reason;
use super::written_arc::{SameEnds, WrittenArc};
use super::{Circle, OF_RADIUS, circle_frame};
use crate::coordinates::Coordinates;
use crate::path::PathError;
use crate::path::arc::Arc;

impl Task<'_> {
    /// R as it can be written, with which the control, that works out the centre from the ends written, comes nearest to the
    /// circle. Near to half a turn a last digit of R moves the centre by many: √(R² − half²).
    pub fn radius_to_say(
        &self,
        goals: &Goals,
        started: &Coordinates,
        circle: &Circle,
    ) -> Result<f64, Found> {
        // Two arcs with the same ends are farthest apart in their middles.
        let off = |radius: f64| {
            let arc = self.arc_of_radius(goals, started, radius, circle);
            arc.map_or(f64::INFINITY, |arc| {
                let [x, y] = arc.plane.of(&arc.at(0.5));
                let [centre_x, centre_y] = circle.centre;
                ((x - centre_x).hypot(y - centre_y) - circle.radius).abs()
            })
        };
        let exact = circle.signed_radius();
        let scale = self.centre_scale();
        let nearest = scale
            .nearest(exact, b'R')
            .map_err(|reason| (self.at(), reason))?
            .1;
        let step = scale.step();
        let (radius, off_mm) = [nearest, nearest - step, nearest + step]
            .map(|radius| (radius, off(radius)))
            .into_iter()
            .min_by(|a, b| a.1.total_cmp(&b.1))
            .unwrap_or((nearest, f64::INFINITY));
        let written = self.written_arc(goals, started, circle.centre, SameEnds::NoArc);
        written
            .check_sweep(circle.sweep)
            .map_err(|reason| (self.at(), reason))?;
        // A step is what rounding may be off anywhere.
        if off_mm > OF_RADIUS * self.known.tolerance.mm + step {
            return Err((self.at(), Reason::RadiusForm { off_mm }));
        }
        Ok(radius)
    }

    /// The arc that the control works out of R and the ends as they are written.
    fn arc_of_radius(
        &self,
        goals: &Goals,
        started: &Coordinates,
        radius: f64,
        circle: &Circle,
    ) -> Result<Arc, PathError> {
        let (from, to) = self.written_ends(goals, started);
        let tolerance = self.known.radius_tolerance_mm;
        let clockwise = circle.sweep < 0.0;
        Arc::from_radius(
            self.now.modes.plane,
            from,
            to,
            radius,
            clockwise,
            1,
            tolerance,
        )
    }

    /// Where the control begins, having started with so much more, and where it ends after what is written.
    fn written_ends(&self, goals: &Goals, started: &Coordinates) -> (Coordinates, Coordinates) {
        let (mut from, mut to) = (Coordinates::ZERO, Coordinates::ZERO);
        for axis in self.now.modes.plane.axes() {
            let goal = &goals[axis.index()];
            from[axis] = circle_frame(goal) - goal.way + started[axis];
            to[axis] = circle_frame(goal) + self.now.axes[axis.index()].applied;
        }
        (from, to)
    }

    fn written_arc(
        &self,
        goals: &Goals,
        started: &Coordinates,
        [x, y]: [f64; 2],
        same_ends: SameEnds,
    ) -> WrittenArc {
        let plane = self.now.modes.plane;
        let (from, to) = self.written_ends(goals, started);
        let seen = |place: &Coordinates| {
            let [first, second] = plane.of(place);
            [first - x, second - y]
        };
        WrittenArc {
            start: seen(&from),
            end: seen(&to),
            steps: plane.axes().map(|axis| self.scale(axis).step()),
            same_ends,
        }
    }

    /// What the control will find in what was written: radii at both ends, and the angle between them.
    pub fn check_written(
        &self,
        goals: &Goals,
        started: &Coordinates,
        centre: [f64; 2],
        circle: &Circle,
    ) -> Result<(), Found> {
        let written = self.written_arc(goals, started, centre, SameEnds::FullCircle);
        let [start_mm, end_mm] = written.radii();
        let tolerance_mm = self.known.radius_tolerance_mm;
        if (start_mm - end_mm).abs() > tolerance_mm {
            return Err((
                self.at(),
                Reason::Path(PathError::Radii {
                    start_mm,
                    end_mm,
                    tolerance_mm,
                }),
            ));
        }
        written
            .check_sweep(circle.sweep)
            .map_err(|reason| (self.at(), reason))
    }
}
