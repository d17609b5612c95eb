//! A setting vector given at places of the coordinate, linear between them.

use crate::setting_vector::SettingVector;

/// A setting vector given at places, linear between them.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    places: Vec<f64>,
    values: Vec<SettingVector>,
    full_turn: bool,
}

impl Table {
    /// A table from its places (mm or degrees, rising) and the vectors there. One of a rotary unit whose ends lie a full turn
    /// apart goes round without end.
    ///
    /// # Errors
    /// What is wrong with the numbers, in words.
    pub fn new(places: Vec<f64>, values: Vec<SettingVector>, rotary: bool) -> Result<Self, String> {
        if places.len() < 2 {
            return Err(format!(
                "a table needs two places or more, found {}",
                places.len()
            ));
        }
        if places.len() != values.len() {
            return Err(format!(
                "{} values for {} places: one for each is needed",
                values.len(),
                places.len()
            ));
        }
        let finite = places
            .iter()
            .copied()
            .chain(values.iter().flat_map(|v| v.to_array()));
        if let Some(value) = finite.into_iter().find(|value| !value.is_finite()) {
            return Err(format!(
                "a number of the table is {value}: it must be finite"
            ));
        }
        if let Some(pair) = places.windows(2).find(|pair| pair[0] >= pair[1]) {
            return Err(format!(
                "the places must rise from one to the next: {} follows {}",
                pair[1], pair[0]
            ));
        }
        let length = places[places.len() - 1] - places[0];
        let full_turn = rotary && (length - 360.0).abs() < 1e-9;
        if rotary && length > 360.0 + 1e-9 {
            return Err(format!(
                "the places go over {length} degrees: a full turn at most"
            ));
        }
        if full_turn && values[0] != values[values.len() - 1] {
            return Err(
                "the last place is the first after a full turn, and its values differ".to_owned(),
            );
        }
        Ok(Self {
            places,
            values,
            full_turn,
        })
    }

    /// First and last place; without end for a table of a full turn.
    #[must_use]
    pub fn range(&self) -> (f64, f64) {
        if self.full_turn {
            return (f64::NEG_INFINITY, f64::INFINITY);
        }
        (self.places[0], self.places[self.places.len() - 1])
    }

    /// Its places.
    #[must_use]
    pub fn places(&self) -> &[f64] {
        &self.places
    }

    /// The vectors at its places.
    #[must_use]
    pub fn values(&self) -> &[SettingVector] {
        &self.values
    }

    /// The vector at a place; beyond the ends that of the end.
    pub(super) fn at(&self, place: f64) -> SettingVector {
        let first = self.places[0];
        let place = if self.full_turn {
            first + (place - first).rem_euclid(360.0)
        } else {
            place
        };
        let above = self.places.partition_point(|&one| one <= place);
        let high = above.clamp(1, self.places.len() - 1);
        let (low_place, high_place) = (self.places[high - 1], self.places[high]);
        let part = ((place - low_place) / (high_place - low_place)).clamp(0.0, 1.0);
        self.values[high - 1] * (1.0 - part) + self.values[high] * part
    }

    /// Mean over its places.
    pub(super) fn mean(&self) -> SettingVector {
        let mut sum = SettingVector::ZERO;
        for (places, values) in self.places.windows(2).zip(self.values.windows(2)) {
            sum += (values[0] + values[1]) * (0.5 * (places[1] - places[0]));
        }
        sum * (1.0 / (self.places[self.places.len() - 1] - self.places[0]))
    }

    /// Its vectors, to be changed one by one.
    pub(super) fn values_mut(&mut self) -> impl Iterator<Item = &mut SettingVector> {
        self.values.iter_mut()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::setting_vector::Component;

    fn b_of(values: &[f64]) -> Vec<SettingVector> {
        let vector = |&b: &f64| SettingVector::ZERO.with(Component::B, b);
        values.iter().map(vector).collect()
    }

    #[test]
    fn a_table_is_linear_between_its_places() {
        let table = Table::new(vec![0.0, 10.0, 30.0], b_of(&[1.0, 2.0, -2.0]), false).unwrap();
        let b = |place| table.at(place).shift.y;
        assert_eq!(
            [b(0.0), b(5.0), b(10.0), b(20.0), b(30.0)],
            [1.0, 1.5, 2.0, 0.0, -2.0]
        );
    }

    #[test]
    fn a_table_of_a_full_turn_goes_round() {
        let places = vec![0.0, 90.0, 180.0, 270.0, 360.0];
        let table = Table::new(places, b_of(&[0.0, 1.0, 0.0, 3.0, 0.0]), true).unwrap();
        assert_eq!(table.at(-45.0), table.at(315.0));
        assert_eq!(table.at(-45.0).shift.y, 1.5);
        assert_eq!(table.at(360.0 + 90.0).shift.y, 1.0);
        assert_eq!(table.mean().shift.y, 1.0);
    }

    #[test]
    fn the_mean_of_a_table_weighs_each_stretch_by_its_length() {
        // 0 to 2 over a quarter, 2 to 0 over three: 1 in the mean of each.
        let steep = Table::new(vec![0.0, 90.0, 360.0], b_of(&[0.0, 2.0, 0.0]), true).unwrap();
        assert_eq!(steep.mean().shift.y, 1.0);
        // 1 over a quarter, 1 to 3 over a quarter, 3 to 1 over the rest: ¼·1 + ¼·2 + ½·2.
        let places = vec![0.0, 90.0, 180.0, 360.0];
        let uneven = Table::new(places, b_of(&[1.0, 1.0, 3.0, 1.0]), true).unwrap();
        assert_eq!(uneven.mean().shift.y, 1.75);
    }

    #[test]
    fn tables_that_cannot_be_are_refused() {
        let new = |places: &[f64], rotary| {
            let values = vec![SettingVector::ZERO; places.len()];
            Table::new(places.to_vec(), values, rotary).unwrap_err()
        };
        assert!(new(&[1.0], false).contains("two places"));
        assert!(new(&[1.0, 1.0], false).contains("must rise"));
        assert!(new(&[0.0, f64::NAN], false).contains("finite"));
        assert!(new(&[0.0, 400.0], true).contains("full turn"));
        let open = Table::new(vec![0.0, 360.0], b_of(&[0.0, 1.0]), true).unwrap_err();
        assert!(open.contains("values differ"), "{open}");
    }
}
