//! The second encoder: spindle or master, read as well as the axis' own.
//!
//! Its velocity and acceleration come from a polynomial through its edges that answers for the sampling instant, so
//! that what follows it does not lag. Its index says where a revolution begins, and whether counts get lost: the place
//! of each index is compared with that of the first one, whole revolutions apart.

use crate::capture::{Observation, Unwrapper};
use crate::edges::{EdgeConfig, EdgeReader};
use crate::estimator::polynomial::{Answer, Config as Fit, Estimator};
use crate::estimator::{Estimate, Evidence};
use crate::hal::Capture;
use crate::parameter_table;
use crate::parameter_table::ParameterTable;
use crate::units::{Position, RangeError, checked};

parameter_table! {
    /// The second encoder: spindle or master.
    pub struct MasterParams {
        /// Counts (x4) a revolution
        master_counts_per_revolution: 4096.0, "d", 16.0..=1e6;
        /// Window of the estimate of its speed
        master_window_ticks: 8.0, "ticks", 4.0..=64.0;
        /// How far an index may lie from where the one before says
        master_index_tolerance_counts: 3.0, "d", 1.0..=100.0;
    }
}

/// Quantised parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Config {
    edges: EdgeConfig,
    fit: Fit,
    per_turn: i64,
    tolerance: i64,
}

impl MasterParams {
    /// Validates and quantises; `edges` are the rates and the timer of the axis.
    ///
    /// # Errors
    /// [`RangeError`] naming the parameter that is out of range.
    pub fn quantise(&self, edges: EdgeConfig) -> Result<Config, RangeError> {
        self.check()?;
        let per_turn = whole(
            "master_counts_per_revolution",
            self.master_counts_per_revolution,
        )?;
        let window = whole("master_window_ticks", self.master_window_ticks)?;
        Ok(Config {
            edges,
            fit: Fit::new(window as u32, Answer::Newest)?,
            per_turn,
            tolerance: libm::round(self.master_index_tolerance_counts) as i64,
        })
    }
}

impl Config {
    /// Counts a revolution.
    #[must_use]
    pub const fn per_turn(&self) -> i64 {
        self.per_turn
    }
}

fn whole(name: &'static str, value: f64) -> Result<i64, RangeError> {
    let nearest = libm::round(value);
    checked(name, value, nearest, nearest).map(|value| value as i64)
}

/// Where an index lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Index {
    /// The boundary at which it came, d, moved on by whole revolutions to the newest one.
    pub place: i64,
    /// It was passed going forward; its other flank lies elsewhere.
    pub is_forward: bool,
}

/// The second encoder.
#[derive(Clone, Debug)]
pub struct Master {
    config: Config,
    unwrapper: Unwrapper,
    edges: EdgeReader<'static>,
    estimator: Estimator,
    estimate: Estimate,
    count: i64,
    delta: i32,
    index: Option<Index>,
    is_present: bool,
    is_slipped: bool,
}

impl Master {
    /// Waiting for the first capture.
    #[must_use]
    pub fn new(config: Config) -> Self {
        Self {
            config,
            unwrapper: Unwrapper::new(),
            edges: EdgeReader::new(config.edges),
            estimator: Estimator::new(config.fit),
            estimate: Estimate::default(),
            count: 0,
            delta: 0,
            index: None,
            is_present: false,
            is_slipped: false,
        }
    }

    /// Takes other parameters, and begins anew if they are others. Outside the tick.
    pub fn reconfigure(&mut self, config: Config) {
        if config != self.config {
            *self = Self::new(config);
        }
    }

    /// Takes what its inputs saw; `is_lost` if a line receiver of it sees no signal.
    #[inline]
    pub fn step(&mut self, capture: Option<&Capture<'_>>, is_lost: bool) {
        self.is_present = false;
        if let Some(capture) = capture {
            self.read(capture);
            self.is_present = !is_lost;
        }
    }

    #[inline(never)]
    fn read(&mut self, capture: &Capture<'_>) {
        let observation = self.unwrapper.unwrap(capture);
        self.delta = observation.delta;
        self.count = observation.count;
        let evidence = Evidence::new(&observation, &self.edges, None);
        self.estimator.update_into(&evidence, &mut self.estimate);
        self.is_slipped = false;
        if observation.delta != 0 {
            self.note_turns(&observation);
        }
    }

    /// Compares the index with the one before.
    #[inline]
    fn note_turns(&mut self, observation: &Observation<'_>) {
        if let Some(latch) = observation.index() {
            self.note_index(latch.count, observation.delta > 0);
        } else if let Some(index) = &mut self.index {
            let way = self.count.wrapping_sub(index.place);
            let longest = self.config.per_turn.wrapping_add(self.config.tolerance);
            if index.is_forward && way > longest {
                self.is_slipped = true;
                index.place = index.place.wrapping_add(self.config.per_turn);
            } else if !index.is_forward && way.wrapping_neg() > longest {
                self.is_slipped = true;
                index.place = index.place.wrapping_sub(self.config.per_turn);
            }
        }
    }

    #[cold]
    fn note_index(&mut self, count: i64, is_forward: bool) {
        // The boundary below count k is k, and the one above it k + 1.
        let place = if is_forward {
            count
        } else {
            count.wrapping_add(1)
        };
        let Config {
            per_turn,
            tolerance,
            ..
        } = self.config;
        if let Some(index) = self.index
            && index.is_forward == is_forward
        {
            let way = place.wrapping_sub(index.place);
            let half = per_turn.wrapping_shr(1);
            let slip = if way > half {
                way.wrapping_sub(per_turn)
            } else if way < half.wrapping_neg() {
                way.wrapping_add(per_turn)
            } else {
                way
            };
            self.is_slipped = slip.unsigned_abs() > tolerance.unsigned_abs();
            let kept = if self.is_slipped {
                place
            } else {
                place.wrapping_sub(slip)
            };
            self.index = Some(Index {
                place: kept,
                is_forward,
            });
        } else {
            self.index = Some(Index { place, is_forward });
        }
    }

    /// Forgets the index, so that the next one counts.
    pub const fn forget_index(&mut self) {
        self.index = None;
    }

    /// A capture came in this tick, and its lines carry a signal.
    #[must_use]
    pub const fn is_present(&self) -> bool {
        self.is_present
    }

    /// In this tick an index came elsewhere than a whole revolution from the one before, or did not come.
    #[must_use]
    pub const fn is_slipped(&self) -> bool {
        self.is_slipped
    }

    /// The newest index.
    #[must_use]
    pub const fn index(&self) -> Option<Index> {
        self.index
    }

    /// Counts without wrap.
    #[must_use]
    pub const fn count(&self) -> i64 {
        self.count
    }

    /// Counts of this tick.
    #[must_use]
    pub const fn delta(&self) -> i32 {
        self.delta
    }

    /// Position, velocity and acceleration, d of its own and ticks.
    #[must_use]
    pub const fn estimate(&self) -> &Estimate {
        &self.estimate
    }

    /// How far the position lies from the lower boundary of the count, 2⁻¹⁶ d; within a few counts.
    #[must_use]
    pub fn part(&self) -> i32 {
        const FEW: i64 = 4 << Position::FRAC_NBITS;
        let part = self
            .estimate
            .position
            .to_bits()
            .wrapping_sub(self.count.wrapping_shl(Position::FRAC_NBITS));
        part.clamp(-FEW, FEW) as i32
    }

    /// Counts a revolution.
    #[must_use]
    pub const fn per_turn(&self) -> i64 {
        self.config.per_turn
    }
}
