//! What the edges of a tick cost: their times and the errors of the encoder map added up, one division each.
//! `note` is a tick's notice without an index, `index` one with it; `plain_N` and `map_N` are samples of N
//! edges without a map and with a full one. An edge costs (map_1000 − map_50)/950.

use board_mps2_an386::instructions::Counter;
use leadscrew::capture::Unwrapper;
use leadscrew::edges::EdgeReader;
use leadscrew::encoder_map::encode::{MapContent, encode};
use leadscrew::encoder_map::tie::MapState;
use leadscrew::encoder_map::{EncoderMap, Form, Residual};
use leadscrew::hal::{Capture, Latch};
use leadscrew_hal_mock::scenario::ScenarioError;
use static_cell::ConstStaticCell;

use crate::samples::Samples;
use crate::standard_move::{config, estimators};

const REVOLUTION: u32 = 10_000;
const IMAGE: usize = leadscrew::encoder_map::format::image_len(REVOLUTION, Form::Full);
/// Edges of the sampled ticks.
const STEPS: [usize; 3] = [50, 150, 1000];
const MOST_EDGES: usize = 1000;
const TICKS: u32 = 500;

static IMAGE_BYTES: ConstStaticCell<[u8; IMAGE]> = ConstStaticCell::new([0; IMAGE]);
static TIMES: ConstStaticCell<[u32; MOST_EDGES]> = ConstStaticCell::new([0; MOST_EDGES]);
static TABLE: ConstStaticCell<Table> = ConstStaticCell::new(Table {
    note: Samples::of("note"),
    index: Samples::of("index"),
    plain: [
        Samples::of("plain_50"),
        Samples::of("plain_150"),
        Samples::of("plain_1000"),
    ],
    map: [
        Samples::of("map_50"),
        Samples::of("map_150"),
        Samples::of("map_1000"),
    ],
});

struct Table {
    note: Samples,
    index: Samples,
    plain: [Samples; 3],
    map: [Samples; 3],
}

pub fn run(counter: &mut Counter) -> Result<(), ScenarioError> {
    let (config, _) = config(estimators()?[0])?;
    let image = IMAGE_BYTES.take();
    let content = MapContent {
        edges: REVOLUTION,
        error: &|edge| (edge.wrapping_mul(7919) % 13_001).cast_signed() - 6_500,
        phases: [[1000, -2000, 3000, -4000]; 2],
        fronts: [Some(0), Some(2)],
        residual: Residual::default(),
    };
    encode(&content, Form::Full, image).expect("a byte holds a tenth of a d");
    let map = EncoderMap::from_bytes(image).expect("it was just made");
    let table = TABLE.take();
    let times = TIMES.take();
    for (place, edges) in STEPS.into_iter().enumerate() {
        let mut unwrapper = Unwrapper::new();
        let plain = EdgeReader::new(config.edges);
        let mut mapped = plain.clone().with_map(map);
        let (mut count, mut now) = (0_u32, 0_u32);
        for tick in 0..TICKS {
            count += edges as u32;
            now = now.wrapping_add(84_000);
            let times = &mut times[..edges];
            for (age, time) in (0..).zip(times.iter_mut().rev()) {
                *time = now.wrapping_sub(age * 84);
            }
            // The ring parts them anywhere.
            let (older, newer) = times.split_at(tick as usize % edges);
            let front = count - count % REVOLUTION;
            let index = (front + edges as u32 > count).then_some(Latch {
                count: front,
                time: now,
            });
            let capture = Capture {
                count,
                sampled_at: now,
                last_edge_at: Some(now),
                edges: [older, newer],
                index,
                ..Capture::default()
            };
            let observation = unwrapper.unwrap(&capture);
            let noted = counter.count(|| mapped.note(&observation));
            if index.is_some() {
                table.index.push(noted);
            } else {
                table.note.push(noted);
            }
            if mapped.map_state() == Some(MapState::Tied) {
                table.plain[place].push(counter.count(|| plain.sample(&observation)));
                table.map[place].push(counter.count(|| mapped.sample(&observation)));
            }
        }
    }
    let Table {
        note,
        index,
        plain,
        map,
    } = table;
    for samples in [note, index].into_iter().chain(plain).chain(map) {
        samples.log("edges");
    }
    Ok(())
}
