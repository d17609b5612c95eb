//! `leadscrew sim`: what a run reports and writes.

use leadscrew::estimator::EstimatorConfig;

use crate::pictures::assert_picture;
use crate::table::{SHARED, Table};
use crate::{Folder, assert_says, keys, number};

/// A run of a few hundred ticks.
const SHORT: &str = "sim --move-mm 5";

const FURTHER: &str = "setpoint_d,setpoint_velocity_d_per_tick,setpoint_acceleration_d_per_tick2,\
                       following_error_d,command,true_position_d,true_velocity_d_per_tick,\
                       true_acceleration_d_per_tick2,carriage_d,tachogenerator_d_per_tick";

#[test]
fn the_text_says_what_ran_and_lines_up() {
    let printed = Folder::new().printed(SHORT);
    let first = "16k20f3: 5 mm at 9000 mm/min and back, 1000 Hz, exponential in the loop, seed 1\n";
    assert!(printed.starts_with(first), "{printed}");
    assert_says(
        &printed,
        &[
            "digest ",
            "following error, d: peak ",
            "rms errors over the move, ramps included, seed 1\n",
        ],
    );
    assert!(!printed.contains("warning"), "{printed}");
    let (_, table) = printed.split_once("\n\n").expect("a table");
    let widths: Vec<_> = table.lines().map(|line| line.chars().count()).collect();
    assert_eq!(widths.len(), 2 + EstimatorConfig::NAMES.len());
    assert!(widths.iter().all(|width| *width == widths[0]), "{table}");
}

#[test]
fn json_has_its_keys_and_stands_alone() {
    let report = Folder::new().json(SHORT);
    assert_eq!(
        keys(&report),
        [
            "capture",
            "digest",
            "estimator",
            "estimators",
            "fault",
            "feed_mm_per_min",
            "following_error",
            "machine",
            "move_mm",
            "schema",
            "seed",
            "tachogenerator",
            "tick_hz",
            "ticks",
            "units"
        ]
    );
    assert_eq!(report["schema"], "leadscrew/sim/1");
    assert_eq!(report["units"]["acceleration"], "d/tick²");
    assert_eq!(keys(&report["following_error"]), ["at_end", "peak", "rms"]);
    let mut names = EstimatorConfig::NAMES.to_vec();
    names.sort_unstable();
    assert_eq!(keys(&report["estimators"]), names);
    for name in names {
        assert_eq!(
            keys(&report["estimators"][name]),
            [
                "acceleration_error_rms",
                "lag_a_ticks",
                "lag_v_ticks",
                "lag_x_ticks",
                "tachogenerator_difference_rms",
                "velocity_error_rms"
            ]
        );
        assert!(number(&report, &format!("/estimators/{name}/velocity_error_rms")) > 0.0);
    }
    let digest = report["digest"].as_str().expect("text");
    assert!(digest.len() == 16 && digest.chars().all(|digit| digit.is_ascii_hexdigit()));
}

#[test]
fn the_tachogenerator_vouches_for_the_encoder() {
    let report = Folder::new().json("sim");
    let watched = &report["tachogenerator"];
    assert_eq!(
        keys(watched),
        [
            "disagreed_at_tick",
            "disagreement",
            "disagreements",
            "gain",
            "is_learned",
            "offset",
            "residual_rms"
        ]
    );
    assert!(watched["disagreement"].is_null() && watched["disagreed_at_tick"].is_null());
    assert_eq!(
        (&watched["disagreements"], &watched["is_learned"]),
        (&0.into(), &true.into())
    );
    assert!((number(watched, "/gain") - 1.0).abs() < 0.005);
    let residual = number(watched, "/residual_rms");
    assert!(residual > 0.01 && residual < 0.5, "{residual}");
    let printed = Folder::new().printed(SHORT);
    assert_says(
        &printed,
        &[
            "tachogenerator over encoder: gain ",
            "moved too little to know them",
        ],
    );
}

#[test]
fn a_coupling_that_slips_or_breaks_is_told() {
    let folder = Folder::new();
    for (slip, kind, words) in [
        ("1.0", "broken", "the encoder stands"),
        // So little that the drive still follows, and no fault stops the axis.
        ("0.05", "slipping", "turns less than the motor"),
    ] {
        folder.write(
            "loose.toml",
            format!("[mount]\ncoupling_slip = {slip}\nslip_from_s = 1.8\n"),
        );
        let watched = folder.json("sim --machine loose.toml")["tachogenerator"].clone();
        let tick = number(&watched, "/disagreed_at_tick");
        assert!((1800.0..1850.0).contains(&tick), "{slip}: {tick}");
        let printed = folder.printed("sim --machine loose.toml");
        let warning = format!("warning: encoder and tachogenerator disagree from tick {tick} on");
        assert_says(&printed, &[&warning]);
        assert_eq!(watched["disagreement"], kind);
        assert_says(&printed, &[words]);
    }
}

#[test]
fn the_health_of_the_encoder_is_told() {
    let folder = Folder::new();
    let report = folder.json(SHORT);
    let capture = &report["capture"];
    assert_eq!(
        keys(capture),
        [
            "ambiguous_ticks",
            "illegal",
            "overrun_ticks",
            "overspeed_ticks"
        ]
    );
    for sound in ["illegal", "overrun_ticks", "overspeed_ticks"] {
        assert_eq!(capture[sound], 0, "{sound}");
    }
    // 150 mm/s are 2 046.9 d a tick; a velocity holds 2 047, which the overshoot passes.
    folder.write("fine.toml", "[mount]\ncounts_per_mm = 13646");
    let fine = "sim --move-mm 100 --machine fine.toml";
    let ticks = number(&folder.json(fine), "/capture/overspeed_ticks");
    assert!(ticks > 0.0);
    let warning = format!("warning: {ticks} ticks with more than 2047 d");
    assert_says(&folder.printed(fine), &[&warning]);
}

#[test]
fn the_csv_has_one_row_a_tick_and_agrees_with_the_report() {
    let folder = Folder::new();
    let report = folder.json("sim --move-mm 5 --tick-hz 2500 --csv run.csv");
    let table = Table::read(&folder.path("run.csv"));
    assert_eq!(table.header.join(","), format!("{SHARED},{FURTHER}"));
    table.assert_ticks(number(&report, "/ticks") as usize, 2500.0);

    let error = table.column("following_error_d");
    let peak = error
        .iter()
        .fold(0.0_f64, |peak, error| peak.max(error.abs()));
    assert!((peak - number(&report, "/following_error/peak")).abs() < 1e-6);
    assert!((error[error.len() - 1] - number(&report, "/following_error/at_end")).abs() < 1e-6);
    // There and back: 5 mm are 5 000 d.
    let setpoint = table.column("setpoint_d");
    let far = setpoint.iter().copied().fold(f64::MIN, f64::max);
    assert_eq!(far - setpoint[0], 5000.0);
    assert_eq!(setpoint[setpoint.len() - 1], setpoint[0]);
    // The count follows the true position to within the errors of the disc.
    for (count, truth) in table
        .column("count_d")
        .iter()
        .zip(table.column("true_position_d"))
    {
        assert!((count - truth).abs() < 4.0, "{count} {truth}");
    }
    for lag in ["lag_x_ticks", "lag_v_ticks", "lag_a_ticks"] {
        let expected = number(&report, &format!("/estimators/exponential/{lag}"));
        assert!(
            table
                .column(lag)
                .iter()
                .all(|lag| (lag - expected).abs() < 1e-8)
        );
    }
    assert!(
        table
            .column("command")
            .iter()
            .all(|command| command.abs() <= 1.0)
    );
}

#[test]
fn plots_in_both_formats() {
    let folder = Folder::new();
    for plot in ["run.svg", "run.PNG", "run.png"] {
        folder.printed(&format!("{SHORT} --plot {plot}"));
    }
    assert_picture(&folder.path("run.svg"));
    assert_picture(&folder.path("run.png"));
    let svg = folder.read("run.svg");
    assert_says(
        &svg,
        &["16k20f3: 5 mm at 9000 mm/min", "following error, d", "true"],
    );
    assert_eq!(folder.listing(), ["run.PNG", "run.png", "run.svg"]);
}

#[test]
fn a_seed_is_a_run() {
    let folder = Folder::new();
    let digest = |seed: u64| folder.json(&format!("{SHORT} --seed {seed}"))["digest"].clone();
    assert_eq!(digest(1), digest(1));
    assert_ne!(digest(1), digest(2));
    assert_ne!(digest(u64::MAX), digest(2));
}

#[test]
fn every_estimator_can_be_in_the_loop() {
    let folder = Folder::new();
    let digests: Vec<_> = EstimatorConfig::NAMES
        .iter()
        .map(|name| {
            let report = folder.json(&format!("{SHORT} --estimator {name} --csv run.csv"));
            assert_eq!(report["estimator"], *name);
            let expected = number(&report, &format!("/estimators/{name}/lag_v_ticks"));
            let lag = Table::read(&folder.path("run.csv")).column("lag_v_ticks")[0];
            assert!((lag - expected).abs() < 1e-8, "{name}");
            report["digest"].to_string()
        })
        .collect();
    for (index, digest) in digests.iter().enumerate() {
        assert!(!digests[..index].contains(digest), "{index}: two alike");
    }
}

#[test]
fn the_bare_machine_follows_better() {
    let folder = Folder::new();
    let peak = |machine: &str| {
        let report = folder.json(&format!("sim --move-mm 50 --machine {machine}"));
        assert_eq!(report["machine"], machine);
        number(&report, "/following_error/peak")
    };
    assert!(peak("16k20f3-bare") < peak("16k20f3"));
}

#[test]
fn a_move_may_start_the_other_way() {
    let folder = Folder::new();
    folder.printed("sim --move-mm -5 --csv run.csv");
    let table = Table::read(&folder.path("run.csv"));
    let setpoint = table.column("setpoint_d");
    let far = setpoint.iter().copied().fold(f64::MAX, f64::min);
    assert_eq!(far - setpoint[0], -5000.0);
    assert_eq!(setpoint[setpoint.len() - 1], setpoint[0]);
}

#[test]
fn a_move_of_nothing_has_no_errors_to_tell() {
    let folder = Folder::new();
    let report = folder.json("sim --move-mm 0");
    for name in EstimatorConfig::NAMES {
        assert!(report["estimators"][name]["velocity_error_rms"].is_null());
        assert!(report["estimators"][name]["acceleration_error_rms"].is_null());
    }
    assert!(number(&report, "/following_error/peak") < 2.0);
    let printed = folder.printed("sim --move-mm 0");
    let row = printed.lines().find(|line| line.starts_with("simple"));
    assert_eq!(row.expect("a row").split_whitespace().nth(1), Some("-"));
}
