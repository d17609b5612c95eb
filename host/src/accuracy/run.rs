//! One encoder on one motion in one direction, all methods on the same edges.

use leadscrew::capture::Unwrapper;
use leadscrew::edges::{EdgeConfig, EdgeReader};
use leadscrew::encoder_map::EncoderMap;
use leadscrew::encoder_map::tie::MapState;
use leadscrew::estimator::{Estimate, Estimator, EstimatorConfig, Evidence};
use leadscrew::hal::Capture;
use leadscrew::uncertainty::EdgeErrors;
use leadscrew::units::Variance;
use leadscrew_hal_mock::encoder::EncoderModel;
use leadscrew_hal_mock::scene::{Ripple, Scene};

use super::TICK_HZ;
use super::anatomy::Anatomy;
use super::columns::Column;
use super::error::AccuracyError;
use super::parts::{Dissection, Parts};
use super::residue::Residue;
use super::rows::Row;
use super::tally::Tally;
use super::two_edge::{TwoEdge, TwoEdgeEstimate};
use crate::truth::TruthTrack;

/// What is run.
#[derive(Clone, Copy, Debug)]
pub struct RunSpec<'m> {
    pub row: Row,
    pub model: EncoderModel,
    pub seed: u64,
    pub map: Option<EncoderMap<'m>>,
    /// What the map leaves, to take errors apart by.
    pub residue: Option<&'m Residue>,
    pub ripple: Ripple,
    /// Edges are stamped one by one; otherwise the last one of a tick.
    pub every_edge: bool,
}

/// Errors of one method.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tallies {
    pub velocity: Tally,
    pub acceleration: Tally,
}

/// What a run gives, in the order asked for.
#[derive(Clone, Debug, Default)]
pub struct RunFigures {
    /// Of the estimators.
    pub estimators: Vec<Tallies>,
    /// Of hostmot2's method.
    pub two_edge: Tallies,
    /// Of the columns; without a residue nothing.
    pub parts: Vec<Parts>,
}

/// The state of a run.
struct Bench<'m> {
    track: TruthTrack,
    unwrapper: Unwrapper,
    reader: EdgeReader<'m>,
    estimators: Vec<Estimator>,
    two_edge: TwoEdge,
    figures: RunFigures,
}

impl RunSpec<'_> {
    /// Runs `estimators`, and takes apart the errors of `columns`, the estimator of each given by its place among them.
    ///
    /// # Errors
    /// A parameter out of range, or a map that was not tied to the index when the estimators should have settled.
    pub fn run(
        &self,
        estimators: &[EstimatorConfig],
        columns: &[(usize, Column)],
    ) -> Result<RunFigures, AccuracyError> {
        let Row {
            motion, start_d, ..
        } = self.row;
        let mut scene = Scene::with_ripple(
            motion,
            self.ripple,
            &self.model,
            TICK_HZ,
            start_d,
            self.seed,
        )?;
        let timer_hz = self.model.encoder.timer_hz;
        let anatomy = self
            .residue
            .map(|residue| Anatomy::new(residue, timer_hz / TICK_HZ));
        let mut dissections: Vec<_> = columns
            .iter()
            .map(|(_, column)| Dissection::new(*column))
            .collect();
        let mut bench = self.bench(estimators)?;
        bench.track.push(scene.truth());
        let mut estimates = vec![Estimate::default(); estimators.len()];
        let ticks = self.row.warm_up_ticks + self.row.ticks;
        for tick in 1..=ticks as usize {
            scene.step();
            bench.track.push(scene.truth());
            let capture = self.stripped(scene.capture());
            let seen = bench.unwrapper.unwrap(&capture);
            bench.reader.note(&seen);
            let evidence = Evidence::new(&seen, &bench.reader, None);
            for (estimate, estimator) in estimates.iter_mut().zip(&mut bench.estimators) {
                *estimate = estimator.update(&evidence);
            }
            let two_edge = bench.two_edge.update(&seen);
            if let Some(anatomy) = &anatomy {
                for dissection in &mut dissections {
                    dissection.note(anatomy, tick, &seen, &bench.track);
                }
            }
            if tick <= self.row.warm_up_ticks as usize {
                continue;
            }
            self.check_tie(&bench)?;
            bench.judge(tick, &estimates, &two_edge);
            if anatomy.is_some() {
                for (dissection, (index, _)) in dissections.iter_mut().zip(columns) {
                    dissection.compare(tick, &estimates[*index], &bench.track);
                }
            }
        }
        bench.figures.parts = dissections.iter().map(Dissection::parts).collect();
        Ok(bench.figures)
    }

    fn bench(&self, estimators: &[EstimatorConfig]) -> Result<Bench<'_>, AccuracyError> {
        let timer_hz = self.model.encoder.timer_hz;
        let edges = EdgeConfig::new(TICK_HZ, timer_hz, &EdgeErrors::default())?;
        let reader = EdgeReader::new(edges);
        Ok(Bench {
            track: TruthTrack::default(),
            unwrapper: Unwrapper::new(),
            reader: match self.map {
                Some(map) => reader.with_map(map),
                None => reader,
            },
            estimators: estimators.iter().copied().map(Estimator::new).collect(),
            two_edge: TwoEdge::new(timer_hz / TICK_HZ),
            figures: RunFigures {
                estimators: vec![Tallies::default(); estimators.len()],
                ..RunFigures::default()
            },
        })
    }

    /// What hardware that keeps one time stamp gives.
    const fn stripped<'c>(&self, capture: Capture<'c>) -> Capture<'c> {
        if self.every_edge {
            capture
        } else {
            Capture {
                edges: [&[], &[]],
                ..capture
            }
        }
    }

    fn check_tie(&self, bench: &Bench<'_>) -> Result<(), AccuracyError> {
        match bench.reader.map_state() {
            None | Some(MapState::Tied) => Ok(()),
            Some(state) => Err(AccuracyError::NotTied {
                row: self.row.name,
                seed: self.seed,
                state,
            }),
        }
    }
}

impl Bench<'_> {
    fn judge(&mut self, tick: usize, estimates: &[Estimate], two_edge: &TwoEdgeEstimate) {
        let sigma = |variance: Variance| variance.to_num::<f64>().sqrt();
        let seen = estimates.iter().zip(&self.estimators);
        for (tallies, (estimate, estimator)) in self.figures.estimators.iter_mut().zip(seen) {
            let lags = estimate.lags;
            let variances = estimator.variances(self.reader.noise());
            tallies.push(
                &self.track,
                tick,
                (
                    estimate.velocity.to_num(),
                    lags.velocity.to_num(),
                    sigma(variances.velocity),
                ),
                (
                    estimate.acceleration.to_num(),
                    lags.acceleration.to_num(),
                    sigma(variances.acceleration),
                ),
            );
        }
        let TwoEdgeEstimate {
            velocity,
            lag_v,
            acceleration,
            lag_a,
        } = *two_edge;
        let (velocity, acceleration) = ((velocity, lag_v, 0.0), (acceleration, lag_a, 0.0));
        self.figures
            .two_edge
            .push(&self.track, tick, velocity, acceleration);
    }
}

impl Tallies {
    /// Takes velocity and acceleration, each with its lag and stated 1σ.
    fn push(
        &mut self,
        track: &TruthTrack,
        tick: usize,
        (velocity, lag_v, sigma_v): (f64, f64, f64),
        (acceleration, lag_a, sigma_a): (f64, f64, f64),
    ) {
        let moves = track
            .before(tick, 0.0)
            .is_some_and(|now| now.velocity != 0.0);
        if let Some(truth) = track.before(tick, lag_v) {
            let error = velocity - truth.velocity;
            self.velocity.push(error, moves.then_some(lag_v), sigma_v);
        }
        if let Some(truth) = track.before(tick, lag_a) {
            let error = acceleration - truth.acceleration;
            self.acceleration
                .push(error, moves.then_some(lag_a), sigma_a);
        }
    }
}
