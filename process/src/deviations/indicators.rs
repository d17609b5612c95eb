//! Setting vectors from indicators: P4's Figure 6.
//!
//! Three indicators on the setting base of a table give b, λ and γ, two on its guiding base a and β; c is the drive's own
//! positioning error and comes from ISO 230-2. Here an indicator stands anywhere and looks anywhere: its reading is
//! d · (t + θ × r), and a setting vector is what fits all readings at a coordinate best. One that looks along the drive (a laser)
//! gives the drive's own error too, freed of the turns between its line and the frame.

use nalgebra::{DMatrix, DVector, UnitVector3, Vector3};

use super::law::Table;
use super::unit::Motion;
use crate::setting_vector::{Component, SettingVector};

/// An indicator.
#[derive(Clone, Debug, PartialEq)]
pub struct Indicator {
    /// What messages and tables call it.
    pub name: String,
    /// Place of its tip in the unit's frame, mm; for one that stands on the machine, with the coordinate at 0.
    pub place_mm: Vector3<f64>,
    /// The reading grows as the unit moves this way.
    pub direction: UnitVector3<f64>,
}

/// What indicators stand on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stand {
    /// The unit: they ride along a straightedge at rest.
    Unit,
    /// The machine: they touch a face of the unit, which slides under them.
    Machine,
}

/// Readings at the coordinates of a unit.
#[derive(Clone, Debug, PartialEq)]
pub struct Readings {
    /// The indicators.
    pub indicators: Vec<Indicator>,
    /// What they stand on.
    pub stand: Stand,
    /// Coordinates of the unit, mm or degrees, rising.
    pub places: Vec<f64>,
    /// For each coordinate the reading of each indicator, mm.
    pub readings_mm: Vec<Vec<f64>>,
    /// 1σ of a reading where it is known, mm; else it is told from the residuals.
    pub sigma_mm: Option<f64>,
}

/// What the readings say.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// The setting vectors, 0 in what was not looked at.
    pub table: Table,
    /// The parameters that were found.
    pub components: Vec<Component>,
    /// For each coordinate the reading of each indicator less what the setting vector gives, mm.
    pub residuals_mm: Vec<Vec<f64>>,
    /// 1σ of each of `components`, the worst over the coordinates, mm or rad; none where neither σ nor spare readings tell it.
    pub sigma: Option<Vec<f64>>,
}

impl Measured {
    /// True where more indicators than unknowns check each other.
    #[must_use]
    pub fn is_checked(&self) -> bool {
        let readings = self.residuals_mm.first().map_or(0, Vec::len);
        readings > self.components.len()
    }
}

impl Readings {
    /// The setting vectors that fit best, least squares at each coordinate.
    ///
    /// # Errors
    /// What is wrong with the numbers, or which parameters these places of indicators cannot tell apart, in words.
    pub fn solve(&self, motion: &Motion) -> Result<Measured, String> {
        self.check(motion)?;
        let size = self.size();
        let components = self.components(motion, size);
        let mut values = Vec::with_capacity(self.places.len());
        let mut residuals_mm = Vec::with_capacity(self.places.len());
        let mut spread = vec![0.0_f64; components.len()];
        for (&place, readings) in self.places.iter().zip(&self.readings_mm) {
            let geometry = self.geometry(motion, place, &components, size);
            let fit = Fit::new(geometry, readings, &components, size)?;
            let found = components.iter().zip(&fit.values);
            values.push(found.fold(SettingVector::ZERO, |all, (&one, &value)| {
                all.with(one, value)
            }));
            residuals_mm.push(fit.residuals);
            for (worst, one) in spread.iter_mut().zip(fit.spread) {
                *worst = worst.max(one);
            }
        }
        let sigma_mm = self.reading_sigma(&residuals_mm, components.len());
        let sigma = sigma_mm.map(|sigma| spread.iter().map(|one| one * sigma).collect());
        Ok(Measured {
            table: Table::new(self.places.clone(), values, motion.is_rotary())?,
            components,
            residuals_mm,
            sigma,
        })
    }

    fn check(&self, motion: &Motion) -> Result<(), String> {
        let count = self.indicators.len();
        if self.readings_mm.len() != self.places.len() {
            return Err(format!(
                "{} rows of readings for {} coordinates: one for each is needed",
                self.readings_mm.len(),
                self.places.len()
            ));
        }
        let wrong = |row: &&Vec<f64>| row.len() != count || row.iter().any(|v| !v.is_finite());
        if let Some(row) = self.readings_mm.iter().position(|row| wrong(&row)) {
            return Err(format!(
                "row {} of the readings: a finite reading of each of the {count} indicators is needed",
                row + 1
            ));
        }
        if self.stand == Stand::Unit && motion.is_rotary() {
            return Err("indicators on a turning unit: let them stand on the machine".to_owned());
        }
        Ok(())
    }

    /// Length that makes turns comparable with shifts, mm.
    fn size(&self) -> f64 {
        let places = self.indicators.iter().map(|one| one.place_mm.norm());
        places.fold(1.0, f64::max)
    }

    /// All parameters, but for the drive's own error where no indicator sees it.
    fn components(&self, motion: &Motion, size: f64) -> Vec<Component> {
        let drive = motion.drive_component();
        let at = self.places.first().copied().unwrap_or_default();
        let seen = self.geometry(motion, at, &[drive], size).amax() > 1e-9;
        let mut components = Component::ALL.to_vec();
        components.retain(|&one| one != drive || seen);
        components
    }

    /// Readings for 1 mm of each shift, and for turns that move what lies `size` away by 1 mm.
    fn geometry(
        &self,
        motion: &Motion,
        place: f64,
        components: &[Component],
        size: f64,
    ) -> DMatrix<f64> {
        DMatrix::from_fn(self.indicators.len(), components.len(), |row, column| {
            let Indicator {
                place_mm,
                direction,
                ..
            } = &self.indicators[row];
            let slid = match (self.stand, motion) {
                (Stand::Machine, Motion::Linear(along)) => along.into_inner() * place,
                _ => Vector3::zeros(),
            };
            let component = components[column];
            let scale = if component.is_turn() { 1.0 / size } else { 1.0 };
            let unit = SettingVector::ZERO.with(component, scale);
            direction.dot(&unit.reduced(&(place_mm - slid)).shift)
        })
    }

    fn reading_sigma(&self, residuals_mm: &[Vec<f64>], unknowns: usize) -> Option<f64> {
        let spare = residuals_mm.len() * (self.indicators.len() - unknowns);
        let sum: f64 = residuals_mm.iter().flatten().map(|one| one * one).sum();
        let told = (spare > 0).then(|| (sum / spare as f64).sqrt());
        self.sigma_mm.or(told)
    }
}

/// A least-squares fit at one coordinate.
struct Fit {
    values: Vec<f64>,
    residuals: Vec<f64>,
    /// 1σ of each value for readings of 1σ = 1 mm.
    spread: Vec<f64>,
}

impl Fit {
    fn new(
        geometry: DMatrix<f64>,
        readings: &[f64],
        components: &[Component],
        size: f64,
    ) -> Result<Self, String> {
        let unscaled = |values: &[f64]| -> Vec<f64> {
            let scaled = values.iter().zip(components);
            scaled
                .map(|(value, one)| if one.is_turn() { value / size } else { *value })
                .collect()
        };
        if geometry.nrows() < components.len() {
            return Err(format!(
                "{} indicators for {}: {} are needed",
                geometry.nrows(),
                list(components.iter().copied()),
                components.len()
            ));
        }
        let target = DVector::from_column_slice(readings);
        let svd = geometry.clone().svd(true, true);
        let (least, value) = svd.singular_values.argmin();
        let v = svd.v_t.as_ref().ok_or("the fit has no solution")?;
        if value < 1e-6 * svd.singular_values.max() {
            let mixed = components.iter().enumerate();
            let mixed = mixed.filter(|(column, _)| v[(least, *column)].abs() > 0.1);
            return Err(format!(
                "from these places of the indicators {} cannot be told: move one of them",
                list(mixed.map(|(_, &one)| one))
            ));
        }
        let values = svd.solve(&target, 0.0)?;
        let residuals = target - &geometry * &values;
        let spread: Vec<f64> = (0..components.len())
            .map(|column| {
                let parts = (0..svd.singular_values.len())
                    .map(|row| (v[(row, column)] / svd.singular_values[row]).powi(2));
                parts.sum::<f64>().sqrt()
            })
            .collect();
        Ok(Self {
            values: unscaled(values.as_slice()),
            residuals: residuals.as_slice().to_vec(),
            spread: unscaled(&spread),
        })
    }
}

fn list(components: impl Iterator<Item = Component>) -> String {
    let letters: Vec<_> = components.map(Component::letter).collect();
    letters.join(", ")
}
