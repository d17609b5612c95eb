//! The estimators on recorded counts.

use leadscrew::estimator::{Estimate, EstimatorConfig};
use leadscrew::hal::Capture;
use leadscrew::scope::Signal;
use leadscrew::units::Command;

use super::{Desk, ENABLED, Lacking};
use crate::listening::Listening;
use crate::simulation::all_estimators;
use crate::statistics::Spread;

/// Most ticks at the beginning that are not compared: the windows fill.
const WARM_UP: usize = 200;

/// An estimator on the recorded counts.
#[derive(Clone, Debug)]
pub struct Compared {
    /// Which.
    pub config: EstimatorConfig,
    /// It is the one that the axis was set to.
    pub is_the_axis_s: bool,
    /// On the axis it has edge times as well, which are not recorded.
    pub lacks_edges: bool,
    /// What it says of each tick.
    pub estimates: Vec<Estimate>,
    /// Its velocity less that of the axis, bits; none where that was not recorded.
    pub difference: Option<Spread>,
}

/// Runs the estimators that go by counts, that of the axis first whatever it goes by, and compares.
///
/// # Errors
/// What the recording lacks.
pub fn estimators(desk: &Desk<'_>) -> Result<Vec<Compared>, Lacking> {
    let [counts] = desk.need([Signal::Count])?;
    let recording = &desk.recorded.recording;
    let own = *desk
        .config
        .estimators
        .of(desk.config.estimators.paths().display);
    let others = all_estimators();
    // What goes by the times of edges has nothing to go by.
    let others = others
        .into_iter()
        .filter(|one| one.name() != own.name() && !one.reads_edges());
    let configs: Vec<_> = std::iter::once(own).chain(others).collect();
    let mut listening = Listening::new(&configs, desk.config.edges);
    let mut estimates = vec![Vec::with_capacity(counts.len()); configs.len()];
    let tick_clocks = 1_000_000_u32;
    for (tick, &count) in counts.iter().enumerate() {
        let capture = Capture {
            count: count as u32,
            sampled_at: (tick as u32).wrapping_mul(tick_clocks),
            ..Capture::default()
        };
        listening.hear(&capture, told(desk, tick), |index, estimate| {
            estimates[index].push(estimate);
        });
    }
    let recorded = recording.bits(Signal::Velocity);
    let compared = configs.into_iter().zip(estimates);
    Ok(compared
        .enumerate()
        .map(|(place, (config, estimates))| Compared {
            config,
            is_the_axis_s: place == 0,
            lacks_edges: config.reads_edges(),
            difference: recorded.map(|recorded| difference(&estimates, recorded)),
            estimates,
        })
        .collect())
}

/// What the drive was told for the tick just past, where that was recorded.
fn told(desk: &Desk<'_>, tick: usize) -> Option<Command> {
    let before = tick.checked_sub(1)?;
    let recording = &desk.recorded.recording;
    let flags = *recording.bits(Signal::Flags)?.get(before)?;
    let command = *recording.bits(Signal::Command)?.get(before)?;
    (flags & ENABLED != 0).then(|| Command::from_bits(command as i32))
}

fn difference(estimates: &[Estimate], recorded: &[i64]) -> Spread {
    let warm_up = WARM_UP.min(recorded.len() / 4);
    let pairs = estimates.iter().zip(recorded).skip(warm_up);
    pairs
        .map(|(estimate, recorded)| f64::from(estimate.velocity.to_bits()) - *recorded as f64)
        .collect()
}
