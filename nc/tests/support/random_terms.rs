//! Random corrections of the size that machines need.

use leadscrew_nc::coordinates::{Axis, Coordinates};
use leadscrew_nc::terms::Terms;
use leadscrew_nc::terms::affine::Affine;
use leadscrew_nc::terms::grid::{Grid, GridAxis};
use leadscrew_nc::terms::screw::ScrewMap;
use leadscrew_nc::terms::thermal::{Grows, Thermal};
use leadscrew_nc::terms::workpiece::Workpiece;
use proptest::prelude::*;

/// Places that lie in all tables.
pub fn place() -> impl Strategy<Value = Coordinates> {
    let linear = -140.0..140.0_f64;
    (linear.clone(), linear.clone(), linear, -90.0..90.0_f64)
        .prop_map(|(x, y, z, b)| Coordinates::xyz(x, y, z).with(Axis::B, b))
}

fn rising(count: usize) -> impl Strategy<Value = Vec<f64>> {
    proptest::collection::vec(1.0..100.0_f64, count).prop_map(|steps| {
        let whole: f64 = steps.iter().sum();
        let mut at = 0.0;
        let mut places = vec![-150.0];
        places.extend(steps.iter().map(|step| {
            at += step;
            -150.0 + 300.0 * at / whole
        }));
        if let Some(last) = places.last_mut() {
            *last = 150.0;
        }
        places
    })
}

fn grid() -> impl Strategy<Value = Terms> {
    let over = prop_oneof![
        Just(vec![Axis::X]),
        Just(vec![Axis::X, Axis::Z]),
        Just(vec![Axis::Y, Axis::B]),
        Just(vec![Axis::X, Axis::Y, Axis::Z]),
    ];
    (over, rising(4), any::<u64>()).prop_flat_map(|(over, places, _)| {
        let nodes = places.len().pow(over.len() as u32);
        let over: Vec<_> = over
            .into_iter()
            .map(|axis| GridAxis {
                axis,
                places: places.clone(),
            })
            .collect();
        proptest::collection::vec(-0.03..0.03_f64, nodes * 3).prop_map(move |values| {
            let corrects = vec![Axis::X, Axis::Y, Axis::Z];
            Terms::none().with(Grid::new("volume", over.clone(), corrects, values).unwrap())
        })
    })
}

fn screws() -> impl Strategy<Value = Terms> {
    let errors = proptest::collection::vec((-0.02..0.02_f64, -0.01..0.01_f64), 9);
    (rising(8), errors, any::<bool>()).prop_map(|(places, errors, both)| {
        let points: Vec<_> = places
            .iter()
            .zip(&errors)
            .map(|(at, (up, lost))| (*at, *up, up + if both { 0.0 } else { *lost }))
            .collect();
        Terms::none()
            .with(ScrewMap::new("screw X", Axis::X, &points).unwrap())
            .with(ScrewMap::new("screw Z", Axis::Z, &points).unwrap())
    })
}

fn affine() -> impl Strategy<Value = Terms> {
    let small = -2e-4..2e-4_f64;
    (
        small.clone(),
        small.clone(),
        small,
        rising(3),
        -0.5..0.5_f64,
    )
        .prop_map(|(a, b, c, places, by)| {
            let points = [
                (places[0], a),
                (places[1], b),
                (places[2], c),
                (places[3], a),
            ];
            let affine = Affine::new(
                "geometry",
                Coordinates::xyz(by, a, b),
                Coordinates::xyz(by, 3.0, 0.0),
            )
            .with(Axis::Z, Axis::X, c)
            .with_function(Axis::X, Axis::Y, Axis::Z, &points)
            .unwrap();
            Terms::none().with(affine)
        })
}

fn rigid() -> impl Strategy<Value = Terms> {
    let angle = -0.003..0.003_f64;
    (
        [angle.clone(), angle.clone(), angle],
        -0.5..0.5_f64,
        -5.0..15.0_f64,
    )
        .prop_map(|(angles, shift, warmer)| {
            Terms::none()
                .with(Workpiece::new(
                    "setting",
                    [10.0, 20.0, -30.0],
                    [shift, 0.1, -shift],
                    angles,
                ))
                .with(Thermal::new(
                    "warm",
                    Axis::X,
                    Grows::Screw,
                    11.5e-6,
                    40.0,
                    warmer,
                ))
        })
}

/// One or several kinds of term.
pub fn terms() -> impl Strategy<Value = Terms> {
    let several = (grid(), screws(), affine()).prop_map(|(a, b, c)| {
        let mut all = a;
        all.append(b);
        all.append(c);
        all
    });
    prop_oneof![grid(), screws(), affine(), rigid(), several]
}
