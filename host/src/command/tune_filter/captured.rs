//! A capture to tune on.

use std::path::Path;

use leadscrew::edges::EdgeConfig;
use leadscrew::uncertainty::EdgeErrors;

use super::TuneFilterArgs;
use super::judge::{Judge, warm_up};
use super::sweep::Candidate;
use super::trend::{HALF, MAX_MISFIT_D, Trend};
use crate::command::map_figures::{MapFigures, TieLog};
use crate::command::span::Span;
use crate::command::{MAX_TICKS, too_long};
use crate::error::CommandError;
use crate::listening::Listening;
use crate::map_file::MapFile;
use crate::progress::Progress;
use crate::recording::Recording;
use crate::sampler::Sampler;

/// Differences of all candidates from the trend of the capture in `file`, and what became of the map.
///
/// # Errors
/// Bad usage, files that cannot be read, or a capture without steady motion.
pub(super) fn judge(
    file: &Path,
    args: &TuneFilterArgs,
    candidates: &[Candidate],
    tick_hz: f64,
) -> Result<(Vec<Judge>, Option<MapFigures>), CommandError> {
    let span = Span::new(args.from_s, args.to_s)?;
    let map = args.map.as_deref().map(MapFile::read).transpose()?;
    let recording = args.channels.read(file)?;
    let trend = Trend::of(&counts(file, &recording, tick_hz)?);
    let mut sampler = Sampler::new(&recording, tick_hz);
    let edges = EdgeConfig::new(tick_hz, sampler.timer_hz() as f64, &EdgeErrors::default())
        .map_err(|error| CommandError::Usage(error.to_string()))?;
    let configs: Vec<_> = candidates
        .iter()
        .map(|candidate| candidate.config)
        .collect();
    let mut listening = Listening::new(&configs, edges);
    if let Some(map) = &map {
        listening = listening.with_map(map.map()?);
    }
    let mut judges = vec![Judge::default(); candidates.len()];
    let longest = longest_lag(candidates);
    let first = warm_up(candidates) as usize;
    let mut progress = Progress::new("tuning", sampler.ticks());
    let mut tie = TieLog::default();
    let (mut tick, mut steady) = (0, 0);
    while let Some(capture) = sampler.next_capture() {
        // All are judged on the same ticks: those with a trend at the instants of the youngest and the oldest, and
        // throughout between them.
        let has_trend = trend.before(tick, 0.0).is_some();
        steady = if has_trend { steady + 1 } else { 0 };
        let is_judged = tick >= first && steady > longest && span.contains(tick, tick_hz);
        listening.hear(&capture, None, |index, estimate| {
            if is_judged {
                judges[index].push(&estimate, |lag| trend.before(tick, lag));
            }
        });
        tie.note(tick, &listening);
        tick += 1;
        progress.step();
    }
    if judges.iter().any(|judge| judge.ticks() == 0) {
        return Err(nothing_steady(file, trend.steady_ticks(), first));
    }
    let map = map
        .as_ref()
        .map(|map| MapFigures::new(map, tie, args.channels.z.is_some()))
        .transpose()?;
    Ok((judges, map))
}

/// Longest lag of the acceleration, ticks, rounded up.
fn longest_lag(candidates: &[Candidate]) -> usize {
    let lag = |candidate: &Candidate| candidate.config.lags().acceleration.to_num::<f64>();
    candidates.iter().map(lag).fold(0.0, f64::max).ceil() as usize
}

fn counts(file: &Path, recording: &Recording, tick_hz: f64) -> Result<Vec<i64>, CommandError> {
    let mut sampler = Sampler::new(recording, tick_hz);
    let ticks = sampler.ticks();
    if ticks > MAX_TICKS {
        return Err(too_long(file, ticks, tick_hz));
    }
    let mut counts: Vec<i64> = Vec::new();
    while let Some(capture) = sampler.next_capture() {
        let count = capture.count;
        let next = match counts.last() {
            // The counter wraps.
            Some(last) => last + i64::from(count.wrapping_sub(*last as u32).cast_signed()),
            None => i64::from(count),
        };
        counts.push(next);
    }
    Ok(counts)
}

fn nothing_steady(file: &Path, steady: usize, warm_up: usize) -> CommandError {
    CommandError::Data(format!(
        "{}: has no steady motion to judge estimators on: {steady} ticks have a trend ({} ticks of motion one way \
         that a quadratic fits to {MAX_MISFIT_D} d rms), and the slowest estimator settles in {warm_up} ticks; \
         capture a longer stretch at constant feed, choose another --from-s and --to-s, or another --tick-hz",
        file.display(),
        2 * HALF + 1,
    ))
}
