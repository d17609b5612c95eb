//! The machine, the part and the tools as they are: what the program does not know.

use leadscrew_nc::coordinates::{Axis, Coordinates};
use nalgebra::{Isometry3, Point3, Translation3, Vector3};

use super::ProveOutError;
use super::amounts::{Amounts, certified};
use super::cut::{Cut, CutPaths};
use super::draws::Draws;
use super::part::{Feature, PLANNED_MM, TOOLS, Tool, control_point, tool};
use super::program::Feed;
use crate::deviations::{Chain, DeviationError, Machine, Motion, SettingVector, built_in, read};
use crate::metrology::Touch;

/// Length of the probe, mm.
pub(super) const PROBE_MM: f64 = 150.0;
/// Length of the pieces that the true path of a feed is taken in, mm.
const PIECE_MM: f64 = 4.0;
/// Part of the growth by heat that is left while the machine probes.
const PROBING: f64 = 0.5;
/// The probe touches where its tip is this near to the surface, mm.
const NEAR_MM: f64 = 1e-9;

/// What is true.
#[derive(Clone, Debug)]
pub struct World {
    machine: Machine,
    /// Where the part lies in the frame of the table, in truth.
    part: Isometry3<f64>,
    /// Wear of the tools: by how much the cutting point lies back, mm.
    wear: [Vector3<f64>; 3],
    growth: Vector3<f64>,
    /// What was cut.
    cut: CutPaths,
}

impl World {
    /// A world with so much wrong in it, and the machine as it was certified.
    ///
    /// # Errors
    /// A built-in machine that cannot be read, which tests exclude.
    pub fn new(amounts: &Amounts, seed: u64) -> Result<(Self, Machine), ProveOutError> {
        let mut draws = Draws::new(seed, 0);
        let text = built_in("6904MF2").unwrap_or_default();
        let mut machine = read(text)
            .map_err(|complaint| ProveOutError::Machine(complaint.to_string()))?
            .machine;
        for unit in machine.workpiece.iter_mut().chain(&mut machine.tool) {
            // An indexed table: K in X, Y and Z alone.
            unit.corrected &= matches!(unit.motion, Motion::Linear(_));
        }
        let machine = machine.scaled(amounts.machine);
        let mut draw = |largest: f64| largest * (2.0 * draws.uniform() - 1.0);
        let setting = SettingVector::new([
            draw(amounts.setting_mm),
            draw(amounts.setting_mm),
            draw(amounts.setting_mm),
            draw(amounts.setting_rad),
            draw(amounts.setting_rad),
            draw(amounts.setting_rad),
        ]);
        let wear = [
            Vector3::new(0.0, 0.0, draw(amounts.wear_mm).abs()),
            // A bore lies where the spindle is: the bar's wear is one of its diameter.
            Vector3::zeros(),
            Vector3::new(draw(amounts.wear_mm).abs(), 0.0, 0.0),
        ];
        let growth = Vector3::from_fn(|_, _| draw(amounts.growth_mm));
        let certified = certified(&machine, amounts, &mut draws)?;
        let world = Self {
            machine,
            part: Isometry3::from(Translation3::from(Vector3::from(PLANNED_MM)))
                * setting.to_isometry(),
            wear,
            growth,
            cut: CutPaths::default(),
        };
        Ok((world, certified))
    }

    /// Where the part seems to lie to a probe that heat has moved, as planned to as it is.
    #[must_use]
    pub fn setting_seen(&self) -> SettingVector {
        let planned = Isometry3::from(Translation3::from(Vector3::from(PLANNED_MM)));
        let mut setting = SettingVector::of_isometry(&(planned.inverse() * self.part));
        setting.shift -= self.growth * PROBING;
        setting
    }

    /// By how much a tool cuts beside the place where the machine brings it, as a probe that heat has moved sees it, mm.
    #[must_use]
    pub fn tool_seen(&self, number: u32) -> Option<[f64; 3]> {
        let index = TOOLS.iter().position(|one| one.number == number)?;
        Some((self.wear[index] + self.growth * (1.0 - PROBING)).into())
    }

    /// Cuts the part anew by these feeds; `allowance` leaves what a first pass leaves.
    ///
    /// # Errors
    /// A tool that is not there, a place beyond the ends of the machine.
    pub fn cut(&mut self, feeds: &[Feed], allowance: bool) -> Result<(), ProveOutError> {
        let mut cut = CutPaths::default();
        for feed in feeds {
            let tool = tool(feed.tool).ok_or(ProveOutError::Tool(feed.tool))?;
            let edge = self.edge(tool, allowance);
            let length = (Vector3::from(feed.to) - Vector3::from(feed.from)).norm();
            let pieces = (length / PIECE_MM).ceil().max(1.0) as usize;
            let path = (0..=pieces).map(|piece| {
                let part = piece as f64 / pieces as f64;
                let at = |i: usize| feed.from[i] * (1.0 - part) + feed.to[i] * part;
                let control = control_point([at(0), at(1), at(2)], tool.length_mm);
                let point = self.in_part(edge, &control)?;
                let above = self.in_part(edge + Vector3::z(), &control)?;
                Ok::<_, ProveOutError>(Cut {
                    point,
                    axis: above - point,
                })
            });
            cut.add(feed.tool, path.collect::<Result<_, _>>()?);
        }
        self.cut = cut;
        Ok(())
    }

    /// The true cutting point from the nose of the spindle.
    fn edge(&self, tool: &Tool, allowance: bool) -> Vector3<f64> {
        let index = TOOLS.iter().position(|one| one.number == tool.number);
        let worn = index.map_or(Vector3::zeros(), |index| self.wear[index]);
        let left = if allowance {
            Vector3::from(tool.allowance_mm)
        } else {
            Vector3::zeros()
        };
        Vector3::new(0.0, 0.0, -tool.length_mm)
            + Vector3::from(tool.edge_mm)
            + worn
            + left
            + self.growth
    }

    /// Where a point of the spindle really is in the part.
    fn in_part(
        &self,
        from_nose: Vector3<f64>,
        at: &Coordinates,
    ) -> Result<Vector3<f64>, DeviationError> {
        let table = self.machine.true_frame(Chain::Workpiece, at)?;
        let spindle = self.machine.true_frame(Chain::Tool, at)?;
        let place = self.part.inverse() * table.inverse() * spindle * Point3::from(from_nose);
        Ok(place.coords)
    }

    /// The coordinate of the axis along which the probe, its tip planned at `from`, touches a feature against `normal`: where it
    /// really does, as the machine counts.
    ///
    /// # Errors
    /// A place beyond the ends of the machine, a surface that is not met.
    pub fn contact(
        &self,
        feature: Feature,
        from: &Coordinates,
        along: Axis,
    ) -> Result<f64, ProveOutError> {
        let tip = Vector3::new(0.0, 0.0, -PROBE_MM) + self.growth * PROBING;
        let clear = |place: f64| -> Result<f64, ProveOutError> {
            let in_part = self.in_part(tip, &from.with(along, place))?;
            Ok(self.cut.clearance(feature, &in_part))
        };
        let (mut a, mut b) = (from[along], from[along] + 1e-2);
        let (mut clear_a, mut clear_b) = (clear(a)?, clear(b)?);
        for _ in 0..60 {
            if clear_b.abs() < NEAR_MM {
                return Ok(b);
            }
            let slope = (clear_b - clear_a) / (b - a);
            if slope.abs() < 0.1 {
                break;
            }
            (a, clear_a) = (b, clear_b);
            b -= clear_b / slope;
            clear_b = clear(b)?;
        }
        Err(ProveOutError::NoContact(feature))
    }

    /// A touch as a perfect measuring machine would make it: the true place on the surface, in the coordinates of the part.
    #[must_use]
    pub fn true_touch(&self, feature: Feature, nominal: [f64; 3], normal: [f64; 3]) -> Touch {
        let mut place = Vector3::from(nominal);
        let out = Vector3::from(normal);
        for _ in 0..4 {
            place -= out * self.cut.clearance(feature, &place);
        }
        Touch::at(nominal, normal, place.into())
    }
}
