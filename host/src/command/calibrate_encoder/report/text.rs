//! The report for people.

use std::fmt::Write;

use super::{Report, Waves};
use crate::report::{figure_or_dash, text_table};

impl Waves {
    const NAMES: [&'static str; 6] = [
        "once a revolution",
        "twice",
        "3 to 10 times",
        "11 to 32 times",
        "shorter, line by line",
        "edges within a line",
    ];

    const fn figures(&self) -> [f64; 6] {
        [
            self.first,
            self.second,
            self.third_to_tenth,
            self.eleventh_to_32nd,
            self.lines,
            self.edges,
        ]
    }
}

impl Report {
    /// The report for people.
    pub(in crate::command::calibrate_encoder) fn to_text(&self) -> String {
        let mut text = format!(
            "{}: {} bytes, {} edges a revolution, {}\n\n{}\n\n{}\n\n",
            self.map,
            self.map_bytes,
            self.edges_per_rev,
            self.form,
            self.run_table(),
            self.wave_table()
        );
        self.write_findings(&mut text);
        text
    }

    fn run_table(&self) -> String {
        let mut table = text_table(&[
            "run",
            "from\ns",
            "to\ns",
            "direction\n",
            "speed\nd/tick",
            "speed\nrpm",
            "revolutions\naveraged",
            "noise\nof a pass, d",
            "file\n",
        ]);
        for (number, run) in (1..).zip(&self.runs) {
            table.add_row([
                format!("{number}"),
                format!("{:.2}", run.from_s),
                format!("{:.2}", run.to_s),
                run.direction.to_owned(),
                format!("{:.2}", run.speed),
                format!("{:.1}", run.rpm),
                format!("{}", run.revolutions),
                format!("{:.4}", run.pass_noise),
                run.file.clone(),
            ]);
        }
        table.trim_fmt()
    }

    fn wave_table(&self) -> String {
        let mut table = text_table(&[
            "errors, d rms",
            "without\na map",
            "left on the last run\nby a map of the others",
            "halves of it\nagainst each other",
        ]);
        let halves = self.runs.last().map(|run| run.halves.figures());
        let after = self.errors_after.map(|after| after.figures());
        for (row, (name, before)) in Waves::NAMES
            .iter()
            .zip(self.errors_before.figures())
            .enumerate()
        {
            table.add_row([
                (*name).to_owned(),
                format!("{before:.4}"),
                figure_or_dash(after.map(|after| after[row]), 4),
                // Halves are compared in long waves.
                figure_or_dash(halves.map(|halves| halves[row]).filter(|_| row < 4), 4),
            ]);
        }
        table.trim_fmt()
    }

    fn write_findings(&self, text: &mut String) {
        // Writing to a string does not fail.
        let mut put = |line: String| {
            let _ = writeln!(text, "{line}");
        };
        for (name, phases) in [
            ("forward", self.phases.forward),
            ("backward", self.phases.backward),
        ] {
            match phases {
                Some([first, second, third, fourth]) => put(format!(
                    "phases {name}: {first:.4} {second:.4} {third:.4} {fourth:.4} d"
                )),
                None => put(format!(
                    "phases {name}: no run, taken from the other direction"
                )),
            }
        }
        if let Some(hysteresis) = self.hysteresis_a_less_b {
            put(format!(
                "hysteresis of A less that of B: {hysteresis:.4} d; what both have in common cannot be seen"
            ));
        }
        if let Some(found) = &self.disagreement {
            put(format!(
                "runs disagree most at {} cycles a revolution: run {} by {:.4} d",
                found.cycles_per_rev, found.run, found.difference
            ));
        }
        let residual = &self.residual;
        put(format!(
            "the map leaves: edges {:.4} d, slope {:.1e} d/d, curvature {:.1e} 1/d; noise of a pass {:.4} d and {:.0} ns",
            residual.edges,
            residual.slope,
            residual.curvature,
            residual.noise_place,
            1e9 * residual.noise_time
        ));
        for left in &self.not_used {
            put(format!(
                "not used: {:.1} revolutions from {:.2} to {:.2} s of {}: {}",
                left.revolutions, left.from_s, left.to_s, left.file, left.why
            ));
        }
        put(format!("note: {}", self.not_separated));
    }
}
