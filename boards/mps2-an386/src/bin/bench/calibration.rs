//! What learning costs an edge: the average over revolutions, in ticks of [`EDGES`] edges.

use board_mps2_an386::instructions::Counter;
use leadscrew::calibration::{Learner, Progress, RunPlan, Work};
use leadscrew::capture::Unwrapper;
use leadscrew::hal::{Capture, Latch};
use static_cell::ConstStaticCell;

use crate::samples::Samples;

const REVOLUTION: u32 = 10_000;
/// Edges of a tick: a fast feed.
const EDGES: u32 = 125;
const CLOCKS_PER_EDGE: u32 = 672;
const TIMER_HZ: f64 = 84e6;

static SUMS: ConstStaticCell<[i32; REVOLUTION as usize]> =
    ConstStaticCell::new([0; REVOLUTION as usize]);
static MEAN: ConstStaticCell<[i16; REVOLUTION as usize]> =
    ConstStaticCell::new([0; REVOLUTION as usize]);
static SAMPLES: ConstStaticCell<Samples> = ConstStaticCell::new(Samples::of("edge"));

pub fn run(counter: &mut Counter) {
    let work = Work {
        sums: SUMS.take(),
        mean: MEAN.take(),
    };
    let mut learner = Learner::new(REVOLUTION, TIMER_HZ, work).expect("memory for all edges");
    learner
        .begin_run(RunPlan::steady(12))
        .expect("enough revolutions");
    let samples = SAMPLES.take();
    let mut unwrapper = Unwrapper::new();
    let mut times = [0; EDGES as usize];
    let (mut count, mut now) = (0_u32, 0_u32);
    loop {
        for time in &mut times {
            now = now.wrapping_add(CLOCKS_PER_EDGE);
            *time = now;
        }
        count += EDGES;
        let capture = Capture {
            count,
            sampled_at: now,
            last_edge_at: Some(now),
            edges: [&times, &[]],
            index: count
                .is_multiple_of(REVOLUTION)
                .then_some(Latch { count, time: now }),
            ..Capture::default()
        };
        let observation = unwrapper.unwrap(&capture);
        let mut fed = Ok(Progress::SeekingIndex);
        let instructions = counter.count(|| fed = learner.feed(&observation));
        match fed.expect("a steady feed") {
            Progress::Averaging { .. } => samples.push(instructions / EDGES),
            Progress::Complete => break,
            Progress::SeekingIndex | Progress::MeasuringSpeed => {}
        }
    }
    samples.log("calibration");
}
