//! The order of experiments, and how the axis is taken through them.

use super::drive::Vector;
use super::evidence::{Broke, pulses};
use super::experiment::{Ending, Experiment};
use super::fit::{Fit, Problem};
use super::identified::Identified;
use super::plan::{IdentifyParams, Main, Plan};
use super::program::Program;
use super::recorder::{Recorder, Records};
use super::refusal::Refusal;
use super::stages::Stage;
use crate::axis::{Axis, StartError};
use crate::supervisor::Fault;
use crate::units::AxisScale;

/// Fewest records that there must be room for.
pub const MIN_RECORDS: usize = 6000;
/// Longest wait for rest before an experiment, s.
const LONGEST_WAIT_S: f64 = 3.0;

/// What comes next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Next {
    /// An experiment for the axis.
    Run(Program),
    /// The end.
    Done(Identified),
}

/// Identification of a drive, experiment by experiment.
#[derive(Debug)]
pub struct Identification<'w> {
    pub(super) plan: Plan,
    pub(super) scale: AxisScale,
    pub(super) recorder: Recorder<'w>,
    pub(super) stage: Option<Stage>,
    running: bool,
    /// Records of the experiment that runs go on behind those before.
    goes_on: bool,
    /// A program that waits for rest, and for how many ticks it has.
    waiting: Option<(Program, u32)>,
    /// Count at which all of it began.
    centre: i64,
    /// Level of the proof.
    pub(super) level: f64,
    pub(super) drifts: bool,
    pub(super) broke: [Option<Broke>; 2],
    pub(super) probe_levels: [f64; 2],
    pub(super) probe: Option<Vector>,
    pub(super) main: Option<Main>,
    pub(super) fit: Option<(Fit, Option<[f64; 2]>)>,
}

impl<'w> Identification<'w> {
    /// Identification within `params` on an axis with `scale`, whose speed at full command is thought to be about
    /// `full_velocity` d/tick; `memory` takes the records.
    ///
    /// # Errors
    /// [`Refusal`] for a parameter out of range, or memory for fewer than [`MIN_RECORDS`].
    pub fn new(
        params: &IdentifyParams,
        scale: AxisScale,
        full_velocity: f64,
        memory: &'w mut [i32],
    ) -> Result<Self, Refusal> {
        if memory.len() < MIN_RECORDS {
            return Err(Refusal::WorkMemory {
                given: memory.len(),
                needed: MIN_RECORDS,
            });
        }
        Ok(Self {
            plan: Plan::new(params, scale, full_velocity)?,
            scale,
            recorder: Recorder::new(memory),
            stage: None,
            running: false,
            goes_on: false,
            waiting: None,
            centre: 0,
            level: 0.0,
            drifts: false,
            broke: [None; 2],
            probe_levels: [0.0; 2],
            probe: None,
            main: None,
            fit: None,
        })
    }

    /// What runs; none before the first experiment.
    #[must_use]
    pub const fn stage(&self) -> Option<Stage> {
        self.stage
    }

    /// Command of the proof of the sign, of full command: the last one tried.
    #[must_use]
    pub const fn level(&self) -> f64 {
        self.level
    }

    /// Takes what a tick of the experiment saw, right after that tick.
    pub fn feed(&mut self, experiment: &Experiment) {
        if self.running {
            self.recorder.feed(experiment);
            self.running = experiment.ending().is_none();
        }
    }

    /// After each tick of `axis`: takes its record and starts what comes next. The result ends it, and gives the axis
    /// back to its loop.
    ///
    /// # Errors
    /// [`Refusal`]. The loop then stays open at zero command: disable the axis before it is released.
    pub fn tend(&mut self, axis: &mut Axis<'_>) -> Result<Option<Identified>, Refusal> {
        if let Some((program, waited)) = self.waiting.take() {
            return self.start(axis, program, waited).map(|()| None);
        }
        let mut ending = None;
        if let Some(experiment) = axis.experiment() {
            self.feed(experiment);
            ending = experiment.ending();
        }
        if self.running {
            return Ok(None);
        }
        if let Some(fault) = axis.outputs().fault {
            self.judge(fault)?;
        }
        match self.next(axis.outputs().count, ending)? {
            Next::Run(program) => self.start(axis, program, 0).map(|()| None),
            Next::Done(identified) => {
                axis.release_experiment();
                Ok(Some(identified))
            }
        }
    }

    /// Ticks of a record of the experiment that [`Self::next`] gave, for an axis elsewhere; 0: its records go on behind
    /// those before, as these are.
    #[must_use]
    pub const fn record_ticks(&self) -> u32 {
        if self.goes_on {
            0
        } else {
            self.recorder.decimation()
        }
    }

    /// Takes all records that an axis elsewhere has, of the experiments since [`Self::record_ticks`] was not 0, in place of
    /// [`Self::feed`].
    pub fn load(&mut self, words: &[i32]) {
        self.recorder.load(words, self.recorder.decimation());
        self.running = false;
    }

    /// What a fault that cut the proof of the sign short says of it.
    ///
    /// # Errors
    /// [`Refusal`] where it says something.
    pub fn judge(&self, fault: Fault) -> Result<(), Refusal> {
        let [moved_d, _] = pulses(self.recorder.records());
        let level = self.level;
        match (self.stage, fault) {
            (Some(Stage::Proof), Fault::EncoderLoss) => Err(Refusal::NoMotion { level, moved_d }),
            (Some(Stage::Proof), Fault::MotionAgainstCommand) => {
                Err(Refusal::WrongPolarity { level, moved_d })
            }
            _ => Ok(()),
        }
    }

    /// Starts a program as soon as the axis has come to rest.
    fn start(&mut self, axis: &mut Axis<'_>, program: Program, waited: u32) -> Result<(), Refusal> {
        let most = LONGEST_WAIT_S * self.plan.tick_hz;
        match axis.start_experiment(&program) {
            Err(StartError::NotAtRest) if f64::from(waited) < most => {
                self.waiting = Some((program, waited.saturating_add(1)));
                Ok(())
            }
            started => Ok(started?),
        }
    }

    /// What comes after an experiment that ended so, with the axis at `count`. Takes its time: fits are made here.
    ///
    /// # Errors
    /// [`Refusal`].
    pub fn next(&mut self, count: i64, ending: Option<Ending>) -> Result<Next, Refusal> {
        let offset = count.wrapping_sub(self.centre) as f64;
        match (self.stage, ending) {
            (None, _) => {
                self.centre = count;
                self.prove()
            }
            (Some(stage), Some(Ending::Complete)) => match stage {
                Stage::Proof => self.proved(),
                Stage::Ramps => self.ramped(offset),
                Stage::Probe => self.probed(offset),
                Stage::Main(number) => self.measured(number, offset),
            },
            (Some(Stage::Proof), Some(Ending::WindowLeft | Ending::TooFast)) => {
                Err(Refusal::RunsAway { level: self.level })
            }
            (Some(stage), ending) => Err(Refusal::Ended {
                stage,
                ending: ending.unwrap_or(Ending::NotPermitted),
            }),
        }
    }

    pub(super) fn run(&mut self, stage: Stage, program: Program, decimation: Option<u32>) -> Next {
        match decimation {
            Some(decimation) => self.recorder.clear(decimation),
            None => self.recorder.pause(),
        }
        self.goes_on = decimation.is_none();
        self.stage = Some(stage);
        self.running = true;
        let aligned = program.aligned(self.recorder.decimation());
        Next::Run(aligned.about(self.centre))
    }

    /// Measured and modelled motion of the main experiments: number of the record, its measured and modelled velocity
    /// in d/tick and the error of position in d. Nothing before the end.
    pub fn trace(&self, mut see: impl FnMut(usize, f64, f64, f64)) {
        let Some((fit, held)) = &self.fit else {
            return;
        };
        let ticks = f64::from(self.recorder.decimation());
        let problem = Problem {
            records: self.recorder.records(),
            free: [false; super::drive::PARAMETERS],
            held: *held,
            ln_stribeck: 0.0,
        };
        problem.trace(&fit.vector, |index, measured, modelled, error| {
            see(index, measured / ticks, modelled / ticks, error);
        });
    }

    /// The records of the last experiments.
    #[must_use]
    pub fn records(&self) -> Records<'_> {
        self.recorder.records()
    }

    /// Ticks of a record.
    #[must_use]
    pub const fn ticks_of_record(&self) -> u32 {
        self.recorder.decimation()
    }
}
