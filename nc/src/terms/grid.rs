//! A table of corrections on a grid over one to four coordinates, linear between the nodes: P4's tables that "set the
//! corrections against the values of the controlled coordinates".

mod file;
mod interpolate;

use serde::{Deserialize, Serialize};

use super::{Circumstances, Region, Shape, Steepness, Term, TermError, Trouble};
use crate::coordinates::{Axis, AxisSet, Coordinates};
use crate::source::Complaint;
use file::GridFile;

/// One coordinate of a grid.
#[derive(Clone, Debug, PartialEq)]
pub struct GridAxis {
    /// The axis.
    pub axis: Axis,
    /// Places of its nodes in machine coordinates, rising, mm or degrees; two or more.
    pub places: Vec<f64>,
}

/// The tool offsets for which a grid holds: deviations by an angle grow with the offset, so a grid made for a long tool is
/// wrong for a short one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToolOffsetRange {
    /// The offset it was made for, control point less tip, mm.
    pub offset: Coordinates,
    /// By how much the offset in force may differ on each axis, mm.
    pub within_mm: f64,
}

/// Corrections K at the nodes of a grid, multilinear between them, none beyond them.
///
/// In TOML: `name`, `includes_drive_errors` (false if absent), one `[[over]]` for each coordinate with `axis` and `places_mm`
/// (`places_deg` for A, B, C), one `[[correct]]` for each corrected axis with `axis` and `values_mm` (`values_deg`): a value for
/// each node, the last coordinate of `over` running fastest. Optionally `[tool]` with `offset_mm = { Z = 120.0 }` and
/// `within_mm`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "GridFile", into = "GridFile")]
pub struct Grid {
    name: String,
    over: Vec<GridAxis>,
    corrects: Vec<Axis>,
    /// `corrects.len()` values for each node, the last coordinate running fastest.
    values: Vec<f64>,
    includes_drive_errors: bool,
    tool: Option<ToolOffsetRange>,
    steepness: Steepness,
}

/// Coordinates of a grid at most.
pub const MAX_OVER: usize = 4;
/// Of these at most so many may change K, which keeps it of third degree along a line; one more says at which place of an axis
/// the table holds.
pub const MAX_VARYING: usize = 3;
/// Nodes of a grid at most: 100 in each of three coordinates.
pub const MAX_NODES: usize = 1_000_000;

impl Grid {
    /// A grid from the values at its nodes: `values` holds `corrects.len()` values for each node, the last coordinate of `over`
    /// running fastest.
    ///
    /// # Errors
    /// What is wrong with the numbers, in words.
    pub fn new(
        name: impl Into<String>,
        over: Vec<GridAxis>,
        corrects: Vec<Axis>,
        values: Vec<f64>,
    ) -> Result<Self, String> {
        check(&over, &corrects, &values)?;
        let mut grid = Self {
            name: name.into(),
            over,
            corrects,
            values,
            includes_drive_errors: false,
            tool: None,
            steepness: Steepness::default(),
        };
        grid.steepness = interpolate::steepness(&grid);
        if interpolate::varying(&grid) > MAX_VARYING {
            return Err(format!(
                "the corrections change with more than {MAX_VARYING} coordinates: make a table for each place of one of them"
            ));
        }
        Ok(grid)
    }

    /// From a text in TOML; what is wrong has its place, also where it is the numbers.
    ///
    /// # Errors
    /// What is wrong in the text, and where.
    pub fn read(text: &str) -> Result<Self, Complaint> {
        file::read(text)
    }

    /// A grid filled by asking for K at each node; coordinates not in `over` are 0 in the place asked for.
    ///
    /// # Errors
    /// The first error of `correction`, or what is wrong with the numbers.
    pub fn sampled(
        name: impl Into<String>,
        over: Vec<GridAxis>,
        corrects: Vec<Axis>,
        mut correction: impl FnMut(&Coordinates) -> Result<Coordinates, String>,
    ) -> Result<Self, String> {
        check_axes(&over, &corrects)?;
        let mut values = Vec::new();
        for node in 0..nodes(&over) {
            let k = correction(&place_of(&over, node))?;
            values.extend(corrects.iter().map(|axis| k[*axis]));
        }
        Self::new(name, over, corrects, values)
    }

    /// States whether the drives' own positioning errors (the screw map) are in it: such a grid owns the screw map.
    #[must_use]
    pub fn including_drive_errors(mut self, included: bool) -> Self {
        self.includes_drive_errors = included;
        self
    }

    /// States the tool offsets for which it holds; without it, it holds for all.
    #[must_use]
    pub fn for_tool(mut self, tool: Option<ToolOffsetRange>) -> Self {
        self.tool = tool;
        self
    }

    /// Its coordinates.
    #[must_use]
    pub fn over(&self) -> &[GridAxis] {
        &self.over
    }

    /// The tool offsets for which it holds.
    #[must_use]
    pub fn tool(&self) -> Option<&ToolOffsetRange> {
        self.tool.as_ref()
    }

    /// True where the drives' own positioning errors are in it.
    #[must_use]
    pub fn includes_drive_errors(&self) -> bool {
        self.includes_drive_errors
    }

    /// The nodes with K at each, the last coordinate running fastest.
    pub fn nodes(&self) -> impl Iterator<Item = (Coordinates, Coordinates)> + '_ {
        self.values
            .chunks(self.corrects.len())
            .enumerate()
            .map(|(node, row)| (place_of(&self.over, node), self.vector(row)))
    }

    fn vector(&self, row: &[f64]) -> Coordinates {
        self.corrects
            .iter()
            .copied()
            .zip(row.iter().copied())
            .collect()
    }

    fn check_tool(&self, with: &Circumstances) -> Result<(), TermError> {
        let Some(made_for) = &self.tool else {
            return Ok(());
        };
        let trouble = |trouble| TermError {
            term: self.name.clone(),
            trouble,
        };
        let in_force = with
            .tool_offset
            .ok_or_else(|| trouble(Trouble::ToolOffsetUnknown))?;
        for (axis, nominal) in made_for.offset.iter() {
            let value = in_force[axis];
            let range = (nominal - made_for.within_mm, nominal + made_for.within_mm);
            if !(range.0..=range.1).contains(&value) {
                return Err(trouble(Trouble::ToolOffset { axis, value, range }));
            }
        }
        Ok(())
    }
}

impl Term for Grid {
    fn name(&self) -> &str {
        &self.name
    }

    fn correction(&self, at: &Coordinates, with: &Circumstances) -> Result<Coordinates, TermError> {
        self.check_tool(with)?;
        interpolate::correction(self, at)
    }

    fn corrects(&self) -> AxisSet {
        self.corrects.iter().copied().collect()
    }

    fn depends_on(&self) -> AxisSet {
        self.over.iter().map(|one| one.axis).collect()
    }

    fn depends_on_tool(&self) -> bool {
        self.tool.is_some()
    }

    fn shape(&self) -> Shape {
        if self.values.iter().all(|value| *value == 0.0) {
            Shape::None
        } else {
            Shape::Curved
        }
    }

    fn breaks(&self, axis: Axis, found: &mut dyn FnMut(&[f64])) {
        if let Some(one) = self.over.iter().find(|one| one.axis == axis) {
            found(&one.places);
        }
    }

    fn steepness(&self, _: &Region) -> Steepness {
        self.steepness
    }
}

fn nodes(over: &[GridAxis]) -> usize {
    over.iter().fold(1, |product: usize, one| {
        product.saturating_mul(one.places.len())
    })
}

fn place_of(over: &[GridAxis], node: usize) -> Coordinates {
    let mut rest = node;
    let mut place = Coordinates::ZERO;
    for one in over.iter().rev() {
        place[one.axis] = one.places[rest % one.places.len()];
        rest /= one.places.len();
    }
    place
}

fn check(over: &[GridAxis], corrects: &[Axis], values: &[f64]) -> Result<(), String> {
    check_axes(over, corrects)?;
    let expected = nodes(over) * corrects.len();
    if values.len() != expected {
        return Err(format!(
            "{} values for {} nodes of {} corrected axes: {expected} are needed",
            values.len(),
            nodes(over),
            corrects.len()
        ));
    }
    if let Some(value) = values.iter().find(|value| !value.is_finite()) {
        return Err(format!(
            "a value of the table is {value}: it must be a finite number"
        ));
    }
    Ok(())
}

fn check_axes(over: &[GridAxis], corrects: &[Axis]) -> Result<(), String> {
    if over.is_empty() || over.len() > MAX_OVER {
        return Err(format!(
            "a grid is over one to {MAX_OVER} coordinates, not {}",
            over.len()
        ));
    }
    if nodes(over) > MAX_NODES {
        return Err(format!("a grid has {MAX_NODES} nodes at most"));
    }
    for (i, one) in over.iter().enumerate() {
        let axis = one.axis;
        if over[..i].iter().any(|other| other.axis == axis) {
            return Err(format!("{axis} is twice a coordinate of the grid"));
        }
        check_places(one)?;
    }
    if corrects.is_empty() {
        return Err("a grid corrects one axis or more".to_owned());
    }
    for (i, axis) in corrects.iter().enumerate() {
        if corrects[..i].contains(axis) {
            return Err(format!("{axis} is corrected twice by the grid"));
        }
    }
    Ok(())
}

fn check_places(GridAxis { axis, places }: &GridAxis) -> Result<(), String> {
    if places.len() < 2 || !places.iter().all(|place| place.is_finite()) {
        return Err(format!("{axis} needs two places or more, all finite"));
    }
    if places.windows(2).any(|pair| pair[0] >= pair[1]) {
        return Err(format!(
            "the places of {axis} must rise from one to the next"
        ));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::read_toml;

    const TOML: &str = r#"
name = "volume"
includes_drive_errors = true
over = [{ axis = "X", places_mm = [0, 100] }, { axis = "B", places_deg = [-90, 0, 90] }]
correct = [{ axis = "Z", values_mm = [0.0, 0.01, 0.02, 0.10, 0.11, 0.13] }]
"#;

    #[test]
    fn between_the_nodes_it_is_linear_and_beyond_them_refused() {
        let grid: Grid = read_toml(TOML).unwrap();
        let k = |x, b| {
            let at = Coordinates::xyz(x, 5.0, 7.0).with(Axis::B, b);
            grid.correction(&at, &Circumstances::default())
                .map(|k| k[Axis::Z])
        };
        assert_eq!(k(0.0, 90.0), Ok(0.02));
        assert_eq!(
            k(100.0, 90.0),
            Ok(0.13),
            "the last node belongs to the table"
        );
        assert!((k(50.0, 45.0).unwrap() - 0.0675).abs() < 1e-15);
        assert_eq!(
            k(100.5, 0.0).unwrap_err().to_string(),
            "X = 100.5000 mm (machine) is outside of the table of term \"volume\", 0.0000 to 100.0000 mm: \
             extend the table or move the work"
        );
        assert!(k(f64::NAN, 0.0).is_err());
    }

    #[test]
    fn what_is_written_is_read_again() {
        let grid: Grid = read_toml(TOML).unwrap();
        let again: Grid = read_toml(&toml::to_string(&grid).unwrap()).unwrap();
        assert_eq!(grid, again);
        assert!(again.includes_drive_errors());
        let sampled = Grid::sampled("volume", grid.over.clone(), vec![Axis::Z], |at| {
            grid.correction(at, &Circumstances::default())
                .map_err(|error| error.to_string())
        });
        assert_eq!(sampled.unwrap().including_drive_errors(true), grid);
    }

    #[test]
    fn its_steepness_is_that_of_its_cells() {
        let grid: Grid = read_toml(TOML).unwrap();
        let Steepness { slope, bend } = grid.steepness;
        let expected = (0.11_f64 / 100.0).hypot(0.02 / 90.0);
        assert!((slope - expected).abs() < 1e-15, "{slope}");
        let twist = (0.13 - 0.11 - (0.02 - 0.01)) / (100.0 * 90.0);
        assert!((bend - twist).abs() < 1e-15, "{bend}");
    }

    #[test]
    fn bad_tables_are_refused_in_words() {
        for (from, to, message) in [
            ("[0, 100]", "[100, 0]", "the places of X must rise"),
            (
                "places_deg",
                "places_mm",
                "B needs places_deg, and only that",
            ),
            (
                ", 0.13]",
                "]",
                "5 values correct Z, and the grid has 6 nodes",
            ),
            ("\"B\"", "\"X\"", "X needs places_mm"),
            ("0.13", "inf", "must be a finite number"),
        ] {
            let error = Grid::read(&TOML.replace(from, to)).unwrap_err();
            assert!(error.place.line >= 4, "{error}");
            assert!(error.message.contains(message), "{error}");
        }
    }
}
