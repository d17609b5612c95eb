//! The program that touches a part: for LinuxCNC, with the log that [`super::log`] reads.

use std::fmt::Write;

use leadscrew_nc::source::Complaint;

use super::{Feature, Kind, Part, Planned};
use crate::metrology::touch::{Axis, vector3};

/// Writes the program. `text` is that of the part's file, for complaints.
///
/// Every touch: along the safe axis up to the safe place, across, down, the touch (`G38.2`) at its own feed and back. Coordinates
/// are those of the work offset that is active, and of the centre of the stylus.
///
/// # Errors
/// No safe place, nothing to touch, or a touch that cannot be reached from the safe place.
pub fn write(text: &str, part: &Part) -> Result<String, Complaint> {
    let plan = &part.program;
    let touched: Vec<&Feature> = part
        .features
        .iter()
        .filter(|feature| feature.is_touched())
        .collect();
    let nothing = |message: &str| Err(Complaint::at(text, &(0..0), message));
    if touched.is_empty() {
        return nothing("the part has nothing to touch");
    }
    let Some(safe) = plan.safe_mm else {
        return nothing(
            "[program] safe_mm is missing: the coordinate where the probe is free to move across",
        );
    };
    let mut writer = Writer {
        part,
        safe,
        program: String::new(),
    };
    writer.line("(probing program: stylus radius is taken off by the evaluation, not here)");
    writer.line("G17 G21 G40 G90 G94");
    writer.line("G8 (X in radius)");
    writer.line(&format!("(PROBEOPEN {})", plan.log));
    writer.go(&[(plan.safe_axis, safe)]);
    for feature in touched {
        writer.feature(text, feature)?;
    }
    writer.line("(PROBECLOSE)");
    writer.line("M2");
    Ok(writer.program)
}

struct Writer<'a> {
    part: &'a Part,
    safe: f64,
    program: String,
}

impl Writer<'_> {
    fn line(&mut self, line: &str) {
        self.program.push_str(line);
        self.program.push('\n');
    }

    /// A move between touches.
    fn go(&mut self, words: &[(Axis, f64)]) {
        let words = words_of(words);
        let feed = self.part.program.travel_mm_per_min;
        let _ = writeln!(self.program, "G1{words} F{feed}");
    }

    fn feature(&mut self, text: &str, feature: &Feature) -> Result<(), Complaint> {
        if feature.planned.is_empty() {
            let message =
                "its touches are not in the part's file: give points, or angles and sections";
            return Err(feature.complain(text, message));
        }
        self.line(&format!("({})", ascii(&feature.name)));
        for planned in &feature.planned {
            let room = self.room(text, feature, planned)?;
            self.touch(planned, room).map_err(|message| {
                feature.complain(text, format!("point {}: {message}", planned.point))
            })?;
        }
        Ok(())
    }

    /// How far a touch may begin from the surface, mm.
    fn room(&self, text: &str, feature: &Feature, planned: &Planned) -> Result<f64, Complaint> {
        let plan = &self.part.program;
        let (nominal, inside) = match feature.kind {
            Kind::Circle { nominal, inside }
            | Kind::Axis {
                nominal, inside, ..
            }
            | Kind::Turned { nominal, inside } => (nominal, inside),
            _ => return Ok(plan.approach_mm),
        };
        if !inside {
            return Ok(plan.approach_mm);
        }
        if nominal.axis != plan.safe_axis {
            let message = format!(
                "its axis is {}, and the probe comes along {}: it cannot be reached",
                nominal.axis.name(),
                plan.safe_axis.name()
            );
            return Err(feature.complain(text, message));
        }
        // A hole may narrow: by its radius where it is touched.
        let room = nominal.radius_at(planned.nominal) - self.part.probe.radius_mm;
        if room <= 0.0 {
            let message = format!(
                "the stylus, radius {} mm, does not go into it at point {}",
                self.part.probe.radius_mm, planned.point
            );
            return Err(feature.complain(text, message));
        }
        Ok(plan.approach_mm.min(room))
    }

    fn touch(&mut self, planned: &Planned, room: f64) -> Result<(), String> {
        let plan = &self.part.program;
        let (radius, axis) = (self.part.probe.radius_mm, plan.safe_axis);
        let normal = vector3(planned.normal);
        let at =
            |distance: f64| -> [f64; 3] { (vector3(planned.nominal) + normal * distance).into() };
        let (start, end) = (at(radius + room), at(radius - plan.overtravel_mm));
        let height = axis.index();
        if normal[height] < -1e-9 {
            return Err(format!(
                "its surface looks away from safe_mm along {}",
                axis.name()
            ));
        }
        if start[height] > self.safe || planned.nominal[height] >= self.safe {
            let message = format!(
                "it begins at {} {:.3} mm, above safe_mm {}",
                axis.name(),
                start[height],
                self.safe
            );
            return Err(message);
        }
        let across: Vec<(Axis, f64)> = Axis::ALL
            .into_iter()
            .filter(|other| *other != axis)
            .map(|other| (other, start[other.index()]))
            .collect();
        self.go(&across);
        self.go(&[(axis, start[height])]);
        let moved: Vec<(Axis, f64)> = Axis::ALL
            .into_iter()
            .filter(|axis| normal[axis.index()].abs() > 1e-9)
            .map(|axis| (axis, end[axis.index()]))
            .collect();
        let feed = plan.feed_mm_per_min;
        let words = words_of(&moved);
        let _ = writeln!(self.program, "G38.2{words} F{feed}");
        let back: Vec<(Axis, f64)> = moved
            .iter()
            .map(|(axis, _)| (*axis, start[axis.index()]))
            .collect();
        self.go(&back);
        self.go(&[(axis, self.safe)]);
        Ok(())
    }
}

fn words_of(words: &[(Axis, f64)]) -> String {
    let word =
        |(axis, value): &(Axis, f64)| format!(" {}{:.4}", axis.name().to_uppercase(), value + 0.0);
    words.iter().map(word).collect()
}

/// Comments of programs are plain.
fn ascii(name: &str) -> String {
    name.chars()
        .map(|letter| if letter.is_ascii() { letter } else { '_' })
        .collect()
}
