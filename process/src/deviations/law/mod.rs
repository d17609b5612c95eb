//! A setting vector as it follows the coordinate: a [`table`] or more, linear between their places, and [`function`]s, added up.

mod function;
mod table;

use std::ops::Add;

use crate::setting_vector::{Component, SettingVector};

pub use function::{Function, Wave};
pub use table::Table;

/// How the setting vector of a unit follows its coordinate.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Law {
    /// Tables.
    pub tables: Vec<Table>,
    /// Functions.
    pub functions: Vec<Function>,
}

impl Law {
    /// A unit without deviations.
    pub const NONE: Self = Self {
        tables: Vec::new(),
        functions: Vec::new(),
    };

    /// The law of one table.
    #[must_use]
    pub fn table(table: Table) -> Self {
        Self {
            tables: vec![table],
            functions: Vec::new(),
        }
    }

    /// The setting vector at a place, mm or degrees; beyond the end of a table that of its end.
    #[must_use]
    pub fn at(&self, place: f64) -> SettingVector {
        let tables = self.tables.iter().map(|table| table.at(place));
        let functions = self
            .functions
            .iter()
            .map(|one| SettingVector::ZERO.with(one.component, one.at(place)));
        tables.chain(functions).fold(SettingVector::ZERO, Add::add)
    }

    /// Its mean over a revolution, for a rotary unit: waves of whole parts of a turn leave nothing.
    #[must_use]
    pub fn mean(&self) -> SettingVector {
        let tables = self.tables.iter().map(Table::mean);
        let functions = self
            .functions
            .iter()
            .map(|one| SettingVector::ZERO.with(one.component, one.constant));
        tables.chain(functions).fold(SettingVector::ZERO, Add::add)
    }

    /// The stretch over which all its tables are known.
    #[must_use]
    pub fn range(&self) -> (f64, f64) {
        self.tables
            .iter()
            .map(Table::range)
            .fold((f64::NEG_INFINITY, f64::INFINITY), |all, one| {
                (all.0.max(one.0), all.1.min(one.1))
            })
    }

    /// The law with all vectors multiplied.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        let mut law = self.clone();
        for value in law.tables.iter_mut().flat_map(Table::values_mut) {
            *value = *value * factor;
        }
        for function in &mut law.functions {
            function.constant *= factor;
            function.slope *= factor;
            for wave in &mut function.waves {
                wave.amplitude *= factor;
            }
        }
        law
    }

    /// The law without one parameter.
    #[must_use]
    pub fn without(&self, component: Component) -> Self {
        let mut law = self.clone();
        for value in law.tables.iter_mut().flat_map(Table::values_mut) {
            *value = value.with(component, 0.0);
        }
        law.functions.retain(|one| one.component != component);
        law
    }

    /// True where a parameter is other than 0 somewhere.
    #[must_use]
    pub fn has(&self, component: Component) -> bool {
        let tables = self.tables.iter().flat_map(Table::values);
        tables
            .map(|value| value.get(component))
            .any(|value| value != 0.0)
            || self.functions.iter().any(|one| one.component == component)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_of_a_revolution_keeps_the_constant_only() {
        let wave = Wave {
            amplitude: 2.0,
            period: 120.0,
            phase_deg: 30.0,
        };
        let law = Law {
            functions: vec![Function {
                component: Component::C,
                constant: 0.5,
                slope: 0.0,
                waves: vec![wave],
            }],
            ..Law::NONE
        };
        let sum: f64 = (0..360).map(|deg| law.at(f64::from(deg)).shift.z).sum();
        assert!((sum / 360.0 - law.mean().shift.z).abs() < 1e-12);
        assert_eq!(law.at(0.0).shift.z, 0.5 + 2.0 * 30f64.to_radians().sin());
        assert!(law.has(Component::C) && !law.without(Component::C).has(Component::C));
    }
}
