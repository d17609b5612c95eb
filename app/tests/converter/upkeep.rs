//! A converter that fails at start or later, and comes back or does not.

use leadscrew::units::Command;
use leadscrew_app::converter::{TRIES, Trouble, Upkeep, ZERO};

use crate::chip::Chip;
use crate::command;

const TICK_HZ: f64 = 1000.0;

/// An axis whose drive is off.
struct Axis {
    chip: Chip,
    upkeep: Upkeep,
}

impl Axis {
    fn started(harm: impl FnOnce(&mut Chip)) -> Self {
        let mut chip = Chip::default();
        chip.is_held_in_reset = true;
        harm(&mut chip);
        let mut upkeep = Upkeep::start(&mut chip, true, || {});
        upkeep.pace(TICK_HZ);
        Self { chip, upkeep }
    }

    /// Ticks with the drive off; whether the converter was well in the last one.
    fn wait(&mut self, ticks: u32) -> bool {
        for _ in 0..ticks {
            let before = self.chip.words;
            let put = self.upkeep.put(&mut self.chip, Command::ZERO, true, false);
            assert_eq!(put.trouble.is_none(), put.readback == Command::ZERO);
            assert!(self.chip.words - before <= 3, "a tick has no time for more");
            assert_eq!(self.chip.volts(), 0.0);
        }
        self.upkeep.trouble().is_none()
    }

    /// Times in so many ticks that the converter was let out of its reset.
    fn tries_in(&mut self, ticks: u32) -> u32 {
        let mut tries = 0;
        for _ in 0..ticks {
            let was_held = self.chip.is_held_in_reset;
            self.wait(1);
            tries += u32::from(was_held && !self.chip.is_held_in_reset);
        }
        tries
    }
}

#[test]
fn one_that_is_well_is_put_out_from_the_first_tick_on() {
    let mut axis = Axis::started(|_| {});
    assert!(axis.wait(1));
    let put = axis.upkeep.put(&mut axis.chip, command(0.5), false, false);
    assert_eq!((put.trouble, put.readback), (None, command(0.5)));
    assert_eq!(axis.chip.volts(), 5.0);
}

#[test]
fn one_that_failed_at_start_is_held_in_reset_and_tried_some_times() {
    let mut axis = Axis::started(|chip| chip.is_dead = true);
    assert!(axis.chip.is_held_in_reset);
    assert_eq!(axis.upkeep.trouble(), Some(Trouble::Silent));
    assert_eq!(axis.tries_in(60_000), u32::from(TRIES));
    assert!(axis.chip.is_held_in_reset, "0 V for good");
    axis.chip.is_dead = false;
    assert!(!axis.wait(10_000), "it was given up");
}

#[test]
fn one_whose_supply_came_late_comes_up_by_itself_and_shows_nothing_but_0_v() {
    let mut axis = Axis::started(|chip| chip.is_dead = true);
    assert!(!axis.wait(2_500));
    axis.chip.is_dead = false;
    assert!(axis.wait(1_100), "the third try");
    assert!(axis.chip.seen_out.iter().all(|code| *code == ZERO));
    let put = axis
        .upkeep
        .put(&mut axis.chip, command(-0.25), false, false);
    assert_eq!((put.trouble, axis.chip.volts()), (None, -2.5));
}

#[test]
fn one_that_falls_is_told_while_on_and_set_up_anew_only_once_off() {
    let mut axis = Axis::started(|_| {});
    axis.chip.brown_out();
    for _ in 0..3_000 {
        let put = axis.upkeep.put(&mut axis.chip, command(0.1), false, false);
        assert!(!axis.chip.is_held_in_reset);
        assert_eq!(put.trouble.is_some(), put.readback == command(-1.0));
    }
    assert_eq!(axis.upkeep.trouble(), Some(Trouble::BrownOut));
    assert!(axis.wait(1_100));
    assert_eq!(axis.chip.volts(), 0.0);
}

#[test]
fn enabling_ends_a_try_at_0_v() {
    for ticks in 1_000..1_020 {
        let mut axis = Axis::started(|chip| chip.is_dead = true);
        axis.chip.is_dead = false;
        if axis.wait(ticks) {
            assert!(ticks > 1_010, "three waits and seven steps");
            continue;
        }
        let put = axis.upkeep.put(&mut axis.chip, command(0.3), false, false);
        assert_eq!(put.readback, command(-1.0), "a mismatch");
        assert!(axis.chip.is_held_in_reset, "{ticks}");
    }
}

#[test]
fn who_was_well_for_a_second_is_tried_as_often_again() {
    let mut axis = Axis::started(|_| {});
    for _ in 0..2 {
        assert!(axis.wait(1_001));
        axis.chip.is_dead = true;
        assert_eq!(axis.tries_in(4_500), 4);
        axis.chip.is_dead = false;
        assert!(axis.wait(1_100), "the fifth");
    }
}
