//! Runs of scenario files, what happened in them, and whether it was what the file expects.

mod events;
mod figures;
mod judge;

use leadscrew::axis::{Axis, Outputs};
use leadscrew::encoder_map::EncoderMap;
use leadscrew::estimator::Variances;
use leadscrew::setpoint::thread::SpindleTrouble;
use leadscrew::supervisor::FirstFault;
use leadscrew_hal_mock::arc::State;
use leadscrew_hal_mock::encoder::EncoderModel;
use leadscrew_hal_mock::invariants::Violation;
use leadscrew_hal_mock::scenario::{Happening, Runner, Scenario, ScenarioError};
use thiserror::Error;

pub use self::events::{Event, What};
pub use self::figures::{Figures, Stop};
pub use self::judge::{Verdict, judge, short};

use crate::calibration::{CalibrationError, Procedure, learn_simulated};
use crate::progress::Progress;

/// A tick of a run.
#[derive(Clone, Copy, Debug)]
pub struct Tick {
    /// What the axis put out.
    pub outputs: Outputs,
    /// How uncertain its estimate is.
    pub variances: Variances,
    /// The screw, as it really moves: what the encoder says if nothing is wrong with it.
    pub shaft: State,
    /// Carriage, d.
    pub carriage: f64,
}

/// A finished run.
#[derive(Clone, Debug)]
pub struct Record {
    /// The ticks.
    pub ticks: Vec<Tick>,
    /// What became of each action, in the order of the timeline.
    pub actions: Vec<Happening>,
    /// Every fault that was latched, with its context.
    pub faults: Vec<FirstFault>,
    /// The first rule that holds in every run and did not in this.
    pub violation: Option<Violation>,
    /// Why homing failed and what was wrong with the spindle, for people.
    pub notes: Vec<String>,
    /// Digest of inputs and outputs of the axis.
    pub digest: u64,
    /// Control rate, Hz.
    pub tick_hz: f64,
    /// Encoder resolution, d/mm.
    pub counts_per_mm: f64,
}

/// Why a scenario could not run.
#[derive(Debug, Error)]
pub enum RunError {
    /// A parameter is out of range.
    #[error(transparent)]
    Scenario(#[from] ScenarioError),
    /// The encoder's map could not be learned.
    #[error("the encoder's map cannot be learned: {0}")]
    Map(#[from] CalibrationError),
    /// The encoder's map cannot be read back.
    #[error("the encoder's map cannot be used: {0}")]
    Image(#[from] leadscrew::encoder_map::error::MapError),
}

/// Runs a scenario.
///
/// # Errors
/// [`RunError`]; what the axis refuses while it runs is no error.
pub fn run(scenario: &Scenario<'_>) -> Result<Record, RunError> {
    let image = scenario.mapped.then(|| learn(scenario)).transpose()?;
    let map = image.as_deref().map(EncoderMap::from_bytes).transpose()?;
    // The map has to live as long as what the runner borrows.
    run_with(&Scenario { ..*scenario }, map)
}

fn learn(scenario: &Scenario<'_>) -> Result<Vec<u8>, CalibrationError> {
    let model: EncoderModel = scenario.plant().machine.encoder;
    let procedure = Procedure {
        tick_hz: scenario.tick_hz,
        ..Procedure::default()
    };
    learn_simulated(&model, scenario.seed, &procedure)
}

fn run_with<'s>(scenario: &Scenario<'s>, map: Option<EncoderMap<'s>>) -> Result<Record, RunError> {
    let mut runner = Runner::new(scenario)?;
    runner.axis.set_map(map);
    let mut progress = Progress::new("simulating", u64::from(runner.ticks()));
    let mut ticks = Vec::with_capacity(runner.ticks() as usize);
    let (mut actions, mut faults) = (Vec::new(), Vec::new());
    while let Some(outputs) = runner.step(|happening| actions.push(happening)) {
        let outputs = *outputs;
        let latched = runner.axis.supervisor().first_fault();
        match latched {
            Some(first) if first.tick == outputs.tick => faults.push(*first),
            _ => {}
        }
        let machine = &runner.world.board.machine;
        ticks.push(Tick {
            outputs,
            variances: runner.axis.variances(),
            shaft: machine.screw(),
            carriage: machine.truth().carriage.position,
        });
        progress.step();
    }
    Ok(Record {
        ticks,
        actions,
        faults,
        violation: runner.violation(),
        notes: notes(&runner.axis),
        digest: runner.digest(),
        tick_hz: scenario.tick_hz,
        counts_per_mm: scenario.plant().machine.mount.counts_per_mm,
    })
}

/// What the axis has to say beside its faults.
fn notes(axis: &Axis<'_>) -> Vec<String> {
    let homing = axis.homing().failure().map(|failure| failure.to_string());
    let distance = axis
        .homing()
        .index_distance()
        .map(|distance| format!("home switch to index: {distance} d"));
    let spindle = axis.spindle_trouble().map(|trouble| {
        let what = match trouble {
            SpindleTrouble::NoSignal => "no signal comes from its encoder",
            SpindleTrouble::IndexSlipped => "its index came elsewhere than counted, or not at all",
            SpindleTrouble::TooSlow => "it turned slower than the pass allows for, or back",
            SpindleTrouble::TooFast => "it turned faster than the pass allows for",
            SpindleTrouble::Jumped => "its count jumped",
        };
        format!("spindle: {what}")
    });
    [homing, distance, spindle].into_iter().flatten().collect()
}
