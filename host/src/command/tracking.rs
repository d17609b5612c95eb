//! `leadscrew tracking`: how well the axis follows, beside the controller that most retrofits use.

use serde::Serialize;

use super::{print, print_json};
use crate::cli::TrackingArgs;
use crate::error::CommandError;
use crate::progress::Progress;
use crate::tracking::linuxcnc::hand::{self, Manner};
use crate::tracking::{Figures, TrackingError, figures};

/// The figures with what they are.
#[derive(Serialize)]
struct Report {
    schema: &'static str,
    units: Units,
    /// Figures that are reached, and all that are judged.
    reached: usize,
    judged: usize,
    #[serde(flatten)]
    figures: Figures,
}

#[derive(Serialize)]
struct Units {
    error: &'static str,
    feed: &'static str,
    ratio: &'static str,
}

/// Runs the command.
///
/// # Errors
/// Standard output that cannot be written.
pub fn run(args: &TrackingArgs) -> Result<(), CommandError> {
    let failed = |error: TrackingError| CommandError::Data(error.to_string());
    if args.tune_linuxcnc {
        return print(&tuned_anew().map_err(failed)?);
    }
    let figures = {
        let _measuring = Progress::endless("measuring");
        figures().map_err(failed)?
    };
    if args.json {
        let (reached, judged) = figures.score();
        print_json(&Report {
            schema: "leadscrew/tracking/1",
            units: Units {
                error: "d",
                feed: "mm/min",
                ratio: "our peak over the peer's",
            },
            reached,
            judged,
            figures,
        })
    } else {
        print(&figures.to_text())
    }
}

/// Searches the gains of the peer's hand tunings, as the tables have them.
fn tuned_anew() -> Result<String, TrackingError> {
    let _searching = Progress::endless("searching");
    let mut text = String::new();
    for manner in Manner::ALL {
        let tuned = hand::search(&hand::lessons(manner)?, manner)?;
        text += &format!(
            "{manner:?}: peak {:.1} d\n{:#?}\n",
            tuned.cost, tuned.params
        );
    }
    Ok(text)
}
