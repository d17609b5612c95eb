//! The parameter tables of a machine, its board and an axis, by the names that files give them.

use leadscrew::parameter_table::ParameterTable;
use leadscrew::params::{AxisParams, SectionVisitor};

use super::definition::{Setting, set};
use super::plant::Plant;
use crate::machine::MachineParams;

/// Something to be done with a table, whichever it is.
pub trait Visitor {
    /// What comes of it.
    type Output;

    /// Does it.
    fn visit<T: ParameterTable>(self, table: &mut T) -> Self::Output;
}

/// Declares a list of sections and the function that finds them.
macro_rules! sections {
    ($(#[$list_doc:meta])* $list:ident, $(#[$visit_doc:meta])* $visit:ident($params:ty) { $($name:ident: $($field:ident).+,)* }) => {
        $(#[$list_doc])*
        pub const $list: &[&str] = &[$(stringify!($name)),*];

        $(#[$visit_doc])*
        pub fn $visit<V: Visitor>(params: &mut $params, section: &str, visitor: V) -> Option<V::Output> {
            match section {
                $(stringify!($name) => Some(visitor.visit(&mut params.$($field).+)),)*
                _ => None,
            }
        }
    };
}

sections! {
    /// Sections of a machine.
    MACHINE_SECTIONS,
    /// Visits a section of a machine; `None` if there is none of that name.
    visit_machine(MachineParams) {
        drive: drive,
        carriage: carriage,
        mount: mount,
        disc: encoder.disc,
        encoder: encoder.encoder,
    }
}

sections! {
    /// Sections of what is around a machine.
    BOARD_SECTIONS,
    /// Visits one of these; `None` if there is none of that name.
    visit_around(Plant) {
        drive_lines: board.drive_lines,
        switches: board.switches,
        brake: board.brake,
        touch_probe: board.probe,
        spindle: spindle,
    }
}

/// Visits a section of a machine or of what is around it; `None` if there is none of that name.
pub fn visit_plant<V: Visitor>(plant: &mut Plant, section: &str, visitor: V) -> Option<V::Output> {
    if MACHINE_SECTIONS.contains(&section) {
        visit_machine(&mut plant.machine, section, visitor)
    } else {
        visit_around(plant, section, visitor)
    }
}

/// Visits a section of an axis; `None` if there is none of that name.
pub fn visit_axis<V: Visitor>(
    params: &mut AxisParams,
    section: &str,
    visitor: V,
) -> Option<V::Output> {
    let mut found = Found {
        section,
        visitor: Some(visitor),
        output: None,
    };
    params.visit_sections(&mut found);
    found.output
}

/// Visits one section of all.
struct Found<'a, V: Visitor> {
    section: &'a str,
    visitor: Option<V>,
    output: Option<V::Output>,
}

impl<V: Visitor> SectionVisitor for Found<'_, V> {
    fn section<T: ParameterTable>(&mut self, name: &'static str, table: &mut T) {
        if name == self.section
            && let Some(visitor) = self.visitor.take()
        {
            self.output = Some(visitor.visit(table));
        }
    }
}

/// Sets a parameter.
pub(super) struct Set<'a>(pub &'a Setting);

impl Visitor for Set<'_> {
    type Output = bool;

    fn visit<T: ParameterTable>(self, table: &mut T) -> bool {
        set(table, self.0.key, self.0.value)
    }
}
