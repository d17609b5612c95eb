//! Learning the encoder, from the captures of the ticks.

use embedded_storage::nor_flash::NorFlash;
use leadscrew::calibration::{
    Bands, Disagreement, Learner, Progress, Refusal as LearnRefusal, Requirements, Residual,
    RunPlan, RunSummary,
};
use leadscrew::capture::Unwrapper;
use leadscrew::encoder_map::{EncoderMap, Form};
use leadscrew::protocol::refusal::Refusal;
use leadscrew::protocol::reply::Reply;

use super::bench::Bench;
use super::memory::{Lent, MAP_BYTES};
use crate::axis_control::What;

/// What came of learning so far.
#[derive(Default)]
pub(super) struct Learning {
    last: Option<RunSummary>,
    refusal: Option<LearnRefusal>,
    learned: Option<Learned>,
}

/// A map that is not in use yet.
struct Learned {
    image: &'static mut [u8; MAP_BYTES],
    length: usize,
    errors: Bands,
    disagreement: Disagreement,
    residual: Residual,
}

impl<F: NorFlash> Bench<F> {
    #[inline(never)]
    pub fn begin_learning(&mut self, edges: u32) -> Result<(), Refusal> {
        if self.is_recording {
            return Err(Refusal::WorkMemoryLent);
        }
        // One that is under way is dropped.
        let _ = self.end_learning();
        // Said now: a run takes minutes.
        if self.map_places.is_empty() {
            return Err(Refusal::MapMemoryTaken);
        }
        let work = self.lent.reclaim().ok_or(Refusal::WorkMemoryLent)?;
        if let Err(refusal) = Learner::check(edges, &work) {
            self.lent = Lent::Free(work);
            self.learning.refusal = Some(refusal);
            return Err(Refusal::LearningRefused);
        }
        self.lent = match Learner::new(edges, self.timer_hz, work) {
            Ok(learner) => Lent::Learner(learner),
            // It was checked.
            Err(_) => Lent::Nobody,
        };
        self.learning.last = None;
        self.learning.refusal = None;
        Ok(())
    }

    #[inline(never)]
    pub fn begin_run(&mut self, revolutions: u32) -> Result<(), Refusal> {
        let Lent::Learner(learner) = &mut self.lent else {
            return Err(Refusal::NotLearning);
        };
        self.learning.refusal = None;
        if let Err(refusal) = learner.begin_run(RunPlan::steady(revolutions)) {
            self.learning.refusal = Some(refusal);
            return Err(Refusal::LearningRefused);
        }
        self.tell(What::Captures(true))?;
        self.captures.clear();
        self.unwrapper = Unwrapper::new();
        Ok(())
    }

    /// Feeds the run under way with the captures that came.
    pub fn learn(&mut self) {
        let Lent::Learner(learner) = &mut self.lent else {
            return;
        };
        if matches!(learner.progress(), None | Some(Progress::Complete)) {
            return;
        }
        let (unwrapper, learning) = (&mut self.unwrapper, &mut self.learning);
        let mut is_over = false;
        while !is_over {
            let fed = self
                .captures
                .next(|capture| learner.feed(&unwrapper.unwrap(capture)));
            match fed {
                None => return,
                // It is ended when the axis stands: that takes long, and nobody looks after the lease meanwhile.
                Some(Ok(Progress::Complete)) => is_over = true,
                Some(Ok(_)) => {}
                Some(Err(refusal)) => {
                    is_over = true;
                    learning.refusal = Some(refusal);
                }
            }
        }
        // With a full queue it goes on, and nobody listens.
        let _ = self.tell(What::Captures(false));
    }

    /// Adds the run that is complete to those before.
    #[inline(never)]
    pub fn end_run(&mut self) -> Result<(), Refusal> {
        let Lent::Learner(learner) = &mut self.lent else {
            return Err(Refusal::NotLearning);
        };
        match learner.end_run() {
            Ok(summary) => {
                self.learning.last = Some(summary);
                Ok(())
            }
            Err(refusal) => {
                self.learning.refusal = Some(refusal);
                Err(Refusal::LearningRefused)
            }
        }
    }

    pub fn learning_reply(&self) -> Reply<'static> {
        let learning = &self.learning;
        let mut revolutions = 0;
        let mut runs = 0;
        let mut phase = if learning.learned.is_some() { 6 } else { 0 };
        if let Lent::Learner(learner) = &self.lent {
            runs = learner.runs() as u8;
            phase = match learner.progress() {
                None => 1,
                Some(Progress::SeekingIndex) => 2,
                Some(Progress::MeasuringSpeed) => 3,
                Some(Progress::Averaging { revolutions: whole }) => {
                    revolutions = whole;
                    4
                }
                Some(Progress::Complete) => 5,
            };
        }
        Reply::Learning {
            phase,
            revolutions,
            runs,
            last: learning.last,
            refusal: learning.refusal,
        }
    }

    #[inline(never)]
    pub fn finish_learning(&mut self) -> Result<(), Refusal> {
        let Lent::Learner(learner) = &mut self.lent else {
            return Err(Refusal::NotLearning);
        };
        let learning = &mut self.learning;
        let place = match learning.learned.take() {
            Some(learned) => Some(learned.image),
            None => self.map_places.pop(),
        };
        let image = place.ok_or(Refusal::MapMemoryTaken)?;
        let made = match learner.conclude(&Requirements::default()) {
            Ok(learned) => {
                let report = learned.report();
                let (errors, disagreement, residual) =
                    (report.errors, report.disagreement, report.residual);
                let length = learned.encode(Form::Full, image);
                length
                    .map(|length| (length, errors, disagreement, residual))
                    .map_err(|_| Refusal::WrongContent)
            }
            Err(refusal) => {
                learning.refusal = Some(refusal);
                Err(Refusal::LearningRefused)
            }
        };
        match made {
            Ok((length, errors, disagreement, residual)) => {
                learning.learned = Some(Learned {
                    image,
                    length,
                    errors,
                    disagreement,
                    residual,
                });
                self.give_back_learner();
                Ok(())
            }
            Err(refusal) => {
                let _ = self.map_places.push(image);
                Err(refusal)
            }
        }
    }

    pub fn learned(&self) -> Result<Reply<'static>, Refusal> {
        let learned = self.learning.learned.as_ref();
        let learned = learned.ok_or(Refusal::NotLearning)?;
        Ok(Reply::Learned {
            errors: learned.errors,
            disagreement: learned.disagreement,
            residual: learned.residual,
            length: learned.length as u32,
        })
    }

    /// Takes the learned map into use. Its memory is the axis's until the next restart.
    pub fn take_map(&mut self) -> Result<(), Refusal> {
        let learned = self.learning.learned.take();
        let Learned { image, length, .. } = learned.ok_or(Refusal::NotLearning)?;
        let image: &'static [u8; MAP_BYTES] = image;
        let image = image.get(..length).unwrap_or_default();
        let map = EncoderMap::from_bytes(image).map_err(|_| Refusal::WrongContent)?;
        self.tell(What::SetMap(Some(map)))?;
        self.map = Some(image);
        Ok(())
    }

    #[inline(never)]
    pub fn end_learning(&mut self) -> Result<(), Refusal> {
        if let Some(learned) = self.learning.learned.take() {
            let _ = self.map_places.push(learned.image);
        }
        if matches!(self.lent, Lent::Learner(_)) {
            self.give_back_learner();
            return self.tell(What::Captures(false));
        }
        Ok(())
    }

    fn give_back_learner(&mut self) {
        match core::mem::replace(&mut self.lent, Lent::Nobody) {
            Lent::Learner(learner) => self.lent = Lent::Free(learner.into_work()),
            other => self.lent = other,
        }
    }
}
