//! The table: what it takes, what it refuses and how it says so, what lies between its points.

use leadscrew::compensation::table::{MAX_ERROR_D, MAX_SLOPE, MAX_SPACING_D};
use leadscrew::compensation::{
    CompensationParams, Heading, ScrewError, ScrewPoint, ScrewTable, TableError, TableRefused,
};
use leadscrew::units::Position;
use proptest::prelude::*;

use crate::motion::{at_origin, config, memory, point, settled, with_backlash};
use crate::seeded::seeded;

fn error_of(points: &[ScrewPoint]) -> TableError {
    ScrewTable::build(points, &mut memory()).unwrap_err()
}

#[test]
fn a_table_has_two_to_256_points() {
    let points: Vec<_> = (0..300)
        .map(|at| point(f64::from(at) * 1000.0, 0.0, 0.0))
        .collect();
    assert_eq!(error_of(&[]), TableError::Points { count: 0 });
    assert_eq!(error_of(&points[..1]), TableError::Points { count: 1 });
    assert_eq!(error_of(&points[..257]), TableError::Points { count: 257 });
    for count in [2, 256] {
        let mut memory = memory();
        let table = ScrewTable::build(&points[..count], &mut memory).unwrap();
        assert_eq!(table.points(), count);
    }
    let short = ScrewTable::build(&points[..9], &mut memory()[..7]).unwrap_err();
    assert_eq!(
        short,
        TableError::Memory {
            given: 7,
            needed: 8
        }
    );
}

#[test]
fn the_first_bad_point_is_named() {
    let good = [
        point(-500.0, 1.0, 0.0),
        point(0.0, 2.0, 1.0),
        point(700.0, 0.0, 0.0),
    ];
    let with = |at: usize, bad: ScrewPoint| {
        let mut points = good;
        points[at] = bad;
        error_of(&points)
    };
    assert_eq!(
        with(2, point(0.0, 0.0, 0.0)),
        TableError::Spacing {
            point: 2,
            spacing_d: 0.0
        }
    );
    assert_eq!(
        with(1, point(-600.0, 0.0, 0.0)),
        TableError::Spacing {
            point: 1,
            spacing_d: -100.0
        }
    );
    assert_eq!(
        with(1, point(0.0, 0.0, 51.0)),
        TableError::Slope {
            point: 1,
            slope: 0.102
        }
    );
    assert_eq!(
        with(0, point(-500.0, 0.0, -1000.5)),
        TableError::Error {
            point: 0,
            error_d: -1000.5
        }
    );
    let text = with(2, point(0.0, 0.0, 0.0)).to_string();
    assert!(
        text.contains("point 2") && text.contains("positions must grow"),
        "{text}"
    );
}

#[test]
fn a_table_that_the_axis_cannot_follow_is_refused_and_says_what_to_do() {
    let used = config(&with_backlash(0.0));
    let refusal = |points: &[ScrewPoint], config| {
        let mut memory = memory();
        let table = ScrewTable::build(points, &mut memory).unwrap();
        let mut compensation = leadscrew::compensation::Compensation::new(config);
        let refused = compensation.set_table(Some(table)).unwrap_err();
        assert!(compensation.table().is_none());
        refused
    };
    let fine = [point(0.0, 0.0, 0.0), point(1000.0, 1.0, 1.0)];
    let unused = config(&CompensationParams::default());
    assert_eq!(refusal(&fine, unused), TableRefused::NotUsed);
    let steep = [fine[0], point(1000.0, 5.0, 1.0)];
    let refused = refusal(&steep, used);
    assert!(matches!(refused, TableRefused::Steep { .. }), "{refused}");
    assert!(
        refused.to_string().contains("raise feed_share"),
        "{refused}"
    );
    let dense = [fine[0], point(100.0, 0.0, 0.0), point(2000.0, 0.0, 0.0)];
    let refused = refusal(&dense, used);
    assert!(matches!(refused, TableRefused::Short { .. }), "{refused}");
}

#[test]
fn the_compensation_is_the_negative_error_linear_between_points_and_held_outside() {
    let points = [
        point(-1000.0, 1.0, -1.0),
        point(1000.0, 2.0, 0.0),
        point(4000.0, -1.0, 1.0),
    ];
    let mut memory = memory();
    let table = ScrewTable::build(&points, &mut memory).unwrap();
    let mut compensation = at_origin(config(&with_backlash(0.0)), Some(table));
    settled(&mut compensation, -9500.0);
    for (place, forward) in [
        (-9000.0, -1.0),
        (-1000.0, -1.0),
        (0.0, -1.5),
        (1000.0, -2.0),
        (2500.0, -0.5),
        (9000.0, 1.0),
    ] {
        let amount = settled(&mut compensation, place);
        assert!((amount - forward).abs() < 1e-4, "{amount} at {place}");
        assert_eq!(compensation.heading(), Heading::Forward);
    }
    for (place, backward) in [(2500.0, -0.5), (0.0, 0.5), (-9000.0, 1.0)] {
        let amount = settled(&mut compensation, place);
        assert!((amount - backward).abs() < 1e-4, "{amount} at {place}");
        assert_eq!(compensation.heading(), Heading::Backward);
    }
}

#[test]
fn places_are_counted_from_the_origin() {
    let points = [point(0.0, 0.0, 0.0), point(2000.0, 2.0, 2.0)];
    let mut memory = memory();
    let table = ScrewTable::build(&points, &mut memory).unwrap();
    let mut compensation = at_origin(config(&with_backlash(0.0)), Some(table));
    compensation.set_origin(Some(Position::from_num(-5_000_000)));
    let amount = settled(&mut compensation, -5_000_000.0 + 500.0);
    assert!((amount + 0.5).abs() < 1e-4, "{amount}");
    // At the place 500 d of the machine with the encoder half a d before it.
    let reported = compensation.reported(Position::from_num(-4_999_500.5));
    assert!((reported.to_num::<f64>() - 500.0).abs() < 1e-4);
}

/// A number of any kind, mostly of a size that a table might hold.
fn position() -> impl Strategy<Value = Position> {
    prop_oneof![
        (-1e6..1e6).prop_map(Position::from_num::<f64>),
        any::<i64>().prop_map(Position::from_bits),
    ]
}

fn error() -> impl Strategy<Value = ScrewError> {
    prop_oneof![
        9 => (-20.0..20.0).prop_map(ScrewError::from_num::<f64>),
        1 => any::<i32>().prop_map(ScrewError::from_bits),
    ]
}

proptest! {
    #![proptest_config(seeded(300))]

    #[test]
    fn any_points_make_a_table_or_an_error_that_names_a_point_rightly(
        mut points in prop::collection::vec(
            (position(), error(), error())
                .prop_map(|(position, forward, backward)| ScrewPoint { position, error: [forward, backward] }),
            0..20,
        ),
        sorted: bool,
    ) {
        if sorted {
            points.sort_by_key(|point| point.position);
        }
        let spacing = |at: usize| -> f64 {
            points[at].position.to_num::<f64>() - points[at - 1].position.to_num::<f64>()
        };
        let wrong_error = |point: &ScrewPoint| {
            point.error.iter().any(|error| error.to_num::<f64>().abs() > MAX_ERROR_D)
        };
        match ScrewTable::build(&points, &mut memory()) {
            Ok(table) => {
                prop_assert_eq!(table.points(), points.len());
                for at in 1..points.len() {
                    prop_assert!((1.0 / 256.0..=MAX_SPACING_D).contains(&spacing(at)));
                }
                prop_assert!(!points.iter().any(wrong_error));
                prop_assert!(table.steepest().value <= MAX_SLOPE);
            }
            Err(TableError::Points { count }) => prop_assert!(!(2..=256).contains(&count)),
            Err(TableError::Memory { .. }) => prop_assert!(false, "there is memory for all"),
            Err(TableError::Spacing { point, spacing_d }) => {
                prop_assert_eq!(spacing_d, spacing(point));
                prop_assert!(!(1.0 / 256.0..=MAX_SPACING_D).contains(&spacing_d));
            }
            Err(TableError::Error { point, .. }) => prop_assert!(wrong_error(&points[point])),
            Err(TableError::Slope { point, slope }) => {
                prop_assert!(point > 0 && slope > MAX_SLOPE);
                prop_assert!(!points[..point].iter().any(wrong_error));
            }
        }
    }
}
