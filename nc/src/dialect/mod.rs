//! Dialects: what the letters, numbers and codes of a control mean. A dialect is a TOML file: four come with the crate, users
//! write their own.

mod build;
mod file;
mod meaning;

pub use file::{Field, Integers, Numbers, ToolSelection};
pub use meaning::{Code, Cycle, CycleEnd, Meaning};

use crate::block::{Lexis, Number};
use crate::coordinates::{Axis, AxisSet};
use crate::source::{Complaint, read_toml};

const SHIPPED: [(&str, &str); 5] = [
    ("iso-mill", include_str!("../../dialects/iso-mill.toml")),
    ("iso-lathe", include_str!("../../dialects/iso-lathe.toml")),
    (
        "linuxcnc-mill",
        include_str!("../../dialects/linuxcnc-mill.toml"),
    ),
    (
        "linuxcnc-lathe",
        include_str!("../../dialects/linuxcnc-lathe.toml"),
    ),
    ("micrometre", include_str!("../../dialects/micrometre.toml")),
];

/// Codes have at most three digits before the point and one after it.
const CODES: usize = 10_000;

/// What a letter is besides its place in the text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Letter {
    /// Not of this dialect.
    Unknown,
    /// G: what is done.
    G,
    /// M: what the machine does.
    M,
    /// Number of the block or of the program.
    Label,
    /// An axis; a way where the mode says so.
    Axis(Axis),
    /// An axis; always a way.
    Way(Axis),
    /// I, J, K: centre of an arc, or something of a cycle.
    Centre(Axis),
    /// A value that is no place.
    Parameter,
}

/// What the letters, numbers and codes of a control mean.
#[derive(Clone, Debug)]
pub struct Dialect {
    name: String,
    description: String,
    lexis: Lexis,
    numbers: Numbers,
    letters: [Letter; 128],
    fields: [Option<Field>; 128],
    g: Vec<Option<Code>>,
    m: Vec<Option<Code>>,
    cycles: Vec<Cycle>,
    refused: Vec<String>,
    axes: AxisSet,
    diameter: Option<Axis>,
    diameter_at_start: bool,
    start: Vec<Code>,
    set_data: Vec<u32>,
    work_offsets: Vec<u16>,
    local_is_shift: bool,
    tools: ToolSelection,
    offsets_stand_still: bool,
    length_of_tool_in_use: bool,
}

impl Dialect {
    /// Names of the dialects that come with the crate.
    pub fn names() -> impl Iterator<Item = &'static str> {
        SHIPPED.iter().map(|(name, _)| *name)
    }

    /// A dialect that comes with the crate.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        let (_, text) = SHIPPED.iter().find(|(shipped, _)| *shipped == name)?;
        Self::from_toml(text).ok()
    }

    /// The text of a dialect that comes with the crate, to write one's own from.
    #[must_use]
    pub fn text_of(name: &str) -> Option<&'static str> {
        let (_, text) = SHIPPED.iter().find(|(shipped, _)| *shipped == name)?;
        Some(text)
    }

    /// From a file's text.
    ///
    /// # Errors
    /// What in it is not known or contradicts itself, and where.
    pub fn from_toml(text: &str) -> Result<Self, Complaint> {
        build::Builder::new(text, read_toml(text)?)?.build()
    }

    /// Its name.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// What it is for.
    #[must_use]
    pub fn description(&self) -> &str {
        &self.description
    }

    /// What counts as a word.
    #[must_use]
    pub const fn lexis(&self) -> &Lexis {
        &self.lexis
    }

    /// How numbers of places are written.
    #[must_use]
    pub const fn numbers(&self) -> &Numbers {
        &self.numbers
    }

    /// Axes it has.
    #[must_use]
    pub const fn axes(&self) -> AxisSet {
        self.axes
    }

    /// The axis that may be written as a diameter.
    #[must_use]
    pub const fn diameter(&self) -> Option<Axis> {
        self.diameter
    }

    /// True where its words are diameters before any code says so.
    #[must_use]
    pub const fn diameter_at_start(&self) -> bool {
        self.diameter_at_start
    }

    /// True where G52 writes into the same place as G92.
    #[must_use]
    pub const fn local_is_shift(&self) -> bool {
        self.local_is_shift
    }

    /// How tools are taken.
    #[must_use]
    pub const fn tools(&self) -> ToolSelection {
        self.tools
    }

    /// True where taking an offset moves no axis.
    #[must_use]
    pub const fn offsets_stand_still(&self) -> bool {
        self.offsets_stand_still
    }

    /// True where a tool length without H is that of the tool in use, and H alone does nothing.
    #[must_use]
    pub const fn length_of_tool_in_use(&self) -> bool {
        self.length_of_tool_in_use
    }

    /// What a letter is.
    #[must_use]
    pub fn letter(&self, letter: u8) -> Letter {
        self.letters
            .get(usize::from(letter))
            .copied()
            .unwrap_or(Letter::Unknown)
    }

    /// Width of the words of a letter, where it is fixed.
    #[must_use]
    pub fn field(&self, letter: u8) -> Option<Field> {
        self.fields.get(usize::from(letter)).copied().flatten()
    }

    /// What a G or M word does; none where it is unknown.
    #[must_use]
    pub fn code(&self, letter: u8, number: Number) -> Option<Code> {
        let table = if letter == b'G' { &self.g } else { &self.m };
        let tenths = usize::try_from(number.tenths()?).ok()?;
        table.get(tenths).copied().flatten()
    }

    /// A cycle by its number.
    #[must_use]
    pub fn cycle(&self, number: u8) -> Cycle {
        self.cycles[usize::from(number)]
    }

    /// Why a code is refused.
    #[must_use]
    pub fn why_refused(&self, number: u8) -> &str {
        &self.refused[usize::from(number)]
    }

    /// True where G10 of this L is known.
    #[must_use]
    pub fn sets_data(&self, l: u32) -> bool {
        self.set_data.contains(&l)
    }

    /// Codes of the work offsets, in tenths, in the order that G10 counts them in.
    #[must_use]
    pub fn work_offsets(&self) -> &[u16] {
        &self.work_offsets
    }

    /// The number of a code that does something, in tenths, the lowest of several.
    #[must_use]
    pub fn code_of(&self, meaning: Meaning) -> Option<u16> {
        let tenths = self
            .g
            .iter()
            .position(|code| *code == Some(Code::Of(meaning)))?;
        u16::try_from(tenths).ok()
    }

    /// Codes in force at the start.
    #[must_use]
    pub fn start(&self) -> &[Code] {
        &self.start
    }
}
