//! Learning where the edges of an encoder really lie, from steady feeds of the axis it is on.
//!
//! ```text
//! captures ─► run: index, speed ─► average over revolutions ─► combine ─► Learned: errors, phases,
//!             (refuses)            (B-spline taper)            (aligns)   fronts, report
//! ```
//!
//! A run goes one way at a nearly constant feed. With x_ref(t) linear in time, edge j passed at t_j has the residual
//! r_j = x_ref(t_j) − j = e(j mod N) − m(t_j): the encoder's error e less what the motion m strays from the
//! reference. The average over the revolutions with the weights of [`taper`](leakage) keeps e, and turns a drift
//! into a constant and a wobble into almost nothing, unless it comes a near-whole number of times a revolution.
//! That shows as runs at different speeds which disagree: what trembles at a frequency is another harmonic at
//! another speed. What trembles in step with the shaft at every speed cannot be told from the encoder: it is in
//! the map.
//!
//! # Procedure
//!
//! Forty revolutions at each of two speeds in both directions: four runs, at least twelve revolutions each. The
//! speeds differ by a fifth or more. A tremble with a known period of n ticks comes N/(n·v) times a revolution, and
//! its own second harmonic twice as often: both stay away from whole numbers at v = N/(n·(i ± ⅓)) ([`leakage`] says
//! how much is left). Runs may come in any order, from one capture or
//! several; each is aligned to those before by the pattern of the lines.
//!
//! # Numbering
//!
//! Count k means x ∈ [k, k + 1) d; edge k is the boundary between k − 1 and k and lies at
//! k + error(k) + phase(direction, k mod 4). Boundary 0 has a count that is a multiple of 4 (the state of A and B
//! tells) and is the first one at or after the front of the index pulse in forward motion, or in backward motion
//! where there was no other run.
//!
//! Edges are averaged in integers, floating point comes once a segment: this runs in thread mode, not in the tick.
//! Work memory is 6 bytes an edge and the [`Learner`], below 64 KiB for 10 000 edges; the end of a run and the end of
//! all take some 10 KiB of stack besides.

mod average;
mod bands;
mod combine;
mod compare;
mod image;
mod index;
mod learned;
mod pattern;
mod plan;
mod reference;
mod refusal;
mod repeats;
mod report;
mod run;
mod segments;
mod taper;
mod timing;

use crate::capture::Observation;

pub use self::bands::Bands;
pub use self::learned::Learned;
pub use self::plan::{MEASURING_REVOLUTIONS, MIN_REVOLUTIONS, Progress, RunMotion, RunPlan};
pub use self::refusal::Refusal;
pub use self::report::{
    Disagreement, MAX_RUNS, NOT_SEPARATED, Noise, Report, Requirements, Residual, RunSummary,
    SPEED_RATIO,
};
pub use self::taper::leakage;

use self::combine::Combination;
use self::run::Run;

/// Fewest edges per revolution.
pub const MIN_EDGES: u32 = 512;
/// Most edges per revolution.
pub const MAX_EDGES: u32 = crate::encoder_map::EDGES.1;

/// Work memory, an entry an edge in each slice. Its contents at the beginning do not matter.
#[derive(Debug)]
pub struct Work<'w> {
    /// Sums of the run under way.
    pub sums: &'w mut [i32],
    /// Mean of the runs before.
    pub mean: &'w mut [i16],
}

/// Learns an encoder, one run after the other.
#[derive(Debug)]
pub struct Learner<'w> {
    edges: u32,
    timer_hz: f64,
    sums: &'w mut [i32],
    mean: &'w mut [i16],
    run: Option<Run>,
    combination: Combination,
}

/// The budget of the target: work memory for the reference encoder.
const _: () =
    assert!(size_of::<Learner<'_>>() + 10_000 * (size_of::<i32>() + size_of::<i16>()) <= 64 << 10);

impl<'w> Learner<'w> {
    /// A learner for an encoder with `edges_per_revolution` (x4), times by a timer of `timer_hz`.
    ///
    /// # Errors
    /// [`Refusal`] unless the edges are a multiple of 4 from [`MIN_EDGES`] to [`MAX_EDGES`] and both slices of `work`
    /// have an entry for each.
    pub fn new(edges_per_revolution: u32, timer_hz: f64, work: Work<'w>) -> Result<Self, Refusal> {
        let edges = edges_per_revolution;
        Self::check(edges, &work)?;
        Ok(Self {
            edges,
            timer_hz,
            sums: work.sums,
            mean: work.mean,
            run: None,
            combination: Combination::new(edges),
        })
    }

    /// Passes edges and work memory that [`Self::new`] takes.
    ///
    /// # Errors
    /// As of [`Self::new`].
    pub fn check(edges: u32, work: &Work<'_>) -> Result<(), Refusal> {
        if !(MIN_EDGES..=MAX_EDGES).contains(&edges) || !edges.is_multiple_of(4) {
            return Err(Refusal::EdgesPerRevolution {
                edges,
                min: MIN_EDGES,
                max: MAX_EDGES,
            });
        }
        let given = work.sums.len().min(work.mean.len());
        if given < edges as usize {
            return Err(Refusal::WorkMemory {
                given,
                needed: edges,
            });
        }
        Ok(())
    }

    /// Begins a run; one under way is dropped.
    ///
    /// # Errors
    /// [`Refusal`] for too few revolutions, or a run too many. Runs before are kept.
    pub fn begin_run(&mut self, plan: RunPlan) -> Result<(), Refusal> {
        plan.check()?;
        self.combination.check_room()?;
        sums_of(self.sums, self.edges).fill(0);
        self.run = Some(Run::new(plan, self.edges, self.timer_hz));
        Ok(())
    }

    /// Takes what a tick saw. Before the index anything may happen; from then on every edge counts.
    ///
    /// # Errors
    /// [`Refusal`] of data that do not suffice. The run is dropped, runs before are kept.
    pub fn feed(&mut self, observation: &Observation<'_>) -> Result<Progress, Refusal> {
        let run = self.run.as_mut().ok_or(Refusal::NoRun)?;
        let fed = run.feed(observation, sums_of(self.sums, self.edges));
        if fed.is_err() {
            self.run = None;
        }
        fed
    }

    /// Ends a run that is [`Progress::Complete`] and adds it to those before.
    ///
    /// # Errors
    /// [`Refusal`] of a run that is not complete, or does not go with those before. It is dropped, they are kept.
    pub fn end_run(&mut self) -> Result<RunSummary, Refusal> {
        let run = self.run.take().ok_or(Refusal::NoRun)?;
        let sums = sums_of(self.sums, self.edges);
        self.combination
            .add(&run, sums, mean_of(self.mean, self.edges))
    }

    /// The map that the runs give.
    ///
    /// # Errors
    /// [`Refusal`] if there is no run or `requirements` are not met.
    pub fn finish(self, requirements: &Requirements) -> Result<Learned<'w>, Refusal> {
        let mean = mean_of(self.mean, self.edges);
        self.combination.finish(mean, requirements)
    }

    /// The same for a learner whose memory is wanted back: the map is to be encoded before it is used for anything
    /// else. After it the runs are forgotten, unless it is refused.
    ///
    /// # Errors
    /// As of [`Self::finish`].
    pub fn conclude(&mut self, requirements: &Requirements) -> Result<Learned<'_>, Refusal> {
        let mean = mean_of(self.mean, self.edges);
        let learned = self.combination.finish(mean, requirements)?;
        self.combination = Combination::new(self.edges);
        Ok(learned)
    }

    /// Complete runs so far.
    #[must_use]
    pub const fn runs(&self) -> usize {
        self.combination.runs()
    }

    /// How far the run under way is; none between runs.
    #[must_use]
    pub fn progress(&self) -> Option<Progress> {
        self.run.as_ref().map(Run::progress)
    }

    /// Gives the memory back.
    #[must_use]
    pub fn into_work(self) -> Work<'w> {
        Work {
            sums: self.sums,
            mean: self.mean,
        }
    }
}

/// As many sums as there are edges; a learner has room for them.
fn sums_of(sums: &mut [i32], edges: u32) -> &mut [i32] {
    sums.get_mut(..edges as usize).unwrap_or_default()
}

/// As many means.
fn mean_of(mean: &mut [i16], edges: u32) -> &mut [i16] {
    mean.get_mut(..edges as usize).unwrap_or_default()
}
