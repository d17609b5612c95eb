//! The software decoder on walks of a simulated shaft.

use leadscrew::quadrature::{Decoder, Step};
use proptest::prelude::*;

#[path = "support/seeded.rs"]
mod seeded;
use seeded::seeded;

/// Levels of A and B on a shaft at a whole position: A is high over positions 1 and 2 of the cycle
/// of four, B over 2 and 3, so that A leads when the shaft turns forward.
fn levels(position: i64) -> (bool, bool) {
    let place = position.rem_euclid(4);
    (matches!(place, 1 | 2), matches!(place, 2 | 3))
}

fn decoder_at(position: i64) -> Decoder {
    let (a, b) = levels(position);
    Decoder::new(a, b)
}

fn see(decoder: &mut Decoder, position: i64) -> Step {
    let (a, b) = levels(position);
    decoder.step(a, b)
}

proptest! {
    #![proptest_config(seeded(256))]

    #[test]
    fn any_walk_of_the_shaft_decodes_to_its_position(
        start in any::<i32>(),
        steps in prop::collection::vec(-1..=1_i64, 0..500),
    ) {
        let mut position = i64::from(start);
        let mut decoder = decoder_at(position);
        let mut count = position;
        for step in steps {
            position += step;
            count += i64::from(see(&mut decoder, position).counts());
            prop_assert_eq!(count, position);
        }
    }

    #[test]
    fn a_missed_sample_is_illegal_exactly_there_and_costs_two_counts(
        before in prop::collection::vec(-1..=1_i64, 0..100),
        missed in prop::sample::select(vec![-2, 2_i64]),
        after in prop::collection::vec(-1..=1_i64, 0..100),
    ) {
        let (mut position, mut count) = (0, 0);
        let mut decoder = decoder_at(position);
        let miss_at = before.len();
        for (place, step) in before.into_iter().chain([missed]).chain(after).enumerate() {
            position += step;
            let seen = see(&mut decoder, position);
            prop_assert_eq!(seen == Step::Illegal, place == miss_at);
            count += i64::from(seen.counts());
            // The direction of a double step is unknown, so the count stays behind by it from there on.
            prop_assert_eq!(count, position - if place >= miss_at { missed } else { 0 });
        }
    }

    #[test]
    fn exchanging_the_channels_turns_the_direction_round(steps in prop::collection::vec(-2..=2_i64, 0..100)) {
        let mut position = 0;
        let mut decoder = decoder_at(position);
        let (a, b) = levels(position);
        let mut exchanged = Decoder::new(b, a);
        for step in steps {
            position += step;
            let (a, b) = levels(position);
            prop_assert_eq!(exchanged.step(b, a).counts(), -decoder.step(a, b).counts());
        }
    }
}
