//! Captures by hand and the estimator on them.

use leadscrew::capture::Unwrapper;
use leadscrew::edges::{EdgeConfig, EdgeReader};
use leadscrew::estimator::polynomial::{Answer, Config, Estimator};
use leadscrew::estimator::{Estimate, Evidence, Variances};
use leadscrew::hal::Capture;
use leadscrew::uncertainty::EdgeErrors;

/// Timer clocks of a tick at 84 MHz and 1 kHz.
pub const CLOCKS: u32 = 84_000;

/// An estimator behind its unwrapper.
pub struct Bench {
    unwrapper: Unwrapper,
    edges: EdgeReader<'static>,
    estimator: Estimator,
}

impl Bench {
    pub fn new(window: u32, answer: Answer) -> Self {
        let config = Config::new(window, answer).unwrap();
        Self {
            unwrapper: Unwrapper::new(),
            edges: EdgeReader::new(EdgeConfig::new(1000.0, 84e6, &EdgeErrors::default()).unwrap()),
            estimator: Estimator::new(config),
        }
    }

    pub fn update(&mut self, capture: &Capture<'_>) -> Estimate {
        let observation = self.unwrapper.unwrap(capture);
        self.estimator
            .update(&Evidence::new(&observation, &self.edges, None))
    }

    pub fn variances(&self) -> Variances {
        self.estimator.variances(self.edges.noise())
    }
}

/// One tick of an encoder: the count at its end and the times of its edges.
#[derive(Clone, Debug)]
pub struct Tick {
    pub count: i64,
    pub sampled_at: u64,
    pub times: Vec<u64>,
}

impl Tick {
    /// The capture with all edges; `shift` moves all times, `start` all counts.
    pub fn with<R>(&self, start: i64, shift: u64, take: impl FnOnce(&Capture<'_>) -> R) -> R {
        let times: Vec<u32> = self
            .times
            .iter()
            .map(|time| (time + shift) as u32)
            .collect();
        take(&Capture {
            count: (self.count + start) as u32,
            sampled_at: (self.sampled_at + shift) as u32,
            last_edge_at: times.last().copied(),
            edges: [&times, &[]],
            ..Capture::default()
        })
    }
}

/// Ticks of an ideal encoder on a shaft at `position(ticks)`, d, which may turn round between ticks only.
pub fn ticks_of(position: impl Fn(f64) -> f64, ticks: u32) -> Vec<Tick> {
    let mut count = position(0.0).floor() as i64;
    (1..=ticks)
        .map(|tick| {
            let (from, to) = (f64::from(tick - 1), f64::from(tick));
            let end = position(to).floor() as i64;
            let boundaries: Vec<i64> = if end >= count {
                (count + 1..=end).collect()
            } else {
                (end + 1..=count).rev().collect()
            };
            let times = boundaries
                .iter()
                .map(|&boundary| passing(&position, boundary as f64, from, to))
                .map(|time| (time * f64::from(CLOCKS)) as u64)
                .collect();
            count = end;
            Tick {
                count,
                sampled_at: u64::from(tick) * u64::from(CLOCKS),
                times,
            }
        })
        .collect()
}

/// When a monotone stretch of the motion passes a place, by bisection.
fn passing(position: &impl Fn(f64) -> f64, place: f64, from: f64, to: f64) -> f64 {
    let rising = position(to) >= position(from);
    let (mut low, mut high) = (from, to);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if (position(middle) >= place) == rising {
            high = middle;
        } else {
            low = middle;
        }
    }
    high
}
