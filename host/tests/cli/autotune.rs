//! `leadscrew autotune`.

use crate::{Folder, assert_says, number};

#[test]
fn an_offer_keeps_its_margins_follows_and_is_written_only_where_told() {
    let folder = Folder::new();
    let report = folder.json("autotune");
    assert_eq!(report["schema"], "leadscrew/autotune/1");
    assert!(report["written"].is_null());
    assert!(folder.listing().is_empty(), "{:?}", folder.listing());
    let tolerance = 0.05;
    assert!(number(&report, "/margins/worst/gain_db") > 6.0 - tolerance);
    assert!(number(&report, "/margins/worst/phase_deg") > 30.0 - tolerance);
    assert!(number(&report, "/after/peak_d") < 20.0);

    let text = folder.printed("autotune --out axis.toml");
    assert_says(
        &text,
        &[
            "controller.position_gain_per_s",
            "worst within ±20 %",
            "written to axis.toml",
        ],
    );
    let written = folder.read("axis.toml");
    assert_says(
        &written,
        &[
            "estimator = \"observer\"",
            "[controller]",
            "[calm]",
            "[friction]",
            "[observer]",
        ],
    );
    let path = folder.path("axis.toml");
    let read = leadscrew_host::axis_file::read(&path).expect("a file of its own");
    assert!(read.axis.validate().is_ok());
    let gain = read.axis.controller.position_gain_per_s;
    let row = report["parameters"].as_array().and_then(|rows| {
        rows.iter()
            .find(|row| row["name"] == "position_gain_per_s" && row["section"] == "controller")
    });
    let offered = row.and_then(|row| row["after"].as_f64()).expect("a gain");
    // JSON is read to the last digit but one.
    assert!((offered / gain - 1.0).abs() < 1e-12, "{offered} {gain}");
}

#[test]
fn a_feed_without_room_for_control_is_refused_with_the_figure() {
    let folder = Folder::new();
    let message = folder.refused(2, "autotune --max-feed 9400 --out axis.toml");
    assert_says(
        &message,
        &[
            "--max-feed 9400",
            "95 %",
            "mm/min at full command",
            "ask for 9100 or less",
        ],
    );
}

#[test]
fn a_slower_drive_gets_the_feed_that_it_gives() {
    let folder = Folder::new();
    folder.write(
        "slow.toml",
        "base = \"16k20f3\"\n[drive]\nfull_command_feed_mm_per_min = 7680.0\nnatural_period_s = 0.117\n",
    );
    let report = folder.json("autotune --machine slow.toml");
    // 95 % of some 7 680 mm/min, in round figures.
    assert_eq!(number(&report, "/max_feed_mm_per_min"), 7200.0);
    assert!(number(&report, "/after/peak_d") < 20.0);
    assert!(number(&report, "/after/rest_swing_d") < 1.0);
}

#[test]
fn a_machine_that_cannot_be_identified_is_not_tuned() {
    let folder = Folder::new();
    let message = folder.refused(1, "autotune --reverse-drive --out axis.toml");
    assert_says(&message, &["wrong polarity"]);
}
