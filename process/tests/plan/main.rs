//! `leadscrew plan` against the papers' numbers, and against brute force.

mod boards;
mod catalogue;
mod cycle;
mod papers;

use leadscrew_process::plan::{Catalogue, Kinematics, MachinePlan, Question};

/// The figures of a built-in machine at 1 kHz.
fn plan_of(machine: &str) -> MachinePlan {
    let catalogue = Catalogue::built_in().unwrap();
    Question::default()
        .machine(catalogue.machine(machine).unwrap())
        .unwrap()
}

/// An axis by overload in g.
fn axis_of(feed: f64, overload_g: f64, jerk: Option<f64>, counts_per_mm: f64) -> Kinematics {
    Kinematics::new(feed, 9.81 * overload_g, jerk, counts_per_mm).unwrap()
}

#[track_caller]
fn assert_near(value: f64, expected: f64, tolerance: f64) {
    assert!(
        (value - expected).abs() <= tolerance,
        "{value} is not {expected} ± {tolerance}"
    );
}
