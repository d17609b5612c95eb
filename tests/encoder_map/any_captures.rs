//! Whatever the captures, the map holds its bounds and nothing panics.

use leadscrew::capture::Unwrapper;
use leadscrew::edges::EdgeReader;
use leadscrew::encoder_map::{EncoderMap, Form};
use leadscrew::hal::{Capture, Latch};
use proptest::prelude::*;

use crate::content::errors;
use crate::seeded::seeded;
use crate::tie::scale;

/// Any capture at all, edges as many as the count moved or not.
#[derive(Clone, Debug)]
struct Any {
    moved: i32,
    sampled_at: u32,
    edges: usize,
    index: Option<(i32, u32)>,
    illegal: u16,
    overrun: bool,
}

fn any_capture() -> impl Strategy<Value = Any> {
    let moved = prop_oneof![-5..=5_i32, -300..=300_i32, -3000..=3000_i32, any::<i32>()];
    let index = prop::option::of((prop_oneof![-8..=8_i32, any::<i32>()], any::<u32>()));
    let rare = |value| prop::sample::select(vec![0, 0, 0, 0, 0, 0, 0, value]);
    (
        moved,
        any::<u32>(),
        0..300_usize,
        index,
        any::<bool>(),
        rare(3),
        rare(1),
    )
        .prop_map(
            |(moved, sampled_at, edges, index, explained, illegal, overrun)| {
                let explained = explained && moved.unsigned_abs() <= 300;
                Any {
                    moved,
                    sampled_at,
                    edges: if explained {
                        moved.unsigned_abs() as usize
                    } else {
                        edges
                    },
                    index,
                    illegal,
                    overrun: overrun == 1,
                }
            },
        )
}

proptest! {
    #![proptest_config(seeded(256))]

    #[test]
    fn no_captures_whatever_upset_it(
        errors in errors(),
        start in any::<u32>(),
        captures in prop::collection::vec(any_capture(), 1..100),
        times in prop::collection::vec(any::<u32>(), 300),
    ) {
        for form in [Form::Full, Form::Phases] {
            let image = errors.encode(form);
            let map = EncoderMap::from_bytes(&image).unwrap();
            let mut unwrapper = Unwrapper::new();
            let mut reader = EdgeReader::new(scale()).with_map(map);
            let mut count = start;
            for any in &captures {
                count = count.wrapping_add_signed(any.moved);
                let (older, newer) = times[..any.edges].split_at(any.edges / 3);
                let capture = Capture {
                    count,
                    sampled_at: any.sampled_at,
                    last_edge_at: newer.last().copied(),
                    edges: [older, newer],
                    illegal: any.illegal,
                    overrun: any.overrun,
                    index: any.index.map(|(back, time)| Latch {
                        count: count.wrapping_add_signed(back),
                        time,
                    }),
                    probe: None,
                    touching: false,
                    home: None,
                };
                let observation = unwrapper.unwrap(&capture);
                reader.note(&observation);
                if let Some(sample) = reader.sample(&observation) {
                    // A map corrects by its base, 8 d, its byte, 1 d, and its phase, 2 d, at most.
                    let off = sample.position - observation.position();
                    prop_assert!(off.abs().to_num::<f64>() <= f64::from(any.moved.unsigned_abs().min(2047)) + 12.0);
                }
            }
        }
    }
}
