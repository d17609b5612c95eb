//! Figures worked by hand.

use leadscrew_process::metrology::bore::Diameters;
use leadscrew_process::metrology::passes::{Cut, passes};
use leadscrew_process::metrology::relations::{self, Placed, TableTurn, Uncertain, pivot_offset};
use leadscrew_process::metrology::tool;
use leadscrew_process::metrology::{Axis, Nominal, Settings, Touch, bore, circle, plane};

use crate::support::{assert_all_near, assert_near};

fn touch(nominal: [f64; 3], axis: Axis, side: f64, deviation: f64) -> Touch {
    let normal = axis.unit().map(|part| part * side);
    Touch::off_by(nominal, normal, deviation * side)
}

/// A hole along y, 40 mm, by deviations of its + and − wall along z, then along x.
fn hole(nominal: &Nominal, d: [f64; 4]) -> Vec<Touch> {
    let radius = nominal.diameter_mm / 2.0;
    let [x, y, z] = nominal.centre_mm;
    vec![
        touch([x, y, z + radius], Axis::Z, -1.0, d[0]),
        touch([x, y, z - radius], Axis::Z, 1.0, d[1]),
        touch([x + radius, y, z], Axis::X, -1.0, d[2]),
        touch([x - radius, y, z], Axis::X, 1.0, d[3]),
    ]
}

fn settings() -> Settings {
    Settings {
        first_order: true,
        ..Settings::default()
    }
}

#[test]
fn a_plane_by_hand() {
    // Points (0, 0), (100, 0), (0, 50): 10, 30 and −15 µm. At the origin 10 µm; 20 µm over 100 mm along x, −25 µm over 50 along y.
    let touches = [
        touch([0.0, 0.0, 0.0], Axis::Z, 1.0, 0.010).with_sigma(0.001),
        touch([100.0, 0.0, 0.0], Axis::Z, 1.0, 0.030).with_sigma(0.001),
        touch([0.0, 50.0, 0.0], Axis::Z, 1.0, -0.015).with_sigma(0.001),
    ];
    let fitted = plane::fit(&touches, &settings()).unwrap();
    assert_near(fitted.value.offset_mm, 0.010, 1e-14);
    assert_all_near(fitted.value.rotation, [-5e-4, -2e-4, 0.0], 1e-17);
    // The touch at the origin alone tells the offset; each slope is a difference of two.
    let sigma = fitted.sigma.unwrap();
    assert_near(sigma.offset_mm, 0.001, 1e-14);
    assert_all_near(
        sigma.rotation,
        [
            2_f64.sqrt() * 0.001 / 50.0,
            2_f64.sqrt() * 0.001 / 100.0,
            0.0,
        ],
        1e-17,
    );
    assert_eq!(fitted.quality.freedom, 0);
}

#[test]
fn a_hole_by_hand() {
    // Along z +12 and −4 µm: centre +4, diameter +16 µm. Along x +7 and +1: centre +4, diameter +6 µm. Ovality 10 µm.
    let nominal = Nominal::straight(Axis::Y, [0.0; 3], 40.0);
    let touches: Vec<Touch> = hole(&nominal, [0.012, -0.004, 0.007, 0.001])
        .into_iter()
        .map(|touch| touch.with_sigma(0.001))
        .collect();
    let fitted = circle::fit(&nominal, &touches, &settings()).unwrap();
    assert_all_near(fitted.value.centre_mm, [0.004, 0.0, 0.004], 1e-14);
    assert_near(fitted.value.diameter_mm, 0.011, 1e-14);
    assert_near(fitted.value.ovality_mm.unwrap(), 0.010, 1e-14);
    // Residuals ±2.5 µm with one degree of freedom: 5 µm is not explained by 1 µm.
    assert_near(fitted.quality.over_stated.unwrap(), 5.0, 1e-9);
    assert_near(fitted.value.form_mm.unwrap(), 0.005, 1e-14);
    let sigma = fitted.sigma.unwrap();
    assert_near(sigma.ovality_mm.unwrap(), 0.002, 1e-14);
}

#[test]
fn a_touch_left_out_is_held_against_what_the_others_foretell() {
    let settings = Settings {
        without_outliers: true,
        ..Settings::default()
    };
    let touched = [10.0, 10.001, 9.999, 10.0, 10.1];
    let fitted = tool::setting(&touched, 0.0, Some(0.001), &settings).unwrap();
    assert_eq!(fitted.quality.outliers(), [4]);
    assert_near(fitted.value, 10.0, 1e-12);
    // 0.1 mm against σ² of the touch and σ²/4 of the mean of the other four.
    let standardised = fitted.quality.residuals[4].standardised.unwrap();
    assert_near(standardised, 100.0 / 1.25_f64.sqrt(), 1e-9);
    assert_near(fitted.quality.peak_to_valley_mm(), 0.002, 1e-12);
    // One that counts has less than its own: σ²·(1 − ¼).
    let counted = fitted.quality.residuals[1].standardised.unwrap();
    assert_near(counted, 1.0 / 0.75_f64.sqrt(), 1e-9);
}

#[test]
fn repeated_touches_are_no_ovality() {
    // Every wall is met twice, 3 µm apart: both means of two diameters are the same, and so are those along x with 4 µm more.
    let nominal = Nominal::straight(Axis::Y, [0.0; 3], 40.0);
    let twice = |along_x: f64| -> Vec<Touch> {
        let once = hole(&nominal, [0.003, 0.0, along_x, 0.0]);
        let again = hole(&nominal, [0.0, 0.0, along_x + 0.003, 0.0]);
        let touches = once.into_iter().chain(again);
        touches.map(|touch| touch.with_sigma(0.002)).collect()
    };
    let fit = |along_x| circle::fit(&nominal, &twice(along_x), &settings()).unwrap();
    assert_near(fit(0.0).value.ovality_mm.unwrap(), 0.0, 1e-14);
    let oval = fit(0.004);
    assert_near(oval.value.ovality_mm.unwrap(), 0.004, 1e-14);
    // A mean of two diameters of two touches each has the variance of one touch.
    let sigma = oval.sigma.unwrap().ovality_mm.unwrap();
    assert_near(sigma, 2_f64.sqrt() * 0.002, 1e-14);
    let pairs = circle::diameters(&nominal, &twice(0.0)).unwrap();
    let pairs: Vec<[usize; 2]> = pairs.iter().map(|pair| pair.touches).collect();
    assert_eq!(pairs, [[0, 1], [2, 3], [4, 5], [6, 7]]);
    // One direction alone, met twice, has two diameters and no ovality.
    let along_z: Vec<Touch> = twice(0.0)
        .into_iter()
        .filter(|touch| touch.normal[2] != 0.0)
        .collect();
    let fitted = circle::fit(&nominal, &along_z, &settings()).unwrap();
    assert_eq!(fitted.value.ovality_mm, None);
}

#[test]
fn perpendicularity_is_the_axis_less_the_face() {
    // The axis moves by 30 µm in x over 100 mm of z: β = +3e-4. The face falls by 10 µm over 100 mm of x: β = −∂z/∂x = +1e-4.
    let nominal = Nominal::straight(Axis::Z, [0.0; 3], 40.0);
    let section = |z: f64, off: f64| {
        [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)].map(|(x, y)| {
            let place = [20.0 * x, 20.0 * y, z];
            Touch::at(place, [-x, -y, 0.0], [place[0] + off, place[1], z])
        })
    };
    let touches = [section(0.0, 0.0), section(100.0, 0.03)].concat();
    let axis = bore::fit(&nominal, &touches, Diameters::OfSections, &settings()).unwrap();
    assert_all_near(axis.value.rotation, [0.0, 3e-4, 0.0], 1e-12);
    let face = [
        touch([0.0, 0.0, 0.0], Axis::Z, 1.0, 0.0),
        touch([100.0, 0.0, 0.0], Axis::Z, 1.0, -0.01),
        touch([0.0, 100.0, 0.0], Axis::Z, 1.0, 0.0),
    ];
    let face = plane::fit(&face, &settings()).unwrap();
    assert_all_near(face.value.rotation, [0.0, 1e-4, 0.0], 1e-15);
    let square = relations::perpendicularity((&nominal, &axis), &face).unwrap();
    assert_all_near(square.value, [0.0, 2e-4, 0.0], 1e-12);
}

#[test]
fn coaxiality_by_hand() {
    // Holes at y = 0 and y = −120 (the far side), hole II measured after a turn about z around (0, −60).
    let first = Nominal::straight(Axis::Y, [30.0, 0.0, 5.0], 40.0);
    let after = Nominal::straight(Axis::Y, [-30.0, 0.0, 5.0], 40.0);
    let turn = TableTurn {
        about: Axis::Z,
        pivot_mm: [0.0, -60.0, 0.0],
        pivot_offset_mm: [0.010, 0.0, 0.0],
        pivot_sigma_mm: [0.001, 0.0, 0.0],
    };
    assert_eq!(turn.turned(after.centre_mm), [30.0, -120.0, 5.0]);
    // Hole I at x +6, z +3 µm. Hole II seen at x +26, z −5 µm: on the workpiece x = 2·10 − 26 = −6 µm.
    let near: Vec<Touch> = hole(&first, [0.003, 0.003, 0.006, 0.006])
        .into_iter()
        .map(|touch| touch.with_sigma(0.002))
        .collect();
    let far: Vec<Touch> = hole(&after, [-0.005, -0.005, 0.026, 0.026])
        .into_iter()
        .map(|touch| touch.with_sigma(0.002))
        .collect();
    let near = circle::fit(&first, &near, &settings()).unwrap();
    let far = circle::fit(&after, &far, &settings()).unwrap();
    let coaxial = relations::coaxiality(
        Placed {
            nominal: &first,
            circle: &near,
        },
        Placed {
            nominal: &after,
            circle: &far,
        },
        Some(&turn),
    )
    .unwrap();
    assert_all_near(coaxial.value.offset_mm, [0.012, 0.0, 0.008], 1e-14);
    assert_near(coaxial.value.eccentricity_mm, 0.012_f64.hypot(0.008), 1e-14);
    // γ = (x_I − x_II)/(y_II − y_I) = 12 µm / −120 mm, λ = (z_II − z_I)/(y_II − y_I) = −8 µm / −120 mm.
    assert_all_near(coaxial.value.rotation, [8e-3 / 120.0, 0.0, -1e-4], 1e-14);
    // Centres 2/√2 µm each; the pivot's 1 µm enters twice, along x.
    let sigma = coaxial.sigma.unwrap();
    assert_near(
        sigma.offset_mm[0],
        (2.0 + 2.0 + 4.0_f64).sqrt() * 1e-3,
        1e-14,
    );
    assert_near(sigma.offset_mm[2], 2e-3, 1e-14);
    // Hole I seen before and after gives the pivot.
    assert_eq!(
        pivot_offset([0.006, 0.0, 0.003], [0.014, 0.0, 0.003], Axis::Z)[0],
        0.010
    );
}

#[test]
fn a_distance_by_hand() {
    // 30 and 40 mm apart; the second centre 6 µm off along x, 8 along z: 10 µm along the line.
    let first = Nominal::straight(Axis::Y, [0.0; 3], 20.0);
    let second = Nominal::straight(Axis::Y, [30.0, 0.0, 40.0], 20.0);
    let a = circle::fit(&first, &hole(&first, [0.0; 4]), &settings()).unwrap();
    let b = circle::fit(
        &second,
        &hole(&second, [0.008, 0.008, 0.006, 0.006]),
        &settings(),
    )
    .unwrap();
    let distance = relations::distance(
        Placed {
            nominal: &first,
            circle: &a,
        },
        Placed {
            nominal: &second,
            circle: &b,
        },
    )
    .unwrap();
    assert_near(distance.value.measured_mm, 50.010, 1e-12);
    assert_near(distance.value.deviation_mm, 0.010, 1e-12);
}

#[test]
fn an_axis_by_hand() {
    // Sections at y −10 and −60; centres x +5 and +15 µm, z 0 and −20 µm: −0.2 µm/mm along x, +0.4 along z.
    let nominal = Nominal::straight(Axis::Y, [0.0; 3], 40.0);
    let at = |y| Nominal {
        centre_mm: [0.0, y, 0.0],
        ..nominal
    };
    let mut touches = hole(&at(-10.0), [0.0, 0.0, 0.005, 0.005]);
    touches.extend(hole(&at(-60.0), [-0.020, -0.020, 0.015, 0.015]));
    let fitted = bore::fit(&nominal, &touches, Diameters::OfSections, &settings()).unwrap();
    assert_all_near(fitted.value.offset_mm, [0.003, 0.0, 0.004], 1e-14);
    assert_all_near(fitted.value.rotation, [4e-4, 0.0, 2e-4], 1e-16);
    assert_eq!(
        fitted
            .value
            .sections
            .iter()
            .map(|section| section[0])
            .collect::<Vec<_>>(),
        [-60.0, -10.0]
    );
}

#[test]
fn tool_setting_and_wear_by_hand() {
    let settings = Settings::default();
    let setting = |touched: &[f64], sigma| {
        let fitted = tool::setting(touched, 50.0, sigma, &settings).unwrap();
        Uncertain {
            value: fitted.value,
            sigma: fitted.sigma,
        }
    };
    let then = setting(&[170.000, 170.004], Some(0.002));
    assert_near(then.value, 120.002, 1e-12);
    assert_near(then.sigma.unwrap(), 0.002 / 2_f64.sqrt(), 1e-14);
    let now = setting(&[169.985], Some(0.002));
    let wear = tool::wear(now, then);
    assert_near(wear.value, -0.017, 1e-12);
    assert_near(wear.sigma.unwrap(), 0.002 * 1.5_f64.sqrt(), 1e-14);
    assert_eq!(setting(&[170.0], None).sigma, None);
    let tip = tool::tip_by_diameter(Uncertain {
        value: 0.036,
        sigma: Some(0.004),
    });
    assert_eq!((tip.value, tip.sigma), (0.018, Some(0.002)));
}

#[test]
fn passes_by_hand() {
    let cut = Cut {
        blank_mm: 30.0,
        finished_mm: 25.0,
        max_depth_mm: 2.0,
        finishing_mm: 0.5,
    };
    let depths = |cut: &Cut| -> Vec<(f64, f64)> {
        passes(cut)
            .unwrap()
            .iter()
            .map(|pass| (pass.depth_mm, pass.size_mm))
            .collect()
    };
    // 4.5 mm in three passes of 1.5, then 0.5.
    assert_eq!(
        depths(&cut),
        [(1.5, 28.5), (1.5, 27.0), (1.5, 25.5), (0.5, 25.0)]
    );
    // Inside: the blank is smaller.
    let inside = Cut {
        blank_mm: 20.0,
        finished_mm: 22.5,
        ..cut
    };
    assert_eq!(depths(&inside), [(2.0, 22.0), (0.5, 22.5)]);
    // Less stock than the finishing pass takes, and none.
    assert_eq!(
        depths(&Cut {
            blank_mm: 25.25,
            ..cut
        }),
        [(0.25, 25.0)]
    );
    assert_eq!(
        depths(&Cut {
            blank_mm: 25.0,
            ..cut
        }),
        []
    );
    // Whole passes, though not in binary numbers.
    assert_eq!(
        depths(&Cut {
            blank_mm: 25.9,
            finishing_mm: 0.0,
            max_depth_mm: 0.3,
            ..cut
        })
        .len(),
        3
    );
    let error = passes(&Cut {
        max_depth_mm: 0.0,
        ..cut
    })
    .unwrap_err()
    .to_string();
    assert_eq!(error, "max_depth_mm = 0 mm: expected more than 0");
    assert!(
        passes(&Cut {
            finishing_mm: 3.0,
            ..cut
        })
        .is_err()
    );
    assert!(
        passes(&Cut {
            blank_mm: f64::NAN,
            ..cut
        })
        .is_err()
    );
    assert!(
        passes(&Cut {
            max_depth_mm: 1e-9,
            ..cut
        })
        .is_err()
    );
}
