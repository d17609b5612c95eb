//! Gain and offset.

use leadscrew_hal_mock::machine::MachineParams;
use leadscrew_hal_mock::scenario::MoveAndBack;

use crate::runs::watch;

#[test]
fn a_tachogenerator_of_another_scale_is_learned() {
    // Rest tells the offset from the gain.
    let scenario = MoveAndBack {
        dwell_s: 0.8,
        ..MoveAndBack::standard(1000.0)
    };
    for (gain, offset) in [(1.12, 0.4), (0.87, -0.6), (1.0, 0.0)] {
        let machine = MachineParams::z_16k20f3();
        let wired = |_: usize, v: f64| gain * v + offset;
        let watched = watch(&machine, &scenario, "exponential", 1, wired);
        assert_eq!(watched.first(), None, "{gain} {offset}");
        let found: f64 = watched.check.gain().to_num();
        // The last ticks that it learns from are slow ones, in deceleration.
        assert!((found / gain - 1.0).abs() < 0.006, "{found} {gain}");
        let found: f64 = watched.check.offset().to_num();
        assert!((found - offset).abs() < 0.1, "{found} {offset}");
    }
}

#[test]
fn what_was_learned_is_what_is_held_against_it() {
    // A scale that would do at the start comes too late.
    let scenario = MoveAndBack::standard(1000.0);
    let machine = MachineParams::z_16k20f3();
    let wired = |tick: usize, v: f64| if tick < 1800 { v } else { 1.1 * v };
    let watched = watch(&machine, &scenario, "exponential", 1, wired);
    assert!((1800..1830).contains(&watched.first().expect("it is seen")));
    // One that creeps away by 0.02 % a tick passes twice the tolerance and the floor 315 ticks later; from there the
    // 100 d take 82 ticks.
    let wired = |tick: usize, v: f64| v * (1.0 + 2e-4 * (tick.max(1800) - 1800) as f64);
    let watched = watch(&machine, &scenario, "exponential", 1, wired);
    let first = watched.first().expect("it is seen");
    assert!((2115..2230).contains(&first), "{first}");
}

#[test]
fn a_restart_forgets_all_but_the_totals() {
    let scenario = MoveAndBack::standard(1000.0);
    let machine = MachineParams::z_16k20f3();
    let mut check = watch(&machine, &scenario, "exponential", 1, |_, _| 0.0).check;
    assert!(check.disagreement().is_some());
    check.restart();
    assert_eq!(check.disagreement(), None);
    assert_eq!(check.health().disagreements, 1);
    assert!(!check.is_learned() && check.gain() == 1 && check.offset() == 0);
}
