//! A stretch of a recording fed to a learner.

use leadscrew::calibration::{Learner, MIN_REVOLUTIONS, Progress, Refusal, RunPlan, RunSummary};
use leadscrew::capture::Unwrapper;
use leadscrew::hal::{Capture, Latch};

use super::{Candidate, Options, RunFigures, refused, timer_hz};
use crate::calibration::CalibrationError;
use crate::calibration::stretches::Motion;
use crate::recording::Recording;
use crate::sampler::Sampler;

/// Adds a run to the learner, with an index every `revolution` counts instead of the recording's if that is given.
pub fn learn(
    learner: &mut Learner<'_>,
    recordings: &[Recording],
    options: &Options,
    candidate: &Candidate,
    revolution: Option<u32>,
) -> Result<RunFigures, CalibrationError> {
    let feeding = Feeding {
        recording: &recordings[candidate.recording],
        tick_hz: options.tick_hz,
        timer_hz: timer_hz(recordings),
        candidate,
        revolution: revolution.map(i64::from),
    };
    let mut revolutions = candidate.revolutions();
    loop {
        let plan = Candidate::plan(options.motion, revolutions);
        match feeding.feed(learner, plan) {
            Ok(summary) => {
                return Ok(RunFigures {
                    recording: candidate.recording,
                    stretch: candidate.stretch,
                    summary,
                });
            }
            // An index early in its tick costs a revolution more.
            Err(Refusal::TooFewRevolutions { found, .. })
                if (MIN_REVOLUTIONS..revolutions).contains(&found) =>
            {
                revolutions = found;
            }
            // How far a flywheel keeps to a constant deceleration shows on the way.
            Err(Refusal::SpeedChanging { revolution, .. })
                if options.motion == Motion::Coast && shorter(revolution) < revolutions =>
            {
                revolutions = shorter(revolution);
            }
            Err(cause) => return Err(refused(candidate, options, cause)),
        }
    }
}

/// An average that ends before a revolution of the run; [`MIN_REVOLUTIONS`] at least.
fn shorter(revolution: u32) -> u32 {
    revolution.saturating_sub(4).max(MIN_REVOLUTIONS)
}

struct Feeding<'a> {
    recording: &'a Recording,
    tick_hz: f64,
    timer_hz: u64,
    candidate: &'a Candidate,
    revolution: Option<i64>,
}

impl Feeding<'_> {
    fn feed(&self, learner: &mut Learner<'_>, plan: RunPlan) -> Result<RunSummary, Refusal> {
        let mut sampler = Sampler::new(self.recording, self.tick_hz).with_timer_hz(self.timer_hz);
        let mut unwrapper = Unwrapper::new();
        learner.begin_run(plan)?;
        let stretch = &self.candidate.stretch;
        let (mut tick, mut before) = (0, 0);
        while let Some(mut capture) = sampler.next_capture() {
            if let Some(revolution) = self.revolution {
                capture.index = virtual_index(&capture, before, revolution);
            }
            let seen = unwrapper.unwrap(&capture);
            before = seen.count;
            if tick >= stretch.from && learner.feed(&seen)? == Progress::Complete {
                break;
            }
            tick += 1;
            if tick == stretch.to {
                break;
            }
        }
        learner.end_run()
    }
}

/// An index where the count, `before` at the last tick, reaches a multiple of a revolution.
fn virtual_index(capture: &Capture<'_>, before: i64, revolution: i64) -> Option<Latch> {
    let count = i64::from(capture.count.cast_signed());
    let multiple = if count > before {
        count.div_euclid(revolution) * revolution
    } else {
        // The multiple at or above.
        -(-count).div_euclid(revolution) * revolution
    };
    let reached = if count > before {
        multiple > before
    } else {
        multiple < before
    };
    reached.then_some(Latch {
        count: multiple as u32,
        time: capture.sampled_at,
    })
}
