//! Experiments, recorded from the reports of their ticks.

use embedded_storage::nor_flash::NorFlash;
use leadscrew::identification::experiment::Ending;
use leadscrew::identification::recorder::Recorder;
use leadscrew::protocol::refusal::Refusal;
use leadscrew::protocol::reply::Reply;

use super::bench::{Bench, to_bytes};
use super::memory::Lent;
use crate::report::Report;

impl<F: NorFlash> Bench<F> {
    /// Makes room for the record of an experiment that is about to begin.
    #[inline(never)]
    pub fn begin_record(&mut self, record_ticks: u32) -> Result<(), Refusal> {
        if self.is_recording && self.is_running() {
            return Err(Refusal::ExperimentRuns);
        }
        match (&mut self.lent, record_ticks) {
            (Lent::Recorder(recorder, _), 0) => recorder.pause(),
            (_, 0) => return Err(Refusal::WrongProgram),
            _ => {
                let work = self.lent.reclaim().ok_or(Refusal::WorkMemoryLent)?;
                let mut recorder = Recorder::new(work.sums);
                recorder.clear(record_ticks);
                self.lent = Lent::Recorder(recorder, work.mean);
                self.is_torn = false;
            }
        }
        self.is_recording = true;
        Ok(())
    }

    fn is_running(&self) -> bool {
        let experiment = self.report.experiment;
        experiment.is_some_and(|experiment| experiment.ending.is_none())
    }

    /// Records the tick of an experiment, from its first one to that in which it ends.
    pub fn record_experiment(&mut self, report: &Report) {
        let (Lent::Recorder(recorder, _), Some(experiment), true) =
            (&mut self.lent, report.experiment, self.is_recording)
        else {
            return;
        };
        if experiment.ticks == 1 {
            recorder.pause();
        }
        recorder.take(experiment.position, experiment.in_force);
        self.is_torn |= recorder.is_full();
        self.is_recording = experiment.ending.is_none();
    }

    pub fn experiment(&self) -> Reply<'static> {
        let seen = self.report.experiment.unwrap_or_default();
        let ending = match (self.report.experiment, seen.ending) {
            (None, _) => 0,
            (Some(_), None) => 1,
            (_, Some(Ending::Complete)) => 2,
            (_, Some(Ending::WindowLeft)) => 3,
            (_, Some(Ending::TooFast)) => 4,
            (_, Some(Ending::TooLong)) => 5,
            (_, Some(Ending::Aborted)) => 6,
            (_, Some(Ending::NotPermitted)) => 7,
        };
        let records = match &self.lent {
            Lent::Recorder(recorder, _) => recorder.len() as u32,
            _ => 0,
        };
        Reply::Experiment {
            tick: self.seen.tick,
            ending,
            segment: seen.segment,
            ticks: seen.ticks,
            records,
            is_torn: self.is_torn,
            count: self.seen.count,
        }
    }

    #[inline(never)]
    pub fn read_work(&self, offset: u32, say: &mut dyn FnMut(&Reply<'_>)) -> Result<(), Refusal> {
        let words = self.lent.words().ok_or(Refusal::WorkMemoryLent)?;
        let words = words.get(offset as usize..).unwrap_or_default();
        let bytes = to_bytes(words.iter());
        say(&Reply::Words {
            offset,
            bytes: &bytes,
        });
        Ok(())
    }
}
