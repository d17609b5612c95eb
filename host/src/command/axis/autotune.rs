//! `leadscrew --port … autotune`: the loop of an axis, made of what its drive does, tried, and kept if it is better.

use leadscrew::units::checked;
use leadscrew_client::{Axis, Kind};
use serde::Serialize;

use super::changes::{self, Changed};
use super::identify::identified;
use super::person::Person;
use crate::axis::{Follows, Guide as _, Room, TestMove, Tuning, followed_now, read_settings, tune};
use crate::axis_file;
use crate::cli::AutotuneArgs;
use crate::command::autotune::margins::MarginFigures;
use crate::command::identify;
use crate::command::{check_replaceable, print_json, write_file};
use crate::error::CommandError;

/// Longest test move, mm.
const TEST_MM: f64 = 100.0;

/// What was done.
#[derive(Serialize)]
struct Report {
    schema: &'static str,
    identification: identify::Report,
    max_feed_mm_per_min: f64,
    bandwidth_rad_per_s: f64,
    parameters: Vec<Changed>,
    margins: MarginFigures,
    predicted_peak_d: f64,
    /// Null where there was no loop.
    before: Option<Follows>,
    after: Follows,
    saved: bool,
    /// The file that was written; null if none was.
    written: Option<String>,
}

/// Runs the command.
///
/// # Errors
/// Bad usage, an axis that cannot be identified or tuned, one that does not follow better.
pub fn run(axis: &mut Axis, port: &str, args: &AutotuneArgs) -> Result<(), CommandError> {
    let asked = args
        .max_feed
        .map(|feed| checked("--max-feed", feed, 0.1, 1e6));
    let asked = asked
        .transpose()
        .map_err(|error| CommandError::Usage(format!("{error} mm/min")))?;
    if let Some(path) = &args.out {
        check_replaceable("--out", path, None)?;
    }
    let mut person = Person::new(&args.yes, args.json);
    let settings = read_settings(axis)?;
    let room = person.room(axis, &settings, &args.room)?;
    let (found, identification) = identified(axis, port, &settings, &args.bench, &mut person)?;
    person.tell(&identification.to_text());
    person.progress("looking for the loop");
    let has_map = axis.stored(Kind::EncoderMap)?.length > 0;
    let wanted = asked.unwrap_or(settings.axis.motion.max_feed_mm_per_min);
    let model = found.identified.model();
    let tuning = tune(axis, &settings, &model, wanted, has_map)?;
    let margins = MarginFigures::from(&tuning.report);
    person.tell(&format!(
        "{}\n\n{}\n",
        changes::table(&tuning.changes),
        margins.table()
    ));
    if let Some(path) = &args.out {
        let text = axis_file::dump(&tuning.settings);
        write_file(path, |file| file.write_all(text.as_bytes()))?;
    }
    let test = test_move(axis, &room, &tuning)?;
    person.agreed(&format!(
        "These {} parameters are set, and tried by moves from {:.1} to {:.1} mm and back with {} mm/min, loop closed; where the axis \
         follows worse than before, or not at all, all is set as it was. Go on?",
        tuning.changes.len(),
        test.from_mm,
        test.to_mm,
        test.feed_mm_per_min
    ))?;
    let before_feed = test
        .feed_mm_per_min
        .min(settings.axis.motion.max_feed_mm_per_min);
    let before_test = TestMove {
        feed_mm_per_min: before_feed,
        ..test
    };
    let before = followed_now(axis, &settings, &before_test)?;
    let after = tuning.try_on(axis, &test, before.as_ref())?;
    person.tell(&follow_text(before.as_ref(), &after));
    let saved = person.agree(
        "Save all parameters in the axis? (Else they are in force until it is switched off.)",
        true,
    )?;
    if saved {
        axis.save_parameters()?;
        person.tell("saved");
    }
    if args.json {
        return print_json(&Report {
            schema: "leadscrew/autotune-axis/1",
            identification,
            max_feed_mm_per_min: tuning.settings.axis.motion.max_feed_mm_per_min,
            bandwidth_rad_per_s: tuning.report.bandwidth_rad_per_s,
            parameters: tuning.changes.iter().map(Changed::from).collect(),
            margins,
            predicted_peak_d: tuning.report.trial.peak_d,
            before,
            after,
            saved,
            written: args.out.as_ref().map(|path| path.display().to_string()),
        });
    }
    Ok(())
}

/// A move of up to 100 mm at the largest feed.
fn test_move(axis: &mut Axis, room: &Room, tuning: &Tuning) -> Result<TestMove, CommandError> {
    let at_mm = axis.status()?.position_mm;
    let way_mm = TEST_MM.min(room.length_mm());
    let (from_mm, to_mm) = room.place(at_mm, way_mm, "the test move", "State more room")?;
    Ok(TestMove {
        from_mm,
        to_mm,
        feed_mm_per_min: tuning.settings.axis.motion.max_feed_mm_per_min,
        passes: 2,
    })
}

fn follow_text(before: Option<&Follows>, after: &Follows) -> String {
    let told = |follows: &Follows| {
        format!(
            "{:.1} d at most, {:.2} d rms, {:.1} d standing",
            follows.peak_d, follows.rms_d, follows.standing_d
        )
    };
    let before = before.map_or_else(|| "no loop".to_owned(), told);
    format!(
        "following error before: {before}\nfollowing error after:  {}",
        told(after)
    )
}
