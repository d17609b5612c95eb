//! How much is wrong with the simulated machine, and the certificate that knows it as well as it was measured.

use super::ProveOutError;
use super::draws::Draws;
use crate::deviations::{Machine, SettingVector, Table};

/// How much is wrong, and how well the machine is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Amounts {
    /// The machine's deviations, 1 for those of its file.
    pub machine: f64,
    /// Largest shift of the part from where it was planned, mm.
    pub setting_mm: f64,
    /// Largest turn of it about each axis, rad.
    pub setting_rad: f64,
    /// Largest wear of a tool, mm.
    pub wear_mm: f64,
    /// Largest growth of spindle and column by heat while cutting, mm; while probing half of it is left.
    pub growth_mm: f64,
    /// 1σ of the certified deviations: shifts of a unit, mm, at each place of its table.
    pub map_mm: f64,
    /// The same of its turns, rad.
    pub map_rad: f64,
}

impl Default for Amounts {
    fn default() -> Self {
        Self {
            machine: 1.0,
            setting_mm: 0.15,
            setting_rad: 4e-4,
            wear_mm: 0.02,
            growth_mm: 0.012,
            map_mm: 1e-4,
            map_rad: 5e-7,
        }
    }
}

/// The machine as its certificate has it: the truth and what measuring it added.
pub(super) fn certified(
    machine: &Machine,
    amounts: &Amounts,
    draws: &mut Draws,
) -> Result<Machine, ProveOutError> {
    let mut certified = machine.clone();
    let axes = machine.axes();
    for unit in certified.workpiece.iter_mut().chain(&mut certified.tool) {
        let range = unit.axis().and_then(|axis| {
            let found = axes.iter().find(|(known, _)| *known == axis);
            found.map(|(_, range)| *range)
        });
        let (Some((low, high)), false) = (range, unit.motion.is_rotary()) else {
            continue;
        };
        let places: Vec<f64> = (0..=5)
            .map(|i| low + (high - low) * f64::from(i) / 5.0)
            .collect();
        let noise = places.iter().map(|_| {
            let mut of = |sigma: f64| sigma * draws.normal();
            let [s, r] = [amounts.map_mm, amounts.map_rad];
            SettingVector::new([of(s), of(s), of(s), of(r), of(r), of(r)])
        });
        let table = Table::new(places.clone(), noise.collect(), false);
        unit.law.tables.push(table.map_err(ProveOutError::Machine)?);
    }
    Ok(certified)
}
