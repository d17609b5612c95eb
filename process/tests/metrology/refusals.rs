//! What cannot be told is refused, with its reason.

use leadscrew_process::metrology::bore::Diameters;
use leadscrew_process::metrology::relations::{self, Placed};
use leadscrew_process::metrology::{
    Axis, MetrologyError, Nominal, Settings, Touch, bore, circle, plane, setting, shoulder,
};

use crate::support::{STILL, around, face, touch_cylinder};

fn up(x: f64, y: f64) -> Touch {
    Touch::off_by([x, y, 0.0], [0.0, 0.0, 1.0], 0.001)
}

#[track_caller]
fn assert_says<T: std::fmt::Debug>(result: Result<T, MetrologyError>, parts: &[&str]) {
    let message = result.unwrap_err().to_string();
    for part in parts {
        assert!(message.contains(part), "`{part}` is not in: {message}");
    }
}

#[test]
fn a_plane_needs_three_touches_off_one_line() {
    let settings = Settings::default();
    assert_says(
        plane::fit(&[], &settings),
        &["a plane needs 3 touches or more, found 0"],
    );
    assert_says(
        plane::fit(&[up(0.0, 0.0), up(1.0, 0.0)], &settings),
        &["needs 3 touches", "found 2"],
    );
    let line = [
        up(0.0, 10.0),
        up(10.0, 20.0),
        up(20.0, 30.0),
        up(50.0, 60.0),
    ];
    assert_says(
        plane::fit(&line, &settings),
        &[
            "a plane is not determined",
            "on one line",
            "condition number",
        ],
    );
    let mut nearly = line;
    nearly[3] = up(50.0, 60.00001);
    assert_says(plane::fit(&nearly, &settings), &["on one line"]);
    let two_faces = [
        up(0.0, 0.0),
        up(1.0, 0.0),
        Touch::off_by([0.0, 1.0, 0.0], [1.0, 0.0, 0.0], 0.0),
    ];
    assert_says(
        plane::fit(&two_faces, &settings),
        &["touch 3 of a plane", "another way"],
    );
}

#[test]
fn a_shoulder_needs_a_length() {
    let touches = [
        Touch::off_by([5.0, 0.0, 0.0], Axis::Y.unit(), 0.0),
        Touch::off_by([5.0, 0.0, 9.0], Axis::Y.unit(), 0.0),
    ];
    assert_says(
        shoulder::fit(&touches, Axis::X, &Settings::default()),
        &["a shoulder is not determined", "one place"],
    );
    assert_says(
        shoulder::fit(&touches, Axis::Y, &Settings::default()),
        &["shoulder"],
    );
}

#[test]
fn round_features_need_touches_around_them() {
    let settings = Settings::default();
    let nominal = Nominal::straight(Axis::Z, [0.0; 3], 40.0);
    let at = |height: f64, angle: f64| touch_cylinder(&STILL, &nominal, (height, angle), true, 0.0);
    let one_side = [at(0.0, 0.0), at(0.0, 0.0)];
    assert_says(
        circle::fit(&nominal, &one_side, &settings),
        &["a circle needs 2"],
    );
    let oblique = [at(0.0, 0.7), at(0.0, 0.7 + std::f64::consts::PI)];
    assert_says(
        circle::fit(&nominal, &oblique, &settings),
        &["along an axis"],
    );
    let two = [at(0.0, 0.0), at(0.0, 1.0)];
    assert_says(circle::fit(&nominal, &two, &settings), &["needs 3 touches"]);
    let near: Vec<Touch> = (0..5)
        .map(|index| at(0.0, f64::from(index) * 1e-4))
        .collect();
    assert_says(
        circle::fit(&nominal, &near, &settings),
        &["too near to one another"],
    );
    let sections = [at(0.0, 0.0), at(5.0, 2.0), at(0.0, 4.0)];
    assert_says(
        circle::fit(&nominal, &sections, &settings),
        &["several sections"],
    );
    let flat: Vec<Touch> = around(6).map(|angle| at(3.0, angle)).collect();
    assert_says(
        bore::fit(&nominal, &flat, Diameters::Cylinder, &settings),
        &["one section"],
    );
    let skew = Touch::off_by([20.0, 0.0, 0.0], [0.8, 0.6, 0.0], 0.0);
    assert_says(
        circle::fit(&nominal, &[skew, at(0.0, 2.0), at(0.0, 4.0)], &settings),
        &["along the radius"],
    );
    let on_axis = Touch::off_by([0.0, 0.0, 0.0], [1.0, 0.0, 0.0], 0.0);
    assert_says(
        circle::fit(&nominal, &[on_axis], &settings),
        &["on the axis"],
    );
}

#[test]
fn features_that_do_not_go_together_are_refused() {
    let settings = Settings::default();
    let nominal = Nominal::straight(Axis::Z, [0.0; 3], 40.0);
    let other = Nominal::straight(Axis::X, [0.0; 3], 40.0);
    let circle = |nominal: &Nominal, count| {
        let touches: Vec<Touch> = around(count)
            .map(|angle| touch_cylinder(&STILL, nominal, (0.0, angle), true, 0.0))
            .collect();
        circle::fit(nominal, &touches, &settings).unwrap()
    };
    let (a, b, half) = (circle(&nominal, 4), circle(&other, 4), circle(&nominal, 2));
    let placed = |nominal, circle| Placed { nominal, circle };
    assert_says(
        relations::distance(placed(&nominal, &a), placed(&other, &b)),
        &["not parallel"],
    );
    assert_says(
        relations::distance(placed(&nominal, &a), placed(&nominal, &half)),
        &["one direction only"],
    );
    assert_says(
        relations::coaxiality(placed(&nominal, &a), placed(&nominal, &a), None),
        &["one place along the axis"],
    );
}

#[test]
fn a_setting_names_what_its_touches_leave_open() {
    let touches: Vec<Touch> = face(Axis::Z, 0.0, 100.0, 3)
        .into_iter()
        .map(|(at, normal)| Touch::off_by(at, normal, 0.0))
        .collect();
    let settings = Settings::default();
    assert_says(
        setting::fit(&touches, [true; 6], &settings),
        &["a setting of the workpiece is not determined", "open"],
    );
    let free = [false, false, true, true, true, true];
    assert_says(setting::fit(&touches, free, &settings), &["leave γ open"]);
    assert!(setting::fit(&touches, [false, false, true, true, true, false], &settings).is_ok());
}

#[test]
fn numbers_that_are_none_are_refused() {
    let settings = Settings::default();
    let bad = Touch::off_by([0.0, f64::NAN, 0.0], [0.0, 0.0, 1.0], 0.0);
    assert_says(
        plane::fit(&[up(0.0, 0.0), up(1.0, 0.0), bad], &settings),
        &["touch 3"],
    );
    let mixed = [up(0.0, 0.0), up(1.0, 0.0), up(0.0, 1.0).with_sigma(0.001)];
    assert_says(plane::fit(&mixed, &settings), &["1 of 3 touches", "1σ"]);
    let none = [up(0.0, 0.0), up(1.0, 0.0), up(0.0, 1.0).with_sigma(0.0)];
    assert_says(plane::fit(&none, &settings), &["touch 3", "1σ"]);
    let level = Settings {
        level: 0.0,
        ..settings
    };
    assert_says(
        plane::fit(&[up(0.0, 0.0), up(1.0, 0.0), up(0.0, 1.0)], &level),
        &["level"],
    );
}
