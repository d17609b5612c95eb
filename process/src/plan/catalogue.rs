//! Machines and encoders by name: a built-in TOML file, and those of users added to it.

mod entries;
mod fitted;
mod read;

use leadscrew::units::PAPER_GRAVITY_M_S2;
use leadscrew_nc::source::Complaint;
use serde::Serialize;

use super::cycle::Kinematics;

/// The built-in file.
pub const BUILT_IN: &str = include_str!("catalogue.toml");

/// Machines and encoders, each name once.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Catalogue {
    encoders: Vec<Encoder>,
    machines: Vec<Machine>,
}

/// A rotary encoder.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Encoder {
    /// Its name.
    pub name: String,
    /// Who makes it, if that is told.
    pub maker: Option<String>,
    /// Fewest and most lines a revolution, Z.
    pub lines: [f64; 2],
    /// Highest speed, rpm.
    pub max_rpm: Option<f64>,
    /// Highest frequency of a channel f_I, Hz.
    pub max_line_hz: Option<f64>,
    /// Where that is from.
    pub source: Option<String>,
}

/// A machine.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Machine {
    /// Its name.
    pub name: String,
    /// Where that is from.
    pub source: Option<String>,
    /// Its linear axes.
    pub axes: Vec<MachineAxis>,
    /// Its spindles.
    pub spindles: Vec<Spindle>,
}

/// A linear axis.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MachineAxis {
    /// Its name.
    pub name: String,
    /// Limits and resolution.
    pub kinematics: Kinematics,
    /// The other end of the overload's range where a source gives one, g.
    pub least_overload_g: Option<f64>,
    /// What measures it, if that is told.
    pub encoder: Option<FittedEncoder>,
    /// What no source says.
    pub assumed: Option<String>,
}

/// A spindle.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Spindle {
    /// Its name.
    pub name: String,
    /// Highest speed, rpm.
    pub max_rpm: f64,
    /// What measures it.
    pub encoder: FittedEncoder,
    /// What no source says.
    pub assumed: Option<String>,
}

/// An encoder in its place.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FittedEncoder {
    /// The encoder.
    pub encoder: Encoder,
    /// Its lines, Z.
    pub lines: f64,
    /// Travel of the axis in a revolution, mm; of a spindle 0.
    pub travel_mm: f64,
}

impl MachineAxis {
    /// Overload n at the largest acceleration, g (P3, 8).
    #[must_use]
    pub fn overload_g(&self) -> f64 {
        self.kinematics.max_acceleration_m_s2() / PAPER_GRAVITY_M_S2
    }
}

impl Machine {
    /// The same machine with another encoder on every axis that has a travel for one, and on every spindle.
    ///
    /// # Errors
    /// A message: lines that it does not come with, none chosen where there are several, or no place for it.
    pub fn with_encoder(&self, encoder: &Encoder, lines: Option<f64>) -> Result<Self, String> {
        let mut machine = self.clone();
        for axis in &mut machine.axes {
            let Some(fitted) = &mut axis.encoder else {
                let name = &axis.name;
                return Err(format!(
                    "of axis {name} only the resolution is known: give it encoder and travel_mm in a catalogue"
                ));
            };
            *fitted = FittedEncoder::new(encoder, lines, fitted.travel_mm)?;
            let counts_per_mm = fitted.counts_per_mm().map_err(|error| error.to_string())?;
            let limits = &axis.kinematics;
            axis.kinematics = Kinematics::new(
                limits.max_feed_mm_per_min(),
                limits.max_acceleration_m_s2(),
                limits.max_jerk_m_s3(),
                counts_per_mm,
            )
            .map_err(|error| error.to_string())?;
        }
        for spindle in &mut machine.spindles {
            spindle.encoder = FittedEncoder::new(encoder, lines, 0.0)?;
        }
        Ok(machine)
    }
}

impl Catalogue {
    /// The built-in one.
    ///
    /// # Errors
    /// Never: a test reads it.
    pub fn built_in() -> Result<Self, Complaint> {
        let mut catalogue = Self::default();
        catalogue.add(BUILT_IN)?;
        Ok(catalogue)
    }

    /// Adds what a text in the form of [`BUILT_IN`] holds. Its machines may have encoders that were there before. On an error
    /// nothing is added.
    ///
    /// # Errors
    /// With line and column: no such TOML, a value out of range, a name that is there already, an unknown encoder.
    pub fn add(&mut self, text: &str) -> Result<(), Complaint> {
        let mut whole = self.clone();
        read::add(&mut whole, text)?;
        *self = whole;
        Ok(())
    }

    /// All encoders.
    #[must_use]
    pub fn encoders(&self) -> &[Encoder] {
        &self.encoders
    }

    /// All machines.
    #[must_use]
    pub fn machines(&self) -> &[Machine] {
        &self.machines
    }

    /// The machine of a name; capitals and blanks do not count.
    #[must_use]
    pub fn machine(&self, name: &str) -> Option<&Machine> {
        self.machines
            .iter()
            .find(|machine| is_same(&machine.name, name))
    }

    /// The encoder of a name; capitals and blanks do not count.
    #[must_use]
    pub fn encoder(&self, name: &str) -> Option<&Encoder> {
        self.encoders
            .iter()
            .find(|encoder| is_same(&encoder.name, name))
    }
}

/// Names that people take for one.
fn is_same(one: &str, other: &str) -> bool {
    let plain = |name: &str| -> String {
        let letters = name.chars().filter(|letter| !letter.is_whitespace());
        letters.flat_map(char::to_lowercase).collect()
    };
    plain(one) == plain(other)
}
