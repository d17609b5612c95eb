//! Runs of scenario files, what happened in them, and whether it was what the file expects.

mod events;
mod figures;
mod judge;

use leadscrew::axis::{Axis, Outputs};
use leadscrew::compensation::{
    ScrewError, ScrewPoint, ScrewTable, Stretch, TableError, TableRefused,
};
use leadscrew::encoder_map::EncoderMap;
use leadscrew::estimator::Variances;
use leadscrew::identification::experiment::{Ending, Experiment};
use leadscrew::probe::Report;
use leadscrew::setpoint::thread::SpindleTrouble;
use leadscrew::supervisor::FirstFault;
use leadscrew::units::Position;
use leadscrew_hal_mock::arc::State;
use leadscrew_hal_mock::encoder::EncoderModel;
use leadscrew_hal_mock::invariants::Violation;
use leadscrew_hal_mock::scenario::{Happening, Runner, Scenario, ScenarioError, ScrewReading};
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
    /// The origin is known.
    pub homed: bool,
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
    /// What the probe came to.
    pub probe: Report,
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
    /// The points of the screw make no table.
    #[error("[[screw]]: {0}")]
    Screw(#[from] TableError),
    /// The axis cannot follow the table of the screw.
    #[error("[[screw]]: {0}")]
    Table(#[from] TableRefused),
}

/// Runs a scenario.
///
/// # Errors
/// [`RunError`]; what the axis refuses while it runs is no error.
pub fn run(scenario: &Scenario<'_>) -> Result<Record, RunError> {
    let image = scenario.mapped.then(|| learn(scenario)).transpose()?;
    let map = image.as_deref().map(EncoderMap::from_bytes).transpose()?;
    let points = screw_points(scenario);
    let mut memory = vec![Stretch::default(); points.len()];
    let screw = if points.is_empty() {
        None
    } else {
        Some(ScrewTable::build(&points, &mut memory)?)
    };
    // Map and table have to live as long as what the runner borrows.
    run_with(&Scenario { ..*scenario }, map, screw)
}

/// The readings of the screw in d.
fn screw_points(scenario: &Scenario<'_>) -> Vec<ScrewPoint> {
    let counts = scenario.plant().machine.mount.counts_per_mm;
    let point = |reading: &ScrewReading| ScrewPoint {
        position: Position::saturating_from_num(reading.position_mm * counts),
        error: [reading.forward_mm, reading.backward_mm]
            .map(|error| ScrewError::saturating_from_num(error * counts)),
    };
    scenario.screw.iter().map(point).collect()
}

fn learn(scenario: &Scenario<'_>) -> Result<Vec<u8>, CalibrationError> {
    let model: EncoderModel = scenario.plant().machine.encoder;
    let procedure = Procedure {
        tick_hz: scenario.tick_hz,
        ..Procedure::default()
    };
    learn_simulated(&model, scenario.seed, &procedure)
}

fn run_with<'s>(
    scenario: &Scenario<'s>,
    map: Option<EncoderMap<'s>>,
    screw: Option<ScrewTable<'s>>,
) -> Result<Record, RunError> {
    let mut runner = Runner::new(scenario)?;
    runner.axis.set_map(map);
    runner.axis.set_screw_table(screw)?;
    let mut progress = Progress::new("simulating", u64::from(runner.ticks()));
    let mut ticks = Vec::with_capacity(runner.ticks() as usize);
    let (mut actions, mut faults) = (Vec::new(), Vec::new());
    let mut experiment = None;
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
            homed: runner.axis.homing().origin().is_some(),
        });
        experiment = runner
            .axis
            .experiment()
            .map(Experiment::ending)
            .or(experiment);
        progress.step();
    }
    Ok(Record {
        ticks,
        actions,
        faults,
        violation: runner.violation(),
        notes: notes(&runner.axis, experiment),
        probe: *runner.axis.probe().report(),
        digest: runner.digest(),
        tick_hz: scenario.tick_hz,
        counts_per_mm: scenario.plant().machine.mount.counts_per_mm,
    })
}

/// What the axis has to say beside its faults.
fn notes(axis: &Axis<'_>, experiment: Option<Option<Ending>>) -> Vec<String> {
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
    let probe = axis.probe().report().end.map(|end| format!("probe: {end}"));
    let experiment = experiment.map(|found| format!("experiment: {}", ending(found)));
    [homing, distance, probe, spindle, experiment]
        .into_iter()
        .flatten()
        .collect()
}

/// How the last experiment ended, if it did.
const fn ending(found: Option<Ending>) -> &'static str {
    match found {
        None => "broken off before its end",
        Some(Ending::Complete) => "it came to its end",
        Some(Ending::WindowLeft) => "the axis left its window",
        Some(Ending::TooFast) => "the axis was too fast",
        Some(Ending::TooLong) => "it took too long",
        Some(Ending::Aborted) => "it was aborted",
        Some(Ending::NotPermitted) => "the supervisor ended it",
    }
}
