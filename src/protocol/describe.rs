//! Messages and what is to be said about them, in one table: the code takes its type from it, the specification its
//! text.

/// A field of a message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FieldText {
    /// Its name, unit included.
    pub name: &'static str,
    /// Its type.
    pub kind: &'static str,
    /// What it is.
    pub what: &'static str,
}

/// A message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Described {
    /// Its number: the first byte of its body.
    pub number: u8,
    /// Its name, as in the code.
    pub name: &'static str,
    /// What it is.
    pub what: &'static [&'static str],
    /// Its fields, in the order of the wire.
    pub fields: &'static [FieldText],
}

/// Declares an enum of messages: a description, then `Name = number { fields }`, in the order of the numbers, which
/// begin with 0 and have no gap, as postcard counts them.
macro_rules! messages {
    (
        $(#[doc = $about:literal])+
        pub enum $enum:ident<'a> {
            $($(#[doc = $what:literal])+ $name:ident = $number:literal {
                $($(#[doc = $text:literal])+ $field:ident: $kind:ty,)*
            })*
        }
    ) => {
        $(#[doc = $about])+
        #[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
        pub enum $enum<'a> {
            $($(#[doc = $what])+ $name {
                $($(#[doc = $text])+ $field: $kind,)*
            },)*
        }

        impl $enum<'_> {
            /// All messages, by number.
            pub const ALL: &'static [$crate::protocol::Described] = &[
                $($crate::protocol::Described {
                    number: $number,
                    name: stringify!($name),
                    what: &[$($what.trim_ascii()),+],
                    fields: &[$($crate::protocol::FieldText {
                        name: stringify!($field),
                        kind: stringify!($kind),
                        what: concat!($($text),+).trim_ascii(),
                    },)*],
                },)*
            ];

            /// Its number: the first byte of its body.
            #[must_use]
            pub const fn number(&self) -> u8 {
                match self { $(Self::$name { .. } => $number,)* }
            }

            /// Its name.
            #[must_use]
            pub const fn name(&self) -> &'static str {
                match self { $(Self::$name { .. } => stringify!($name),)* }
            }
        }
    };
}

pub(super) use messages;
