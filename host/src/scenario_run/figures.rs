//! Figures of a run.

use leadscrew::probe::Report;
use leadscrew::supervisor::{Fault, FaultSet, FirstFault, State};
use leadscrew_hal_mock::invariants::Violation;
use leadscrew_hal_mock::scenario::{Action, Timed};

use super::{Record, Tick};
use crate::scenario_file::expect::Figure;
use crate::statistics::Spread;

/// Time after a motion from which on the axis has to stand, s.
const SETTLED_S: f64 = 0.1;
/// Time after a motion from which on the carriage is where it is to be: compensation that came into force has, s.
const PLACED_S: f64 = 1.0;
/// The shaft stands if it does not leave 1 d for so long, s.
const STANDING_S: f64 = 0.05;

/// Figures of a run.
#[derive(Clone, Debug, Default)]
pub struct Figures {
    /// Following error while under control and without a fault, d.
    pub following: Spread,
    /// When it was largest, tick.
    pub peak_tick: usize,
    /// Following error from 0.1 s after each motion, d.
    pub standing: Spread,
    /// Velocity shown less that of the shaft, while under control and without a fault, d/tick.
    pub shown_velocity: Spread,
    /// Carriage less reported position at rest since the origin is known: smallest and largest, d.
    pub off: Option<(f64, f64)>,
    /// Setpoint at the end, from the start, mm.
    pub final_position_mm: f64,
    /// Farthest positions of the shaft, from the start, mm.
    pub travel_mm: (f64, f64),
    /// Largest magnitude of the output, of full command.
    pub output_peak: f64,
    /// Actions that were refused.
    pub refused: usize,
    /// Warnings of the run.
    pub warnings: FaultSet,
    /// What each fault led to.
    pub stops: Vec<Stop>,
    /// The first rule that holds in every run and did not in this.
    pub violation: Option<Violation>,
    /// State at the end.
    pub final_state: State,
    /// What the probe came to.
    pub probe: Report,
    /// How far the axis went beyond the last contact, mm.
    pub overtravel_mm: Option<f64>,
}

/// A fault and what it led to.
#[derive(Clone, Copy, Debug)]
pub struct Stop {
    /// The fault.
    pub fault: Fault,
    /// What was found and where the axis was; `None` if it was not noted.
    pub first: Option<FirstFault>,
    /// The tick in which it was found.
    pub tick: usize,
    /// Since the last trouble that began: s, and way of the shaft, mm; `None` without any trouble.
    pub detected: Option<(f64, f64)>,
    /// Ticks from the fault to zero output; `None` if there was none.
    pub zero_output_ticks: Option<usize>,
    /// From the fault to standstill: s, and way of the shaft, mm; `None` if it did not stand until the end.
    pub stopped: Option<(f64, f64)>,
}

impl Figures {
    /// Figures of `record`, whose actions were those of `timeline`.
    #[must_use]
    pub fn new(record: &Record, timeline: &[Timed]) -> Self {
        let mut figures = Self {
            refused: record
                .actions
                .iter()
                .filter(|happening| happening.refused.is_some())
                .count(),
            stops: stops(record, timeline),
            violation: record.violation,
            probe: record.probe,
            overtravel_mm: record
                .probe
                .touch
                .map(|touch| touch.overtravel.to_num::<f64>() / record.counts_per_mm),
            ..Self::default()
        };
        let (Some(first), Some(last)) = (record.ticks.first(), record.ticks.last()) else {
            return figures;
        };
        let [settled, placed] = [SETTLED_S, PLACED_S].map(|time| (time * record.tick_hz) as usize);
        let mut moved_at = 0;
        for (tick, found) in record.ticks.iter().enumerate() {
            let outputs = &found.outputs;
            if outputs.moving || !is_controlled(found) {
                moved_at = tick;
            }
            let error: f64 = outputs.following_error.to_num();
            if is_controlled(found) {
                if error.abs() > figures.following.peak() {
                    figures.peak_tick = tick;
                }
                figures.following.push(error);
                let shown: f64 = outputs.estimate.velocity.to_num();
                figures.shown_velocity.push(shown - found.shaft.velocity);
                if tick - moved_at > settled {
                    figures.standing.push(error);
                }
                if found.homed && tick - moved_at > placed {
                    let off = found.carriage - outputs.reported.to_num::<f64>();
                    let (low, high) = figures.off.unwrap_or((off, off));
                    figures.off = Some((low.min(off), high.max(off)));
                }
            }
            let way = (found.shaft.position - first.shaft.position) / record.counts_per_mm;
            let (low, high) = figures.travel_mm;
            figures.travel_mm = (low.min(way), high.max(way));
            figures.warnings = figures.warnings.union(outputs.warnings);
            let output: f64 = outputs.command.to_num();
            figures.output_peak = figures.output_peak.max(output.abs());
        }
        figures.final_state = last.outputs.state;
        let setpoint = |tick: &Tick| tick.outputs.setpoint.position.to_num::<f64>();
        figures.final_position_mm = (setpoint(last) - setpoint(first)) / record.counts_per_mm;
        figures
    }

    /// The value of a figure; `None` where the run has none.
    #[must_use]
    pub fn value(&self, figure: Figure) -> Option<f64> {
        let stop = self.stops.first();
        match figure {
            Figure::FollowingErrorPeak => self.following.peak_of_some(),
            Figure::FollowingErrorRms => self.following.rms_of_some(),
            Figure::StandingError => self.standing.peak_of_some(),
            Figure::ShownVelocity => self.shown_velocity.rms_of_some(),
            Figure::Positioning => self.off.map(|(low, high)| high - low),
            Figure::FinalPosition => Some(self.final_position_mm),
            Figure::Travel => Some(self.travel_mm.1.max(-self.travel_mm.0)),
            Figure::Detected => Some(stop?.detected?.0),
            Figure::DetectedWay => Some(stop?.detected?.1),
            Figure::ZeroOutput => Some(stop?.zero_output_ticks? as f64),
            Figure::Stopped => Some(stop?.stopped?.0),
            Figure::StoppedWay => Some(stop?.stopped?.1),
            Figure::OutputPeak => Some(self.output_peak),
            Figure::Refused => Some(self.refused as f64),
            Figure::Touches => Some(self.probe.touches.into()),
            Figure::Glitches => Some(self.probe.glitches.into()),
            Figure::Overtravel => self.overtravel_mm,
            Figure::TouchSigma => {
                let touch = self.probe.touch?;
                Some(touch.variance.to_num::<f64>().sqrt())
            }
        }
    }
}

/// True while the loop is closed and nothing has gone wrong.
fn is_controlled(tick: &Tick) -> bool {
    let state = tick.outputs.state;
    tick.outputs.fault.is_none() && matches!(state, State::Ready | State::Moving)
}

/// Every fault that was found.
fn stops(record: &Record, timeline: &[Timed]) -> Vec<Stop> {
    let mut before = None;
    let mut stops = Vec::new();
    for (tick, found) in record.ticks.iter().enumerate() {
        let fault = found.outputs.fault;
        if let (Some(fault), true) = (fault, fault != before) {
            stops.push(stop(record, timeline, tick, fault));
        }
        before = fault;
    }
    stops
}

fn stop(record: &Record, timeline: &[Timed], tick: usize, fault: Fault) -> Stop {
    let ticks = &record.ticks;
    let since = |from: usize, to: usize| {
        let way = ticks[to].shaft.position - ticks[from].shaft.position;
        (
            (to - from) as f64 / record.tick_hz,
            way.abs() / record.counts_per_mm,
        )
    };
    let mut troubles = record.actions.iter().filter(|happening| {
        let timed = timeline.get(happening.index);
        happening.tick as usize <= tick
            && timed.is_some_and(|timed| matches!(timed.action, Action::Trouble { .. }))
    });
    let zero = ticks[tick..]
        .iter()
        .position(|found| found.outputs.command == 0);
    Stop {
        fault,
        first: record
            .faults
            .iter()
            .find(|first| first.tick as usize == tick)
            .copied(),
        tick,
        detected: troubles
            .next_back()
            .map(|cause| since(cause.tick as usize, tick)),
        zero_output_ticks: zero,
        stopped: standstill(record, tick).map(|stand| since(tick, stand)),
    }
}

/// The first tick from `tick` on in which the shaft stands.
fn standstill(record: &Record, tick: usize) -> Option<usize> {
    let span = ((STANDING_S * record.tick_hz) as usize).max(1);
    let stands = |window: &[Tick]| {
        let start = window[0].shaft.position;
        window
            .iter()
            .all(|found| (found.shaft.position - start).abs() <= 1.0)
    };
    record.ticks[tick..]
        .windows(span)
        .position(stands)
        .map(|after| tick + after)
}
