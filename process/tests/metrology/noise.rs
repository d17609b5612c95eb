//! Noise: the stated 1σ is what the results really scatter by, and bad touches are found.

use leadscrew_process::metrology::bore::Diameters;
use leadscrew_process::metrology::relations::{self, Placed};
use leadscrew_process::metrology::setting;
use leadscrew_process::metrology::{
    Axis, Fitted, Nominal, Settings, SigmaFrom, Touch, bore, circle, plane, shoulder,
};

use crate::support::{Noise, STILL, around, face, touch_cylinder, touch_plane, v};

const SIGMA_MM: f64 = 0.002;
const RUNS: usize = 1200;

fn disturbed(touches: &[Touch], noise: &mut Noise, sigma_of: impl Fn(usize) -> f64) -> Vec<Touch> {
    let disturb = |(index, touch): (usize, &Touch)| {
        let off = v(touch.normal) * noise.normal() * sigma_of(index);
        Touch {
            measured: (v(touch.measured) + off).into(),
            ..*touch
        }
    };
    touches.iter().enumerate().map(disturb).collect()
}

/// Rms error over rms stated 1σ, of every value that the function gives as (error, 1σ).
fn assert_honest(touches: &[Touch], states: bool, values: impl Fn(&[Touch]) -> Vec<(f64, f64)>) {
    let mut noise = Noise::new(7);
    let mut sums: Vec<(f64, f64)> = Vec::new();
    // Touches of two qualities: the weights matter.
    let sigma_of = |index: usize| {
        if states && index % 2 == 1 {
            3.0 * SIGMA_MM
        } else {
            SIGMA_MM
        }
    };
    for _ in 0..RUNS {
        let mut touches = disturbed(touches, &mut noise, sigma_of);
        if states {
            for (index, touch) in touches.iter_mut().enumerate() {
                *touch = touch.with_sigma(sigma_of(index));
            }
        }
        let values = values(&touches);
        sums.resize(values.len(), (0.0, 0.0));
        for (sum, (error, sigma)) in sums.iter_mut().zip(values) {
            sum.0 += error * error;
            sum.1 += sigma * sigma;
        }
    }
    for (index, (errors, sigmas)) in sums.into_iter().enumerate() {
        let ratio = (errors / sigmas).sqrt();
        assert!(
            (0.9..=1.1).contains(&ratio),
            "value {index}: rms error {ratio:.3} times the stated 1σ"
        );
    }
}

fn flat(grid: usize) -> Vec<Touch> {
    let touch = |(at, normal)| touch_plane(&STILL, at, normal);
    face(Axis::Z, 10.0, 100.0, grid)
        .into_iter()
        .map(touch)
        .collect()
}

fn round(nominal: &Nominal, heights: &[f64], count: usize) -> Vec<Touch> {
    let places = heights
        .iter()
        .flat_map(|&height| around(count).map(move |angle| (height, angle)));
    places
        .map(|place| touch_cylinder(&STILL, nominal, place, true, 0.0))
        .collect()
}

fn pairs(values: &[f64], sigmas: &[f64]) -> Vec<(f64, f64)> {
    values
        .iter()
        .copied()
        .zip(sigmas.iter().copied())
        .filter(|(_, sigma)| *sigma > 0.0)
        .collect()
}

fn settings() -> Settings {
    Settings::default()
}

#[test]
fn the_1_sigma_of_a_plane_is_honest() {
    for states in [true, false] {
        assert_honest(&flat(4), states, |touches| {
            let fitted = plane::fit(touches, &settings()).unwrap();
            let (value, sigma) = (fitted.value, fitted.sigma.unwrap());
            let mut all = pairs(&value.rotation, &sigma.rotation);
            all.push((value.offset_mm, sigma.offset_mm));
            all
        });
    }
}

#[test]
fn the_1_sigma_of_a_shoulder_is_honest() {
    let touches: Vec<Touch> = (0..5)
        .map(|index| {
            touch_plane(
                &STILL,
                [f64::from(index) * 20.0 - 15.0, 5.0, 0.0],
                Axis::Y.unit(),
            )
        })
        .collect();
    assert_honest(&touches, true, |touches| {
        let fitted = shoulder::fit(touches, Axis::X, &settings()).unwrap();
        let (value, sigma) = (fitted.value, fitted.sigma.unwrap());
        vec![(value.offset_mm, sigma.offset_mm), (value.turn, sigma.turn)]
    });
}

#[test]
fn the_1_sigma_of_a_circle_is_honest() {
    let nominal = Nominal::straight(Axis::Z, [5.0, 6.0, 0.0], 40.0);
    for (count, states) in [(4, true), (7, true), (8, false)] {
        assert_honest(&round(&nominal, &[0.0], count), states, |touches| {
            let fitted = circle::fit(&nominal, touches, &settings()).unwrap();
            let (value, sigma) = (fitted.value, fitted.sigma.unwrap());
            let mut all = pairs(&value.centre_mm, &sigma.centre_mm);
            all.push((value.diameter_mm, sigma.diameter_mm));
            all
        });
    }
}

#[test]
fn the_1_sigma_of_an_axis_and_of_perpendicularity_is_honest() {
    let nominal = Nominal::straight(Axis::Z, [0.0; 3], 40.0);
    let faces = flat(3);
    let count = faces.len();
    let mut touches = faces;
    touches.extend(round(&nominal, &[10.0, 50.0, 70.0], 5));
    assert_honest(&touches, true, |touches| {
        let face = plane::fit(&touches[..count], &settings()).unwrap();
        let bore = bore::fit(
            &nominal,
            &touches[count..],
            Diameters::OfSections,
            &settings(),
        )
        .unwrap();
        let square = relations::perpendicularity((&nominal, &bore), &face).unwrap();
        let mut all = pairs(&square.value, &square.sigma.unwrap());
        let sigma = bore.sigma.unwrap();
        all.extend(pairs(&bore.value.offset_mm, &sigma.offset_mm));
        all.extend(pairs(&bore.value.rotation, &sigma.rotation));
        all.push((bore.value.sections[1][1], sigma.sections[1][1]));
        all
    });
}

#[test]
fn the_1_sigma_of_distance_and_coaxiality_is_honest() {
    let first = Nominal::straight(Axis::Z, [0.0; 3], 40.0);
    let second = Nominal::straight(Axis::Z, [60.0, 30.0, 0.0], 40.0);
    let third = Nominal::straight(Axis::Z, [0.0, 0.0, 80.0], 30.0);
    let mut touches = round(&first, &[0.0], 4);
    touches.extend(round(&second, &[0.0], 4));
    touches.extend(round(&third, &[0.0], 4));
    assert_honest(&touches, true, |touches| {
        let circles = [&first, &second, &third].map(|nominal| {
            let at = if nominal == &first {
                0
            } else if nominal == &second {
                4
            } else {
                8
            };
            (
                nominal,
                circle::fit(nominal, &touches[at..at + 4], &settings()).unwrap(),
            )
        });
        let placed = |index: usize| Placed {
            nominal: circles[index].0,
            circle: &circles[index].1,
        };
        let distance = relations::distance(placed(0), placed(1)).unwrap();
        let coaxial = relations::coaxiality(placed(0), placed(2), None).unwrap();
        let sigma = coaxial.sigma.unwrap();
        let mut all = vec![(
            distance.value.deviation_mm,
            distance.sigma.unwrap().deviation_mm,
        )];
        all.extend(pairs(&coaxial.value.offset_mm, &sigma.offset_mm));
        all.extend(pairs(&coaxial.value.rotation, &sigma.rotation));
        all
    });
}

#[test]
fn the_1_sigma_of_ovality_is_honest_at_an_oval_hole() {
    let nominal = Nominal::straight(Axis::Z, [0.0; 3], 40.0);
    for (count, turned) in [(4, 0.0_f64), (12, 0.0), (12, 0.4)] {
        let mut touches = round(&nominal, &[0.0], count);
        for (touch, angle) in touches.iter_mut().zip(around(count)) {
            let swing = 0.05 * (2.0 * (angle - turned)).cos();
            touch.measured = (v(touch.measured) - v(touch.normal) * swing).into();
        }
        if turned != 0.0 {
            // A part of the round is not reached: cosine and sine of the swing then hang together.
            touches.truncate(9);
        }
        assert_honest(&touches, true, |touches| {
            let fitted = circle::fit(&nominal, touches, &settings()).unwrap();
            vec![(
                fitted.value.ovality_mm.unwrap() - 0.2,
                fitted.sigma.unwrap().ovality_mm.unwrap(),
            )]
        });
    }
}

#[test]
fn the_1_sigma_of_a_setting_and_of_turning_is_honest() {
    let touches: Vec<Touch> = Axis::ALL
        .into_iter()
        .flat_map(|normal| face(normal, 20.0, 100.0, 2))
        .map(|(at, normal)| touch_plane(&STILL, at, normal))
        .collect();
    assert_honest(&touches, true, |touches| {
        let fitted = setting::fit(touches, [true; 6], &settings()).unwrap();
        let (value, sigma) = (fitted.value, fitted.sigma.unwrap());
        pairs(&value.to_array(), &sigma.to_array())
    });
    let nominal = Nominal::straight(Axis::Z, [0.0; 3], 40.0);
    let touches = round(&nominal, &[-10.0, -40.0, -80.0], 2);
    assert_honest(&touches, true, |touches| {
        let fitted = bore::fit_turned(&nominal, touches, &settings()).unwrap();
        let (value, sigma) = (fitted.value, fitted.sigma.unwrap());
        let mut all = vec![(value.taper.unwrap(), sigma.taper.unwrap())];
        all.push((value.sections[0][1], sigma.sections[0][1]));
        all.extend(pairs(&value.offset_mm, &sigma.offset_mm));
        all
    });
}

/// Flags of many planes with these touches off by so many 1σ: how often exactly those are flagged.
fn found(grid: usize, bad: &[(usize, f64)], states: bool) -> f64 {
    let mut noise = Noise::new(11);
    let good = flat(grid);
    let expected: Vec<usize> = bad.iter().map(|(index, _)| *index).collect();
    let runs = 500;
    let mut count = 0;
    for _ in 0..runs {
        let mut touches = disturbed(&good, &mut noise, |_| SIGMA_MM);
        for &(index, size) in bad {
            touches[index].measured[2] += size * SIGMA_MM;
        }
        if states {
            touches
                .iter_mut()
                .for_each(|touch| *touch = touch.with_sigma(SIGMA_MM));
        }
        let fitted: Fitted<_> = plane::fit(&touches, &settings()).unwrap();
        if fitted.quality.outliers() == expected {
            count += 1;
        }
    }
    f64::from(count) / f64::from(runs)
}

#[test]
fn bad_touches_are_flagged_and_good_ones_are_not() {
    for states in [true, false] {
        assert!(
            found(4, &[], states) > 0.98,
            "flagged without need: {}",
            1.0 - found(4, &[], states)
        );
        assert!(
            found(5, &[(7, 12.0)], states) > 0.97,
            "{}",
            found(5, &[(7, 12.0)], states)
        );
        let two = [(3, 15.0), (17, -15.0)];
        assert!(found(5, &two, states) > 0.95, "{}", found(5, &two, states));
        let beside = [(11, 15.0), (12, 15.0)];
        assert!(
            found(5, &beside, states) > 0.95,
            "{}",
            found(5, &beside, states)
        );
    }
}

#[test]
fn a_flagged_touch_counts_until_it_is_left_out() {
    let mut noise = Noise::new(3);
    let mut touches = disturbed(&flat(4), &mut noise, |_| SIGMA_MM);
    touches
        .iter_mut()
        .for_each(|touch| *touch = touch.with_sigma(SIGMA_MM));
    touches[5].measured[2] += 0.2;
    let with = plane::fit(&touches, &settings()).unwrap();
    assert_eq!(with.quality.outliers(), [5]);
    assert!(with.value.offset_mm > 0.01);
    assert_eq!(
        with.quality.sigma_from,
        Some(SigmaFrom::Residuals),
        "the residuals contradict 2 µm"
    );
    assert!(with.quality.over_stated.unwrap() > 10.0);
    let left_out = Settings {
        without_outliers: true,
        ..settings()
    };
    let without = plane::fit(&touches, &left_out).unwrap();
    assert_eq!(without.quality.outliers(), [5]);
    assert_eq!(without.quality.residuals.len(), 16);
    assert!((without.quality.residuals[5].mm - 0.2).abs() < 0.01);
    assert_eq!(without.quality.sigma_from, Some(SigmaFrom::Stated));
    assert!(without.value.offset_mm.abs() < 0.005);
}
