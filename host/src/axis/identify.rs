//! Identification of the drive of an axis over its link: the axis runs the experiments, the fits are made here.

use leadscrew::identification::experiment::Ending;
use leadscrew::identification::program::Program;
use leadscrew::identification::{Identification, Identified, IdentifyParams, Next, Stage};
use leadscrew::protocol::refusal::Refusal;
use leadscrew::settings::Settings;
use leadscrew::supervisor::Fault;
use leadscrew::units::{AxisScale, RangeError};
use leadscrew_client::{Axis, Error, ExperimentPhase, ExperimentStatus};
use std::time::Duration;

use super::ProcedureError;
use super::calm::{made_ready, switched_off};
use crate::identify::{Sample, samples};

/// Words of the work memory of an axis.
const MEMORY: usize = 10_000;
/// Longest wait for rest before an experiment, and the time between two looks.
const REST: Duration = Duration::from_secs(3);
const LOOK: Duration = Duration::from_millis(50);

/// What was found of an axis.
#[derive(Clone, Debug)]
pub struct IdentifiedAxis {
    /// The figures.
    pub identified: Identified,
    /// The records they were made of.
    pub samples: Vec<Sample>,
    /// Time of the axis that the experiments took, s.
    pub duration_s: f64,
    /// Furthest that it was seen from where it began, mm.
    pub furthest_mm: f64,
}

/// Counts and ticks of an axis with these settings.
pub(super) fn scale_of(settings: &Settings) -> Result<AxisScale, RangeError> {
    AxisScale::new(settings.axis.motion.counts_per_mm, settings.axis.tick_hz)
}

/// Identifies the drive within `params`; `progress` hears what runs. The axis is enabled, moved, and switched off again.
///
/// # Errors
/// [`ProcedureError`]; the drive is off then.
pub fn identify(
    axis: &mut Axis,
    settings: &Settings,
    params: &IdentifyParams,
    progress: &mut dyn FnMut(&str),
) -> Result<IdentifiedAxis, ProcedureError> {
    let scale = scale_of(settings)?;
    let mut memory = vec![0; MEMORY];
    let mut identification = begin(settings, params, &mut memory)?;
    let mut run = Run::begin(axis)?;
    let outcome = run.all(axis, &mut identification, |_| false, progress);
    let found = switched_off(axis, outcome)?;
    let identified = found.ok_or(ProcedureError::Declined)?;
    Ok(IdentifiedAxis {
        identified,
        samples: samples(&identification, settings.axis.tick_hz),
        duration_s: f64::from(run.ticks(axis)?) / settings.axis.tick_hz,
        furthest_mm: scale.mm_from_counts(run.furthest_d as f64),
    })
}

/// Proves the sign alone, by the first pulses of identification; gives the command that moved the axis, of full command.
/// The axis is enabled, moved by `params.proof_distance_mm` at most, and switched off again.
///
/// # Errors
/// [`ProcedureError`], above all a wrong polarity; the drive is off then.
pub fn prove_sign(
    axis: &mut Axis,
    settings: &Settings,
    params: &IdentifyParams,
    progress: &mut dyn FnMut(&str),
) -> Result<f64, ProcedureError> {
    let mut memory = vec![0; MEMORY];
    let mut identification = begin(settings, params, &mut memory)?;
    let mut run = Run::begin(axis)?;
    let is_proved = |stage| stage == Stage::Ramps;
    let outcome = run.all(axis, &mut identification, is_proved, progress);
    switched_off(axis, outcome)?;
    Ok(identification.level())
}

fn begin<'w>(
    settings: &Settings,
    params: &IdentifyParams,
    memory: &'w mut [i32],
) -> Result<Identification<'w>, ProcedureError> {
    let scale = scale_of(settings)?;
    let full = scale.velocity_from_feed(settings.axis.motion.full_command_feed_mm_per_min)?;
    Ok(Identification::new(params, scale, full, memory)?)
}

/// Experiments under way.
struct Run {
    words: Vec<i32>,
    began: ExperimentStatus,
    furthest_d: u64,
}

impl Run {
    /// Enables the axis.
    fn begin(axis: &mut Axis) -> Result<Self, ProcedureError> {
        made_ready(axis)?;
        Ok(Self {
            words: Vec::new(),
            began: axis.experiment()?,
            furthest_d: 0,
        })
    }

    fn ticks(&self, axis: &mut Axis) -> Result<u32, Error> {
        Ok(axis.experiment()?.tick.wrapping_sub(self.began.tick))
    }

    /// Runs what comes next until the end, or until a stage that is not wanted any more.
    fn all(
        &mut self,
        axis: &mut Axis,
        identification: &mut Identification<'_>,
        is_enough: impl Fn(Stage) -> bool,
        progress: &mut dyn FnMut(&str),
    ) -> Result<Option<Identified>, ProcedureError> {
        let mut count = self.began.count;
        let mut ending = None;
        loop {
            let next = axis.keep_alive_while(|| identification.next(count, ending))??;
            let program = match next {
                Next::Done(identified) => return Ok(Some(identified)),
                Next::Run(program) => program,
            };
            if let Some(stage) = identification.stage() {
                if is_enough(stage) {
                    return Ok(None);
                }
                progress(&stage.to_string());
            }
            let ended = self.run(axis, identification, &program)?;
            count = ended.count;
            ending = ending_of(ended.phase);
        }
    }

    /// Runs an experiment and fetches its records.
    fn run(
        &mut self,
        axis: &mut Axis,
        identification: &mut Identification<'_>,
        program: &Program,
    ) -> Result<ExperimentStatus, ProcedureError> {
        let ran = run_from_rest(axis, program, identification.record_ticks());
        let ended = match ran {
            Ok(ended) => ended,
            Err(Error::Faulted(number)) => {
                // What was recorded until then may say why.
                let ended = axis.experiment()?;
                self.fetch(axis, identification, &ended)?;
                if let Some(fault) = Fault::from_number(number) {
                    identification.judge(fault)?;
                }
                return Err(Error::Faulted(number).into());
            }
            Err(error) => return Err(error.into()),
        };
        self.fetch(axis, identification, &ended)?;
        let away = ended.count.abs_diff(self.began.count);
        self.furthest_d = self.furthest_d.max(away);
        if ended.is_torn {
            return Err(ProcedureError::Torn);
        }
        Ok(ended)
    }

    fn fetch(
        &mut self,
        axis: &mut Axis,
        identification: &mut Identification<'_>,
        ended: &ExperimentStatus,
    ) -> Result<(), Error> {
        if identification.record_ticks() != 0 {
            self.words.clear();
        }
        while self.words.len() < ended.records as usize {
            let more = axis.read_work(self.words.len() as u32)?;
            if more.is_empty() {
                break;
            }
            self.words.extend(more);
        }
        self.words.truncate(ended.records as usize);
        identification.load(&self.words);
        Ok(())
    }
}

/// Runs an experiment as soon as the axis has come to rest.
pub(super) fn run_from_rest(
    axis: &mut Axis,
    program: &Program,
    record_ticks: u32,
) -> Result<ExperimentStatus, Error> {
    let mut waited = Duration::ZERO;
    loop {
        match axis.run_experiment(program, record_ticks) {
            Err(error) if error.refusal() == Some(Refusal::NotAtRest) && waited < REST => {
                axis.wait(LOOK)?;
                waited += LOOK;
            }
            outcome => return outcome,
        }
    }
}

const fn ending_of(phase: ExperimentPhase) -> Option<Ending> {
    match phase {
        ExperimentPhase::None | ExperimentPhase::Runs => None,
        ExperimentPhase::Complete => Some(Ending::Complete),
        ExperimentPhase::WindowLeft => Some(Ending::WindowLeft),
        ExperimentPhase::TooFast => Some(Ending::TooFast),
        ExperimentPhase::TooLong => Some(Ending::TooLong),
        ExperimentPhase::Aborted => Some(Ending::Aborted),
        ExperimentPhase::NotPermitted => Some(Ending::NotPermitted),
    }
}
