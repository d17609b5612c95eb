//! Lines and arcs under corrections, against brute force: the truly corrected path is sampled finely and compared with what would
//! be written.

#[path = "support/cases.rs"]
mod cases;
#[path = "support/random_terms.rs"]
mod random_terms;

use cases::cases;
use leadscrew_nc::coordinates::{Axis, Coordinates};
use leadscrew_nc::path::arc::{self, Arc, Piece, Plane};
use leadscrew_nc::path::{Tolerance, line};
use leadscrew_nc::terms::screw::ScrewMap;
use leadscrew_nc::terms::{Approach, Circumstances, Direction, Terms};
use proptest::prelude::*;
use random_terms::{place, terms};

const TOLERANCE: Tolerance = Tolerance {
    mm: 0.001,
    degrees: 0.001,
};
/// Rounding of the sums here.
const ROUNDING: f64 = 1e-6;

fn standing() -> Circumstances {
    let approach = Axis::ALL
        .into_iter()
        .fold(Approach::UNKNOWN, |approach, axis| {
            approach.with(axis, Direction::Up)
        });
    Circumstances {
        tool: Some(1),
        tool_offset: Some(Coordinates::xyz(0.0, 0.0, 80.0)),
        approach,
    }
}

/// Largest share of the tolerance by which the lines between corrected places are off the true path, from the first place on.
fn off_line(
    from: &Coordinates,
    places: &[Coordinates],
    started_with: Coordinates,
    terms: &Terms,
    with: &Circumstances,
) -> f64 {
    let mut worst = 0.0_f64;
    let (mut start, mut start_k) = (*from, started_with);
    for end in places {
        let end_k = terms.correction(end, with).unwrap();
        if end != from {
            for i in 0..=200 {
                let t = f64::from(i) / 200.0;
                let at = start.towards(end, t);
                let truly = at + terms.correction(&at, with).unwrap();
                let written = (start + start_k).towards(&(*end + end_k), t);
                worst = worst.max(TOLERANCE.share(&(truly - written)));
            }
        }
        (start, start_k) = (*end, end_k);
    }
    worst
}

proptest! {
    #![proptest_config(cases(60, 10))]

    #[test]
    fn lines_stay_within_the_tolerance_everywhere(
        terms in terms(), from in place(), to in place(),
    ) {
        let before = standing();
        let started_with = terms.correction(&from, &before).unwrap();
        let with = Circumstances {
            approach: before.approach.after(&(to - from)),
            ..before
        };
        let places = line::split(&from, &to, &started_with, &terms, &with, &TOLERANCE).unwrap();
        prop_assert_eq!(places.last(), Some(&to));
        let worst = off_line(&from, &places, started_with, &terms, &with);
        prop_assert!(worst <= 1.0 + ROUNDING, "{worst} in {} pieces", places.len());
    }

    #[test]
    fn arcs_stay_within_the_tolerance_everywhere(
        terms in terms(),
        centre in (-60.0..60.0_f64, -60.0..60.0_f64),
        radius in 0.5..60.0_f64,
        start in 0.0..6.2_f64,
        turned in 0.05..6.2_f64,
        clockwise: bool,
        full: bool,
        plane in prop_oneof![Just(Plane::Xy), Just(Plane::Zx), Just(Plane::Yz)],
        climb in -20.0..20.0_f64,
    ) {
        let [first, second] = plane.axes();
        let on = |angle: f64, across: f64| {
            Coordinates::ZERO
                .with(first, centre.0 + radius * angle.cos())
                .with(second, centre.1 + radius * angle.sin())
                .with(plane.across(), across)
        };
        let from = on(start, 5.0);
        let mut to = on(start + if clockwise { -turned } else { turned }, 5.0 + climb);
        if full {
            to = from.with(plane.across(), 5.0 + climb);
        }
        let centre = [centre.0, centre.1];
        let arc = Arc::from_centre(plane, from, to, centre, clockwise, 1, 1e-6).unwrap();
        let before = standing();
        let started_with = terms.correction(&from, &before).unwrap();
        let pieces = arc::corrected(&arc, &started_with, &terms, &before, &TOLERANCE).unwrap();
        let worst = off_arc(&arc, &pieces, started_with, &terms, &before);
        prop_assert!(worst <= 1.0 + ROUNDING, "{worst} in {} pieces", pieces.len());
        prop_assert!(pieces.len() < 400, "{} pieces", pieces.len());
    }
}

/// Largest share of the tolerance by which what is written is off the true path of an arc.
fn off_arc(
    arc: &Arc,
    pieces: &[Piece],
    started_with: Coordinates,
    terms: &Terms,
    before: &Circumstances,
) -> f64 {
    let mut worst = 0.0_f64;
    let mut start = arc.from + started_with;
    let mut start_fraction = 0.0;
    for piece in pieces {
        let piece = match piece {
            Piece::Line { corrected, .. } => {
                start = *corrected;
                continue;
            }
            Piece::Arc(piece) => piece,
        };
        let end_fraction = fraction_of(arc, &piece.to, start_fraction);
        let middle = f64::midpoint(start_fraction, end_fraction);
        let with = Circumstances {
            approach: arc.approach(middle, before.approach),
            ..*before
        };
        // What a control makes of the words of the piece.
        let written = Arc::from_centre(
            arc.plane,
            start,
            piece.corrected,
            piece.centre,
            piece.sweep < 0.0,
            1 + (piece.sweep.abs() / std::f64::consts::TAU - 1e-9).floor() as u32,
            1e-6,
        )
        .unwrap();
        assert!(
            (written.sweep - piece.sweep).abs() < 1e-6,
            "{written:?} {piece:?}"
        );
        for i in 0..=120 {
            let t = f64::from(i) / 120.0;
            let at = arc.at(start_fraction + t * (end_fraction - start_fraction));
            let truly = at + terms.correction(&at, &with).unwrap();
            worst = worst.max(nearest(&written, &truly, t));
        }
        start = piece.corrected;
        start_fraction = end_fraction;
    }
    assert_eq!(start_fraction, 1.0, "the pieces go to the end");
    worst
}

/// Share of the tolerance by which a place is off a curve near a fraction of its way.
fn nearest(curve: &Arc, place: &Coordinates, near: f64) -> f64 {
    let off = |t: f64| TOLERANCE.share(&(curve.at(t) - *place));
    let (mut low, mut high) = ((near - 0.05).max(0.0), (near + 0.05).min(1.0));
    for _ in 0..30 {
        let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
        if off(a) < off(b) {
            high = b;
        } else {
            low = a;
        }
    }
    off(low).min(off(high)).min(off(near))
}

/// Where on the arc a place is, searched from a fraction on.
fn fraction_of(arc: &Arc, place: &Coordinates, from: f64) -> f64 {
    if *place == arc.to {
        // The end of a full circle is its start.
        return 1.0;
    }
    let steps = 1 << 11;
    let off = |t: f64| (arc.at(t) - *place).length_mm();
    let start = (0..=steps)
        .map(|i| from + (1.0 - from) * f64::from(i) / f64::from(steps))
        .min_by(|a, b| off(*a).total_cmp(&off(*b)))
        .unwrap();
    let step = 1.0 / f64::from(steps);
    let (mut low, mut high) = ((start - step).max(from), (start + step).min(1.0));
    for _ in 0..100 {
        let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
        if off(a) < off(b) {
            high = b;
        } else {
            low = a;
        }
    }
    f64::midpoint(low, high)
}

#[test]
fn a_line_is_split_no_oftener_than_a_bent_screw_map_asks_for() {
    let error = |at: f64| 0.010 * (at / 100.0).powi(2);
    let points: Vec<_> = (0..=100)
        .map(|i| f64::from(i) * 3.0)
        .map(|at| (at, error(at), error(at)))
        .collect();
    let terms = Terms::none().with(ScrewMap::new("screw X", Axis::X, &points).unwrap());
    let (from, to) = (Coordinates::ZERO, Coordinates::xyz(300.0, 50.0, 0.0));
    let with = standing();
    let k = terms.correction(&from, &with).unwrap();
    let places = line::split(&from, &to, &k, &terms, &with, &TOLERANCE).unwrap();
    // The parabola of 90 µm over 300 mm is 22.5 µm from its chord; with n pieces 1/n² of it: at least 5 for 1 µm.
    assert!((5..=7).contains(&places.len()), "{places:?}");
    assert!(off_line(&from, &places, k, &terms, &with) <= 1.0);
    let wide = Tolerance {
        mm: 0.03,
        ..TOLERANCE
    };
    assert_eq!(
        line::split(&from, &to, &k, &terms, &with, &wide).unwrap(),
        [to]
    );
}

#[test]
fn a_reversal_is_taken_up_before_the_movement() {
    let points = [(0.0, 0.0, 0.02), (100.0, 0.0, 0.02)];
    let terms = Terms::none().with(ScrewMap::new("screw X", Axis::X, &points).unwrap());
    let (from, to) = (
        Coordinates::xyz(50.0, 0.0, 0.0),
        Coordinates::xyz(10.0, 0.0, 0.0),
    );
    let up = standing();
    let k = terms.correction(&from, &up).unwrap();
    let down = Circumstances {
        approach: up.approach.after(&(to - from)),
        ..up
    };
    let split = |with| line::split(&from, &to, &k, &terms, with, &TOLERANCE).unwrap();
    assert_eq!(split(&down), [from, to]);
    assert_eq!(split(&up), [to]);
}

#[test]
fn an_arc_stays_one_where_the_correction_allows_it_and_is_untouched_by_none() {
    let from = Coordinates::xyz(30.0, 0.0, 0.0);
    let to = Coordinates::xyz(0.0, 30.0, 0.0);
    let arc = Arc::from_centre(Plane::Xy, from, to, [0.0, 0.0], false, 1, 1e-3).unwrap();
    let none = Coordinates::ZERO;
    let pieces = arc::corrected(&arc, &none, &Terms::none(), &standing(), &TOLERANCE).unwrap();
    let [Piece::Arc(piece)] = pieces[..] else {
        panic!("{pieces:?}")
    };
    assert_eq!(
        (piece.corrected, piece.centre, piece.radius),
        (to, [0.0, 0.0], 30.0)
    );

    let points = [(-100.0, 0.0, 0.0), (100.0, 0.02, 0.02)];
    let terms = Terms::none().with(ScrewMap::new("screw X", Axis::X, &points).unwrap());
    let k = terms.correction(&from, &standing()).unwrap();
    let wide = Tolerance {
        mm: 0.002,
        ..TOLERANCE
    };
    let count = |tolerance| {
        arc::corrected(&arc, &k, &terms, &standing(), &tolerance)
            .unwrap()
            .len()
    };
    // A stretch of 1e-4 makes an ellipse, 3 µm longer than wide at radius 30.
    assert_eq!(count(wide), 1);
    let fine = Tolerance {
        mm: 0.0001,
        ..TOLERANCE
    };
    assert!((2..=4).contains(&count(fine)), "{}", count(fine));
}

#[test]
fn an_arc_is_split_where_a_directional_axis_turns_round() {
    let from = Coordinates::xyz(30.0, 0.0, 0.0);
    let arc = Arc::from_centre(Plane::Xy, from, from, [0.0, 0.0], false, 1, 1e-3).unwrap();
    let points = [(-100.0, 0.0, 0.02), (100.0, 0.0, 0.02)];
    let terms = Terms::none().with(ScrewMap::new("screw Y", Axis::Y, &points).unwrap());
    let pieces = arc::corrected(&arc, &Coordinates::ZERO, &terms, &standing(), &TOLERANCE).unwrap();
    let lines = pieces
        .iter()
        .filter(|piece| matches!(piece, Piece::Line { .. }))
        .count();
    assert_eq!((lines, pieces.len()), (2, 5), "{pieces:#?}");
}

#[test]
fn a_table_that_does_not_reach_is_told_of() {
    let points = [(0.0, 0.0, 0.0), (100.0, 0.02, 0.02)];
    let terms = Terms::none().with(ScrewMap::new("screw X", Axis::X, &points).unwrap());
    let (from, to) = (Coordinates::ZERO, Coordinates::xyz(120.0, 0.0, 0.0));
    let error = line::split(&from, &to, &from, &terms, &standing(), &TOLERANCE).unwrap_err();
    let message = error.to_string();
    assert!(
        message.contains("X = 120.0000 mm") && message.contains("\"screw X\""),
        "{message}"
    );
}
