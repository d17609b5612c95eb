//! All machines in a line each, and what the catalogue has.

use leadscrew_process::plan::{Catalogue, MachinePlan};

use super::significant;
use crate::report::{figure_or_dash, text_table};

/// One line a machine.
pub fn summary(plans: &[MachinePlan]) -> String {
    let mut table = text_table(&[
        "machine\n",
        "feed\nmm/min",
        "acceleration\nm/s²",
        "jerk\nm/s³",
        "resolution\nd/mm",
        "cycle\nHz",
        "ruled by\n",
        "runs on\nstm32f4",
        "with a tick\nof, Hz",
    ]);
    for plan in plans {
        let largest = &plan.largest;
        let board = plan.boards.first();
        table.add_row([
            plan.machine.clone(),
            significant(largest.max_feed_mm_per_min(), 6),
            significant(largest.max_acceleration_m_s2(), 3),
            largest
                .max_jerk_m_s3()
                .map_or_else(|| "-".to_owned(), |jerk| significant(jerk, 3)),
            significant(largest.counts_per_mm(), 6),
            format!("{:.0}", plan.cycle.frequency_hz.ceil()),
            plan.cycle.ruled_by.name().to_owned(),
            board.map_or("-", |board| board.runs.name()).to_owned(),
            board.map_or_else(
                || "-".to_owned(),
                |board| format!("{:.0}", board.tick_hz.ceil()),
            ),
        ]);
    }
    format!(
        "{}\n\nof each machine the largest of its axes; leadscrew plan MACHINE tells all, and what is assumed\n",
        table.trim_fmt()
    )
}

/// What the catalogue has.
pub fn list(catalogue: &Catalogue) -> String {
    let mut encoders = text_table(&["encoder", "lines", "rpm", "kHz", "maker", "source"]);
    let dash = |text: &Option<String>| text.clone().unwrap_or_else(|| "-".to_owned());
    for encoder in catalogue.encoders() {
        let [least, most] = encoder.lines;
        encoders.add_row([
            encoder.name.clone(),
            if least == most {
                format!("{least}")
            } else {
                format!("{least}…{most}")
            },
            figure_or_dash(encoder.max_rpm, 0),
            figure_or_dash(encoder.max_line_hz.map(|hz| hz / 1000.0), 0),
            dash(&encoder.maker),
            dash(&encoder.source),
        ]);
    }
    let mut machines = text_table(&["machine", "axes", "spindles", "source"]);
    for machine in catalogue.machines() {
        let axes: Vec<_> = machine.axes.iter().map(|axis| &*axis.name).collect();
        let spindles: Vec<_> = machine
            .spindles
            .iter()
            .map(|spindle| &*spindle.name)
            .collect();
        machines.add_row([
            machine.name.clone(),
            axes.join(", "),
            spindles.join(", "),
            dash(&machine.source),
        ]);
    }
    format!("{}\n\n{}\n", machines.trim_fmt(), encoders.trim_fmt())
}
