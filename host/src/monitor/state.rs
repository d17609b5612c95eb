//! What the screen shows.

use std::collections::VecDeque;

use leadscrew::scope::Signal;
use leadscrew_client::{Scale, Status};

/// Signals that are streamed to the screen, in their order; all but the last ones can be charted.
pub const CHART_SIGNALS: [Signal; 5] = [
    Signal::FollowingError,
    Signal::Velocity,
    Signal::Acceleration,
    Signal::Command,
    Signal::ReportedPosition,
];
/// Seconds of the chart.
pub const CHART_S: f64 = 10.0;
/// Most samples of it.
const MOST: usize = 2000;

/// A sample of [`CHART_SIGNALS`], in their units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Time of the axis, s.
    pub time_s: f64,
    /// The values.
    pub values: [f64; CHART_SIGNALS.len()],
}

/// What the screen shows.
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    /// Where the axis is: its port, board and firmware.
    pub title: String,
    /// What the signals are in.
    pub scale: Scale,
    /// How it stands.
    pub status: Status,
    /// The newest samples, oldest first.
    pub samples: VecDeque<Sample>,
    /// Which of [`CHART_SIGNALS`] the chart shows.
    pub charted: usize,
    /// Feed of a jog, mm/min.
    pub feed: f64,
    /// What was said to the last order, or went wrong.
    pub message: String,
    /// Samples that were lost on the line.
    pub lost: u64,
}

impl State {
    /// Before the first sample.
    #[must_use]
    pub const fn new(title: String, scale: Scale, status: Status, feed: f64) -> Self {
        Self {
            title,
            scale,
            status,
            samples: VecDeque::new(),
            charted: 0,
            feed,
            message: String::new(),
            lost: 0,
        }
    }

    /// Adds a sample; those that the chart has no place for go.
    pub fn push(&mut self, sample: Sample) {
        let oldest = sample.time_s - CHART_S;
        while self
            .samples
            .front()
            .is_some_and(|first| first.time_s < oldest || self.samples.len() >= MOST)
        {
            self.samples.pop_front();
        }
        self.samples.push_back(sample);
    }

    /// Shows the next signal.
    pub const fn show_next(&mut self) {
        self.charted = (self.charted + 1) % CHART_SIGNALS.len();
    }

    /// The signal in the chart.
    #[must_use]
    pub fn signal(&self) -> Signal {
        CHART_SIGNALS[self.charted % CHART_SIGNALS.len()]
    }

    /// The newest value of a signal, if there is one.
    #[must_use]
    pub fn newest(&self, signal: Signal) -> Option<f64> {
        let place = CHART_SIGNALS.iter().position(|one| *one == signal)?;
        self.samples.back().map(|sample| sample.values[place])
    }
}
