//! The live form.

use leadscrew::scope::{MOST_SIGNALS, ScopeError, Signal, Signals, Stream, Unwrap};

use crate::puppet::{Pull, Puppet};

#[test]
fn it_gives_every_nth_tick_and_its_low_words_make_whole_values() {
    let signals = [Signal::Position, Signal::Flags, Signal::Velocity];
    for every in [1, 3] {
        let list = Signals::new(&signals).unwrap();
        let mut stream = Stream::new(list, every).unwrap();
        let mut puppet = Puppet::new(u32::MAX);
        let mut whole: Option<Vec<Unwrap>> = None;
        for tick in 0..200 {
            let row = puppet.step(&Pull {
                delta: 1800,
                enable: tick > 100,
                ..Pull::default()
            });
            let sample = stream.take(&puppet.axis);
            assert_eq!(sample.is_some(), tick % u32::from(every) == 0);
            let Some(sample) = sample else { continue };
            assert_eq!(sample.tick, row.outputs.tick);
            let whole = whole.get_or_insert_with(|| {
                let values = list.values(&puppet.axis);
                let pairs = signals.iter().zip(values);
                pairs.map(|(s, value)| Unwrap::new(*s, value)).collect()
            });
            for ((signal, word), whole) in signals.iter().zip(sample.words).zip(whole) {
                assert_eq!(whole.take(word), row.value(*signal), "{signal}");
            }
            assert_eq!(sample.words[signals.len()..], [0; MOST_SIGNALS - 3]);
        }
    }
}

#[test]
fn a_sample_every_0_ticks_is_refused() {
    let signals = Signals::new(&[Signal::Tick]).unwrap();
    assert_eq!(
        Stream::new(signals, 0).unwrap_err(),
        ScopeError::NoDecimation
    );
}
