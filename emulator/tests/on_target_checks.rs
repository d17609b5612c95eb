//! The checks of the tests that run on the board (`boards/stm32f4/tests`), as far as they are pure.

#[path = "../../boards/stm32f4/tests/axis_board/spacing.rs"]
mod spacing;
#[path = "../../boards/stm32f4/tests/axis_board/spread.rs"]
mod spread;

use spacing::{Reversal, Spacing};
use spread::Spread;

#[test]
fn even_edges_are_even_over_ticks_and_over_the_wrap_of_the_time() {
    let mut spacing = Spacing::new(84);
    let start = u32::MAX - 200;
    let edges: Vec<u32> = (0..10).map(|edge| start.wrapping_add(84 * edge)).collect();
    spacing.take([&edges[..3], &edges[3..5]]);
    spacing.take([&[], &[]]);
    spacing.take([&edges[5..], &[]]);
    assert_eq!((spacing.edges, spacing.worst), (10, 0));
}

#[test]
fn an_edge_that_is_off_or_missing_is_told() {
    for (edges, worst) in [([0, 84, 170, 252], 2), ([0, 84, 168, 336], 84)] {
        let mut spacing = Spacing::new(84);
        spacing.take([&edges, &[]]);
        assert_eq!(spacing.worst, worst, "{edges:?}");
    }
}

#[test]
fn a_reversal_is_forward_then_back_with_a_tick_between_at_most() {
    let is_right = |moved: &[i32]| {
        let mut reversal = Reversal::new(10);
        moved.iter().for_each(|moved| reversal.take(*moved));
        reversal.is_right()
    };
    assert!(is_right(&[10, 11, 9, 3, -10, -9]));
    assert!(is_right(&[10, 10, -10]));
    for wrong in [
        &[10, 10, 10][..],
        &[10, 3, 2, -10],
        &[10, -10, 10],
        &[10, -10, 3, -10],
        &[10, 14, -10],
        &[10, 3],
    ] {
        assert!(!is_right(wrong), "{wrong:?}");
    }
}

#[test]
fn a_spread_has_least_most_and_mean() {
    let spread = Spread::new();
    assert_eq!((spread.count(), spread.mean()), (0, 0));
    for value in [640, 1280, 1920] {
        spread.note(value);
    }
    assert_eq!(spread.range(), (640, 1920));
    assert_eq!((spread.count(), spread.mean()), (3, 1280));
}
