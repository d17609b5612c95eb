//! The stages of an axis one by one, composed as in `Axis::step`, each counted.

use board_mps2_an386::instructions::Counter;
use leadscrew::capture::Unwrapper;
use leadscrew::controller::Controller;
use leadscrew::edges::EdgeReader;
use leadscrew::estimator::{Estimator, EstimatorConfig, Evidence};
use leadscrew::hal::{Capture, Lines};
use leadscrew::output::Output;
use leadscrew::params::AxisConfig;
use leadscrew::setpoint::trajectory::Trajectory;
use leadscrew::supervisor::{Permit, Review, Situation, Supervisor};
use leadscrew_hal_mock::scenario::TimedMove;

use crate::samples::Samples;

/// How many estimators there are.
pub const ESTIMATORS: usize = EstimatorConfig::NAMES.len();

/// One stage after the other.
pub struct Staged {
    unwrapper: Unwrapper,
    edges: EdgeReader<'static>,
    estimators: [Estimator; ESTIMATORS],
    trajectory: Trajectory,
    controller: Controller,
    supervisor: Supervisor,
    output: Output,
}

/// Counts of the stages.
pub struct StageSamples {
    unwrap: Samples,
    estimators: [Samples; ESTIMATORS],
    trajectory: Samples,
    controller: Samples,
    supervisor: Samples,
    output: Samples,
}

impl StageSamples {
    pub const fn new() -> Self {
        Self {
            unwrap: Samples::of("unwrap"),
            estimators: Samples::of_each(EstimatorConfig::NAMES),
            trajectory: Samples::of("trajectory"),
            controller: Samples::of("controller"),
            supervisor: Samples::of("supervisor"),
            output: Samples::of("output"),
        }
    }

    pub fn log(&mut self) {
        self.unwrap.log("capture");
        for samples in &mut self.estimators {
            samples.log("estimator");
        }
        self.trajectory.log("setpoint");
        self.controller.log("controller");
        self.supervisor.log("supervisor");
        self.output.log("output");
    }
}

impl Staged {
    /// The stages of an axis with `config`; the estimator in its loop is number `in_loop`.
    pub fn new(config: &AxisConfig, estimators: [EstimatorConfig; ESTIMATORS]) -> Self {
        Self {
            unwrapper: Unwrapper::new(),
            edges: EdgeReader::new(config.edges),
            estimators: estimators.map(Estimator::new),
            trajectory: Trajectory::new(),
            controller: Controller::new(config.controller),
            supervisor: Supervisor::new(config.supervisor),
            output: Output::new(config.output),
        }
    }

    pub fn queue(&mut self, next: &TimedMove, now: u32) -> bool {
        self.trajectory
            .queue(&next.profile, next.start, now)
            .is_ok()
    }

    /// One tick on the capture; counts go to `samples` if there are any. The estimators are given the newest edge
    /// alone, so that the figures do not depend on the speed; with all edges they are in the whole step.
    pub fn step(
        &mut self,
        tick: u32,
        capture: &Capture<'_>,
        counter: &mut Counter,
        samples: Option<&mut StageSamples>,
    ) {
        let capture = &Capture {
            edges: [&[], &[]],
            ..*capture
        };
        let mut observation = None;
        let unwrap = counter.count(|| observation = Some(self.unwrapper.unwrap(capture)));
        let Some(observation) = observation else {
            return;
        };
        self.edges.note(&observation);
        let evidence = Evidence::new(&observation, &self.edges, Some(self.output.command()));
        let mut estimates = [None; ESTIMATORS];
        let mut estimator_counts = [0; ESTIMATORS];
        for ((estimator, estimate), count) in self
            .estimators
            .iter_mut()
            .zip(&mut estimates)
            .zip(&mut estimator_counts)
        {
            *count = counter.count(|| *estimate = Some(estimator.update(&evidence)));
        }
        let [_, Some(estimate), ..] = estimates else {
            return;
        };
        let mut setpoint = None;
        let trajectory = counter.count(|| setpoint = Some(self.trajectory.step(tick)));
        let Some(setpoint) = setpoint else { return };
        let active = self.output.active_limits();
        let position = observation.position();
        let mut demand = None;
        let control = counter
            .count(|| demand = Some(self.controller.step(&setpoint, position, &estimate, active)));
        let Some(demand) = demand else { return };
        let told = self.output.command();
        let lines = Lines::default();
        let mut permit = Permit::Off;
        let before = counter.count(|| {
            permit = self.supervisor.permit(&Situation {
                tick,
                enable: true,
                lines: &lines,
                illegal: capture.illegal,
                missed_ticks: 0,
                readback: Some(told),
                told,
            });
        });
        let review = Review {
            permit,
            tick,
            moving: self.trajectory.is_moving(),
            trouble: None,
            lines: &lines,
            observation: &observation,
            estimate: &estimate,
            setpoint: &setpoint,
            following_error: demand.following_error.to_bits(),
            told,
            active,
            open_loop: false,
        };
        let after = counter.count(|| permit = self.supervisor.review(&review));
        let output = counter.count(|| self.output.step(demand.command));

        if let Some(samples) = samples {
            samples.unwrap.push(unwrap);
            for (samples, count) in samples.estimators.iter_mut().zip(estimator_counts) {
                samples.push(count);
            }
            samples.trajectory.push(trajectory);
            samples.controller.push(control);
            samples.supervisor.push(before + after);
            samples.output.push(output);
        }
    }
}
