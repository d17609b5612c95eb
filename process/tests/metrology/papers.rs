//! The papers' minimal formulas come out as the special case.

use leadscrew_process::metrology::bore::Diameters;
use leadscrew_process::metrology::{Axis, Nominal, Settings, Touch, bore, circle, plane, shoulder};
use proptest::prelude::*;

use crate::oracle;
use crate::support::assert_near;

/// A touch by its deviation along an axis; `side` is where the surface looks.
fn touch(nominal: [f64; 3], axis: Axis, side: f64, deviation: f64) -> Touch {
    let normal = axis.unit().map(|part| part * side);
    Touch::off_by(nominal, normal, deviation * side)
}

const FIRST_ORDER: Settings = Settings {
    level: 0.01,
    without_outliers: false,
    first_order: true,
};

fn deviation() -> impl Strategy<Value = f64> {
    -0.05..0.05
}

/// Four touches of a hole along y, in P4's order: 1, 2 along z on the + and − wall, 3, 4 along x.
fn hole_touches(nominal: &Nominal, y: f64, d: [f64; 4]) -> Vec<Touch> {
    let radius = nominal.diameter_mm / 2.0;
    let [x0, _, z0] = nominal.centre_mm;
    vec![
        touch([x0, y, z0 + radius], Axis::Z, -1.0, d[0]),
        touch([x0, y, z0 - radius], Axis::Z, 1.0, d[1]),
        touch([x0 + radius, y, z0], Axis::X, -1.0, d[2]),
        touch([x0 - radius, y, z0], Axis::X, 1.0, d[3]),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn a_plane_of_three_points_is_p4_1(
        places in prop::array::uniform3(prop::array::uniform2(-200.0..200.0)),
        dz in prop::array::uniform3(deviation()),
        up in any::<bool>(),
    ) {
        let [[x1, y1], [x2, y2], [x3, y3]] = places;
        let area = (x2 - x1) * (y3 - y1) - (x3 - x1) * (y2 - y1);
        prop_assume!(f64::abs(area) > 500.0);
        let side = if up { 1.0 } else { -1.0 };
        let touches: Vec<Touch> = (0..3)
            .map(|index| {
                let [x, y] = places[index];
                touch([x, y, 40.0], Axis::Z, side, dz[index])
            })
            .collect();
        let [offset, by_x, by_y] = oracle::plane(places, dz);
        let fitted = plane::fit(&touches, &Settings::default()).unwrap().value;
        assert_near(fitted.offset_mm, offset, 1e-11);
        let [lambda, beta, gamma] = fitted.rotation;
        assert_near(lambda, by_y, 1e-13);
        assert_near(beta, -by_x, 1e-13);
        assert_near(gamma, 0.0, 0.0);
    }

    #[test]
    fn a_shoulder_of_two_points_is_the_papers(
        x4 in -200.0..-1.0, x5 in 1.0..200.0,
        dy in prop::array::uniform2(deviation()),
    ) {
        let touches = [touch([x4, 10.0, 5.0], Axis::Y, 1.0, dy[0]), touch([x5, 10.0, 5.0], Axis::Y, 1.0, dy[1])];
        let [offset, turn] = oracle::shoulder([x4, x5], dy);
        let fitted = shoulder::fit(&touches, Axis::X, &Settings::default()).unwrap().value;
        assert_near(fitted.offset_mm, offset, 1e-12);
        assert_near(fitted.turn, turn, 1e-14);
        assert_eq!(fitted.about, Axis::Z);
    }

    #[test]
    fn a_hole_in_one_and_two_directions_is_p4_2(d in prop::array::uniform4(deviation())) {
        let nominal = Nominal::straight(Axis::Y, [12.0, 0.0, -7.0], 40.0);
        let touches = hole_touches(&nominal, 3.0, d);
        let [z, d_z] = oracle::hole(d[0], d[1]);
        let [x, d_x] = oracle::hole(d[2], d[3]);
        let one = circle::fit(&nominal, &touches[..2], &Settings::default()).unwrap().value;
        assert_near(one.centre_mm[2], z, 1e-13);
        assert_near(one.diameter_mm, d_z, 1e-13);
        assert_eq!(one.seen, [false, false, true]);
        let both = circle::fit(&nominal, &touches, &FIRST_ORDER).unwrap().value;
        assert_near(both.centre_mm[0], x, 1e-13);
        assert_near(both.centre_mm[2], z, 1e-13);
        assert_near(both.diameter_mm, (d_x + d_z) / 2.0, 1e-13);
        assert_near(both.ovality_mm.unwrap(), (d_x - d_z).abs(), 1e-13);
        // Exactly: off by what the first order drops.
        let exact = circle::fit(&nominal, &touches, &Settings::default()).unwrap().value;
        let dropped = 2.0 * 0.1 * 0.1 / nominal.diameter_mm;
        assert_near(exact.centre_mm[0], x, dropped);
        assert_near(exact.diameter_mm, both.diameter_mm, dropped);
        let diameters = circle::diameters(&nominal, &touches).unwrap();
        assert_near(diameters[0].deviation_mm, d_z, 1e-13);
        assert_near(diameters[1].deviation_mm, d_x, 1e-13);
    }

    #[test]
    fn an_axis_of_two_sections_is_the_papers(
        y1 in -80.0..-5.0, y2 in 5.0..80.0,
        near in prop::array::uniform4(deviation()), far in prop::array::uniform4(deviation()),
    ) {
        let nominal = Nominal::straight(Axis::Y, [3.0, 0.0, 4.0], 60.0);
        let mut touches = hole_touches(&nominal, y1, near);
        touches.extend(hole_touches(&nominal, y2, far));
        let mean = |d: [f64; 4], at: usize| (d[at] + d[at + 1]) / 2.0;
        let [z, by_z] = oracle::axis([y1, y2], [mean(near, 0), mean(far, 0)]);
        let [x, by_x] = oracle::axis([y1, y2], [mean(near, 2), mean(far, 2)]);
        let fitted = bore::fit(&nominal, &touches, Diameters::OfSections, &FIRST_ORDER).unwrap().value;
        assert_near(fitted.offset_mm[0], x, 1e-12);
        assert_near(fitted.offset_mm[2], z, 1e-12);
        let [lambda, beta, gamma] = fitted.rotation;
        assert_near(lambda, by_z, 1e-14);
        assert_near(gamma, -by_x, 1e-14);
        assert_near(beta, 0.0, 0.0);
    }
}
