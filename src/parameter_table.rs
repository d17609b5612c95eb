//! Tables of parameters: name, unit, range, default and description in one place.
//!
//! [`parameter_table!`](crate::parameter_table!) makes a plain struct of `f64` fields and, beside it,
//! the list of its [`Field`]s, from which validation, files and documentation are made.

use crate::units::{RangeError, checked};

/// One parameter of the table `T`.
#[derive(Clone, Copy, Debug)]
pub struct Field<T> {
    /// Its name, unit included, as in the struct.
    pub name: &'static str,
    /// Its unit, for people.
    pub unit: &'static str,
    /// What it is.
    pub description: &'static str,
    /// Smallest value allowed.
    pub min: f64,
    /// Largest value allowed.
    pub max: f64,
    /// Reads it.
    pub get: fn(&T) -> f64,
    /// Writes it, unchecked.
    pub set: fn(&mut T, f64),
}

/// A struct made by [`parameter_table!`](crate::parameter_table!).
pub trait ParameterTable: Default + 'static {
    /// What it is about, line by line.
    const ABOUT: &'static [&'static str];
    /// Its parameters, in order.
    const FIELDS: &'static [Field<Self>];

    /// Checks every parameter against its range.
    ///
    /// # Errors
    /// [`RangeError`] for the first one that is out of range.
    fn check(&self) -> Result<(), RangeError> {
        Self::FIELDS.iter().try_for_each(|field| {
            checked(field.name, (field.get)(self), field.min, field.max).map(|_| ())
        })
    }
}

/// Declares a struct of parameters: each line is a description, then
/// `name: default, "unit", min..=max;`.
#[macro_export]
macro_rules! parameter_table {
    (
        $(#[doc = $about:literal])+
        pub struct $name:ident {
            $(#[doc = $description:literal] $field:ident: $default:expr, $unit:literal, $min:literal..=$max:literal;)*
        }
    ) => {
        $(#[doc = $about])+
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct $name {
            $(#[doc = concat!($description, " (", $unit, ", ", stringify!($min), " to ", stringify!($max), ")")] pub $field: f64,)*
        }

        impl Default for $name {
            fn default() -> Self {
                Self { $($field: $default,)* }
            }
        }

        impl $crate::parameter_table::ParameterTable for $name {
            const ABOUT: &'static [&'static str] = &[$($about.trim_ascii()),+];
            const FIELDS: &'static [$crate::parameter_table::Field<Self>] = &[
                $($crate::parameter_table::Field {
                    name: stringify!($field),
                    unit: $unit,
                    description: $description.trim_ascii(),
                    min: $min,
                    max: $max,
                    get: |table| table.$field,
                    set: |table, value| table.$field = value,
                },)*
            ];
        }
    };
}
