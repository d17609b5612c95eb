//! Sums over edges are the sums of the edges.

use leadscrew::encoder_map::Direction::{self, Backward, Forward};
use leadscrew::encoder_map::{EncoderMap, Form, MAX_SUM};
use proptest::prelude::*;

use crate::content::{Errors, errors};
use crate::seeded::seeded;

fn form() -> impl Strategy<Value = Form> {
    prop::sample::select(vec![Form::Full, Form::Coarse, Form::Phases])
}

fn direction() -> impl Strategy<Value = Direction> {
    prop::sample::select(vec![Forward, Backward])
}

proptest! {
    #![proptest_config(seeded(256))]

    #[test]
    fn a_sum_is_that_of_its_edges(
        errors in errors(),
        form in form(),
        direction in direction(),
        first in any::<u32>(),
        count in 0..=MAX_SUM,
    ) {
        let image = errors.encode(form);
        let map = EncoderMap::from_bytes(&image).unwrap();
        let first = first % map.edges();
        let edge = |ahead: u32| map.error((first + ahead) % map.edges(), direction);
        let edges: i64 = (0..count).map(|ahead| i64::from(edge(ahead))).sum();
        // An edge is rounded to a quarter of its exact units: off by half and by an eighth on average.
        let off = i64::from(map.sum(first, count, direction)) - edges;
        prop_assert!(off.abs() <= i64::from(count) / 2 + 1, "{} of {}", off, count);
        if count == 1 {
            prop_assert_eq!(off, 0);
        }
    }

    #[test]
    fn sums_over_neighbouring_parts_add_up(
        errors in errors(),
        form in form(),
        direction in direction(),
        first in any::<u32>(),
        count in 0..=MAX_SUM,
        part in 0..=MAX_SUM,
    ) {
        let image = errors.encode(form);
        let map = EncoderMap::from_bytes(&image).unwrap();
        let first = first % map.edges();
        let part = part.min(count);
        let before = map.sum(first, part, direction);
        let after = map.sum((first + part) % map.edges(), count - part, direction);
        // Each of the three is rounded once.
        prop_assert!((map.sum(first, count, direction) - before - after).abs() <= 1);
    }

    #[test]
    fn a_sum_of_phases_is_that_of_its_boundaries(
        errors in errors(),
        direction in direction(),
        first in any::<u32>(),
        count in 0..=MAX_SUM,
    ) {
        let image = errors.encode(Form::Phases);
        let map = EncoderMap::from_bytes(&image).unwrap();
        let edges = (0..count).map(|ahead| map.phase_error(first.wrapping_add(ahead), direction));
        prop_assert_eq!(map.phase_sum(first, count, direction), edges.sum::<i32>());
    }
}

#[test]
fn the_largest_errors_fit_the_largest_sum() {
    const D: i32 = 65_536;
    for sign in [-1, 1] {
        // Edge 0 lies among 40 right ones, so that all the rest is at the limit of the base, 8 d off; then the
        // phases at theirs.
        let errors = Errors {
            edges: (0..8192)
                .map(|edge| if (40..8152).contains(&edge) { sign * (8 * D - 16) } else { 0 } + sign * 2 * D)
                .collect(),
            phases: [[sign * (2 * D - 4); 4]; 2],
            fronts: [None; 2],
        };
        let image = errors.encode(Form::Coarse);
        let map = EncoderMap::from_bytes(&image).unwrap();
        let sum = i64::from(map.sum(3000, MAX_SUM, Forward));
        let edge = i64::from(map.error(3000, Forward));
        assert!((edge - i64::from(sign * 10 * D)).abs() < 100, "{edge}");
        assert!((sum - edge * i64::from(MAX_SUM)).abs() <= i64::from(MAX_SUM));
    }
}
