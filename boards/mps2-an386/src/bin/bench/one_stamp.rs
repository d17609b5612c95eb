//! The estimators that read edges where the hardware keeps one time stamp a tick, at full speed.

use board_mps2_an386::instructions::Counter;
use leadscrew::capture::Unwrapper;
use leadscrew::edges::EdgeReader;
use leadscrew::estimator::{Estimator, EstimatorConfig, Evidence};
use leadscrew::hal::Capture;
use leadscrew_hal_mock::scenario::ScenarioError;
use static_cell::ConstStaticCell;

use crate::samples::Samples;
use crate::standard_move::{config, estimators};

const TICKS: u32 = 2000;
/// Edges of a tick at full speed.
const EDGES: u32 = 150;
/// Clocks of a tick.
const CLOCKS: u32 = 84_000;
/// The estimators that read edges.
const READERS: [&str; 1] = ["polynomial"];

static TABLE: ConstStaticCell<[Samples; READERS.len()]> =
    ConstStaticCell::new(Samples::of_each(&READERS));

pub fn run(counter: &mut Counter) -> Result<(), ScenarioError> {
    let table = TABLE.take();
    let edges = EdgeReader::new(config(estimators()?[0])?.0.edges);
    let mut unwrapper = Unwrapper::new();
    let mut readers = [const { None }; READERS.len()];
    for (reader, name) in readers.iter_mut().zip(READERS) {
        *reader = EstimatorConfig::by_name(name)?.map(Estimator::new);
    }
    for tick in 0..TICKS {
        let now = tick.wrapping_mul(CLOCKS);
        let capture = Capture {
            count: tick * EDGES,
            sampled_at: now,
            last_edge_at: Some(now.wrapping_sub(tick % 97)),
            ..Capture::default()
        };
        let observation = unwrapper.unwrap(&capture);
        let evidence = Evidence::new(&observation, &edges, None);
        for (reader, samples) in readers.iter_mut().flatten().zip(table.iter_mut()) {
            let cost = counter.count(|| reader.update(&evidence).velocity);
            // A window that is not full yet costs less.
            if tick > 64 {
                samples.push(cost);
            }
        }
    }
    for samples in table {
        samples.log("one_stamp");
    }
    Ok(())
}
