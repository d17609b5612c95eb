//! Parameters of an axis.

use leadscrew_hal_mock::machine::MachineParams;
use leadscrew_host::commissioning::learned;

use super::Bench;
use crate::{assert_says, number};

#[test]
fn what_is_set_and_saved_is_there_after_the_next_start() {
    let bench = Bench::new();
    let set = bench.json("params set motion.max_feed_mm_per_min=8000mm/min estimator=polynomial");
    assert_eq!(set["saved"], false);
    assert_eq!(set["changed"].as_array().map(Vec::len), Some(2));
    let feed = |bench: &Bench| {
        let row = bench.json("params get motion.max_feed_mm_per_min");
        number(&row, "/value")
    };
    assert!((feed(&bench) - 9000.0).abs() < 1e-9, "it was not saved");
    bench.printed("params set motion.max_feed_mm_per_min 8000 --save");
    assert!((feed(&bench) - 8000.0).abs() < 1e-9);
    let diff = bench.printed("params diff");
    assert_says(&diff, &["motion.max_feed_mm_per_min  9000 -> 8000 mm/min"]);
    bench.printed("params reset --yes");
    assert_eq!(bench.printed("params diff --defaults"), "no difference\n");
}

#[test]
fn the_list_has_units_ranges_defaults_and_meanings() {
    let bench = Bench::new();
    let list = bench.printed("params list motion");
    assert_says(
        &list,
        &[
            "motion.max_feed_mm_per_min",
            "9000 mm/min",
            "default 9000",
            "Largest feed of a move",
        ],
    );
    assert!(!list.contains("homing."), "{list}");
    let all = bench.json("params list");
    let rows = all.as_array().expect("a list");
    assert!(rows.len() > 100, "{}", rows.len());
    let word = rows.iter().find(|row| row["name"] == "second_estimator");
    assert_eq!(word.expect("a word")["word"], "none");
    assert!(
        rows.iter().all(|row| row["description"]
            .as_str()
            .is_some_and(|text| !text.is_empty())),
        "every parameter has a description"
    );
}

#[test]
fn a_backup_restores_every_setting() {
    let bench = Bench::commissioned();
    bench
        .printed("params set second_estimator=polynomial paths.display=second tick_hz=2000 --save");
    bench.printed("params backup kept.toml");
    let kept = bench.0.read("kept.toml");
    assert_says(
        &kept,
        &[
            "# Largest feed of a move; at most 95 % of the full-command feed (mm/min, ",
            "second_estimator = \"polynomial\"",
            "[paths]",
            "display = \"second\"",
            "[observer]",
        ],
    );
    bench.printed("params reset --yes");
    let changed = bench.json("params diff kept.toml");
    assert!(changed.as_array().is_some_and(|rows| rows.len() > 5));
    let restored = bench.printed("params restore kept.toml --save");
    assert_says(&restored, &["saved", "leadscrew restart"]);
    assert_eq!(bench.printed("params diff kept.toml"), "no difference\n");
}

#[test]
fn a_file_of_the_old_shape_is_restored() {
    let bench = Bench::new();
    bench.0.write(
        "old.toml",
        "tick_hz = 1000\nestimator = \"exponential\"\nposition = \"count\"\n[motion]\nmax_feed_mm_per_min = 7000\n",
    );
    let told = bench.printed("params restore old.toml");
    assert_says(&told, &["9000 -> 7000 mm/min"]);
}

#[test]
fn calibration_goes_beside_a_backup_only_where_it_is_asked_for() {
    let bench = Bench::commissioned();
    let map = learned(&MachineParams::z_16k20f3(), 1).expect("a map");
    bench.printed("params backup kept.toml");
    std::fs::write(bench.0.path("kept.map"), &map).expect("it is written");
    bench.printed("params restore kept.toml --save");
    assert_says(
        &bench.printed("params backup none.toml --calibration"),
        &["no encoder map and no screw table"],
    );
    let told = bench.printed("params restore kept.toml --calibration --save");
    assert_says(&told, &["encoder map", "kept.map", "CRC-32", "restart"]);

    bench.printed("params backup plain.toml");
    assert!(!bench.0.path("plain.map").exists());
    let files = bench.json("params backup again.toml --calibration");
    let checksum = &files[1]["crc32"];
    assert!(
        checksum.as_str().is_some_and(|crc| told.contains(crc)),
        "{files} {told}"
    );
    let read = std::fs::read(bench.0.path("again.map")).expect("a map");
    assert!(read == map, "the map is the same to the byte");

    bench.printed("params reset --yes --keep-calibration");
    bench.printed("params backup kept-map.toml --calibration");
    assert!(bench.0.path("kept-map.map").exists());
    bench.printed("params reset --yes");
    bench.printed("params backup gone.toml --calibration");
    assert!(!bench.0.path("gone.map").exists());
}
