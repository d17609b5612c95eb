//! The whole step under inputs that no machine gives: random counts, times, gaps, wraps, enables and
//! moves. And what an edge costs beyond the tick.

use board_mps2_an386::instructions::Counter;
use leadscrew::axis::{Axis, Inputs};
use leadscrew::estimator::EstimatorConfig;
use leadscrew::hal::{Capture, Latch};
use leadscrew::quadrature::Decoder;
use leadscrew::telemetry::Record;
use leadscrew_hal_mock::scenario::ScenarioError;
use static_cell::ConstStaticCell;

use crate::samples::Samples;
use crate::staged::ESTIMATORS;
use crate::standard_move::{estimators, permissive};

const TICKS: u32 = 4000;
/// Edges of a tick at full speed, and the most that a ring holds.
const EDGES: usize = 150;

static SAMPLES: ConstStaticCell<[Samples; ESTIMATORS]> =
    ConstStaticCell::new(Samples::of_each(EstimatorConfig::NAMES));

static EDGE: ConstStaticCell<[Samples; 2]> =
    ConstStaticCell::new([Samples::of("edges_150"), Samples::of("decoder_step")]);

/// A linear congruential generator: bad enough inputs.
struct Dice(u64);

impl Dice {
    fn roll(&mut self) -> u32 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 32) as u32
    }

    fn one_in(&mut self, chances: u32) -> bool {
        self.roll().is_multiple_of(chances)
    }

    fn latch(&mut self) -> Option<Latch> {
        self.one_in(4).then(|| Latch {
            count: self.roll(),
            time: self.roll(),
        })
    }
}

pub fn run(counter: &mut Counter) -> Result<(), ScenarioError> {
    let table = SAMPLES.take();
    for (estimator, samples) in estimators()?.into_iter().zip(table.iter_mut()) {
        let (config, script) = permissive(estimator)?;
        let mut axis = Axis::new(config);
        let mut dice = Dice(1);
        let mut times = [0_u32; EDGES];
        for tick in 0..TICKS {
            times.fill_with(|| dice.roll());
            let inputs = inputs(&mut dice, &times);
            if dice.one_in(8) {
                let next = &script.moves[tick as usize % 2];
                let _ = axis.queue(&next.profile, tick + 1 + dice.roll() % 4);
            }
            samples.push(counter.count(|| Record::new(axis.step(&inputs))));
        }
        samples.log("adversary");
    }
    edge(counter)
}

fn inputs<'a>(dice: &mut Dice, times: &'a [u32; EDGES]) -> Inputs<'a> {
    let (older, newer) = times.split_at(dice.roll() as usize % EDGES);
    let newer = &newer[..dice.roll() as usize % (newer.len() + 1)];
    let capture = Capture {
        count: if dice.one_in(2) {
            dice.roll()
        } else {
            dice.roll() % 4096
        },
        sampled_at: dice.roll(),
        last_edge_at: dice.one_in(2).then(|| dice.roll()),
        edges: [older, newer],
        illegal: dice.roll() as u16,
        overrun: dice.one_in(2),
        touching: dice.one_in(2),
        index: dice.latch(),
        probe: dice.latch(),
        home: dice.latch(),
    };
    Inputs::of(capture, !dice.one_in(32))
}

/// What an edge costs beyond the tick: nothing in the step, as the papers' estimators do not look at edges
/// (`edges_150` is a step with 150 edge times less one without), and a step of the software decoder where
/// no hardware decodes.
fn edge(counter: &mut Counter) -> Result<(), ScenarioError> {
    let [edges, decoded] = EDGE.take();
    let (config, _) = permissive(estimators()?[1])?;
    let times = [1_u32; EDGES];
    let (mut with, mut without) = (Axis::new(config), Axis::new(config));
    let mut decoder = Decoder::new(false, false);
    let mut count = 0;
    for tick in 0..500_u32 {
        count += EDGES as u32;
        let bare = Capture {
            count,
            sampled_at: tick,
            ..Capture::default()
        };
        let full = Capture {
            edges: [&times, &[]],
            last_edge_at: Some(tick),
            ..bare
        };
        let dear = counter.count(|| with.step(&Inputs::of(full, true)).command);
        let cheap = counter.count(|| without.step(&Inputs::of(bare, true)).command);
        edges.push(dear.saturating_sub(cheap));
        let (a, b) = (tick % 4 < 2, tick.wrapping_add(1) % 4 < 2);
        decoded.push(counter.count(|| decoder.step(a, b)));
    }
    edges.log("capture");
    decoded.log("quadrature");
    Ok(())
}
