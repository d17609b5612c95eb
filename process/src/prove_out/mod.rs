//! Proving out a program: machine a part, probe it where it stands, compute, correct the program, machine again (P4's three modules
//! in a circle), on a simulated machine of which the truth is known.
//!
//! What is wrong and not known to the program: where the part lies, the wear of the tools, what heat has moved. Known as well as it
//! was measured: the machine's deviations. They have to be known from elsewhere. A machine that probes the part where it cut it
//! stands as far off when it probes as when it cut, and reads what was programmed: its own deviations cancel. So readings are
//! corrected by the certified map before anything is computed from them, and K = −Δ of the map is a term of its own.
//!
//! [`World`] is the truth, by full rotations: the `part`, the `amounts` that are wrong, what was `cut`. [`gauge`] turns touches into
//! places, `compute` places into terms, `correct` puts these into the program, `figures` tells what came of it.

mod amounts;
mod compute;
mod correct;
mod cut;
mod draws;
pub mod figures;
pub mod gauge;
mod part;
mod program;
mod world;

use std::collections::BTreeMap;
use std::fmt;

pub use amounts::Amounts;
pub use compute::{Beside, Found};
pub use draws::Draws;
pub use gauge::Touching;
use leadscrew_nc::coordinates::Coordinates;
use nalgebra::DMatrix;
pub use part::{Feature, PROGRAM, TOOLS};
pub use program::{Feed, feeds};
pub use world::World;

use crate::deviations::{DeviationError, Machine};
use crate::metrology::{MetrologyError, Touch};
use crate::setting_vector::SettingVector;
use correct::corrected;
use figures::{Figure, figures, sensitivity};
use gauge::{Reading, in_part, planned, probe};

/// Errors of a figure stay within so many 1σ.
pub const SIGMAS: f64 = 4.0;

/// Why a prove-out failed.
#[derive(Clone, Debug, PartialEq)]
pub enum ProveOutError {
    /// The machine.
    Machine(String),
    /// A block that the simulated control does not know.
    Program {
        /// Its line, from 1.
        line: usize,
        /// What is the matter.
        reason: String,
    },
    /// A tool that is not in the magazine.
    Tool(u32),
    /// A surface that the probe does not meet.
    NoContact(Feature),
    /// The axis did not touch.
    Touching(String),
    /// A deviation that is not known.
    Deviation(DeviationError),
    /// Touches that do not tell a figure.
    Metrology(MetrologyError),
    /// The program cannot be corrected.
    Correction(String),
}

impl fmt::Display for ProveOutError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Machine(reason) => write!(f, "the machine: {reason}"),
            Self::Program { line, reason } => write!(f, "the program, line {line}: {reason}"),
            Self::Tool(number) => write!(f, "there is no tool {number}"),
            Self::NoContact(feature) => write!(f, "{feature:?}: the probe meets no surface"),
            Self::Touching(reason) => write!(f, "the axis did not touch: {reason}"),
            Self::Deviation(error) => error.fmt(f),
            Self::Metrology(error) => error.fmt(f),
            Self::Correction(reason) => write!(f, "the correction: {reason}"),
        }
    }
}

impl std::error::Error for ProveOutError {}

impl From<DeviationError> for ProveOutError {
    fn from(error: DeviationError) -> Self {
        Self::Deviation(error)
    }
}

impl From<MetrologyError> for ProveOutError {
    fn from(error: MetrologyError) -> Self {
        Self::Metrology(error)
    }
}

/// A mistake to make on purpose: a test that it cannot fail shows nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Plant {
    /// None.
    #[default]
    Nothing,
    /// The sign of the machine's map.
    MapSign,
    /// The sign of the part's setting.
    SettingSign,
    /// The sign of the tools' wear.
    WearSign,
}

/// A figure of the part before and after the correction, mm or rad.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// The feature.
    pub feature: Feature,
    /// What of it.
    pub what: &'static str,
    /// True for an angle, rad.
    pub is_angle: bool,
    /// In truth, after the first pass.
    pub before: f64,
    /// The same as the probe has it, readings corrected by the certified map.
    pub probed_before: f64,
    /// The same as the machine reads where it cut, told neither its own deviations nor where the part lies.
    pub blind_before: f64,
    /// In truth, after the corrected program.
    pub after: f64,
    /// The same as the probe has it.
    pub probed_after: f64,
    /// Bound of `after`: [`SIGMAS`] times 1σ of setting, tool offsets and map.
    pub bound: f64,
    /// Bound of `probed_after`: the touches that look at it again besides.
    pub probed_bound: f64,
}

/// What came of it.
#[derive(Clone, Debug, PartialEq)]
pub struct ProveOut {
    /// The figures.
    pub rows: Vec<Row>,
    /// What was computed.
    pub found: Found,
    /// What it should have found: where the part seems to lie to the probe.
    pub setting_seen: SettingVector,
    /// The same of the tools, by number, mm.
    pub tools_seen: BTreeMap<u32, [f64; 3]>,
    /// True places of the touches after the first pass, in the coordinates of the part.
    pub true_before: Vec<(Feature, Touch)>,
    /// The same after the corrected program.
    pub true_after: Vec<(Feature, Touch)>,
    /// The program that was corrected.
    pub corrected: String,
    /// Touches that were made.
    pub touches: usize,
}

impl ProveOut {
    /// True where every figure fell below its bound, in truth and as probed.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.rows
            .iter()
            .all(|row| row.after.abs() <= row.bound && row.probed_after.abs() <= row.probed_bound)
    }
}

/// Machines, probes, computes, corrects, machines again and measures.
///
/// # Errors
/// [`ProveOutError`].
pub fn prove_out(
    amounts: &Amounts,
    plant: Plant,
    seed: u64,
    touching: &mut dyn Touching,
) -> Result<ProveOut, ProveOutError> {
    let (mut world, certified) = World::new(amounts, seed)?;
    let map_mm = map_sigma_mm(&certified, amounts)?;
    let sigma_mm = touching.sigma_mm().hypot(map_mm);

    world.cut(&feeds(PROGRAM)?, true)?;
    let true_before = true_touches(&world, true);
    let before = figures(&true_before)?;
    let datum = probe(
        &world,
        &Feature::DATUM,
        true,
        &SettingVector::ZERO,
        touching,
    )?;
    let (setting, setting_covariance) = compute::setting(&datum, &certified, sigma_mm)?;
    let first = probe(&world, &Feature::CUT, true, &setting, touching)?;
    let tools = compute::tools(&first, &certified, sigma_mm)?;
    let found = Found {
        setting,
        setting_covariance,
        tools,
    };

    let terms = compute::terms(&found, &certified, plant)?;
    let corrected = corrected(PROGRAM, terms)?;
    world.cut(&feeds(&corrected)?, false)?;
    let true_after = true_touches(&world, false);
    let after = figures(&true_after)?;
    let second = probe(&world, &Feature::CUT, false, &setting, touching)?;

    let probed = |readings: &[Reading], map: Option<&Machine>| {
        let touch = |one: &Reading| {
            let touch = one.touch(map, touching.sigma_mm())?;
            Ok((one.feature, in_part(&touch, &found.setting)))
        };
        let touches: Result<Vec<_>, ProveOutError> = readings.iter().map(touch).collect();
        figures(&touches?)
    };
    let unaware = first.iter().map(|one| {
        let touch = one.touch(None, touching.sigma_mm())?;
        Ok::<_, ProveOutError>((one.feature, touch))
    });
    let blind = figures(&unaware.collect::<Result<Vec<_>, _>>()?)?;
    let (probed_before, probed_after) = (
        probed(&first, Some(&certified))?,
        probed(&second, Some(&certified))?,
    );
    let sigmas = sigmas(&found, map_mm, &probed_after, touching.sigma_mm())?;
    let rows = before.iter().enumerate().map(|(i, figure)| Row {
        feature: figure.feature,
        what: figure.what,
        is_angle: figure.is_angle,
        before: figure.value,
        probed_before: probed_before[i].value,
        blind_before: blind[i].value,
        after: after[i].value,
        probed_after: probed_after[i].value,
        bound: SIGMAS * sigmas[i],
        probed_bound: SIGMAS * sigmas[i].hypot(probed_after[i].sigma),
    });
    Ok(ProveOut {
        rows: rows.collect(),
        setting_seen: world.setting_seen(),
        tools_seen: TOOLS
            .iter()
            .filter_map(|tool| Some((tool.number, world.tool_seen(tool.number)?)))
            .collect(),
        true_before,
        true_after,
        corrected,
        touches: datum.len() + first.len() + second.len(),
        found: found.clone(),
    })
}

fn true_touches(world: &World, allowance: bool) -> Vec<(Feature, Touch)> {
    let touches = planned(&Feature::CUT, allowance);
    let touch = |(feature, place, normal)| (feature, world.true_touch(feature, place, normal));
    touches.map(touch).collect()
}

/// 1σ along an axis of the certified map in the middle of the working volume, mm.
fn map_sigma_mm(certified: &Machine, amounts: &Amounts) -> Result<f64, ProveOutError> {
    let parts = certified.parts(&Coordinates::xyz(0.0, 200.0, -150.0))?;
    let measured = parts.iter().filter(|part| {
        let axis = part.unit.axis();
        axis.is_some_and(|axis| !axis.is_rotary())
    });
    let variance: f64 = measured
        .map(|part| amounts.map_mm.powi(2) + (amounts.map_rad * part.r.norm()).powi(2))
        .sum();
    Ok(variance.sqrt())
}

/// 1σ of each figure of the part after the correction: that of the setting at the feature, of the tool's offset, and of the map,
/// once at the faces that the setting comes from and once at the feature.
fn sigmas(
    found: &Found,
    map_mm: f64,
    probed: &[Figure],
    touch_mm: f64,
) -> Result<Vec<f64>, ProveOutError> {
    let rows: DMatrix<f64> = sensitivity()?;
    let of_setting = &rows * &found.setting_covariance * rows.transpose();
    let one = |(i, figure): (usize, &Figure)| {
        let shift: f64 = (0..3)
            .map(|axis| rows[(i, axis)].powi(2))
            .sum::<f64>()
            .sqrt();
        let tool = figure.feature.tool();
        let tool = tool.and_then(|tool| found.tools.get(&tool));
        let tool = shift * tool.map_or(0.0, |beside| beside.sigma_mm);
        // The map's error from touch to touch, as the probe's own, and what it has in common at all of them.
        let map = (figure.sigma * map_mm / touch_mm).hypot(shift * map_mm);
        (of_setting[(i, i)] + tool.powi(2) + map.powi(2)).sqrt()
    };
    Ok(probed.iter().enumerate().map(one).collect())
}
