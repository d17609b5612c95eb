//! One run: find the index, measure the speed, average over the revolutions.

use super::average::{Average, Passed};
use super::index::Fronts;
use super::plan::{MEASURING_REVOLUTIONS, Progress, RunPlan};
use super::reference::POSITION_FRAC;
use super::refusal::Refusal;
use super::segments::within_revolution;
use super::timing::Timing;
use crate::capture::Observation;

/// Longest revolution, timer clocks.
const LONGEST_REVOLUTION: i64 = 1 << 30;

#[derive(Clone, Debug)]
#[expect(
    clippy::large_enum_variant,
    reason = "one run at a time, and nowhere to box it"
)]
enum Stage {
    Seeking,
    Timing(Timing),
    Averaging(Average),
}

/// A run under way.
#[derive(Clone, Debug)]
pub struct Run {
    plan: RunPlan,
    edges: u32,
    timer_hz: f64,
    stage: Stage,
    /// +1 or −1; 0 before the index.
    direction: i32,
    /// Count after the last observation.
    count: i64,
    fronts: Option<Fronts>,
    /// Sampling instant after the last boundary 0.
    revolution_since: i64,
}

impl Run {
    /// A run that waits for the index.
    pub fn new(plan: RunPlan, edges: u32, timer_hz: f64) -> Self {
        Self {
            plan,
            edges,
            timer_hz,
            stage: Stage::Seeking,
            direction: 0,
            count: 0,
            fronts: None,
            revolution_since: 0,
        }
    }

    /// Takes an observation; edges go into `sums`.
    pub fn feed(&mut self, seen: &Observation<'_>, sums: &mut [i32]) -> Result<Progress, Refusal> {
        match &self.stage {
            Stage::Seeking => self.seek(seen),
            _ if self.is_complete() => {}
            _ => self.follow(seen, sums)?,
        }
        self.count = seen.count;
        Ok(self.progress())
    }

    /// How far it is.
    pub fn progress(&self) -> Progress {
        match &self.stage {
            Stage::Seeking => Progress::SeekingIndex,
            Stage::Timing(_) => Progress::MeasuringSpeed,
            Stage::Averaging(average) if average.is_complete() => Progress::Complete,
            Stage::Averaging(average) => Progress::Averaging {
                revolutions: average.revolution(),
            },
        }
    }

    fn is_complete(&self) -> bool {
        self.progress() == Progress::Complete
    }

    /// The result of a complete run.
    pub fn complete(&self) -> Result<(&Average, Fronts), Refusal> {
        let found = match (&self.stage, self.fronts) {
            (Stage::Averaging(average), Some(fronts)) if average.is_complete() => {
                return Ok((average, fronts));
            }
            (Stage::Averaging(average), _) => average.revolution(),
            _ => 0,
        };
        Err(Refusal::TooFewRevolutions {
            found,
            needed: self.plan.averaged(),
        })
    }

    /// Clock of the times, Hz.
    pub const fn timer_hz(&self) -> f64 {
        self.timer_hz
    }

    /// True for a run backward.
    pub const fn is_backward(&self) -> bool {
        self.direction < 0
    }

    /// Number of the revolution, from 0 at the index on; those that gave the speed are 1 and 2.
    fn revolution(&self) -> u32 {
        match &self.stage {
            Stage::Seeking => 0,
            Stage::Timing(timing) => timing.revolution(),
            Stage::Averaging(average) => average
                .revolution()
                .saturating_add(MEASURING_REVOLUTIONS + 1),
        }
    }

    /// Waits for an index in clean motion.
    fn seek(&mut self, seen: &Observation<'_>) {
        let (Some(latch), true) = (seen.index(), seen.edges_complete) else {
            return;
        };
        if seen.delta == 0 {
            return;
        }
        self.direction = seen.delta.signum();
        let fronts = Fronts::new(self.edges, latch.count, self.is_backward());
        self.fronts = Some(fronts);
        self.revolution_since = seen.sampled_at;
        self.stage = Stage::Timing(Timing::new(
            self.edges,
            self.number_after(seen.count, fronts.zero()),
        ));
    }

    /// Number, in the direction of motion, of the edge that comes after `count`.
    fn number_after(&self, count: i64, zero: i64) -> u32 {
        let turned = if self.is_backward() {
            zero.wrapping_sub(count)
        } else {
            count.wrapping_add(1).wrapping_sub(zero)
        };
        within_revolution(turned, self.edges)
    }

    /// Takes the edges and the index of a tick.
    fn follow(&mut self, seen: &Observation<'_>, sums: &mut [i32]) -> Result<(), Refusal> {
        let revolution = self.revolution();
        if seen.delta.signum() == self.direction.wrapping_neg() {
            return Err(Refusal::Reversed { revolution });
        }
        let [older, newer] = seen.edges();
        let times = older.len().wrapping_add(newer.len());
        let moved = seen.count.wrapping_sub(self.count);
        let explained = times as u64 == moved.unsigned_abs() && moved == i64::from(seen.delta);
        if !(seen.edges_complete && explained) {
            return Err(Refusal::MissedEdges { revolution });
        }
        if seen.sampled_at.wrapping_sub(self.revolution_since) > LONGEST_REVOLUTION {
            return Err(self.too_slow());
        }
        if let (Some(latch), Some(fronts)) = (seen.index(), self.fronts.as_mut()) {
            fronts.take(latch.count, revolution)?;
        }
        for &time in older.iter().chain(newer) {
            self.pass(time, seen.sampled_at, sums)?;
        }
        Ok(())
    }

    fn too_slow(&self) -> Refusal {
        Refusal::TooSlow {
            longest_s: LONGEST_REVOLUTION as f64 / self.timer_hz,
        }
    }

    /// Takes one edge.
    #[inline]
    fn pass(&mut self, time: u32, sampled_at: i64, sums: &mut [i32]) -> Result<(), Refusal> {
        let number = match &mut self.stage {
            Stage::Seeking => return Ok(()),
            Stage::Timing(timing) => {
                let number = timing.pass(time);
                if number == 0 {
                    self.revolution_since = sampled_at;
                    self.begin_average(time, sums)?;
                }
                number
            }
            Stage::Averaging(average) => {
                let number = average.next();
                match average.pass(time, sums) {
                    Passed::Edge => {}
                    Passed::NewRevolution(off) => self.check_speed(off, sampled_at)?,
                    Passed::Lost => return Err(self.speed_changing(1.0)),
                }
                number
            }
        };
        if number == self.edges / 2 {
            let revolution = self.revolution();
            if let Some(fronts) = self.fronts.as_mut() {
                fronts.check_fresh(revolution)?;
            }
        }
        Ok(())
    }

    /// Begins the average with the edge passed at `time`, if the speed is known.
    #[inline(never)]
    fn begin_average(&mut self, time: u32, sums: &mut [i32]) -> Result<(), Refusal> {
        let reference = match &self.stage {
            Stage::Timing(timing) if timing.is_done() => timing.reference(self.plan.motion),
            _ => return Ok(()),
        };
        let reference = reference.ok_or(self.too_slow())?;
        let average = Average::new(
            self.edges,
            self.plan.averaged(),
            self.is_backward(),
            reference,
        );
        self.stage = Stage::Averaging(average);
        if let Stage::Averaging(average) = &mut self.stage {
            average.pass(time, sums);
        }
        Ok(())
    }

    /// A revolution of the average ended; it took `off` Q.16 d longer than expected.
    fn check_speed(&mut self, off: i32, sampled_at: i64) -> Result<(), Refusal> {
        self.revolution_since = sampled_at;
        let off_d = libm::ldexp(f64::from(off), POSITION_FRAC.cast_signed().wrapping_neg());
        let change = -off_d / f64::from(self.edges);
        if libm::fabs(change) > self.plan.speed_tolerance {
            return Err(self.speed_changing(change));
        }
        Ok(())
    }

    fn speed_changing(&self, change: f64) -> Refusal {
        Refusal::SpeedChanging {
            revolution: self.revolution(),
            change,
            limit: self.plan.speed_tolerance,
        }
    }
}
