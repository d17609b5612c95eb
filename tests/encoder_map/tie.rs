//! The tie to the index: found from either side, kept, lost on a slip, found again.

use leadscrew::capture::Unwrapper;
use leadscrew::edges::{EdgeConfig, EdgeReader, EdgeSample};
use leadscrew::encoder_map::tie::{MapHealth, MapState};
use leadscrew::encoder_map::{EncoderMap, Form};
use leadscrew::hal::{Capture, Latch};
use leadscrew::uncertainty::EdgeErrors;
use leadscrew_hal_mock::arc::{Arc, State};
use leadscrew_hal_mock::encoder::{Encoder, EncoderModel};

use crate::content::Errors;

pub fn scale() -> EdgeConfig {
    EdgeConfig::new(1000.0, 84e6, &EdgeErrors::default()).unwrap()
}

/// A shaft with the encoder "real" and readers of its edges: with the whole map, with phases, without.
struct Bench<'m> {
    encoder: Encoder,
    position: f64,
    unwrapper: Unwrapper,
    readers: [EdgeReader<'m>; 3],
    /// What the counter has gained by slips.
    slipped: u32,
}

/// The samples of a tick.
type Samples = [Option<EdgeSample>; 3];

impl<'m> Bench<'m> {
    fn new(images: &'m [Vec<u8>; 2], start: f64) -> Self {
        let [full, phases] = images
            .each_ref()
            .map(|image| EdgeReader::new(scale()).with_map(EncoderMap::from_bytes(image).unwrap()));
        Self {
            encoder: Encoder::new(&EncoderModel::real(), 1000.0, start, 1).unwrap(),
            position: start,
            unwrapper: Unwrapper::new(),
            readers: [full, phases, EdgeReader::new(scale())],
            slipped: 0,
        }
    }

    fn turn(&mut self, velocity: f64) -> Samples {
        self.turn_and(velocity, |_| {})
    }

    /// Turns one tick on; `change` is what the hardware makes of the capture.
    fn turn_and(&mut self, velocity: f64, change: impl FnOnce(&mut Capture<'_>)) -> Samples {
        let start = State {
            position: self.position,
            velocity,
            acceleration: 0.0,
        };
        self.encoder.advance(&Arc { start, jerk: 0.0 });
        self.position += velocity;
        let slipped = |count: u32| count.wrapping_add(self.slipped);
        let capture = self.encoder.capture();
        let mut capture = Capture {
            count: slipped(capture.count),
            index: capture.index.map(|latch| Latch {
                count: slipped(latch.count),
                ..latch
            }),
            ..capture
        };
        change(&mut capture);
        let observation = self.unwrapper.unwrap(&capture);
        self.readers.each_mut().map(|reader| {
            reader.note(&observation);
            reader.sample(&observation)
        })
    }

    fn state(&self) -> MapState {
        self.readers[0].map_state().unwrap()
    }

    fn health(&self) -> (u32, u32) {
        let MapHealth { ties, slips } = self.readers[0].map_health();
        (ties, slips)
    }
}

fn images() -> [Vec<u8>; 2] {
    let errors = Errors::true_of(&EncoderModel::real(), 1);
    [errors.encode(Form::Full), errors.encode(Form::Phases)]
}

#[test]
fn the_first_index_ties_from_either_side_and_either_direction_confirms_it() {
    let images = images();
    for (start, velocity) in [
        (-4000.5, 150.3),
        (4000.5, -150.3),
        (-20.5, 1.7),
        (20.5, -1.7),
    ] {
        let mut bench = Bench::new(&images, start);
        let ticks = (f64::abs(start) / f64::abs(velocity)) as usize;
        for _ in 0..ticks - 6 {
            let [full, phases, _] = bench.turn(velocity);
            assert_eq!(full, phases, "the fallback is the phases");
            assert_eq!(bench.state(), MapState::Unfound);
        }
        for _ in 0..12 {
            bench.turn(velocity);
        }
        assert_eq!((bench.state(), bench.health()), (MapState::Tied, (1, 0)));
        // Over the index to and fro, and revolutions on.
        for velocity in [-velocity, velocity, 217.9, -217.9] {
            for _ in 0..100 {
                bench.turn(velocity);
                assert_eq!((bench.state(), bench.health()), (MapState::Tied, (1, 0)));
            }
        }
    }
}

#[test]
fn a_slip_rejects_the_map_until_two_indexes_agree() {
    let images = images();
    for velocity in [150.3, -150.3] {
        let mut bench = Bench::new(&images, -10.0 * velocity);
        let until = |bench: &mut Bench<'_>, state| {
            let ticks = (0..200).take_while(|_| {
                bench.turn(velocity);
                bench.state() != state
            });
            ticks.count()
        };
        assert!(until(&mut bench, MapState::Tied) < 20);
        for ties in 1..5 {
            // By a line, and nothing tells of it before the next index.
            bench.slipped = bench.slipped.wrapping_add(4);
            assert!((40..70).contains(&until(&mut bench, MapState::Rejected)));
            assert_eq!(bench.health(), (ties, ties));
            for _ in 0..60 {
                let [full, phases, _] = bench.turn(velocity);
                assert_eq!(full, phases);
            }
            assert!(until(&mut bench, MapState::Tied) < 10);
            assert_eq!(bench.health(), (ties + 1, ties));
            let [full, phases, _] = bench.turn(velocity);
            assert_ne!(full, phases);
        }
    }
}

#[test]
fn half_a_line_off_nothing_is_used() {
    let images = images();
    let mut bench = Bench::new(&images, -100.5);
    let revolution = |bench: &mut Bench<'_>| {
        (0..70).for_each(|_| {
            bench.turn(150.3);
        });
    };
    revolution(&mut bench);
    assert_eq!(bench.state(), MapState::Tied);
    bench.slipped = 2;
    revolution(&mut bench);
    revolution(&mut bench);
    assert_eq!(
        (bench.state(), bench.health()),
        (MapState::OffPhase, (1, 1))
    );
    let [full, phases, none] = bench.turn(150.3);
    assert_eq!(full, none);
    assert_ne!(phases, none);
    // Back on the line: as after a slip.
    bench.slipped = 0;
    revolution(&mut bench);
    assert_eq!(bench.state(), MapState::Rejected);
    revolution(&mut bench);
    assert_eq!((bench.state(), bench.health()), (MapState::Tied, (2, 1)));
}

#[test]
fn a_front_that_comes_a_count_early_or_late_does_not_matter() {
    let images = images();
    for velocity in [150.3, -150.3] {
        let mut bench = Bench::new(&images, -10.0 * velocity);
        let mut indexes = 0;
        for tick in 0..2000_u32 {
            bench.turn_and(velocity, |capture| {
                if let Some(latch) = &mut capture.index {
                    latch.count = latch.count.wrapping_add(tick % 3).wrapping_sub(1);
                    indexes += 1;
                }
            });
        }
        assert!(indexes > 25);
        assert_eq!((bench.state(), bench.health()), (MapState::Tied, (1, 0)));
    }
}

#[test]
fn an_index_whose_direction_is_not_known_is_passed_over() {
    type Change = fn(&mut Capture<'_>);
    let images = images();
    let changes: [(Change, MapState); 4] = [
        (|_| {}, MapState::Tied),
        // As after a reversal within the tick, where the latch lies off the way.
        (
            |capture| {
                if let Some(latch) = &mut capture.index {
                    latch.count = latch.count.wrapping_sub(400);
                }
            },
            MapState::Unfound,
        ),
        (|capture| capture.illegal = 1, MapState::Unfound),
        // More edges than counts.
        (
            |capture| {
                if capture.index.is_some() {
                    capture.count = capture.count.wrapping_sub(10);
                }
            },
            MapState::Unfound,
        ),
    ];
    for (change, state) in changes {
        let mut bench = Bench::new(&images, -500.5);
        for _ in 0..20 {
            bench.turn_and(150.3, change);
        }
        assert_eq!(bench.state(), state);
    }
}

#[test]
fn a_direction_without_a_front_is_passed_over() {
    let mut errors = Errors::true_of(&EncoderModel::real(), 1);
    errors.fronts[1] = None;
    let images = [errors.encode(Form::Coarse), errors.encode(Form::Phases)];
    let mut bench = Bench::new(&images, 500.5);
    for _ in 0..20 {
        bench.turn(-150.3);
    }
    assert_eq!(bench.state(), MapState::Unfound);
    for _ in 0..30 {
        bench.turn(150.3);
    }
    assert_eq!((bench.state(), bench.health()), (MapState::Tied, (1, 0)));
}

#[test]
fn motion_beyond_the_format_does_not_lose_the_tie() {
    let images = images();
    let mut bench = Bench::new(&images, -200.5);
    for velocity in [150.3, 150.3, 3000.0, 9000.0, 4321.0, -20_007.3, 150.3] {
        bench.turn(velocity);
    }
    assert_eq!((bench.state(), bench.health()), (MapState::Tied, (1, 0)));
    for _ in 0..200 {
        bench.turn(150.3);
    }
    assert_eq!((bench.state(), bench.health()), (MapState::Tied, (1, 0)));
}
