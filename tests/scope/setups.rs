//! Setups that cannot be, each with what to do.

use leadscrew::scope::{Scope, ScopeError, Setup, Signal, Signals, Trigger};

fn setup() -> Setup {
    Setup {
        signals: Signals::new(&[Signal::Velocity, Signal::Position, Signal::Flags]).unwrap(),
        every: 1,
        trigger: Trigger::Now,
        pre: 9,
        samples: 10,
    }
}

#[track_caller]
fn assert_refused(setup: &Setup, words: usize, error: ScopeError, text: &str) {
    let mut memory = vec![7; words];
    let refused = Scope::new(&mut memory, setup).unwrap_err();
    assert_eq!(refused.error, error);
    assert_eq!(refused.memory, vec![7; words], "it comes back");
    assert_eq!(error.to_string(), text);
}

#[test]
fn a_memory_of_just_the_words_is_enough_and_of_one_less_is_not() {
    let mut memory = [0; 30];
    assert!(Scope::new(&mut memory, &setup()).is_ok());
    let error = ScopeError::TooManySamples {
        samples: 10,
        fit: 9,
    };
    assert_refused(
        &setup(),
        29,
        error,
        "10 samples do not fit, 9 do: record fewer samples or signals, or every n-th tick",
    );
    let error = ScopeError::TooManySamples {
        samples: u32::MAX,
        fit: 0,
    };
    let most = Setup {
        samples: u32::MAX,
        ..setup()
    };
    assert_eq!(most.check(2), Err(error));
    assert_eq!(Setup::fit(&setup().signals, 10_000), 3333);
}

#[test]
fn what_cannot_be_recorded_is_refused() {
    let none = Setup {
        every: 0,
        ..setup()
    };
    let text = "a sample every 0 ticks: record every tick (1), or every n-th";
    assert_refused(&none, 30, ScopeError::NoDecimation, text);
    let none = Setup {
        samples: 0,
        ..setup()
    };
    let text = "no samples to record: ask for 1 at least";
    assert_refused(&none, 30, ScopeError::NoSamples, text);
    let error = ScopeError::PreTooLong {
        pre: 10,
        samples: 10,
    };
    let late = Setup { pre: 10, ..setup() };
    let text = "10 samples before the trigger of 10 in all: leave at least one for the trigger";
    assert_refused(&late, 30, error, text);
}

#[test]
fn lists_of_signals_are_those_that_there_are() {
    assert_eq!(Signals::new(&[]), Err(ScopeError::NoSignal));
    let error = ScopeError::TooManySignals { given: 9 };
    assert_eq!(Signals::new(&[Signal::Tick; 9]), Err(error));
    assert_eq!(Signals::from_numbers(&[4; 9]), Err(error));
    let error = ScopeError::UnknownSignal { number: 0 };
    assert_eq!(Signals::from_numbers(&[4, 0]), Err(error));
    let signals = Signals::from_numbers(&[4, 3, 12]).unwrap();
    assert_eq!(signals, setup().signals);
    assert_ne!(signals, Signals::from_numbers(&[4, 3]).unwrap());
    for error in [
        ScopeError::NoSignal,
        ScopeError::TooManySignals { given: 9 },
        ScopeError::UnknownSignal { number: 200 },
    ] {
        assert!(error.to_string().contains(": "), "{error}");
    }
}
