//! A run of the simulated machine with every estimator listening.

use leadscrew::axis::Outputs;
use leadscrew::capture::CaptureHealth;
use leadscrew::encoder_map::EncoderMap;
use leadscrew::estimator::{Estimate, EstimatorConfig, Variances};
use leadscrew::hal::Encoder;
use leadscrew_hal_mock::arc::State;
use leadscrew_hal_mock::machine::MachineParams;
use leadscrew_hal_mock::scenario::{MoveAndBack, ScenarioError, Setup, Simulation};
use leadscrew_hal_mock::tachogenerator;

use crate::listening::Listening;
use crate::progress::Progress;
use crate::statistics::Spread;
use crate::tacho_watch::{TachoWatch, Watched};
use crate::truth::TruthTrack;

/// What is to be run.
#[derive(Clone, Copy, Debug)]
pub struct RunSpec<'m> {
    /// The machine.
    pub machine: MachineParams,
    /// The move.
    pub scenario: MoveAndBack,
    /// The estimator in the loop.
    pub estimator: EstimatorConfig,
    /// Seed of everything random.
    pub seed: u64,
    /// A map of the encoder, in use from its first index on.
    pub map: Option<EncoderMap<'m>>,
}

/// A tick of a run.
#[derive(Clone, Copy, Debug)]
pub struct Tick {
    /// What the axis put out.
    pub outputs: Outputs,
    /// How uncertain its estimate is.
    pub variances: Variances,
    /// Carriage, d.
    pub carriage: f64,
    /// Reading of the tachogenerator, d/tick.
    pub tachogenerator: f64,
}

/// What an estimator that only listens said, tick by tick.
#[derive(Clone, Debug)]
pub struct Listener {
    /// Its configuration.
    pub config: EstimatorConfig,
    /// Its estimates.
    pub estimates: Vec<Estimate>,
}

/// A finished run.
#[derive(Clone, Debug)]
pub struct Run {
    /// The ticks.
    pub ticks: Vec<Tick>,
    /// The shaft's true motion.
    pub truth: TruthTrack,
    /// All estimators of the core on the same captures.
    pub listeners: Vec<Listener>,
    /// What went wrong at the encoder.
    pub health: CaptureHealth,
    /// What the tachogenerator said of the encoder.
    pub watched: Watched,
    /// Digest of inputs and outputs of the axis.
    pub digest: u64,
    /// Control rate, Hz.
    pub tick_hz: f64,
}

/// All estimators with their default parameters.
///
/// # Panics
/// Never: the defaults are within their ranges, which a test checks.
#[must_use]
pub fn all_estimators() -> Vec<EstimatorConfig> {
    let named = |name: &&str| EstimatorConfig::by_name(name).ok().flatten();
    EstimatorConfig::NAMES.iter().filter_map(named).collect()
}

impl RunSpec<'_> {
    /// Runs it.
    ///
    /// # Errors
    /// A parameter that is out of range or a move that cannot be planned.
    pub fn run(&self) -> Result<Run, ScenarioError> {
        let mapped = self.map.is_some();
        let Self {
            machine, scenario, ..
        } = self;
        let in_loop = scenario.tuned(machine, self.estimator, mapped)?;
        let axis = scenario.axis_params(machine, in_loop)?;
        let setup = Setup::with_axis(scenario, machine, &axis, self.seed)?;
        let mut simulation = Simulation::from(setup);
        simulation.axis.set_map(self.map);
        // One that only listens need not fit the machine: an observer then is that of the 16K20F3.
        let tuned = |config| {
            let tuned = self.scenario.tuned(&self.machine, config, mapped);
            tuned.unwrap_or(config)
        };
        let configs: Vec<_> = all_estimators().into_iter().map(tuned).collect();
        let mut listening = Listening::new(&configs, simulation.axis.config().edges);
        if let Some(map) = self.map {
            listening = listening.with_map(map);
        }
        let mut listeners: Vec<_> = configs.into_iter().map(Listener::new).collect();
        let mut progress = Progress::new("simulating", u64::from(simulation.ticks()));
        let mut ticks = Vec::with_capacity(simulation.ticks() as usize);
        let mut truth = TruthTrack::default();
        let tick_hz = self.scenario.tick_hz;
        let mut watch = TachoWatch::new(&self.machine, tick_hz, reading_age(tick_hz))?;
        let mut told = None;
        while let Some(outputs) = simulation.step()? {
            let state = simulation.machine.truth();
            let command = told.replace(outputs.command).filter(|_| outputs.enabled);
            listening.hear(&simulation.machine.capture(), command, |index, estimate| {
                listeners[index].estimates.push(estimate);
            });
            truth.push(state.shaft);
            let tachogenerator = simulation.machine.read_tachogenerator();
            watch.note(&outputs.estimate, tachogenerator);
            ticks.push(Tick {
                outputs,
                variances: simulation.axis.variances(),
                carriage: state.carriage.position,
                tachogenerator,
            });
            progress.step();
        }
        Ok(Run {
            ticks,
            truth,
            listeners,
            health: simulation.axis.capture_health(),
            watched: watch.finish(),
            digest: simulation.digest(),
            tick_hz: self.scenario.tick_hz,
        })
    }
}

impl Listener {
    const fn new(config: EstimatorConfig) -> Self {
        Self {
            config,
            estimates: Vec::new(),
        }
    }
}

/// Errors of an estimator while the axis moves.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Accuracy {
    /// Velocity against the truth at its lag, d/tick.
    pub velocity: Spread,
    /// Acceleration against the truth at its lag, d/tick².
    pub acceleration: Spread,
    /// Velocity against the tachogenerator at its lag, d/tick.
    pub against_tachogenerator: Spread,
}

impl Run {
    /// Following error over the whole run, d.
    #[must_use]
    pub fn following_error(&self) -> Spread {
        self.ticks
            .iter()
            .map(|tick| tick.outputs.following_error.to_num())
            .collect()
    }

    /// The shaft's true state at each tick.
    #[must_use]
    pub fn true_states(&self) -> Vec<State> {
        (0..self.ticks.len())
            .filter_map(|tick| self.truth.before(tick, 0.0))
            .collect()
    }

    /// Velocity errors of a listener over time in s, each at the instant of its estimate.
    #[must_use]
    pub fn velocity_errors(&self, listener: &Listener) -> Vec<(f64, f64)> {
        let lag: f64 = listener.config.lags().velocity.to_num();
        let error = |(tick, estimate): (usize, &Estimate)| {
            let truth = self.truth.before(tick, lag)?;
            Some((
                (tick as f64 - lag) / self.tick_hz,
                estimate.velocity.to_num::<f64>() - truth.velocity,
            ))
        };
        listener
            .estimates
            .iter()
            .enumerate()
            .filter_map(error)
            .collect()
    }

    /// Errors of a listener in the ticks in which a move runs.
    #[must_use]
    pub fn accuracy(&self, listener: &Listener) -> Accuracy {
        let lags = listener.config.lags();
        let (lag_v, lag_a) = (
            lags.velocity.to_num::<f64>(),
            lags.acceleration.to_num::<f64>(),
        );
        let mut accuracy = Accuracy::default();
        for (tick, estimate) in listener.estimates.iter().enumerate() {
            if !self.ticks[tick].outputs.moving {
                continue;
            }
            let velocity: f64 = estimate.velocity.to_num();
            if let Some(truth) = self.truth.before(tick, lag_v) {
                accuracy.velocity.push(velocity - truth.velocity);
            }
            if let Some(truth) = self.truth.before(tick, lag_a) {
                accuracy
                    .acceleration
                    .push(estimate.acceleration.to_num::<f64>() - truth.acceleration);
            }
            if let Some(reading) = self.tachogenerator(tick, lag_v) {
                accuracy.against_tachogenerator.push(velocity - reading);
            }
        }
        accuracy
    }

    /// The tachogenerator's reading `lag` ticks before tick `tick`, between readings by a straight line.
    fn tachogenerator(&self, tick: usize, lag: f64) -> Option<f64> {
        let instant = tick as f64 - lag + reading_age(self.tick_hz);
        let at = |index: usize| self.ticks.get(index).map(|tick| tick.tachogenerator);
        if instant < 0.0 {
            return None;
        }
        let (before, share) = (at(instant as usize)?, instant.fract());
        let after = at(instant as usize + 1).unwrap_or(before);
        Some(before + share * (after - before))
    }
}

/// How far a reading of the tachogenerator lies back on average, ticks.
fn reading_age(tick_hz: f64) -> f64 {
    // The oscilloscope samples at the start of the first tick and every so often from there: within the
    // ticks, samples fall on the multiples of this, 0 among them and 1 not.
    let grid =
        common_divisor(tick_hz.round(), tachogenerator::SAMPLE_HZ) / tachogenerator::SAMPLE_HZ;
    0.5 + 0.5 * grid
}

/// Greatest common divisor of two whole numbers.
fn common_divisor(one: f64, other: f64) -> f64 {
    if other < 0.5 {
        one
    } else {
        common_divisor(other, one % other)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn readings_of_the_tachogenerator_lie_back_by_what_their_samples_do() {
        for tick_hz in [1000.0, 2500.0, 500.0, 1234.0] {
            let mut sum = 0.0;
            // Samples of a motion of constant acceleration 1 d/tick², averaged over each tick.
            let mut next = 0.0_f64;
            let ticks = 4000;
            for tick in 0..ticks {
                let (mut readings, mut samples) = (0.0, 0.0);
                while next < f64::from(tick + 1) - 1e-9 {
                    readings += next;
                    samples += 1.0;
                    next += tick_hz / tachogenerator::SAMPLE_HZ;
                }
                sum += f64::from(tick + 1) - readings / samples;
            }
            let age = sum / f64::from(ticks);
            assert!(
                (age - reading_age(tick_hz)).abs() < 0.01,
                "{tick_hz}: {age}"
            );
        }
    }
}
