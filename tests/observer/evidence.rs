//! An observer on captures made by hand.

use leadscrew::capture::Unwrapper;
use leadscrew::edges::{EdgeConfig, EdgeReader, EdgeSample};
use leadscrew::estimator::observer::{Config, Estimator};
use leadscrew::estimator::{Estimate, Evidence, Variances};
use leadscrew::hal::Capture;
use leadscrew::uncertainty::EdgeErrors;
use leadscrew::units::Command;

/// Timer clocks in a tick of 1 ms.
pub const CLOCKS: u32 = 84_000;

/// An observer behind an encoder input at 1 kHz and 84 MHz.
pub struct Listener {
    unwrapper: Unwrapper,
    edges: EdgeReader<'static>,
    pub observer: Estimator,
}

/// What there was to see in a tick, and what the observer made of it.
pub struct Heard {
    pub count: i64,
    pub delta: i32,
    pub sample: Option<EdgeSample>,
    pub estimate: Estimate,
    pub variances: Variances,
}

impl Listener {
    pub fn new(config: Config) -> Self {
        Self {
            unwrapper: Unwrapper::new(),
            edges: EdgeReader::new(EdgeConfig::new(1000.0, 84e6, &EdgeErrors::default()).unwrap()),
            observer: Estimator::new(config),
        }
    }

    pub fn hear(&mut self, capture: &Capture<'_>, command: Option<Command>) -> Heard {
        let observation = self.unwrapper.unwrap(capture);
        let evidence = Evidence::new(&observation, &self.edges, command);
        let estimate = self.observer.update(&evidence);
        Heard {
            count: observation.count,
            delta: observation.delta,
            sample: self.edges.sample(&observation),
            estimate,
            variances: self.observer.variances(self.edges.noise()),
        }
    }
}

/// A shaft that is moved by hand, with an ideal encoder on it.
pub struct Hand {
    pub listener: Listener,
    position: f64,
    tick: u32,
}

impl Hand {
    /// At the middle of discrete 0.
    pub fn new(config: Config) -> Self {
        Self {
            listener: Listener::new(config),
            position: 0.5,
            tick: 0,
        }
    }

    /// A tick in which the shaft moves straight to `position`.
    pub fn move_to(&mut self, position: f64, command: Option<Command>) -> Heard {
        let start = self.tick.wrapping_mul(CLOCKS);
        let from = self.position;
        let (low, high) = (from.min(position), from.max(position));
        let mut times: Vec<u32> = (low.floor() as i64 + 1..=high.floor() as i64)
            .map(|boundary| {
                let share = (boundary as f64 - from) / (position - from);
                start.wrapping_add((share * f64::from(CLOCKS)) as u32)
            })
            .collect();
        times.sort_by_key(|time| time.wrapping_sub(start));
        self.position = position;
        self.tick = self.tick.wrapping_add(1);
        let capture = Capture {
            count: (position.floor() as i64) as u32,
            sampled_at: start.wrapping_add(CLOCKS),
            last_edge_at: times.last().copied(),
            edges: [&times, &[]],
            ..Capture::default()
        };
        self.listener.hear(&capture, command)
    }

    /// A tick at `velocity`.
    pub fn move_by(&mut self, velocity: f64) -> Heard {
        self.move_to(self.position + velocity, None)
    }

    /// A tick at rest.
    pub fn stand(&mut self) -> Heard {
        self.move_by(0.0)
    }
}
