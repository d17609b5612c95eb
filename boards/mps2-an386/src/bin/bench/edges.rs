//! What edges cost: the mean of a tick's edges, the last edge alone, and the estimators that use them where
//! the hardware keeps one time stamp a tick.

use board_mps2_an386::instructions::Counter;
use leadscrew::capture::Unwrapper;
use leadscrew::edges::EdgeReader;
use leadscrew::estimator::{Estimator, EstimatorConfig, Evidence};
use leadscrew::hal::Capture;
use leadscrew_hal_mock::scenario::ScenarioError;
use static_cell::ConstStaticCell;

use crate::samples::Samples;
use crate::standard_move::config;

const TICKS: u32 = 2000;
/// Edges of a tick at full speed.
const EDGES: u32 = 150;
const CLOCKS: u32 = 84_000;
/// The estimators that read edges.
const READERS: [&str; 1] = ["polynomial"];

struct Table {
    none: Samples,
    last: Samples,
    mean: Samples,
    readers: [Samples; READERS.len()],
}

static TABLE: ConstStaticCell<Table> = ConstStaticCell::new(Table {
    none: Samples::of("none"),
    last: Samples::of("last"),
    mean: Samples::of("mean_of_150"),
    readers: Samples::of_each(&READERS),
});

pub fn run(counter: &mut Counter) -> Result<(), ScenarioError> {
    let table = TABLE.take();
    let exponential = EstimatorConfig::by_name("exponential")?.expect("it is in the list");
    let edges = EdgeReader::new(config(exponential)?.0.edges);
    let mut unwrapper = Unwrapper::new();
    let mut estimators = [const { None }; READERS.len()];
    for (estimator, name) in estimators.iter_mut().zip(READERS) {
        *estimator = EstimatorConfig::by_name(name)?.map(Estimator::new);
    }
    let mut times = [0; EDGES as usize];
    for tick in 0..TICKS {
        let now = tick.wrapping_mul(CLOCKS);
        for (time, edge) in times.iter_mut().zip(1..) {
            *time = now.wrapping_sub(CLOCKS) + edge * (CLOCKS / EDGES) - tick % 97;
        }
        let stamped = Capture {
            count: tick * EDGES,
            sampled_at: now,
            last_edge_at: times.last().copied(),
            ..Capture::default()
        };
        let observation = unwrapper.unwrap(&stamped);
        table
            .last
            .push(counter.count(|| edges.sample(&observation)));
        let evidence = Evidence {
            observation: &observation,
            edges: &edges,
            command: None,
        };
        for (estimator, samples) in estimators.iter_mut().flatten().zip(&mut table.readers) {
            let cost = counter.count(|| estimator.update(&evidence).velocity);
            // A window that is not full yet costs less.
            if tick > 64 {
                samples.push(cost);
            }
        }
        let mut mean = Unwrapper::new();
        let before = Capture {
            count: stamped.count.wrapping_sub(EDGES),
            ..stamped
        };
        mean.unwrap(&before);
        let full = Capture {
            edges: [
                &times[..(tick % EDGES) as usize],
                &times[(tick % EDGES) as usize..],
            ],
            ..stamped
        };
        let observation = mean.unwrap(&full);
        table
            .mean
            .push(counter.count(|| edges.sample(&observation)));
        let still = Capture {
            edges: [&[], &[]],
            last_edge_at: None,
            ..stamped
        };
        let observation = mean.unwrap(&still);
        table
            .none
            .push(counter.count(|| edges.sample(&observation)));
    }
    for samples in [&mut table.none, &mut table.last, &mut table.mean] {
        samples.log("edges");
    }
    for samples in &mut table.readers {
        samples.log("one_stamp");
    }
    Ok(())
}
