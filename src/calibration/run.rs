//! One run: find the index, measure the speed, average over the revolutions.

use super::average::{Average, Passed};
use super::index::Fronts;
use super::reference::{POSITION_FRAC, Reference};
use super::refusal::Refusal;
use super::segments::within_revolution;
use super::taper::ORDER;
use crate::capture::Observation;

/// Fewest revolutions that an average is made of.
pub const MIN_REVOLUTIONS: u32 = 12;
/// Most revolutions of a run.
pub const MAX_REVOLUTIONS: u32 = 1000;
/// Revolutions at the beginning that give the speed.
pub const MEASURING_REVOLUTIONS: u32 = 2;
/// Longest revolution, timer clocks.
const LONGEST_REVOLUTION: i64 = 1 << 30;

/// How the shaft moves in a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RunMotion {
    /// Held at a constant feed.
    Steady,
    /// A free flywheel that slows down.
    Coast,
}

/// What a run shall be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RunPlan {
    /// How the shaft moves.
    pub motion: RunMotion,
    /// Revolutions to average over, 12 to 1 000; of these the largest multiple of 4 is used. The run takes
    /// three more: up to the index, and two to measure the speed.
    pub revolutions: u32,
    /// Most that the duration of a revolution may differ from what the first ones gave, as a part of it.
    pub speed_tolerance: f64,
}

impl RunPlan {
    /// A steady feed, within 1 %.
    #[must_use]
    pub const fn steady(revolutions: u32) -> Self {
        Self {
            motion: RunMotion::Steady,
            revolutions,
            speed_tolerance: 0.01,
        }
    }

    /// A coast-down, within 2 % of a constant deceleration.
    #[must_use]
    pub const fn coast(revolutions: u32) -> Self {
        Self {
            motion: RunMotion::Coast,
            revolutions,
            speed_tolerance: 0.02,
        }
    }

    pub(super) const fn check(&self) -> Result<(), Refusal> {
        if self.revolutions < MIN_REVOLUTIONS || self.revolutions > MAX_REVOLUTIONS {
            return Err(Refusal::TooFewRevolutions {
                found: self.revolutions,
                needed: MIN_REVOLUTIONS,
            });
        }
        Ok(())
    }
}

/// How far a run is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Progress {
    /// No index yet.
    SeekingIndex,
    /// The first revolutions give the speed.
    MeasuringSpeed,
    /// So many revolutions are in the average.
    Averaging {
        /// Whole revolutions so far.
        revolutions: u32,
    },
    /// All revolutions are in; end the run.
    Complete,
}

/// Revolutions timed to find the speed.
#[derive(Clone, Debug)]
struct Timing {
    /// Number of the next edge in the direction of motion.
    next: u32,
    /// Boundaries 0 passed.
    crossings: u32,
    crossed_at: u32,
    durations: [u32; MEASURING_REVOLUTIONS as usize],
}

#[derive(Clone, Debug)]
enum Stage {
    Seeking,
    Timing(Timing),
    Averaging(Average),
    Complete(Average),
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
        match self.stage {
            Stage::Seeking => self.seek(seen),
            Stage::Complete(_) => {}
            Stage::Timing(_) | Stage::Averaging(_) => self.follow(seen, sums)?,
        }
        self.count = seen.count;
        Ok(self.progress())
    }

    fn progress(&self) -> Progress {
        match &self.stage {
            Stage::Seeking => Progress::SeekingIndex,
            Stage::Timing(_) => Progress::MeasuringSpeed,
            Stage::Averaging(average) => Progress::Averaging {
                revolutions: average.revolution(),
            },
            Stage::Complete(_) => Progress::Complete,
        }
    }

    /// The result of a complete run.
    pub fn complete(&self) -> Result<(&Average, Fronts), Refusal> {
        let found = match &self.stage {
            Stage::Complete(average) => {
                if let Some(fronts) = self.fronts {
                    return Ok((average, fronts));
                }
                0
            }
            Stage::Averaging(average) => average.revolution(),
            Stage::Seeking | Stage::Timing(_) => 0,
        };
        Err(Refusal::TooFewRevolutions {
            found,
            needed: self.plan.revolutions,
        })
    }

    /// True for a run backward.
    pub const fn is_backward(&self) -> bool {
        self.direction < 0
    }

    /// Revolutions of the average.
    pub const fn revolutions(&self) -> u32 {
        (self.plan.revolutions / ORDER).wrapping_mul(ORDER)
    }

    /// Number of the revolution, from 0 at the index on; those that gave the speed are 1 and 2.
    fn revolution(&self) -> u32 {
        match &self.stage {
            Stage::Seeking => 0,
            Stage::Timing(timing) => timing.crossings,
            Stage::Averaging(average) | Stage::Complete(average) => average
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
        self.stage = Stage::Timing(Timing {
            next: self.number_after(seen.count, fronts.zero()),
            crossings: 0,
            crossed_at: 0,
            durations: [0; MEASURING_REVOLUTIONS as usize],
        });
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
            Stage::Averaging(average) => {
                let number = average.next();
                match average.pass(time, sums) {
                    Passed::Edge => {}
                    Passed::NewRevolution(off) => self.check_speed(off, sampled_at)?,
                    Passed::Lost => return Err(self.speed_changing(1.0)),
                    Passed::Last => {
                        let average = average.clone();
                        self.stage = Stage::Complete(average);
                    }
                }
                number
            }
            Stage::Timing(timing) => {
                let number = timing.next;
                timing.next = number.wrapping_add(1);
                if timing.next == self.edges {
                    timing.next = 0;
                }
                if number == 0 {
                    self.time_revolution(time, sampled_at, sums)?;
                }
                number
            }
            Stage::Seeking | Stage::Complete(_) => return Ok(()),
        };
        if number == self.edges / 2 {
            let revolution = self.revolution();
            if let Some(fronts) = self.fronts.as_mut() {
                fronts.check_fresh(revolution)?;
            }
        }
        Ok(())
    }

    /// A revolution ended while the speed is measured; after the last one the average begins.
    fn time_revolution(
        &mut self,
        time: u32,
        sampled_at: i64,
        sums: &mut [i32],
    ) -> Result<(), Refusal> {
        self.revolution_since = sampled_at;
        let Stage::Timing(timing) = &mut self.stage else {
            return Ok(());
        };
        let crossing = timing.crossings;
        let before = crossing.wrapping_sub(1) as usize;
        if let Some(duration) = timing.durations.get_mut(before) {
            *duration = time.wrapping_sub(timing.crossed_at);
        }
        timing.crossings = crossing.wrapping_add(1);
        timing.crossed_at = time;
        if crossing < MEASURING_REVOLUTIONS {
            return Ok(());
        }
        let durations = timing.durations.map(f64::from);
        let Some(reference) = self.reference(time, durations) else {
            return Err(self.too_slow());
        };
        let mut average = Average::new(
            self.edges,
            self.revolutions(),
            self.is_backward(),
            reference,
        );
        average.pass(time, sums);
        self.stage = Stage::Averaging(average);
        Ok(())
    }

    /// The motion that the first revolutions give, from the end of the last of them on.
    fn reference(&self, origin: u32, durations: [f64; 2]) -> Option<Reference> {
        let edges = f64::from(self.edges);
        let [first, second] = durations;
        let (velocity, acceleration) = match self.plan.motion {
            RunMotion::Steady => (2.0 * edges / (first + second), 0.0),
            RunMotion::Coast => {
                let acceleration = (edges / second - edges / first) * 2.0 / (first + second);
                (edges / second + acceleration * second / 2.0, acceleration)
            }
        };
        Reference::new(self.edges, origin, velocity, acceleration)
    }

    /// A revolution of the average ended; it took `off` Q.16 d longer than expected.
    fn check_speed(&mut self, off: i32, sampled_at: i64) -> Result<(), Refusal> {
        self.revolution_since = sampled_at;
        let off_d = libm::ldexp(f64::from(off), (POSITION_FRAC as i32).wrapping_neg());
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

    /// Mean speed so far, d/s: that of the reference.
    pub fn speed_d_s(&self) -> f64 {
        match &self.stage {
            Stage::Averaging(average) | Stage::Complete(average) => {
                average.velocity() * self.timer_hz
            }
            Stage::Seeking | Stage::Timing(_) => 0.0,
        }
    }
}
