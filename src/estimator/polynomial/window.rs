//! The samples of the window.

use super::config::{Config, MIN_SAMPLES};
use super::fit::Sums;
use super::regular;

/// Most samples.
pub const CAPACITY: usize = 64;
/// Fractional bits of a place in the window: what 2 047 d/tick go in 64 ticks has 17 bits, the sum of two of them one
/// more, and there is a sign.
pub const PLACE_FRAC: u32 = 13;

/// A sample: where the shaft was at a step of the grid.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// Steps from the window's origin.
    pub step: i32,
    /// Edges that it is the mean of.
    pub edges: u32,
    /// Place, d with [`PLACE_FRAC`] fractional bits; wraps.
    pub place: i32,
}

/// Samples, newest first, about an origin that moves along: half a window before the sampling instant, at the place
/// of the count.
///
/// Steps and places wrap; only differences from the origin are used.
// The small fields first: the target reaches the first kilobyte by pairs.
#[derive(Clone, Debug)]
#[repr(C)]
pub struct Window {
    /// Sums over a regular window; of no meaning else.
    regular: regular::Sums,
    newest: usize,
    count: usize,
    edges: u32,
    origin: i32,
    base: i32,
    regularity: Regularity,
    /// Places; each is stored twice, [`CAPACITY`] apart, so that the window is one slice wherever it starts; so are steps and
    /// edges.
    places: [i32; 2 * CAPACITY],
    steps: [i32; 2 * CAPACITY],
    edges_of: [u16; 2 * CAPACITY],
}

/// How many of the newest samples came one a tick, at one and the same step from the origin.
#[derive(Clone, Copy, Debug)]
struct Regularity {
    step: i32,
    samples: usize,
}

impl Window {
    pub const fn new() -> Self {
        Self {
            places: [0; 2 * CAPACITY],
            steps: [0; 2 * CAPACITY],
            edges_of: [0; 2 * CAPACITY],
            newest: 0,
            count: 0,
            edges: 0,
            regular: regular::Sums::NONE,
            origin: 0,
            base: 0,
            regularity: Regularity {
                step: 0,
                samples: 0,
            },
        }
    }

    /// Forgets all samples.
    pub const fn clear(&mut self) {
        self.count = 0;
        self.edges = 0;
        self.regularity.samples = 0;
    }

    /// Samples.
    pub const fn count(&self) -> usize {
        self.count
    }

    /// Edges of all samples.
    pub const fn edges(&self) -> u32 {
        self.edges
    }

    /// True with a full window of samples that stand one a tick.
    #[inline]
    const fn is_regular(&self, config: &Config) -> bool {
        self.count == config.window() as usize && self.regularity.samples >= self.count
    }

    /// Goes on by a tick: the origin moves by `steps` of the grid and to the place `base`, a sample comes and old ones go.
    /// Gives the step of the newest sample if a full window of them stands one a tick.
    #[inline(always)]
    pub fn tick(
        &mut self,
        config: &Config,
        steps: i32,
        base: i32,
        sample: Option<Sample>,
    ) -> Option<i32> {
        self.origin = self.origin.wrapping_add(steps);
        let way = base.wrapping_sub(self.base);
        self.base = base;
        match sample {
            Some(sample) if self.goes_on(steps, &sample) && self.is_regular(config) => {
                self.exchange(config, way, sample);
                Some(sample.step)
            }
            _ => {
                self.change(config, steps, sample);
                self.regular_step(config)
            }
        }
    }

    /// Step of the newest sample if a full window of them stands one a tick.
    #[inline]
    pub fn regular_step(&self, config: &Config) -> Option<i32> {
        self.is_regular(config).then_some(self.regularity.step)
    }

    #[inline]
    const fn goes_on(&self, steps: i32, sample: &Sample) -> bool {
        steps == super::STEPS && sample.step == self.regularity.step
    }

    /// One for one: what a regular window does.
    #[inline]
    fn exchange(&mut self, config: &Config, way: i32, sample: Sample) {
        let slot = self.newest.wrapping_add(self.count).wrapping_sub(1) & (CAPACITY - 1);
        if let (Some(edges), Some(oldest)) = (self.edges_of.get(slot), self.places.get(slot)) {
            let newest = sample.place.wrapping_sub(self.base);
            let oldest = oldest.wrapping_sub(self.base);
            config.regular.tick(&mut self.regular, way, newest, oldest);
            self.edges = self
                .edges
                .wrapping_add(sample.edges)
                .wrapping_sub(u32::from(*edges));
        }
        self.store(sample);
    }

    #[inline(never)]
    fn change(&mut self, config: &Config, steps: i32, sample: Option<Sample>) {
        match sample {
            Some(sample) => {
                let before = if self.goes_on(steps, &sample) {
                    self.regularity.samples
                } else {
                    0
                };
                self.regularity = Regularity {
                    step: sample.step,
                    samples: before.saturating_add(1),
                };
                self.push(sample);
            }
            None => self.regularity.samples = 0,
        }
        self.drop_old(config);
        if self.is_regular(config) {
            self.regular = config.regular.sums(self.places());
        }
    }

    /// Puts a sample in front.
    #[inline]
    fn store(&mut self, sample: Sample) {
        self.newest = self.newest.wrapping_sub(1) & (CAPACITY - 1);
        let (first, second) = (self.newest, self.newest.wrapping_add(CAPACITY));
        let step = self.origin.wrapping_add(sample.step);
        for slot in [first, second] {
            if let (Some(place), Some(at)) = (self.places.get_mut(slot), self.steps.get_mut(slot)) {
                *place = sample.place;
                *at = step;
            }
        }
        for slot in [first, second] {
            if let Some(edges) = self.edges_of.get_mut(slot) {
                *edges = sample.edges as u16;
            }
        }
    }

    fn push(&mut self, sample: Sample) {
        if self.count >= CAPACITY {
            self.drop_oldest();
        }
        self.store(sample);
        self.count = self.count.wrapping_add(1);
        self.edges = self.edges.wrapping_add(sample.edges);
    }

    /// Lets go of what is too old; a few a tick, which is faster than they come.
    fn drop_old(&mut self, config: &Config) {
        let half_window = config.window_steps.wrapping_shr(1);
        for _ in 0..4 {
            let limit = if self.count > MIN_SAMPLES {
                config.window_steps
            } else {
                config.widest_steps
            };
            let last = self.newest.wrapping_add(self.count).wrapping_sub(1);
            let Some(oldest) = self.steps.get(last) else {
                return;
            };
            let age = half_window.wrapping_sub(oldest.wrapping_sub(self.origin));
            if self.count == 0 || age < limit {
                return;
            }
            self.drop_oldest();
        }
    }

    fn drop_oldest(&mut self) {
        self.count = self.count.saturating_sub(1);
        let slot = self.newest.wrapping_add(self.count) & (CAPACITY - 1);
        if let Some(edges) = self.edges_of.get(slot) {
            self.edges = self.edges.wrapping_sub(u32::from(*edges));
        }
    }

    /// Sums over a regular window.
    pub const fn regular(&self) -> &regular::Sums {
        &self.regular
    }

    /// Places from the base, newest first.
    fn places(&self) -> impl Iterator<Item = i32> {
        let end = self.newest.wrapping_add(self.count);
        let places = self.places.get(self.newest..end).unwrap_or(&[]);
        places.iter().map(|place| place.wrapping_sub(self.base))
    }

    /// Sums over all samples.
    #[inline(never)]
    pub fn sums(&self) -> Sums {
        let window = self.newest..self.newest.wrapping_add(self.count);
        let steps = self.steps.get(window.clone()).unwrap_or(&[]);
        let edges = self.edges_of.get(window.clone()).unwrap_or(&[]);
        let places = self.places.get(window).unwrap_or(&[]);
        let (origin, base) = (self.origin, self.base);
        let mut sums = Sums::default();
        for ((step, place), &edges) in steps.iter().zip(places).zip(edges) {
            sums.add(step.wrapping_sub(origin), place.wrapping_sub(base), edges);
        }
        sums
    }
}
