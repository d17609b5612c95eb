//! Deviations and corrections, for programs as they are here, for people by [`text`].

mod text;

use std::collections::BTreeMap;

use leadscrew_nc::coordinates::{Axis, Coordinates};
use leadscrew_process::deviations::{
    Chain, DeviationError, DriveErrors, Loaded, Machine, Map, MapPoint, SettingVector,
};
use nalgebra::Vector3;
use serde::Serialize;

/// The report.
#[derive(Serialize)]
pub(super) struct Report {
    schema: &'static str,
    machine: String,
    origin: String,
    /// `included` or `elsewhere`.
    drive_errors: &'static str,
    tool_mm: [f64; 3],
    /// What indicators told, by unit.
    indicators: Vec<Indicators>,
    /// The place that is asked for; null without one.
    at: Option<Place>,
    /// What each unit adds there.
    units: Vec<UnitRow>,
    /// Ends and steps of the grid.
    volume: BTreeMap<Axis, [f64; 2]>,
    places: usize,
    /// The largest over the grid, and where.
    largest: Vec<Largest>,
    /// Every place of the grid, where asked for.
    map: Vec<Place>,
    /// Largest error of the table of corrections between its nodes, um; null where none is written.
    corrections_error_um: Option<f64>,
}

#[derive(Serialize)]
struct Indicators {
    unit: String,
    /// Parameters that were found, with their 1σ in um or urad; null where it is unknown.
    sigma: BTreeMap<&'static str, Option<f64>>,
    /// Null where there are no more indicators than unknowns.
    largest_residual_um: Option<f64>,
}

#[derive(Serialize)]
struct Place {
    machine: BTreeMap<Axis, f64>,
    /// Δ = tool less workpiece.
    deviation: Vector,
    /// K, mm and degrees.
    correction: BTreeMap<Axis, f64>,
    /// Δ with K in force.
    left: Vector,
}

/// A setting vector.
#[derive(Serialize)]
struct Vector {
    um: [f64; 3],
    urad: [f64; 3],
}

#[derive(Serialize)]
struct UnitRow {
    unit: String,
    chain: &'static str,
    /// ω in the unit's own frame.
    setting: Vector,
    /// Its part of Δ, sign of the chain included.
    part: Vector,
}

#[derive(Serialize)]
struct Largest {
    what: &'static str,
    unit: &'static str,
    value: f64,
    at: BTreeMap<Axis, f64>,
}

impl Report {
    pub fn new(
        loaded: &Loaded,
        map: &Map,
        point: Option<MapPoint>,
        whole: bool,
        left_mm: Option<f64>,
    ) -> Result<Self, DeviationError> {
        let machine = &loaded.machine;
        let units = match &point {
            Some(point) => units(machine, &point.at)?,
            None => Vec::new(),
        };
        let ends = |places: &[f64]| [places[0], places[places.len() - 1]];
        let mapped = if whole { &map.points[..] } else { &[] };
        Ok(Self {
            schema: "leadscrew/deviations/1",
            machine: machine.name.clone(),
            origin: machine.origin.clone(),
            drive_errors: match machine.drive_errors {
                DriveErrors::Included => "included",
                DriveErrors::Elsewhere => "elsewhere",
            },
            tool_mm: machine.tool_mm.into(),
            indicators: indicators(loaded),
            at: point.as_ref().map(|point| place(machine, point)),
            units,
            volume: map
                .over
                .iter()
                .map(|one| (one.axis, ends(&one.places)))
                .collect(),
            places: map.points.len(),
            largest: largest(machine, map),
            map: mapped.iter().map(|point| place(machine, point)).collect(),
            corrections_error_um: left_mm.map(|mm| 1e3 * mm),
        })
    }
}

impl Vector {
    fn of(vector: &SettingVector) -> Self {
        let scaled = |v: Vector3<f64>, scale: f64| [v.x, v.y, v.z].map(|one| one * scale);
        Self {
            um: scaled(vector.shift, 1e3),
            urad: scaled(vector.turn, 1e6),
        }
    }
}

fn units(machine: &Machine, at: &Coordinates) -> Result<Vec<UnitRow>, DeviationError> {
    let parts = machine.parts(at)?;
    let row = |part: &leadscrew_process::deviations::Part<'_>| UnitRow {
        unit: part.unit.name.clone(),
        chain: match part.chain {
            Chain::Workpiece => "workpiece",
            Chain::Tool => "tool",
        },
        setting: Vector::of(&part.omega),
        part: Vector::of(&(part.reduced() * part.chain.sign())),
    };
    Ok(parts.iter().map(row).collect())
}

fn indicators(loaded: &Loaded) -> Vec<Indicators> {
    let one = |(unit, measured): &(String, leadscrew_process::deviations::Measured)| {
        let sigma = measured.components.iter().enumerate().map(|(index, one)| {
            let scale = if one.is_turn() { 1e6 } else { 1e3 };
            let sigma = measured.sigma.as_ref().map(|sigma| sigma[index] * scale);
            (one.key(), sigma)
        });
        let residuals = measured.residuals_mm.iter().flatten();
        Indicators {
            unit: unit.clone(),
            sigma: sigma.collect(),
            largest_residual_um: measured
                .is_checked()
                .then(|| residuals.fold(0.0, |most, mm| f64::max(most, 1e3 * mm.abs()))),
        }
    };
    loaded.measured.iter().map(one).collect()
}

fn at(machine: &Machine, at: &Coordinates) -> BTreeMap<Axis, f64> {
    let axes = machine.axes().into_iter();
    axes.map(|(axis, _)| (axis, at[axis])).collect()
}

fn place(machine: &Machine, point: &MapPoint) -> Place {
    let corrected = machine.corrected().into_iter();
    Place {
        machine: at(machine, &point.at),
        deviation: Vector::of(&point.delta),
        correction: corrected.map(|axis| (axis, point.k[axis])).collect(),
        left: Vector::of(&point.left),
    }
}

fn largest(machine: &Machine, map: &Map) -> Vec<Largest> {
    let one = |what, unit, scale: f64, of: &dyn Fn(&MapPoint) -> f64| {
        let found = map.extreme(of);
        Largest {
            what,
            unit,
            value: found.value * scale,
            at: at(machine, &found.at),
        }
    };
    vec![
        one("Δx", "um", 1e3, &|point| point.delta.shift.x),
        one("Δy", "um", 1e3, &|point| point.delta.shift.y),
        one("Δz", "um", 1e3, &|point| point.delta.shift.z),
        one("|Δ|", "um", 1e3, &|point| point.delta.shift.norm()),
        one("λ", "urad", 1e6, &|point| point.delta.turn.x),
        one("β", "urad", 1e6, &|point| point.delta.turn.y),
        one("γ", "urad", 1e6, &|point| point.delta.turn.z),
        one("|Δ| left by K", "um", 1e3, &|point| {
            point.left.shift.norm()
        }),
    ]
}
