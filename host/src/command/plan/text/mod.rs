//! The reports for people: of one machine, of [`catalogue`]s in a line each.

mod catalogue;

use std::fmt::Write;

use leadscrew_process::plan::{AxisPlan, EncoderPlan, MachinePlan, RationalCycle, SpindlePlan};

pub use catalogue::{list, summary};

use crate::report::{figure_or_dash, text_table};

/// All figures of a machine.
pub fn machine(plan: &MachinePlan) -> String {
    let mut text = plan.machine.clone();
    if let Some(source) = &plan.source {
        let _ = write!(text, " ({source})");
    }
    let _ = write!(text, "\n\n{}\n\n{}\n", axes(plan), encoders(plan));
    for axis in &plan.axes {
        let _ = write!(text, "\n{}", contours(plan, axis));
    }
    let _ = write!(
        text,
        "\n{}\n{}\n\n{}",
        cycles(plan),
        verdict(plan),
        boards(plan)
    );
    let assumed = |name: &str, assumed: &Option<String>| {
        let assumed = assumed.as_ref()?;
        Some(format!("assumed of {name}: {assumed}\n"))
    };
    let of_axes = plan
        .axes
        .iter()
        .filter_map(|axis| assumed(&axis.name, &axis.assumed));
    let of_spindles = plan
        .spindles
        .iter()
        .filter_map(|spindle| assumed(&spindle.name, &spindle.assumed));
    let notes: String = of_axes.chain(of_spindles).collect();
    if notes.is_empty() {
        text
    } else {
        text + "\n" + &notes
    }
}

fn axes(plan: &MachinePlan) -> String {
    let mut table = text_table(&[
        "axis\n",
        "feed\nmm/min",
        "acceleration\nm/s²",
        "overload\ng",
        "jerk\nm/s³",
        "resolution\nd/mm",
        "discrete\nµm",
        "velocity\nd/tick",
        "acceleration\nd/tick²",
        "jerk\nd/tick³",
    ]);
    for axis in &plan.axes {
        let limits = &axis.kinematics;
        let overload = match axis.least_overload_g {
            Some(least) => format!(
                "{}…{}",
                significant(least, 3),
                significant(axis.overload_g, 3)
            ),
            None => significant(axis.overload_g, 3),
        };
        table.add_row([
            axis.name.clone(),
            significant(limits.max_feed_mm_per_min(), 6),
            significant(limits.max_acceleration_m_s2(), 4),
            overload,
            limits
                .max_jerk_m_s3()
                .map_or_else(|| "-".to_owned(), |jerk| significant(jerk, 4)),
            significant(limits.counts_per_mm(), 6),
            significant(1000.0 * axis.discrete_mm, 4),
            significant(axis.velocity_d_per_tick, 4),
            significant(axis.acceleration_d_per_tick2, 4),
            axis.jerk_d_per_tick3
                .map_or_else(|| "-".to_owned(), |jerk| significant(jerk, 3)),
        ]);
    }
    format!(
        "{}\nvelocities by ticks of {} Hz",
        table.trim_fmt(),
        plan.tick_hz
    )
}

fn encoders(plan: &MachinePlan) -> String {
    let mut table = text_table(&[
        "encoder of\n",
        "type\n",
        "lines\n",
        "speed\nrpm",
        "a channel\nkHz",
        "edges\n1/ms",
        "limit\nkHz",
        "largest number\nof lines",
        "within\n",
    ]);
    let mut row = |name: &str, encoder: &EncoderPlan| {
        let limit = significant(encoder.max_line_hz / 1000.0, 4);
        table.add_row([
            name.to_owned(),
            encoder.name.clone().unwrap_or_else(|| "-".to_owned()),
            figure_or_dash(encoder.lines, 0),
            figure_or_dash(encoder.rpm, 0),
            significant(encoder.line_hz / 1000.0, 4),
            significant(encoder.edge_hz / 1000.0, 4),
            if encoder.is_max_line_own {
                limit
            } else {
                format!("{limit}?")
            },
            figure_or_dash(encoder.largest_lines.map(f64::floor), 0),
            if encoder.is_within { "yes" } else { "no" }.to_owned(),
        ]);
    };
    for axis in &plan.axes {
        row(&axis.name, &axis.encoder);
    }
    for SpindlePlan { name, encoder, .. } in &plan.spindles {
        row(name, encoder);
    }
    let is_asked = |encoder: &EncoderPlan| !encoder.is_max_line_own;
    let asked = plan.axes.iter().any(|axis| is_asked(&axis.encoder))
        || plan
            .spindles
            .iter()
            .any(|spindle| is_asked(&spindle.encoder));
    let note = if asked {
        "\n? not known of the encoder: --line-khz"
    } else {
        ""
    };
    format!("{}{note}", table.trim_fmt())
}

fn contours(plan: &MachinePlan, axis: &AxisPlan) -> String {
    let mut table = text_table(&[
        "radius\nmm",
        "by acceleration\nmm/min",
        "by jerk\nmm/min",
        "feed\nmm/min",
        "limited by\n",
        "step\nd",
        "chord error\nd",
        "cycle\nHz",
    ]);
    for contour in &axis.contours {
        table.add_row([
            significant(contour.radius_mm, 6),
            format!("{:.0}", contour.feed_by_acceleration_mm_per_min),
            figure_or_dash(contour.feed_by_jerk_mm_per_min, 0),
            format!("{:.0}", contour.feed_mm_per_min),
            contour.limit.name().to_owned(),
            significant(contour.step_d, 4),
            contour
                .chord_error_d
                .map_or_else(|| "-".to_owned(), |error| significant(error, 3)),
            significant(contour.frequency_hz, 4),
        ]);
    }
    let crossover = match axis.crossover_radius_mm {
        Some(radius) => format!(
            "jerk rules below R {} mm, acceleration above",
            significant(radius, 3)
        ),
        None => "no jerk is watched".to_owned(),
    };
    format!(
        "axis {}: {crossover}; the largest feed is reached at R {} mm, by {}\n{}\nstep and chord error of a tick of {} Hz\n",
        axis.name,
        significant(axis.full_feed_radius_mm, 3),
        axis.full_feed_limit.name(),
        table.trim_fmt(),
        plan.tick_hz
    )
}

fn cycles(plan: &MachinePlan) -> String {
    let mut table = text_table(&[
        "rational cycle of\n",
        "frequency\nHz",
        "ruled by\n",
        "at radius\nmm",
        "and feed\nmm/min",
        "acceleration alone\nHz",
    ]);
    let mut row = |name: &str, cycle: &RationalCycle| {
        table.add_row([
            name.to_owned(),
            format!("{:.0}", cycle.frequency_hz.ceil()),
            cycle.ruled_by.name().to_owned(),
            significant(cycle.radius_mm, 3),
            format!("{:.0}", cycle.feed_mm_per_min),
            format!("{:.0}", cycle.closed_form_hz),
        ]);
    };
    for axis in &plan.axes {
        row(&axis.name, &axis.cycle);
    }
    if plan.axes.len() > 1 {
        row("all together", &plan.cycle);
    }
    table.trim_fmt()
}

fn verdict(plan: &MachinePlan) -> String {
    let needed = plan.cycle.frequency_hz;
    let tick_hz = plan.tick_hz;
    let limit = plan.cycle.ruled_by.name();
    let allowed = plan.allowed_d;
    let than = if tick_hz >= needed {
        "enough"
    } else {
        "too slow"
    };
    format!(
        "{:.0} Hz keep the chord error to {allowed} d on every contour, ruled by {limit}; {tick_hz} Hz are {than}",
        needed.ceil()
    )
}

fn boards(plan: &MachinePlan) -> String {
    let mut text = String::new();
    for verdict in &plan.boards {
        let _ = writeln!(
            text,
            "{} at {:.0} Hz: {} ({})",
            verdict.board,
            verdict.tick_hz.ceil(),
            verdict.runs.name(),
            verdict.why
        );
    }
    text
}

/// A number with so many significant digits, without idle zeros.
fn significant(value: f64, digits: i32) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    let place = digits - 1 - value.abs().log10().floor() as i32;
    let text = format!("{value:.*}", usize::try_from(place).unwrap_or(0));
    match text.split_once('.') {
        Some(_) => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        None => text,
    }
}
