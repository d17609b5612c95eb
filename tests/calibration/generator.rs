//! Edge times made directly from a motion and a list of placement errors, in f64: an oracle apart from the
//! simulator's encoder.

use leadscrew::calibration::{Learner, Progress, Refusal, RunPlan, RunSummary, Work};
use leadscrew::capture::Unwrapper;
use leadscrew::hal::{Capture, Latch};
use leadscrew_hal_mock::disc::{Disc, DiscParams};

use crate::motion::{Dice, Motion};

pub const TIMER_HZ: f64 = 84e6;
pub const CLOCKS_PER_TICK: f64 = 84_000.0;
/// Width of the index pulse, d.
const INDEX_WIDTH: i64 = 3;

/// The encoder that is learned.
#[derive(Clone)]
pub struct Shaft {
    /// Error of each edge, d.
    pub errors: Vec<f64>,
    /// Hysteresis of even (B) and odd (A) edges, d.
    pub hysteresis: [f64; 2],
    pub noise_d: f64,
    pub noise_s: f64,
}

impl Shaft {
    /// The encoder "real".
    pub fn real(seed: u64) -> Self {
        Self::of(&DiscParams::default(), seed)
    }

    /// One with the errors of "real" and fewer edges.
    pub fn small(seed: u64) -> Self {
        let params = DiscParams {
            edges_per_revolution: 2000.0,
            ..DiscParams::default()
        };
        Self::of(&params, seed)
    }

    fn of(params: &DiscParams, seed: u64) -> Self {
        let disc = Disc::new(params, seed).unwrap();
        let errors = (0..disc.edges())
            .map(|edge| disc.error_q32(edge) as f64 / 4_294_967_296.0)
            .collect();
        Self {
            errors,
            hysteresis: [0.02, 0.04],
            noise_d: 0.005,
            noise_s: 2e-8,
        }
    }

    pub fn edges(&self) -> i64 {
        self.errors.len() as i64
    }
}

/// Edges in the order in which they are passed.
struct Edges<'a> {
    shaft: &'a Shaft,
    motion: Motion,
    dice: Dice,
    /// Boundary passed next.
    boundary: i64,
    backward: bool,
    time: f64,
}

impl<'a> Edges<'a> {
    fn new(shaft: &'a Shaft, motion: Motion, seed: u64) -> Self {
        let backward = motion.velocity < 0.0;
        let start = motion.at(0.0).0;
        // Some counts on, clear of the errors at the start.
        let boundary = start.floor() as i64 + if backward { -8 } else { 8 };
        Self {
            shaft,
            motion,
            dice: Dice::new(seed),
            boundary,
            backward,
            time: 0.0,
        }
    }

    fn count(&self) -> i64 {
        if self.backward {
            self.boundary
        } else {
            self.boundary - 1
        }
    }

    /// Boundary and time in ticks of the next edge.
    fn pass(&mut self) -> (i64, f64) {
        let boundary = self.boundary;
        let edge = boundary.rem_euclid(self.shaft.edges()) as usize;
        let mut place =
            boundary as f64 + self.shaft.errors[edge] + self.shaft.noise_d * self.dice.normal();
        if self.backward {
            place -= self.shaft.hysteresis[edge % 2];
        }
        let mut t = self.time;
        for _ in 0..20 {
            let (x, v) = self.motion.at(t);
            let step = (place - x) / v;
            t += step;
            if step.abs() < 1e-9 {
                break;
            }
        }
        self.time = t;
        self.boundary += if self.backward { -1 } else { 1 };
        (
            boundary,
            t + self.shaft.noise_s * 1000.0 * self.dice.normal(),
        )
    }

    /// True at the boundary that is the front of the index pulse.
    fn is_front(&self, boundary: i64) -> bool {
        let front = if self.backward { INDEX_WIDTH } else { 0 };
        boundary.rem_euclid(self.shaft.edges()) == front
    }
}

/// A tick's capture before it is one: what a test may spoil.
#[derive(Clone, Default)]
pub struct Tick {
    pub count: i64,
    pub sampled_at: u32,
    pub times: Vec<u32>,
    pub index: Option<Latch>,
    pub overrun: bool,
}

/// All ticks of a motion over `revolutions` and what a run needs to find the index and the speed.
pub fn ticks(
    shaft: &Shaft,
    motion: Motion,
    revolutions: u32,
    seed: u64,
) -> impl Iterator<Item = Tick> + '_ {
    let mut edges = Edges::new(shaft, motion, seed);
    let mut left = (revolutions as usize + 4) * shaft.errors.len();
    let mut waiting = edges.pass();
    let mut count = edges.count() + if edges.backward { 1 } else { -1 };
    let mut tick = 0.0_f64;
    std::iter::from_fn(move || {
        if left == 0 {
            return None;
        }
        let mut seen = Tick {
            sampled_at: (tick * CLOCKS_PER_TICK) as u64 as u32,
            ..Tick::default()
        };
        while waiting.1 <= tick && left > 0 {
            let time = (waiting.1 * CLOCKS_PER_TICK) as i64 as u32;
            count += if edges.backward { -1 } else { 1 };
            seen.times.push(time);
            if edges.is_front(waiting.0) {
                seen.index = Some(Latch {
                    count: count as u32,
                    time,
                });
            }
            waiting = edges.pass();
            left -= 1;
        }
        seen.count = count;
        tick += 1.0;
        Some(seen)
    })
}

/// Work memory on the heap.
pub struct Memory {
    sums: Vec<i32>,
    mean: Vec<i16>,
}

impl Memory {
    /// For an encoder of so many edges; filled with what does not belong there.
    pub fn new(edges: i64) -> Self {
        Self {
            sums: vec![12_345; edges as usize],
            mean: vec![-321; edges as usize],
        }
    }

    /// A learner in it.
    pub fn learner(&mut self) -> Learner<'_> {
        let edges = self.sums.len() as u32;
        let work = Work {
            sums: &mut self.sums,
            mean: &mut self.mean,
        };
        Learner::new(edges, TIMER_HZ, work).unwrap()
    }
}

/// Feeds ticks to a run until it is complete or they end.
pub fn learn(
    learner: &mut Learner<'_>,
    plan: RunPlan,
    ticks: impl Iterator<Item = Tick>,
) -> Result<RunSummary, Refusal> {
    learner.begin_run(plan)?;
    let mut unwrapper = Unwrapper::new();
    for tick in ticks {
        let capture = Capture {
            count: tick.count as u32,
            sampled_at: tick.sampled_at,
            last_edge_at: tick.times.last().copied(),
            edges: [&tick.times, &[]],
            overrun: tick.overrun,
            index: tick.index,
            ..Capture::default()
        };
        if learner.feed(&unwrapper.unwrap(&capture))? == Progress::Complete {
            break;
        }
    }
    learner.end_run()
}
