//! Captures sampled from a recording: each edge in its tick, and the same as hardware would give.

use leadscrew::capture::Unwrapper;
use leadscrew::hal::{Capture, Latch};
use leadscrew_hal_mock::encoder::EncoderModel;
use leadscrew_hal_mock::scene::{Motion, Scene};
use leadscrew_host::recording::{Change, Levels, Recording};
use leadscrew_host::sampler::{Sampler, Totals};
use proptest::prelude::*;

/// Control rates in µHz: none of the odd ones divides a clock.
const RATES_MICROHERTZ: [u64; 5] = [
    100_000_000,
    1_000_000_000,
    1_234_500_000,
    333_333_333,
    40_000_000_000,
];
/// Clocks of recordings, Hz.
const CLOCKS_HZ: [u64; 4] = [3, 24_000_000, 1_000_000, 10_000_000_000];
/// Timers that the core takes, Hz.
const TIMERS_HZ: (u64, u64) = (1_000_000, 250_000_000);

/// What happens at an instant of a recording, and what it must come to.
#[derive(Clone, Copy, Debug)]
struct Event {
    time: u64,
    /// Count after it.
    count: i64,
    edge: bool,
    illegal: bool,
    index_rises: bool,
}

/// A shaft's walk from place `start` in the cycle of the levels, 0 to 3, in steps of −1, 0, +1 or 2 (an illegal one) places with the level of Z, at random
/// distances in time; and what each step must come to.
fn walk(
    clock_hz: u64,
    start: i64,
    steps: &[(u64, i64, bool)],
    tail: u64,
) -> (Recording, Vec<Event>) {
    let levels_at = |place: i64, z| {
        let (a, b) = [(false, false), (true, false), (true, true), (false, true)]
            [place.rem_euclid(4) as usize];
        Levels { a, b, z }
    };
    let (mut time, mut place, mut count, mut high) = (0, start, start, false);
    let (mut changes, mut events) = (Vec::new(), Vec::new());
    for &(gap, step, z) in steps {
        time += gap;
        place += step;
        count += if step == 2 { 0 } else { step };
        if step == 0 && z == high {
            continue;
        }
        changes.push(Change {
            time,
            levels: levels_at(place, z),
        });
        events.push(Event {
            time,
            count,
            edge: step.abs() == 1,
            illegal: step == 2,
            index_rises: z && !high,
        });
        high = z;
    }
    let recording = Recording {
        clock_hz,
        duration: time + tail,
        initial: levels_at(start, false),
        changes,
    };
    (recording, events)
}

/// A time in clocks of the recording as a reading of the timer.
fn timer(recording: &Recording, time: u64) -> u32 {
    let timer_hz = recording.clock_hz.clamp(TIMERS_HZ.0, TIMERS_HZ.1);
    (u128::from(time) * u128::from(timer_hz) / u128::from(recording.clock_hz)) as u32
}

/// Asserts that a capture tells just these events.
fn assert_tells(recording: &Recording, capture: &Capture<'_>, before: i64, events: &[Event]) {
    let times: Vec<u32> = capture.edges.concat();
    let of_edges = events.iter().filter(|event| event.edge);
    let expected: Vec<u32> = of_edges.map(|event| timer(recording, event.time)).collect();
    assert_eq!(times, expected);
    assert_eq!(capture.last_edge_at, times.last().copied());
    let count = events.last().map_or(before, |event| event.count);
    assert_eq!(capture.count, count as u32);
    let illegal = events.iter().filter(|event| event.illegal).count();
    assert_eq!(usize::from(capture.illegal), illegal);
    let index = events.iter().rfind(|event| event.index_rises);
    let latch = |event: &Event| Latch {
        count: event.count as u32,
        time: timer(recording, event.time),
    };
    assert_eq!(capture.index, index.map(latch));
    assert_eq!((capture.overrun, capture.probe), (false, None));
}

proptest! {
    #[test]
    fn every_edge_belongs_to_the_first_tick_that_is_not_before_it(
        clock in 0..CLOCKS_HZ.len(),
        rate in 0..RATES_MICROHERTZ.len(),
        start in 0..4_i64,
        // Gaps in fractions of a tick, so that every rate sees ticks with none, one and many.
        steps in prop::collection::vec((1..3000_u64, -1..=2_i64, any::<bool>()), 0..200),
        tail in 0..3000_u64,
    ) {
        let (clock_hz, rate) = (CLOCKS_HZ[clock], RATES_MICROHERTZ[rate]);
        // Clocks of a thousandth of a tick, at least one.
        let scale = (clock_hz * 1000 / rate).max(1);
        // Of a slow clock each time is many ticks: fewer of them do.
        let coarse = clock_hz * 1_000_000 < rate;
        let (gaps, most) = if coarse { (2, 10) } else { (3000, 200) };
        let steps: Vec<_> = steps
            .into_iter()
            .take(most)
            .map(|(gap, step, z)| ((gap % gaps + 1) * scale, step, z))
            .collect();
        let (recording, events) = walk(clock_hz, start, &steps, tail % gaps * scale);
        let duration = u128::from(recording.duration) * u128::from(rate);
        let per_tick = u128::from(clock_hz) * 1_000_000;

        let mut sampler = Sampler::new(&recording, rate as f64 / 1e6);
        prop_assert_eq!(u128::from(sampler.ticks()), duration / per_tick + 1);
        prop_assert_eq!(sampler.start_count(), start);
        let (mut tick, mut told, mut before) = (0_u128, 0, start);
        let mut unwrapper = Unwrapper::new();
        let mut sampled_before = 0;
        while let Some(capture) = sampler.next_capture() {
            let due = |event: &&Event| u128::from(event.time) * u128::from(rate) <= tick * per_tick;
            let here = &events[told..][..events[told..].iter().take_while(due).count()];
            assert_tells(&recording, &capture, before, here);
            told += here.len();
            before = here.last().map_or(before, |event| event.count);

            // The instant itself, rounded down to the timer; edges lie between two of them.
            let timer_hz = clock_hz.clamp(TIMERS_HZ.0, TIMERS_HZ.1);
            let instant = tick * u128::from(timer_hz) * 1_000_000 / u128::from(rate);
            prop_assert_eq!(capture.sampled_at, instant as u32);
            let elapsed = capture.sampled_at.wrapping_sub(sampled_before);
            sampled_before = capture.sampled_at;
            let mut age_before = elapsed;
            for &at in capture.edges.iter().copied().flatten() {
                let age = capture.sampled_at.wrapping_sub(at);
                prop_assert!(age <= age_before);
                age_before = age;
            }
            let observation = unwrapper.unwrap(&capture);
            prop_assert_eq!(observation.count, before);
            prop_assert_eq!(observation.sampled_at, instant as i64);
            tick += 1;
        }
        prop_assert_eq!(tick, duration / per_tick + 1);
        // The last tick is less than a tick before the end.
        prop_assert!((tick - 1) * per_tick <= duration && duration < tick * per_tick);
        let count = |what: fn(&Event) -> bool| events.iter().filter(|event| what(event)).count() as u64;
        prop_assert_eq!(
            sampler.totals(),
            Totals {
                edges: count(|event| event.edge),
                illegal: count(|event| event.illegal),
                final_count: events.last().map_or(0, |event| event.count - start),
            }
        );
    }
}

/// A recording at the timer's clock of what an encoder's captures tell, in a motion one way.
fn record(captures: &[Told], clock_hz: u64) -> Recording {
    let mut place = 0_i64;
    let mut changes = Vec::new();
    for told in captures {
        let direction = told.moved.signum();
        for &time in &told.edges {
            place += direction;
            let (a, b) = [(false, false), (true, false), (true, true), (false, true)]
                [place.rem_euclid(4) as usize];
            let z = told.index.is_some_and(|index| index.time == time);
            changes.push(Change {
                time: u64::from(time),
                levels: Levels { a, b, z },
            });
        }
    }
    Recording {
        clock_hz,
        duration: captures.last().map_or(0, |told| u64::from(told.sampled_at)),
        initial: Levels::default(),
        changes,
    }
}

/// What a capture told.
struct Told {
    moved: i64,
    edges: Vec<u32>,
    sampled_at: u32,
    index: Option<Latch>,
    count: u32,
}

#[test]
fn captures_are_those_of_the_simulated_hardware() {
    for (start_d, velocity) in [(-50.5, 7.3), (60.5, -7.3), (-900.5, 151.7)] {
        let model = EncoderModel::real();
        let motion = Motion::Steady { velocity };
        let mut scene = Scene::new(motion, &model, 1000.0, start_d, 1).expect("in range");
        let mut before = scene.capture().count;
        let origin = before;
        let told: Vec<Told> = (0..40)
            .map(|_| {
                scene.step();
                let capture = scene.capture();
                let moved = i64::from(capture.count.wrapping_sub(before).cast_signed());
                before = capture.count;
                Told {
                    moved,
                    edges: capture.edges.concat(),
                    sampled_at: capture.sampled_at,
                    index: capture.index,
                    count: capture.count.wrapping_sub(origin),
                }
            })
            .collect();
        assert_eq!(told.iter().filter(|told| told.index.is_some()).count(), 1);

        let recording = record(&told, model.encoder.timer_hz as u64);
        let mut sampler = Sampler::new(&recording, 1000.0);
        let first = sampler
            .next_capture()
            .expect("the first tick is at the start");
        assert_eq!((first.count, first.sampled_at), (0, 0));
        for hardware in &told {
            let software = sampler.next_capture().expect("a tick of the hardware's");
            assert_eq!(software.count, hardware.count);
            assert_eq!(software.sampled_at, hardware.sampled_at);
            assert_eq!(software.edges.concat(), hardware.edges);
            assert_eq!(software.last_edge_at, hardware.edges.last().copied());
            let index = hardware.index.map(|latch| Latch {
                count: latch.count.wrapping_sub(origin),
                ..latch
            });
            assert_eq!(software.index, index);
        }
        assert!(sampler.next_capture().is_none());
    }
}

#[test]
fn a_channel_that_starts_high_is_no_index_pulse() {
    let recording = Recording {
        clock_hz: 1000,
        duration: 4,
        initial: Levels {
            z: true,
            ..Levels::default()
        },
        changes: Vec::new(),
    };
    let mut sampler = Sampler::new(&recording, 1000.0);
    while let Some(capture) = sampler.next_capture() {
        assert_eq!(capture.index, None);
    }
}

#[test]
fn a_recording_of_ages_has_a_number_of_ticks() {
    let recording = Recording {
        clock_hz: 1,
        duration: u64::MAX,
        initial: Levels::default(),
        changes: Vec::new(),
    };
    assert_eq!(Sampler::new(&recording, 40_000.0).ticks(), u64::MAX);
}
