//! Probing the part on the machine: readings, and the places they mean.

use leadscrew_nc::coordinates::{Axis, Coordinates};
use nalgebra::{Point3, Vector3};

use super::ProveOutError;
use super::part::{Feature, control_point, tool, work_offset};
use super::world::{PROBE_MM, World};
use crate::deviations::Machine;
use crate::metrology::Touch;
use crate::setting_vector::SettingVector;

/// How far before the surface an approach begins, mm.
const BEFORE_MM: f64 = 3.0;

/// The axis with its probe.
pub trait Touching {
    /// Probes from `from_mm` towards a surface that is met at `contact_mm`, and gives the latched coordinate, mm.
    ///
    /// # Errors
    /// Why the axis did not touch.
    fn touch(&mut self, contact_mm: f64, from_mm: f64) -> Result<f64, String>;

    /// 1σ of the latched coordinate, mm.
    fn sigma_mm(&self) -> f64;
}

/// A touch as the machine has it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// The feature.
    pub feature: Feature,
    /// The planned place, allowance included, in the coordinates of the part.
    pub nominal: [f64; 3],
    /// Out of the material.
    pub normal: [f64; 3],
    /// Where the machine says that it stood, its coordinates.
    pub at: Coordinates,
}

/// Touches all planned places of these features; `setting` says where the part lies, as far as that is known.
///
/// # Errors
/// A touch that does not come.
pub fn probe(
    world: &World,
    features: &[Feature],
    allowance: bool,
    setting: &SettingVector,
    touching: &mut dyn Touching,
) -> Result<Vec<Reading>, ProveOutError> {
    let mut readings = Vec::new();
    for (feature, nominal, normal) in planned(features, allowance) {
        let aim = control_point(setting.moved(nominal), PROBE_MM);
        let axis = [Axis::X, Axis::Y, Axis::Z][Vector3::from(normal).iamax()];
        let out = Vector3::from(normal)[axis.index()];
        let contact = world.contact(feature, &aim, axis)?;
        let from = contact + BEFORE_MM * out.signum();
        let latched = touching
            .touch(contact, from)
            .map_err(ProveOutError::Touching)?;
        readings.push(Reading {
            feature,
            nominal,
            normal,
            at: aim.with(axis, latched),
        });
    }
    Ok(readings)
}

/// Planned touches of features: place and normal.
pub fn planned(
    features: &[Feature],
    allowance: bool,
) -> impl Iterator<Item = (Feature, [f64; 3], [f64; 3])> + '_ {
    features.iter().flat_map(move |&feature| {
        let left = feature
            .tool()
            .and_then(tool)
            .filter(|_| allowance)
            .map_or([0.0; 3], |tool| tool.allowance_mm);
        let touches = feature.touches().into_iter();
        touches.map(move |(place, normal)| {
            let place = Vector3::from(place) + Vector3::from(left);
            (feature, place.into(), normal)
        })
    })
}

impl Reading {
    /// The touch in the coordinates of the part as it was planned to lie. A machine that is told its own deviations takes them
    /// out of its reading; one that is not sees only what is off beside them: the tool that cut here stood as far off as the probe.
    ///
    /// # Errors
    /// A place beyond the ends of the machine.
    pub fn touch(
        &self,
        certified: Option<&Machine>,
        sigma_mm: f64,
    ) -> Result<Touch, ProveOutError> {
        let offset = Vector3::from(work_offset()) + Vector3::new(0.0, 0.0, PROBE_MM);
        let at = Vector3::new(self.at[Axis::X], self.at[Axis::Y], self.at[Axis::Z]);
        let delta = match certified {
            Some(machine) => machine.deviation(&self.at)?.shift,
            None => Vector3::zeros(),
        };
        let place = at - offset + delta;
        Ok(Touch::at(self.nominal, self.normal, place.into()).with_sigma(sigma_mm))
    }
}

/// The same touch in the coordinates of a part that lies displaced.
#[must_use]
pub fn in_part(touch: &Touch, setting: &SettingVector) -> Touch {
    let place = setting.to_isometry().inverse() * Point3::from(touch.measured);
    Touch {
        measured: place.coords.into(),
        ..*touch
    }
}
