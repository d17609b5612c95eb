//! Experiments: told, run and read.

use leadscrew::identification::program::Program;
use leadscrew::protocol::experiment::requests;
use leadscrew::protocol::reply::Reply;
use leadscrew::protocol::request::Request;

use super::Axis;
use crate::error::Error;

/// How an experiment stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ExperimentStatus {
    /// The tick that it tells of.
    pub tick: u32,
    /// Its phase, or how it ended.
    pub phase: ExperimentPhase,
    /// Segment under way.
    pub segment: u8,
    /// Ticks since it began.
    pub ticks: u32,
    /// Records in the work memory.
    pub records: u32,
    /// There was no room for a record, or a tick was lost on the way.
    pub is_torn: bool,
    /// Count of the encoder now.
    pub count: i64,
}

/// Where an experiment is, or how it ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExperimentPhase {
    /// There is none.
    None,
    /// It runs.
    Runs,
    /// Its program is over.
    Complete,
    /// It left its window.
    WindowLeft,
    /// It was faster than allowed.
    TooFast,
    /// It took longer than allowed.
    TooLong,
    /// It was ended from outside.
    Aborted,
    /// The axis did not permit it.
    NotPermitted,
}

impl ExperimentStatus {
    const fn of(reply: &Reply<'_>) -> Option<Self> {
        let Reply::Experiment {
            tick,
            ending,
            segment,
            ticks,
            records,
            is_torn,
            count,
        } = *reply
        else {
            return None;
        };
        let phase = match ending {
            0 => ExperimentPhase::None,
            1 => ExperimentPhase::Runs,
            2 => ExperimentPhase::Complete,
            3 => ExperimentPhase::WindowLeft,
            4 => ExperimentPhase::TooFast,
            5 => ExperimentPhase::TooLong,
            6 => ExperimentPhase::Aborted,
            7 => ExperimentPhase::NotPermitted,
            _ => return None,
        };
        Some(Self {
            tick,
            phase,
            segment,
            ticks,
            records,
            is_torn,
            count,
        })
    }
}

impl Axis {
    /// Tells the program of an experiment, starts it, and waits for its end. It is recorded into the work memory with
    /// `record_ticks` ticks a record; 0: behind the records before, as these were. The axis is not given back to its loop:
    /// [`Self::end_experiment`].
    ///
    /// # Errors
    /// [`Error::Refused`] where it may not run, [`Error::Faulted`].
    pub fn run_experiment(
        &mut self,
        program: &Program,
        record_ticks: u32,
    ) -> Result<ExperimentStatus, Error> {
        for request in requests(program) {
            self.order(&request)?;
        }
        self.order(&Request::StartExperiment { record_ticks })?;
        loop {
            let experiment = self.experiment()?;
            let begun = self.connection.has_begun(experiment.tick, self.ordered);
            if begun && experiment.phase != ExperimentPhase::Runs {
                return Ok(experiment);
            }
            let status = self.status()?;
            if status.fault_number != 0 {
                return Err(Error::Faulted(status.fault_number));
            }
            self.connection.check_lapse()?;
            self.connection.wait_a_look()?;
        }
    }

    /// Gives the axis back to its loop, and ends an experiment under way.
    ///
    /// # Errors
    /// [`Error::Refused`]
    pub fn end_experiment(&mut self) -> Result<(), Error> {
        self.order(&Request::EndExperiment {})
    }

    /// How the experiment stands.
    ///
    /// # Errors
    /// Of a lost axis.
    pub fn experiment(&mut self) -> Result<ExperimentStatus, Error> {
        self.query(&Request::Experiment {}, ExperimentStatus::of)
    }

    /// So many words of the work memory, from the first on.
    ///
    /// # Errors
    /// [`Error::Refused`] while it is in use; [`Error::Unexpected`] where there are not so many.
    pub fn read_work_words(&mut self, count: u32) -> Result<Vec<i32>, Error> {
        let mut words = Vec::new();
        while words.len() < count as usize {
            let more = self.read_work(words.len() as u32)?;
            if more.is_empty() {
                return Err(Error::Unexpected {
                    asked: "ReadWork".to_owned(),
                });
            }
            words.extend(more);
        }
        words.truncate(count as usize);
        Ok(words)
    }
}
