//! Estimators that only listen: capture by capture, all on the same evidence.

use leadscrew::capture::{CaptureHealth, Unwrapper};
use leadscrew::edges::{EdgeConfig, EdgeReader};
use leadscrew::encoder_map::EncoderMap;
use leadscrew::encoder_map::tie::{MapHealth, MapState};
use leadscrew::estimator::{Estimate, Estimator, EstimatorConfig, Evidence, Variances};
use leadscrew::hal::Capture;
use leadscrew::units::Command;

/// Estimators on one encoder.
#[derive(Clone, Debug)]
pub struct Listening<'m> {
    unwrapper: Unwrapper,
    edges: EdgeReader<'m>,
    estimators: Vec<Estimator>,
}

impl<'m> Listening<'m> {
    /// Estimators of `configs` behind an edge timer of `scale`.
    #[must_use]
    pub fn new(configs: &[EstimatorConfig], scale: EdgeConfig) -> Self {
        Self {
            unwrapper: Unwrapper::new(),
            edges: EdgeReader::new(scale),
            estimators: configs.iter().copied().map(Estimator::new).collect(),
        }
    }

    /// The same with an encoder map.
    #[must_use]
    pub fn with_map(self, map: EncoderMap<'m>) -> Self {
        Self {
            edges: self.edges.with_map(map),
            ..self
        }
    }

    /// Takes a capture and hands every estimate to `take`, in the order of the configurations; returns the
    /// count. `command` is what the drive was told for the tick just past, where that is known.
    pub fn hear(
        &mut self,
        capture: &Capture<'_>,
        command: Option<Command>,
        mut take: impl FnMut(usize, Estimate),
    ) -> i64 {
        let observation = self.unwrapper.unwrap(capture);
        self.edges.note(&observation);
        let evidence = Evidence::new(&observation, &self.edges, command);
        for (index, estimator) in self.estimators.iter_mut().enumerate() {
            take(index, estimator.update(&evidence));
        }
        observation.count
    }

    /// How uncertain the newest estimate of estimator `index` is; `None` for one that is not there.
    #[must_use]
    pub fn variances(&self, index: usize) -> Option<Variances> {
        let estimator = self.estimators.get(index)?;
        Some(estimator.variances(self.edges.noise()))
    }

    /// How far the encoder map can be used; `None` without one.
    #[must_use]
    pub fn map_state(&self) -> Option<MapState> {
        self.edges.map_state()
    }

    /// What the indexes showed so far.
    #[must_use]
    pub fn map_health(&self) -> MapHealth {
        self.edges.map_health()
    }

    /// What went wrong at the encoder so far.
    #[must_use]
    pub const fn health(&self) -> CaptureHealth {
        self.unwrapper.health()
    }
}
