//! From touches to corrections: where the part lies, what each tool cuts beside its place.

use std::collections::BTreeMap;

use leadscrew_nc::coordinates::{Axis, Coordinates};
use leadscrew_nc::terms::Terms;
use leadscrew_nc::terms::grid::GridAxis;
use leadscrew_nc::terms::wear::Wear;
use leadscrew_nc::terms::workpiece::Workpiece;
use nalgebra::{DMatrix, Vector3};

use super::figures::nominal_bore;
use super::gauge::Reading;
use super::part::{Feature, TOOLS, control_point, tool, work_offset};
use super::{Plant, ProveOutError};
use crate::deviations::Machine;
use crate::metrology::setting;
use crate::metrology::{Settings, Touch, circle};
use crate::setting_vector::SettingVector;

/// Where the program works, with room for what the part lies off, machine coordinates, mm; and the distance between the nodes of
/// the table of corrections there.
const REGION_MM: [(Axis, f64, f64); 3] = [
    (Axis::X, -120.0, 120.0),
    (Axis::Y, 110.0, 290.0),
    (Axis::Z, -190.0, -80.0),
];
const APART_MM: f64 = 10.0;

/// What the touches say.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// Where the part lies.
    pub setting: SettingVector,
    /// Covariance of the setting (a, b, c, λ, β, γ), mm and rad.
    pub setting_covariance: DMatrix<f64>,
    /// The tools by number.
    pub tools: BTreeMap<u32, Beside>,
}

/// By how much a tool cuts beside the place where the machine brings it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Beside {
    /// 0 along the axes that none of its features looks along, mm.
    pub mm: [f64; 3],
    /// 1σ along each of the others, mm.
    pub sigma_mm: f64,
}

/// Where the part lies, from the datum faces.
///
/// # Errors
/// Touches that do not tell it.
pub fn setting(
    datum: &[Reading],
    certified: &Machine,
    sigma_mm: f64,
) -> Result<(SettingVector, DMatrix<f64>), ProveOutError> {
    let touches = datum.iter().map(|one| one.touch(Some(certified), sigma_mm));
    let touches: Vec<Touch> = touches.collect::<Result<_, _>>()?;
    let fitted = setting::fit(&touches, [true; 6], &Settings::default())?;
    Ok((fitted.value, fitted.covariance))
}

/// What each tool cuts beside its place: what is found less where the certified machine brings the program's places.
///
/// # Errors
/// Touches that do not tell it.
pub fn tools(
    cut: &[Reading],
    certified: &Machine,
    sigma_mm: f64,
) -> Result<BTreeMap<u32, Beside>, ProveOutError> {
    let mut tools = BTreeMap::new();
    for tool in &TOOLS {
        let mut seen = Vec::new();
        for feature in Feature::CUT {
            if feature.tool() != Some(tool.number) {
                continue;
            }
            let own = cut.iter().filter(|one| one.feature == feature);
            let own = own.map(|one| one.touch(Some(certified), sigma_mm));
            seen.extend(beside(
                feature,
                &own.collect::<Result<Vec<_>, _>>()?,
                certified,
            )?);
        }
        let count = seen.len().max(1) as f64;
        let mean = seen.iter().sum::<Vector3<f64>>() / count;
        // Two touches to a diameter: a bore's centre has 1σ of σ/√2.
        let each = if tool.number == 2 { 0.5f64.sqrt() } else { 1.0 };
        let beside = Beside {
            mm: mean.into(),
            sigma_mm: each * sigma_mm / count.sqrt(),
        };
        tools.insert(tool.number, beside);
    }
    Ok(tools)
}

/// By how much a feature lies beside where the certified machine brings the tool, seen at each of its places.
fn beside(
    feature: Feature,
    touches: &[Touch],
    certified: &Machine,
) -> Result<Vec<Vector3<f64>>, ProveOutError> {
    let Some(tool) = feature.tool().and_then(tool) else {
        return Ok(Vec::new());
    };
    let brought = |place: Vector3<f64>| -> Result<Vector3<f64>, ProveOutError> {
        let edge = Vector3::from(tool.edge_mm);
        let at = control_point((place - edge).into(), tool.length_mm);
        let tip = Vector3::new(0.0, 0.0, -tool.length_mm) + edge;
        Ok(certified.clone().with_tool(tip).deviation(&at)?.shift)
    };
    if let Feature::Bore(number) = feature {
        let nominal = nominal_bore(number);
        let centre = circle::fit(&nominal, touches, &Settings::default())?;
        let off = Vector3::from(centre.value.centre_mm) - brought(nominal.centre_mm.into())?;
        return Ok(vec![Vector3::new(off.x, off.y, 0.0)]);
    }
    let off = |touch: &Touch| {
        let normal = Vector3::from(touch.normal);
        let nominal = Vector3::from(touch.nominal);
        let along = touch.along_normal_mm() - brought(nominal)?.dot(&normal);
        Ok(normal * along)
    };
    touches.iter().map(off).collect()
}

/// The terms of correction; `plant` turns the sign of one.
///
/// # Errors
/// A table that cannot be made.
pub fn terms(found: &Found, certified: &Machine, plant: Plant) -> Result<Terms, ProveOutError> {
    let turned = |one: Plant| if plant == one { -1.0 } else { 1.0 };
    let rest = Coordinates::ZERO;
    let map = certified.clone().scaled(turned(Plant::MapSign));
    let grid = map
        .corrections(&rest, region(), 1e-3)
        .map_err(ProveOutError::Machine)?;
    let sign = turned(Plant::SettingSign);
    let workpiece = Workpiece::new(
        "setting of the workpiece",
        work_offset(),
        (found.setting.shift * sign).into(),
        (found.setting.turn * sign).into(),
    );
    let sign = turned(Plant::WearSign);
    let worn = found.tools.iter().map(|(tool, beside)| {
        let [x, y, z] = beside.mm;
        // K = change of the offset: it takes back what the tool cuts beside.
        (*tool, Coordinates::xyz(-sign * x, -sign * y, -sign * z))
    });
    let wear = Wear::new("wear and growth of the tools", worn.collect());
    Ok(Terms::none().with(grid).with(workpiece).with(wear))
}

fn region() -> Vec<GridAxis> {
    let axis = |(axis, low, high): (Axis, f64, f64)| {
        let count = ((high - low) / APART_MM).round() as usize;
        GridAxis {
            axis,
            places: (0..=count).map(|i| low + APART_MM * i as f64).collect(),
        }
    };
    REGION_MM.map(axis).to_vec()
}
