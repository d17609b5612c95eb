//! The axis under any sequence of captures and calls: no panic, and the output keeps its limit.

use leadscrew::axis::{Axis, Inputs};
use leadscrew::controller::Config;
use leadscrew::estimator::EstimatorConfig;
use leadscrew::hal::{Capture, Latch};
use leadscrew::output::ActiveLimits;
use leadscrew::setpoint::profile::Profile;
use leadscrew::units::{Command, Position};
use proptest::prelude::*;

use crate::any_bits::{any_config, extreme_i64};
use crate::axis::config;
use crate::seeded::seeded;

/// What may happen to an axis between two ticks and in the next one.
#[derive(Clone, Debug)]
#[expect(clippy::large_enum_variant, reason = "few of them, in a test")]
enum Event {
    /// Words of the hardware, and the enable line.
    Tick {
        words: Words,
        enable: bool,
    },
    /// The same again and again: long enough for filters and integral to fill up.
    Ticks {
        words: Words,
        times: u8,
    },
    Queue {
        distance: i64,
        ahead: u32,
    },
    Reconfigure {
        estimator: usize,
        controller: Config,
        limit: f64,
        slew: f64,
    },
}

#[derive(Clone, Debug)]
struct Words {
    count: u32,
    /// The count is the previous one plus this, rather than any.
    step: Option<i32>,
    sampled_at: u32,
    last_edge_at: Option<u32>,
    edges: (usize, usize),
    illegal: u16,
    overrun: bool,
    latches: [Option<(u32, u32)>; 2],
}

fn words() -> impl Strategy<Value = Words> {
    let latch = || prop::option::of(any::<(u32, u32)>());
    let step = prop_oneof![
        Just(None),
        (-200..200_i32).prop_map(Some),
        (-5000..5000_i32).prop_map(Some)
    ];
    let times = (
        any::<u32>(),
        any::<Option<u32>>(),
        (0..200_usize, 0..200_usize),
    );
    (
        any::<u32>(),
        step,
        times,
        any::<u16>(),
        any::<bool>(),
        [latch(), latch()],
    )
        .prop_map(
            |(count, step, (sampled_at, last_edge_at, edges), illegal, overrun, latches)| Words {
                count,
                step,
                sampled_at,
                last_edge_at,
                edges,
                illegal,
                overrun,
                latches,
            },
        )
}

fn event() -> impl Strategy<Value = Event> {
    let distance = prop_oneof![-(1000_i64 << 16)..1000 << 16, extreme_i64()];
    let ahead = prop_oneof![0..20_u32, any::<u32>()];
    let reconfigure = (
        0..EstimatorConfig::NAMES.len(),
        any_config(),
        1e-4..1.0_f64,
        1e-6..2.0_f64,
    );
    prop_oneof![
        6 => (words(), prop::bool::weighted(0.9)).prop_map(|(words, enable)| Event::Tick { words, enable }),
        1 => (words(), 2..100_u8).prop_map(|(words, times)| Event::Ticks { words, times }),
        2 => (distance, ahead).prop_map(|(distance, ahead)| Event::Queue { distance, ahead }),
        1 => reconfigure.prop_map(|(estimator, controller, limit, slew)| Event::Reconfigure { estimator, controller, limit, slew }),
    ]
}

/// An axis, and what its output may be.
struct Watched {
    axis: Axis<'static>,
    limit: Command,
    slew: Command,
    /// Above the limit only on the way down to one newly lowered.
    allowed: Command,
    count: u32,
    tick: u32,
}

impl Watched {
    fn tick(&mut self, words: &Words, enable: bool) {
        let times = [0_u32; 200];
        let latch = |words: Option<(u32, u32)>| words.map(|(count, time)| Latch { count, time });
        self.count = words
            .step
            .map_or(words.count, |step| self.count.wrapping_add_signed(step));
        let capture = Capture {
            count: self.count,
            sampled_at: words.sampled_at,
            last_edge_at: words.last_edge_at,
            edges: [&times[..words.edges.0], &times[..words.edges.1]],
            illegal: words.illegal,
            overrun: words.overrun,
            index: latch(words.latches[0]),
            probe: latch(words.latches[1]),
            touching: words.latches[1].is_some(),
            home: None,
        };
        let outputs = self.axis.step(&Inputs::of(capture, enable));
        self.allowed = self.limit.max(self.allowed.saturating_sub(self.slew));
        assert!(outputs.command.abs() <= self.allowed, "{outputs:?}");
        if !enable {
            assert_eq!(
                (outputs.command, outputs.limits),
                (Command::ZERO, ActiveLimits::default())
            );
            assert!(!outputs.moving && !outputs.enabled);
            self.allowed = self.limit;
        }
        assert_eq!(outputs.tick, self.tick);
        assert_eq!(outputs.count as u32, self.count);
        self.tick = self.tick.wrapping_add(1);
    }

    fn event(&mut self, event: Event) {
        match event {
            Event::Tick { words, enable } => self.tick(&words, enable),
            Event::Ticks { words, times } => (0..times).for_each(|_| self.tick(&words, true)),
            Event::Queue { distance, ahead } => {
                if let Ok(profile) =
                    Profile::plan(Position::from_bits(distance), &self.axis.config().limits)
                {
                    let _ = self.axis.queue(&profile, self.tick.wrapping_add(ahead));
                }
            }
            Event::Reconfigure {
                estimator,
                controller,
                limit,
                slew,
            } => {
                let before = self.limit;
                self.axis
                    .reconfigure(&config(estimator, controller, limit, slew))
                    .unwrap();
                self.limit = Command::from_num(limit);
                self.slew = Command::saturating_from_num(slew);
                self.allowed = self.allowed.max(before);
            }
        }
    }
}

proptest! {
    #![proptest_config(seeded(300))]

    #[test]
    fn for_any_sequence_of_captures_and_calls_the_command_keeps_its_limit_and_is_zero_while_disabled(
        estimator in 0..EstimatorConfig::NAMES.len(),
        controller in any_config(),
        events in prop::collection::vec(event(), 1..80),
    ) {
        let axis = Axis::new(config(estimator, controller, 0.5, 0.3));
        let (limit, slew) = (Command::lit("0.5"), Command::from_num(0.3));
        let mut watched = Watched { axis, limit, slew, allowed: limit, count: 0, tick: 0 };
        for event in events {
            watched.event(event);
        }
    }
}
