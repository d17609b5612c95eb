//! The parameter tables of a machine and of an axis, by the names that files give them.

use leadscrew::parameter_table::ParameterTable;
use leadscrew::params::AxisParams;

use super::definition::{Setting, set};
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
    /// Sections of an axis.
    AXIS_SECTIONS,
    /// Visits a section of an axis; `None` if there is none of that name.
    visit_axis(AxisParams) {
        motion: motion,
        controller: controller,
        output: output,
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
