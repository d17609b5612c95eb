//! Any setup on any motion of the axis.

use leadscrew::scope::{Scope, Setup, Side, Signal, Signals, Slope, Trigger};
use leadscrew::supervisor::Fault;
use proptest::prelude::*;

use crate::model::Life;
use crate::puppet::{Pull, Puppet};
use crate::seeded::seeded;

fn pull() -> impl Strategy<Value = Pull> {
    let delta = prop_oneof![
        4 => -3..=3_i32,
        3 => -2000..=2000_i32,
        1 => any::<i32>(),
    ];
    let origin = prop_oneof![
        20 => Just(None),
        1 => (-1_000_000..1_000_000_i64).prop_map(Some),
    ];
    (
        delta,
        prop::bool::weighted(0.8),
        prop::bool::weighted(0.02),
        prop::bool::weighted(0.1),
        origin,
        -0.2..0.2_f64,
    )
        .prop_map(|(delta, enable, drive_fault, clear, origin, analog)| Pull {
            delta,
            enable,
            drive_fault,
            clear,
            origin,
            analog,
        })
}

/// Pulls that stay the same for some ticks: so there is rest between motions.
fn pulls() -> impl Strategy<Value = Vec<Pull>> {
    let stretch = (pull(), 1..12_usize).prop_map(|(pull, ticks)| {
        let on = Pull {
            clear: false,
            origin: None,
            ..pull
        };
        let mut stretch = vec![on; ticks];
        stretch[0] = pull;
        stretch
    });
    let stretches = prop_oneof![3 => stretch, 1 => quiet(1..80)];
    let stretches = prop::collection::vec(stretches, 1..40);
    (quiet(0..9), stretches).prop_map(|(first, stretches)| [first, stretches.concat()].concat())
}

/// Under control at rest.
fn quiet(ticks: std::ops::Range<usize>) -> impl Strategy<Value = Vec<Pull>> {
    let still = Pull {
        enable: true,
        ..Pull::default()
    };
    ticks.prop_map(move |ticks| vec![still; ticks])
}

fn signal() -> impl Strategy<Value = Signal> {
    prop::sample::select(Signal::ALL)
}

/// A trigger, its level still without the size that the signal has.
fn trigger() -> impl Strategy<Value = Trigger> {
    let side = prop_oneof![Just(Side::Above), Just(Side::Below)];
    let slope = prop_oneof![
        Just(Slope::Rising),
        Just(Slope::Falling),
        Just(Slope::Either)
    ];
    let fault = prop::option::of(prop::sample::select(Fault::ALL));
    prop_oneof![
        1 => Just(Trigger::Now),
        1 => Just(Trigger::Force),
        3 => (signal(), side).prop_map(|(signal, side)| Trigger::Level { signal, level: 0, side }),
        4 => (signal(), slope).prop_map(|(signal, slope)| Trigger::Edge { signal, level: 0, slope }),
        2 => fault.prop_map(Trigger::Fault),
        1 => Just(Trigger::Warning),
        1 => Just(Trigger::Command),
    ]
}

/// The same with a level that the signal has at some time of the run: so it is reached, passed and equalled.
fn with_level(trigger: Trigger, value: impl Fn(Signal) -> i64) -> Trigger {
    match trigger {
        Trigger::Level { signal, side, .. } => Trigger::Level {
            signal,
            level: value(signal),
            side,
        },
        Trigger::Edge { signal, slope, .. } => Trigger::Edge {
            signal,
            level: value(signal),
            slope,
        },
        other => other,
    }
}

proptest! {
    #![proptest_config(seeded(1500))]

    #[test]
    fn every_sample_is_what_the_axis_gave(
        start in any::<u32>(),
        pulls in pulls(),
        signals in prop::collection::vec(signal(), 1..=8),
        (every, samples, before) in (1..6_u16, 1..40_u32, 0.0..1.0_f64),
        trigger in trigger(),
        level_at in any::<prop::sample::Index>(),
        forced in prop::option::weighted(0.2, any::<prop::sample::Index>()),
        missed in prop::collection::vec((any::<prop::sample::Index>(), 1..4_u32), 0..3),
        (armed, spare) in (prop::option::of(any::<prop::sample::Index>()), 0..9_usize),
    ) {
        let mut dry = Puppet::new(start);
        let mut rows: Vec<_> = pulls.iter().map(|pull| dry.step(pull)).collect();
        let armed = armed.map_or(0, |at| at.index(rows.len()));
        let prior = armed.checked_sub(1).map(|before| rows[before]);
        rows.drain(..armed);
        let signals = Signals::new(&signals).unwrap();
        let setup = Setup {
            signals,
            every,
            trigger: with_level(trigger, |signal| level_at.get(&rows).value(signal)),
            pre: (f64::from(samples) * before) as u32,
            samples,
        };
        let mut told = vec![0; rows.len()];
        for (at, ticks) in missed {
            told[at.index(rows.len())] = ticks;
        }
        let life = Life {
            setup,
            forced: forced.map(|at| at.index(rows.len())),
            missed: told,
            prior,
            rows,
        };

        let mut memory = vec![-1; samples as usize * signals.len() + spare];
        let mut scope = Scope::new(&mut memory, &setup).unwrap();
        let mut puppet = Puppet::new(start);
        pulls[..armed].iter().for_each(|pull| _ = puppet.step(pull));
        for (tick, pull) in pulls[armed..].iter().enumerate() {
            let row = puppet.step(pull);
            prop_assert_eq!(row, life.rows[tick]);
            if life.forced == Some(tick) {
                scope.trigger();
            }
            scope.miss(life.missed[tick]);
            scope.take(&puppet.axis);
        }
        scope.stop();
        life.assert_recorded(scope.state(), &scope.recording().unwrap());
        let memory = scope.into_memory();
        prop_assert!(memory[memory.len() - spare..].iter().all(|word| *word == -1));
    }
}
