//! `leadscrew --port … calibrate-encoder`: the map of an axis's encoder, learned by the axis.

use leadscrew::calibration::NOT_SEPARATED;
use leadscrew_client::{Axis, Learned};
use serde::Serialize;

use super::person::Person;
use crate::axis::{
    Feeds, Guide as _, LearnedEncoder, forget_learning, keep_map, learn_encoder, read_settings,
};
use crate::cli::CalibrateEncoderArgs;
use crate::command::print_json;
use crate::error::CommandError;
use crate::report::text_table;

/// What was learned.
#[derive(Serialize)]
struct Report {
    schema: &'static str,
    edges_per_rev: u32,
    feeds_mm_per_min: [f64; 2],
    revolutions: u32,
    /// Rms of what stays without a map, d: once a revolution, twice, 3 to 10, 11 to 32 times, lines, edges.
    errors: [f64; 6],
    disagreement_d: f64,
    disagreement_order: u32,
    residual_edge_d: f64,
    residual_slope: f64,
    residual_curvature_per_d: f64,
    velocity_ripple_before: f64,
    velocity_ripple_after: f64,
    map_bytes: u32,
    saved: bool,
    not_separated: &'static str,
}

const BANDS: [&str; 6] = [
    "once a revolution",
    "twice",
    "3 to 10 times",
    "11 to 32 times",
    "shorter, line by line",
    "edges within a line",
];

/// Runs the command.
///
/// # Errors
/// Bad usage, too little room, an encoder that cannot be learned.
pub fn run(axis: &mut Axis, args: &CalibrateEncoderArgs) -> Result<(), CommandError> {
    if !args.files.is_empty() {
        return Err(CommandError::Usage(
            "captures and an axis: leave the files, or --port".to_owned(),
        ));
    }
    let mut person = Person::new(&args.yes, args.json);
    let settings = read_settings(axis)?;
    let room = person.room(axis, &settings, &args.room)?;
    let asked = match args.feeds.as_deref() {
        Some(&[one, other]) => Some([one, other]),
        _ => None,
    };
    let at_mm = axis.status()?.position_mm;
    let feeds = Feeds::plan(&settings, &room, at_mm, args.revolutions, asked)?;
    if feeds.revolutions < args.revolutions / 4 * 4 {
        person.tell(&format!(
            "there is room for {} revolutions in one go, {} were asked for: the map is noisier by {:.0} %",
            feeds.revolutions,
            args.revolutions,
            100.0 * (f64::from(args.revolutions) / f64::from(feeds.revolutions)).sqrt() - 100.0
        ));
    }
    person.agreed(&format!(
        "To learn the encoder {feeds} The loop is soft meanwhile, so that it does not follow the errors that are to be learned. Go on?"
    ))?;
    let learned = learn_encoder(axis, &settings, &feeds, &mut |text| person.progress(text));
    if learned.is_err() {
        forget_learning(axis);
    }
    let learned = learned?;
    person.tell(&text(&feeds, &learned));
    let saved = person.agree(
        "The map is in use. Save it in the axis? (Else it is in use until the axis is switched off.)",
        true,
    )?;
    if saved {
        keep_map(axis, &settings, &learned.learned)?;
        person.tell("saved; identify and tune the axis anew to make use of it: leadscrew autotune");
    }
    if args.json {
        return print_json(&Report::new(&feeds, &learned, saved));
    }
    Ok(())
}

const fn bands(learned: &Learned) -> [f64; 6] {
    let errors = &learned.errors;
    [
        errors.first,
        errors.second,
        errors.third_to_tenth,
        errors.eleventh_to_32nd,
        errors.lines,
        errors.edges,
    ]
}

impl Report {
    fn new(feeds: &Feeds, found: &LearnedEncoder, saved: bool) -> Self {
        let learned = &found.learned;
        Self {
            schema: "leadscrew/calibrate-encoder-axis/1",
            edges_per_rev: feeds.edges,
            feeds_mm_per_min: feeds.feeds_mm_per_min,
            revolutions: feeds.revolutions,
            errors: bands(learned),
            disagreement_d: learned.disagreement.difference_d,
            disagreement_order: learned.disagreement.order,
            residual_edge_d: learned.residual.edge_sigma_d,
            residual_slope: learned.residual.slope,
            residual_curvature_per_d: learned.residual.curvature_per_d,
            velocity_ripple_before: found.ripple.before,
            velocity_ripple_after: found.ripple.after,
            map_bytes: learned.length,
            saved,
            not_separated: NOT_SEPARATED,
        }
    }
}

fn text(feeds: &Feeds, found: &LearnedEncoder) -> String {
    let learned = &found.learned;
    let mut table = text_table(&["errors of the encoder", "d rms"]);
    for (name, error) in BANDS.iter().zip(bands(learned)) {
        table.add_row([(*name).to_owned(), format!("{error:.4}")]);
    }
    format!(
        "{}\nruns disagree most at {} cycles a revolution, by {:.4} d\n\
         the map ({} bytes) leaves {:.4} d of an edge, a slope of {:.1e} d/d\n\
         velocity at {:.0} mm/min trembles by {:.4} d/tick rms without the map, by {:.4} with it\n\
         note: {NOT_SEPARATED}",
        table.trim_fmt(),
        learned.disagreement.order,
        learned.disagreement.difference_d,
        learned.length,
        learned.residual.edge_sigma_d,
        learned.residual.slope,
        feeds.feeds_mm_per_min[1],
        found.ripple.before,
        found.ripple.after,
    )
}
