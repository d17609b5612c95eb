//! Records of resets as words, and garbage in their place.

use leadscrew_app::safe_state::reason::{HardFault, Place, Reason};
use leadscrew_app::safe_state::record::{Record, ResetFlags, WORDS};
use proptest::prelude::*;

const NONE: ResetFlags = ResetFlags {
    watchdog: false,
    power: false,
};
const WATCHDOG: ResetFlags = ResetFlags {
    watchdog: true,
    power: false,
};
const POWER: ResetFlags = ResetFlags {
    watchdog: false,
    power: true,
};

fn reasons() -> impl Strategy<Value = Reason> {
    let fault = any::<[u32; 5]>().prop_map(|[pc, lr, cfsr, hfsr, address]| {
        Reason::HardFault(HardFault {
            pc,
            lr,
            cfsr,
            hfsr,
            address,
        })
    });
    let panic =
        (".{0,40}", any::<u32>()).prop_map(|(path, line)| Reason::Panic(Place::new(&path, line)));
    let late = any::<u32>().prop_map(|tick| Reason::LateTicks { tick });
    prop_oneof![
        fault,
        panic,
        late,
        Just(Reason::Watchdog),
        Just(Reason::StackOverflow)
    ]
}

fn records() -> impl Strategy<Value = Record> {
    let parts = (proptest::option::of(reasons()), any::<u32>());
    parts.prop_map(|(reason, resets)| Record { reason, resets })
}

proptest! {
    #[test]
    fn a_record_comes_back(record in records()) {
        prop_assert_eq!(Record::from_words(&record.words()), Some(record));
    }

    #[test]
    fn garbage_is_no_reason(words in any::<[u32; WORDS]>()) {
        prop_assert_eq!(Record::from_words(&words), None);
        prop_assert_eq!(Record::after_reset(&words, NONE), Record::default());
    }

    #[test]
    fn a_record_with_one_bit_other_is_none(record in records(), bit in 0..WORDS * 32) {
        let mut words = record.words();
        words[bit / 32] ^= 1 << (bit % 32);
        prop_assert_eq!(Record::from_words(&words), None);
    }

    /// A write of a record over another that was cut after some words.
    #[test]
    fn half_a_record_is_none(old in records(), new in records(), written in 1..WORDS) {
        let (old, new) = (old.words(), new.words());
        let mut words = old;
        words[..written].copy_from_slice(&new[..written]);
        prop_assume!(words != old && words != new);
        prop_assert_eq!(Record::from_words(&words), None);
    }
}

#[test]
fn memory_of_all_one_value_is_no_record() {
    for value in [0, u32::MAX, 0xa5a5_a5a5, 0x5afe_1ead] {
        assert_eq!(Record::from_words(&[value; WORDS]), None);
    }
}

#[test]
fn resets_are_counted_until_the_power_goes() {
    let mut ram = [0xdead_beef; WORDS];
    let first = Record::after_reset(&ram, POWER);
    assert_eq!(first, Record::default());
    ram = first.at_start().words();
    // Nobody's fault: a reset by the debugger.
    assert_eq!(Record::after_reset(&ram, NONE), Record::default());

    let reason = Reason::Panic(Place::new("src/axis/mod.rs", 99));
    ram = first.with(reason).words();
    let second = Record::after_reset(&ram, NONE);
    assert_eq!((second.reason, second.resets), (Some(reason), 1));

    ram = second.at_start().words();
    let third = Record::after_reset(&ram, WATCHDOG);
    assert_eq!((third.reason, third.resets), (Some(Reason::Watchdog), 2));

    ram = third.at_start().with(reason).words();
    assert_eq!(Record::after_reset(&ram, POWER), Record::default());
}

#[test]
fn a_panic_that_the_watchdog_ended_is_told_as_the_panic() {
    let reason = Reason::HardFault(HardFault::default());
    let ram = Record::default().with(reason).words();
    assert_eq!(Record::after_reset(&ram, WATCHDOG).reason, Some(reason));
}

#[test]
fn late_ticks_are_the_reason_only_where_the_watchdog_bit() {
    let reason = Reason::LateTicks { tick: 12 };
    let ram = Record::default().with(reason).words();
    assert_eq!(Record::after_reset(&ram, WATCHDOG).reason, Some(reason));
    assert_eq!(Record::after_reset(&ram, NONE), Record::default());
}
