//! `leadscrew sim`: what cannot be asked for.

use crate::{Folder, assert_says};
use leadscrew::estimator::EstimatorConfig;

#[test]
fn tick_rates_out_of_range_name_the_range() {
    let folder = Folder::new();
    for rate in ["0", "1e9", "-1000", "nan", "inf", "99.9", "40000.1"] {
        let message = folder.refused(2, &format!("sim --tick-hz {rate} --csv x.csv"));
        assert_says(&message, &["--tick-hz", "100 to 40000 Hz"]);
    }
    let message = folder.refused(2, "sim --tick-hz fast");
    assert_says(&message, &["fast", "--tick-hz"]);
}

#[test]
fn tick_rates_at_the_ends_of_the_range() {
    let folder = Folder::new();
    folder.printed("sim --move-mm 1 --tick-hz 40000");
    // 10 m/s³ are more than a tick of 10 ms can carry: the shortest rate is this machine's, 137 Hz.
    let message = folder.refused(2, "sim --move-mm 1 --tick-hz 100");
    assert_says(
        &message,
        &["--tick-hz 100", "max_jerk_d_per_tick3 = 10 is out of range"],
    );
    folder.printed("sim --move-mm 1 --tick-hz 137");
}

#[test]
fn feeds_that_the_machine_cannot_run_name_the_option() {
    let folder = Folder::new();
    for feed in ["0", "-9000", "nan", "inf", "1e9"] {
        let message = folder.refused(2, &format!("sim --feed {feed} --json --csv x.csv"));
        assert_says(&message, &["--feed", "out of range: allowed"]);
    }
    // 95 % of 9 600 mm/min.
    let message = folder.refused(2, "sim --feed 9120.1");
    assert_says(
        &message,
        &["--feed 9120.1", "9120 (95 %", "9600 mm/min at full command"],
    );
    folder.printed("sim --move-mm 5 --feed 9120");
    // Slower than a velocity can be told: 1e-4 d/tick.
    let message = folder.refused(2, "sim --move-mm 0.0001 --feed 1e-3");
    assert_says(&message, &["--feed 0.001", "d_per_tick", "allowed 0.0001"]);
}

#[test]
fn moves_that_are_too_long_say_what_to_do() {
    let folder = Folder::new();
    for distance in ["1e9", "-1e9", "nan", "inf"] {
        let message = folder.refused(2, &format!("sim --move-mm {distance} --plot x.png"));
        assert_says(&message, &["--move-mm", "-1000000 to 1000000 mm"]);
    }
    // A day and a half, and a run whose number of ticks passes 32 bits.
    for long in [
        "--move-mm 1e6",
        "--move-mm -1000 --feed 0.028",
        "--move-mm 1e6 --feed 1e-6",
    ] {
        let message = folder.refused(2, &format!("sim {long}"));
        assert_says(
            &message,
            &[
                "ticks",
                "shorten --move-mm, raise --feed or lower --tick-hz",
            ],
        );
    }
}

#[test]
fn machines_and_estimators_that_do_not_exist_list_those_that_do() {
    let folder = Folder::new();
    let message = folder.refused(2, "sim --machine 16k20f4");
    assert_says(
        &message,
        &["--machine 16k20f4", "16k20f3, 16k20f3-bare", "FILE.toml"],
    );
    let message = folder.refused(2, "sim --estimator gausian");
    assert_says(&message, &["gausian", &EstimatorConfig::NAMES.join(", ")]);
}

#[test]
fn a_seed_is_a_whole_number() {
    let folder = Folder::new();
    for seed in ["-1", "1.5", "18446744073709551616"] {
        let message = folder.refused(2, &format!("sim --seed {seed}"));
        assert_says(&message, &[seed, "--seed"]);
    }
}

#[test]
fn a_dump_goes_with_no_results() {
    let folder = Folder::new();
    for other in ["--json", "--csv x.csv", "--plot x.svg"] {
        folder.refused(2, &format!("sim --dump-machine {other}"));
    }
}
