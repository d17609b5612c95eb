//! A move as it went, tick by tick, and the figures that are read off it.
//!
//! Where the shaft's zero lies in the coordinate of the loop is nothing that an axis could know: it is taken as the mean,
//! over the moves, of what the loop takes for the position less the shaft's.

use serde::Serialize;

use crate::statistics::{Spread, mean};

/// What is left out of the standing error after the end of a profile, ticks.
const SETTLING_TICKS: usize = 100;
/// End of the span over which the standing error is judged, ticks.
const STANDING_TICKS: usize = 1000;
/// A change of the output that counts as a swing, fraction of full command.
const SWING: f64 = 0.005;
/// From so many swings in 10 s of rest on the output oscillates: a hunting integral makes one in seconds.
const OSCILLATION_SWINGS: f64 = 20.0;

/// A tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tick {
    /// Where the encoder's shaft should be, d.
    pub setpoint: f64,
    /// Where it is, d.
    pub shaft: f64,
    /// Where the loop takes it to be, d.
    pub seen: f64,
    /// Where the carriage is, d.
    pub carriage: f64,
    /// The command to the drive, fraction of full.
    pub command: f64,
}

/// A run.
pub type Trace = Vec<Tick>;

/// What a run came to, d.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct MoveFigures {
    /// Largest following error at the shaft, dwells included.
    pub peak: f64,
    /// Rms of the following error at the shaft while a move runs.
    pub rms: f64,
    /// Largest following error as the loop sees it.
    pub seen_peak: f64,
    /// Mean magnitude of the error at the shaft from 100 ms to 1 s after the moves' ends.
    pub standing_mean: f64,
    /// Largest error at the shaft in the same spans.
    pub standing_peak: f64,
    /// Peak to peak of the shaft in the last rest, from 1 s on.
    pub rest_swing: f64,
    /// Swings of the output by more than 0.5 % of full command in 10 s of that rest.
    pub output_swings: f64,
}

impl MoveFigures {
    /// Of a run that begins at rest and ends with one of more than a second.
    #[must_use]
    pub fn of(trace: &[Tick]) -> Self {
        let origin = origin(trace);
        let error = |tick: &Tick| tick.setpoint - tick.shaft - origin;
        let all: Spread = trace.iter().map(error).collect();
        let seen: Spread = trace.iter().map(|tick| tick.setpoint - tick.seen).collect();
        let rests = rests(trace);
        let standing: Vec<f64> = rests
            .iter()
            .filter(|rest| rest.start > 0)
            .flat_map(|rest| {
                let end = rest.end.min(rest.start + STANDING_TICKS);
                let start = end.min(rest.start + SETTLING_TICKS);
                trace[start..end].iter().map(|tick| error(tick).abs())
            })
            .collect();
        let last = rests.last().map_or(&[][..], |rest| {
            &trace[rest.end.min(rest.start + STANDING_TICKS)..rest.end]
        });
        Self {
            peak: all.peak(),
            rms: moving(trace).map(error).collect::<Spread>().rms(),
            seen_peak: seen.peak(),
            standing_mean: standing.iter().sum::<f64>() / standing.len().max(1) as f64,
            standing_peak: standing.iter().fold(0.0, |most, &value| most.max(value)),
            rest_swing: peak_to_peak(last.iter().map(|tick| tick.shaft)),
            output_swings: swings(last.iter().map(|tick| tick.command)) as f64 * 10_000.0
                / last.len().max(1) as f64,
        }
    }

    /// The largest of each.
    #[must_use]
    pub fn worst(all: &[Self]) -> Self {
        all.iter().fold(Self::default(), |worst, one| Self {
            peak: worst.peak.max(one.peak),
            rms: worst.rms.max(one.rms),
            seen_peak: worst.seen_peak.max(one.seen_peak),
            standing_mean: worst.standing_mean.max(one.standing_mean),
            standing_peak: worst.standing_peak.max(one.standing_peak),
            rest_swing: worst.rest_swing.max(one.rest_swing),
            output_swings: worst.output_swings.max(one.output_swings),
        })
    }

    /// The axis comes to rest: neither a limit cycle at the shaft nor a sustained oscillation of the output.
    #[must_use]
    pub fn is_quiet(&self) -> bool {
        self.rest_swing <= 1.0 && !self.oscillates()
    }

    /// The output oscillates at rest, or the shaft does by more than what a creeping integral lets go at once.
    #[must_use]
    pub fn oscillates(&self) -> bool {
        self.output_swings >= OSCILLATION_SWINGS
    }
}

/// Ticks in which the setpoint moves.
fn moving(trace: &[Tick]) -> impl Iterator<Item = &Tick> {
    let pairs = trace.windows(2);
    pairs
        .filter(|pair| pair[0].setpoint != pair[1].setpoint)
        .map(|pair| &pair[1])
}

/// Where the shaft's zero lies in the coordinate of the loop.
fn origin(trace: &[Tick]) -> f64 {
    mean(moving(trace).map(|tick| tick.seen - tick.shaft)).unwrap_or_default()
}

/// Following errors at the shaft, d.
#[must_use]
pub fn errors(trace: &[Tick]) -> Vec<f64> {
    let origin = origin(trace);
    let error = |tick: &Tick| tick.setpoint - tick.shaft - origin;
    trace.iter().map(error).collect()
}

/// Spans of ticks in which the setpoint stands, each longer than 50 ticks.
fn rests(trace: &[Tick]) -> Vec<std::ops::Range<usize>> {
    let mut rests = Vec::new();
    let mut start = 0;
    for at in 1..=trace.len() {
        if trace.get(at).map(|tick| tick.setpoint) != Some(trace[at - 1].setpoint) {
            if at - start > 50 {
                rests.push(start..at);
            }
            start = at;
        }
    }
    rests
}

/// Largest less smallest; 0 of nothing.
pub fn peak_to_peak(values: impl Iterator<Item = f64>) -> f64 {
    let (low, high) = values.fold((f64::MAX, f64::MIN), |(low, high), value| {
        (low.min(value), high.max(value))
    });
    (high - low).max(0.0)
}

/// How often a signal turns round by more than [`SWING`].
fn swings(values: impl Iterator<Item = f64>) -> usize {
    let (mut count, mut rising) = (0, None);
    let mut extreme: Option<f64> = None;
    for value in values {
        let reached = *extreme.get_or_insert(value);
        let onward = match rising {
            None | Some(true) if value > reached + SWING => Some(true),
            None | Some(false) if value < reached - SWING => Some(false),
            Some(true) if value < reached - SWING => Some(false),
            Some(false) if value > reached + SWING => Some(true),
            _ => rising,
        };
        let further = matches!(
            (onward, value > reached),
            (Some(true), true) | (Some(false), false)
        );
        if onward != rising || further {
            extreme = Some(value);
        }
        count += usize::from(rising.is_some() && onward != rising);
        rising = onward;
    }
    count
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A move of 1 000 d at 1 d/tick after 200 ticks of rest, with `behind` of the tick.
    fn trace(rest: usize, behind: impl Fn(usize) -> f64) -> Trace {
        let at = |tick: usize| {
            let setpoint = 7.5 + (tick.saturating_sub(200) as f64).min(1000.0);
            Tick {
                setpoint,
                shaft: setpoint + 3.0 - behind(tick),
                seen: setpoint - behind(tick),
                ..Tick::default()
            }
        };
        (0..1200 + rest).map(at).collect()
    }

    #[test]
    fn errors_are_those_in_the_coordinate_of_the_loop() {
        let figures = MoveFigures::of(&trace(3000, |tick| match tick {
            0..200 => 0.0,
            200..1250 => 4.0,
            1250..1320 => 2.0,
            1320.. => 0.5,
        }));
        assert_eq!(figures.peak, 4.0);
        assert!((figures.rms - 4.0).abs() < 0.01, "{figures:?}");
        assert_eq!(figures.seen_peak, 4.0);
        assert_eq!(figures.standing_peak, 2.0);
        // 20 of the 900 ticks stand 2 d off.
        assert!((figures.standing_mean - 0.5 - 1.5 * 20.0 / 900.0).abs() < 0.003);
        assert_eq!((figures.rest_swing, figures.output_swings), (0.0, 0.0));
        assert!(figures.is_quiet());
    }

    #[test]
    fn a_rest_that_is_none_is_seen() {
        let figures = MoveFigures::of(&trace(3000, |tick| f64::from(tick % 100 > 50) * 1.5));
        assert_eq!(figures.rest_swing, 1.5);
        assert!(!figures.is_quiet());
        let mut trace = trace(3000, |_| 0.0);
        for (at, tick) in trace.iter_mut().enumerate() {
            tick.command = 0.01 * (at as f64 / 10.0).sin();
        }
        let figures = MoveFigures::of(&trace);
        assert!(figures.oscillates());
        // Two swings in each 62.8 ticks.
        assert!((figures.output_swings - 318.0).abs() < 5.0, "{figures:?}");
    }

    #[test]
    fn a_ramp_has_no_swings_and_steps_are_counted_once() {
        assert_eq!(swings((0..1000).map(|at| at as f64 * 1e-3)), 0);
        assert_eq!(swings([0.0, 0.1, 0.1, 0.0, 0.0, 0.1].into_iter()), 2);
        assert_eq!(swings((0..1000).map(|at| 0.001 * f64::from(at % 2))), 0);
    }
}
