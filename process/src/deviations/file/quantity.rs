//! Numbers of a machine file in the units of shops: µm, µrad and arcsec, and the places where they hold.

use crate::setting_vector::Component;

/// 1 µm in mm, and 1 µrad and 1 arcsec in rad.
pub(super) const MICRO: f64 = 1e-3;
pub(super) const URAD: f64 = 1e-6;
pub(super) const ARCSEC: f64 = std::f64::consts::PI / 648_000.0;
/// Largest shift, mm, and turn, rad, of a unit: beyond, small angles are not small.
const LARGEST_MM: f64 = 10.0;
const LARGEST_RAD: f64 = 0.01;

/// The places of a list, in the unit that the motion has.
pub(super) fn places(
    at_mm: &Option<Vec<f64>>,
    at_deg: &Option<Vec<f64>>,
    rotary: bool,
) -> Result<Vec<f64>, String> {
    match (at_mm, at_deg, rotary) {
        (Some(places), None, false) | (None, Some(places), true) => Ok(places.clone()),
        (_, _, false) => Err("a linear unit needs its places as `at_mm`".to_owned()),
        (_, _, true) => Err("a rotary unit needs its places as `at_deg`".to_owned()),
    }
}

/// The one value in µm, µrad and arcsec that is given, in mm or rad.
pub(super) fn one_of(
    what: &str,
    component: Component,
    [um, urad, arcsec]: [Option<f64>; 3],
) -> Result<Option<f64>, String> {
    let given = [
        ("um", um, MICRO),
        ("urad", urad, URAD),
        ("arcsec", arcsec, ARCSEC),
    ];
    let mut given = given
        .into_iter()
        .filter_map(|(unit, value, scale)| Some((unit, value?, scale)));
    let Some((unit, value, scale)) = given.next() else {
        return Ok(None);
    };
    if given.next().is_some() {
        return Err(format!(
            "the {what} of {component} is given in two units: choose one"
        ));
    }
    if (unit == "um") == component.is_turn() {
        let expected = if component.is_turn() {
            "urad or arcsec"
        } else {
            "um"
        };
        return Err(format!(
            "the {what} of {component} is in {unit}: {expected} is expected"
        ));
    }
    checked(what, component, value, scale).map(Some)
}

/// The number in mm or rad, within what a unit may deviate by.
pub(super) fn checked(
    what: &str,
    component: Component,
    value: f64,
    unit: f64,
) -> Result<f64, String> {
    let largest = if component.is_turn() {
        LARGEST_RAD
    } else {
        LARGEST_MM
    };
    if (value * unit).abs() <= largest {
        return Ok(value * unit);
    }
    let most = largest / unit;
    Err(format!(
        "{what} of {component} is {value}: -{most:.0} to {most:.0} is allowed"
    ))
}
