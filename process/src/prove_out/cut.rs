//! What was cut: true paths of the tools in the part, and how far a place lies out of the material that they left.

use nalgebra::Vector3;

use super::part::{BORE_MM, Feature};

/// Where a tool cut, in the coordinates of the part.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cut {
    /// The cutting point.
    pub point: Vector3<f64>,
    /// The direction of the spindle: the flank of a mill lies along it, however the part is turned.
    pub axis: Vector3<f64>,
}

impl Cut {
    fn towards(&self, other: &Self, part: f64) -> Self {
        Self {
            point: self.point.lerp(&other.point, part),
            axis: self.axis.lerp(&other.axis, part),
        }
    }

    /// The place of the flank at the height `z`.
    fn at_height(&self, z: f64) -> Vector3<f64> {
        self.point + self.axis * ((z - self.point.z) / self.axis.z)
    }
}

/// Tool and true path, feed after feed.
#[derive(Clone, Debug, Default)]
pub(super) struct CutPaths(Vec<(u32, Vec<Cut>)>);

impl CutPaths {
    /// Adds the path of a feed.
    pub fn add(&mut self, tool: u32, path: Vec<Cut>) {
        self.0.push((tool, path));
    }

    /// How far a place of the part lies out of the material of a feature, mm, about square to its surface.
    pub fn clearance(&self, feature: Feature, place: &Vector3<f64>) -> f64 {
        match feature {
            Feature::Front => place.z,
            Feature::Top => place.y - 80.0,
            Feature::Side => -100.0 - place.x,
            Feature::Face => place.z - self.nearest(1, place, [1.0, 1.0, 0.0]).point.z,
            Feature::Bore(_) => {
                let centre = self.nearest(2, place, [1.0, 1.0, 1.0]);
                BORE_MM - (place - centre.point).xy().norm()
            }
            Feature::Shoulder => {
                let cut = self.nearest(3, place, [0.0, 1.0, 0.0]);
                place.x - cut.at_height(place.z).x
            }
        }
    }

    /// Where a tool's true path is nearest to a place, by weights of the coordinates.
    fn nearest(&self, tool: u32, place: &Vector3<f64>, weights: [f64; 3]) -> Cut {
        let weights = Vector3::from(weights);
        let nowhere = Cut {
            point: Vector3::zeros(),
            axis: Vector3::z(),
        };
        let mut found = (f64::INFINITY, nowhere);
        let paths = self.0.iter().filter(|(number, _)| *number == tool);
        for pair in paths.flat_map(|(_, path)| path.windows(2)) {
            let along = (pair[1].point - pair[0].point).component_mul(&weights);
            let way = (place - pair[0].point).component_mul(&weights);
            let length = along.norm_squared();
            let part = if length == 0.0 {
                0.0
            } else {
                (way.dot(&along) / length).clamp(0.0, 1.0)
            };
            let off = (way - along * part).norm_squared();
            if off < found.0 {
                found = (off, pair[0].towards(&pair[1], part));
            }
        }
        found.1
    }
}
