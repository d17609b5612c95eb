//! A file, checked on its way into the catalogue.

use leadscrew::units::{PAPER_GRAVITY_M_S2, checked};
use leadscrew_nc::source::{Complaint, read_toml};
use toml::Spanned;

use super::super::cycle::{
    ACCELERATION_M_S2, COUNTS_PER_MM, FEED_MM_PER_MIN, JERK_M_S3, Kinematics,
};
use super::entries::{AxisEntry, EncoderEntry, File, MachineEntry, SpindleEntry};
use super::{Catalogue, Encoder, FittedEncoder, Machine, MachineAxis, Spindle, is_same};

const LINES: (f64, f64) = (1.0, 1e7);
const RPM: (f64, f64) = (1e-3, 1e6);
const LINE_KHZ: (f64, f64) = (1e-3, 1e6);

/// Adds the content of `text`.
pub(super) fn add(catalogue: &mut Catalogue, text: &str) -> Result<(), Complaint> {
    let file: File = read_toml(text)?;
    let reader = Reader(text);
    for entry in file.encoder {
        reader.new_name(
            &entry.name,
            "encoder",
            catalogue
                .encoder(entry.name.as_ref())
                .map(|known| &*known.name),
        )?;
        catalogue.encoders.push(reader.encoder(entry)?);
    }
    for entry in file.machine {
        reader.new_name(
            &entry.name,
            "machine",
            catalogue
                .machine(entry.name.as_ref())
                .map(|known| &*known.name),
        )?;
        let machine = reader.machine(entry, catalogue)?;
        catalogue.machines.push(machine);
    }
    Ok(())
}

/// The text, for the places of what is wrong.
struct Reader<'t>(&'t str);

impl Reader<'_> {
    fn complain<T>(&self, at: &Spanned<T>, message: impl Into<String>) -> Complaint {
        Complaint::at(self.0, &at.span(), message)
    }

    fn ranged(
        &self,
        name: &'static str,
        value: &Spanned<f64>,
        (min, max): (f64, f64),
    ) -> Result<f64, Complaint> {
        checked(name, *value.as_ref(), min, max)
            .map_err(|error| self.complain(value, error.to_string()))
    }

    fn ranged_if(
        &self,
        name: &'static str,
        value: Option<&Spanned<f64>>,
        range: (f64, f64),
    ) -> Result<Option<f64>, Complaint> {
        value
            .map(|value| self.ranged(name, value, range))
            .transpose()
    }

    /// Refuses a name that is there already.
    fn new_name(
        &self,
        name: &Spanned<String>,
        what: &str,
        known: Option<&str>,
    ) -> Result<(), Complaint> {
        let given = name.as_ref();
        if given.trim().is_empty() {
            return Err(self.complain(name, format!("the {what} has no name: give it one")));
        }
        match known {
            Some(known) => Err(self.complain(
                name,
                format!("{what} \"{given}\": there is one of that name already (\"{known}\"): choose another name"),
            )),
            None => Ok(()),
        }
    }

    fn encoder(&self, entry: EncoderEntry) -> Result<Encoder, Complaint> {
        let lines = *entry.lines.as_ref();
        let are_good = lines
            .iter()
            .all(|lines| (LINES.0..=LINES.1).contains(lines));
        if !are_good || lines[0] > lines[1] {
            let [least, most] = lines;
            return Err(self.complain(
                &entry.lines,
                format!("lines = [{least}, {most}]: expected fewest and most lines a revolution, 1 to 1e7"),
            ));
        }
        let max_line_khz = self.ranged_if("max_line_khz", entry.max_line_khz.as_ref(), LINE_KHZ)?;
        Ok(Encoder {
            lines,
            max_rpm: self.ranged_if("max_rpm", entry.max_rpm.as_ref(), RPM)?,
            max_line_hz: max_line_khz.map(|khz| 1000.0 * khz),
            name: entry.name.into_inner(),
            maker: entry.maker,
            source: entry.source,
        })
    }

    fn machine(&self, entry: MachineEntry, catalogue: &Catalogue) -> Result<Machine, Complaint> {
        let mut machine = Machine {
            name: entry.name.as_ref().clone(),
            source: entry.source,
            axes: Vec::new(),
            spindles: Vec::new(),
        };
        if entry.axis.is_empty() {
            return Err(self.complain(
                &entry.name,
                format!(
                    "machine \"{}\" has no axis: add a [[machine.axis]]",
                    machine.name
                ),
            ));
        }
        for axis in entry.axis {
            let known = machine
                .axes
                .iter()
                .find(|known| is_same(&known.name, axis.name.as_ref()));
            self.new_name(&axis.name, "axis", known.map(|known| &*known.name))?;
            machine.axes.push(self.axis(axis, catalogue)?);
        }
        for spindle in entry.spindle {
            let known = machine
                .spindles
                .iter()
                .find(|known| is_same(&known.name, spindle.name.as_ref()));
            self.new_name(&spindle.name, "spindle", known.map(|known| &*known.name))?;
            machine.spindles.push(self.spindle(spindle, catalogue)?);
        }
        Ok(machine)
    }

    fn axis(&self, entry: AxisEntry, catalogue: &Catalogue) -> Result<MachineAxis, Complaint> {
        let feed = self.ranged(
            "max_feed_mm_per_min",
            &entry.max_feed_mm_per_min,
            FEED_MM_PER_MIN,
        )?;
        let acceleration = self.acceleration(&entry)?;
        let jerk = self.ranged_if("max_jerk_m_s3", entry.max_jerk_m_s3.as_ref(), JERK_M_S3)?;
        let encoder = self.axis_encoder(&entry, catalogue)?;
        let counts_per_mm = match (&encoder, &entry.counts_per_mm) {
            (None, Some(counts_per_mm)) => {
                self.ranged("counts_per_mm", counts_per_mm, COUNTS_PER_MM)?
            }
            (Some(fitted), None) => fitted
                .counts_per_mm()
                .map_err(|error| self.complain(&entry.name, error.to_string()))?,
            _ => {
                return Err(self.complain(
                    &entry.name,
                    format!(
                        "axis \"{}\": expected either counts_per_mm, or encoder and travel_mm",
                        entry.name.as_ref()
                    ),
                ));
            }
        };
        let kinematics = Kinematics::new(feed, acceleration, jerk, counts_per_mm)
            .map_err(|error| self.complain(&entry.name, error.to_string()))?;
        Ok(MachineAxis {
            kinematics,
            least_overload_g: self.ranged_if(
                "least_overload_g",
                entry.least_overload_g.as_ref(),
                overload_range(),
            )?,
            encoder,
            name: entry.name.into_inner(),
            assumed: entry.assumed,
        })
    }

    fn acceleration(&self, entry: &AxisEntry) -> Result<f64, Complaint> {
        match (&entry.overload_g, &entry.acceleration_m_s2) {
            (Some(overload), None) => {
                let overload = self.ranged("overload_g", overload, overload_range())?;
                Ok(overload * PAPER_GRAVITY_M_S2)
            }
            (None, Some(acceleration)) => {
                self.ranged("acceleration_m_s2", acceleration, ACCELERATION_M_S2)
            }
            _ => Err(self.complain(
                &entry.name,
                format!(
                    "axis \"{}\": expected one of overload_g and acceleration_m_s2",
                    entry.name.as_ref()
                ),
            )),
        }
    }

    fn axis_encoder(
        &self,
        entry: &AxisEntry,
        catalogue: &Catalogue,
    ) -> Result<Option<FittedEncoder>, Complaint> {
        match (&entry.encoder, &entry.travel_mm) {
            (Some(name), Some(travel)) => {
                let travel_mm = self.ranged("travel_mm", travel, (1e-6, 1e4))?;
                self.fitted(name, entry.lines.as_ref(), travel_mm, catalogue)
                    .map(Some)
            }
            (None, None) => match &entry.lines {
                Some(lines) => Err(self.complain(
                    lines,
                    "lines without an encoder: name it, or leave them out",
                )),
                None => Ok(None),
            },
            (Some(name), None) => Err(self.complain(
                name,
                "an encoder without travel_mm, the travel of its revolution: add it",
            )),
            (None, Some(travel)) => Err(self.complain(
                travel,
                "travel_mm without an encoder: name it, or give counts_per_mm alone",
            )),
        }
    }

    fn spindle(&self, entry: SpindleEntry, catalogue: &Catalogue) -> Result<Spindle, Complaint> {
        Ok(Spindle {
            max_rpm: self.ranged("max_rpm", &entry.max_rpm, RPM)?,
            encoder: self.fitted(&entry.encoder, entry.lines.as_ref(), 0.0, catalogue)?,
            name: entry.name.into_inner(),
            assumed: entry.assumed,
        })
    }

    fn fitted(
        &self,
        name: &Spanned<String>,
        lines: Option<&Spanned<f64>>,
        travel_mm: f64,
        catalogue: &Catalogue,
    ) -> Result<FittedEncoder, Complaint> {
        let encoder = catalogue.encoder(name.as_ref()).ok_or_else(|| {
            let known: Vec<_> = catalogue
                .encoders
                .iter()
                .map(|known| &*known.name)
                .collect();
            let (name_, known) = (name.as_ref(), known.join(", "));
            self.complain(
                name,
                format!("encoder \"{name_}\" is in no catalogue; there are {known}"),
            )
        })?;
        FittedEncoder::new(encoder, lines.map(|lines| *lines.as_ref()), travel_mm).map_err(
            |message| match lines {
                Some(lines) => self.complain(lines, message),
                None => self.complain(name, message),
            },
        )
    }
}

const fn overload_range() -> (f64, f64) {
    (
        ACCELERATION_M_S2.0 / PAPER_GRAVITY_M_S2,
        ACCELERATION_M_S2.1 / PAPER_GRAVITY_M_S2,
    )
}
