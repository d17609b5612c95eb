//! `leadscrew calibrate-encoder` on captures of `leadscrew sim-encoder`.

use leadscrew::encoder_map::{Direction, EncoderMap, Form};
use leadscrew_hal_mock::disc::DiscParams;
use leadscrew_hal_mock::encoder::{Encoder, EncoderModel};
use leadscrew_host::recording::{self, ChannelSelection, Recording};

use crate::capture_files::{saleae_csv, sigrok_csv};
use crate::{Folder, assert_says, number};

/// Lines of the small encoder, times 4.
const EDGES: u32 = 2000;
/// Short runs at speeds at which the wobble of 90 ticks stays away from whole numbers a revolution.
const SIM: &str = "sim-encoder --edges-per-rev 2000 --revolutions 16.5 --seed 3 --out cap.vcd";
const CALIBRATE: &str = "calibrate-encoder --edges-per-rev 2000 --out enc.map";

fn simulated(arguments: &str) -> Folder {
    let folder = Folder::new();
    folder.printed(&format!("{SIM} {arguments}"));
    folder
}

/// The recording that was simulated, to be written otherwise or spoiled.
fn recorded(folder: &Folder) -> Recording {
    let channels = ChannelSelection {
        z: Some("Z".to_owned()),
        ..ChannelSelection::default()
    };
    recording::read(&folder.path("cap.vcd"), &channels, None).unwrap()
}

fn write_vcd(folder: &Folder, name: &str, recording: &Recording) {
    let mut bytes = Vec::new();
    recording.write_vcd(&mut bytes).unwrap();
    folder.write(name, bytes);
}

/// Map less truth in a direction, the constant taken out, d rms.
fn off_truth(image: &[u8], direction: Direction) -> f64 {
    let map = EncoderMap::from_bytes(image).unwrap();
    let model = EncoderModel {
        disc: DiscParams {
            edges_per_revolution: f64::from(EDGES),
            ..DiscParams::default()
        },
        ..EncoderModel::real()
    };
    let encoder = Encoder::new(&model, 1000.0, 0.0, 3).unwrap();
    let backward = direction == Direction::Backward;
    let off = |edge: u32| {
        f64::from(map.error(edge, direction)) / 65_536.0
            - encoder.placement_error(edge as usize, backward)
    };
    let mean = (0..EDGES).map(off).sum::<f64>() / f64::from(EDGES);
    let squares: f64 = (0..EDGES).map(|edge| (off(edge) - mean).powi(2)).sum();
    (squares / f64::from(EDGES)).sqrt()
}

#[test]
fn a_capture_becomes_a_map_within_a_hundredth_of_a_d() {
    let folder = simulated("");
    let report = folder.json(&format!("{CALIBRATE} cap.vcd --z Z --plot map.png"));
    assert_eq!(report["schema"], "leadscrew/calibrate-encoder/1");
    assert_eq!(report["runs"].as_array().unwrap().len(), 4);
    for (run, (direction, speed)) in [
        ("forward", 83.3),
        ("backward", 83.3),
        ("forward", 66.7),
        ("backward", 66.7),
    ]
    .into_iter()
    .enumerate()
    {
        let run = &report["runs"][run];
        assert_eq!(run["direction"], direction);
        assert!((number(run, "/speed") - speed).abs() < 1.0, "{run}");
        assert!((number(run, "/rpm") - 30.0 * speed).abs() < 30.0, "{run}");
        assert_eq!(run["revolutions"], 12);
    }
    assert!(number(&report, "/errors_before/1_per_rev") > 1.0);
    assert!(number(&report, "/errors_after/1_per_rev") < 0.01);
    assert!(number(&report, "/errors_before/lines") > 0.08);
    assert!(number(&report, "/errors_after/lines") < 0.004);
    assert!((number(&report, "/hysteresis_a_less_b") - 0.02).abs() < 0.002);
    let image = std::fs::read(folder.path("enc.map")).unwrap();
    assert_eq!(report["map_bytes"], image.len());
    for direction in [Direction::Forward, Direction::Backward] {
        let off = off_truth(&image, direction);
        assert!(off < 0.01, "{direction:?}: {off}");
    }
    assert_eq!(
        folder.listing(),
        ["cap.vcd", "enc.map", "map-waves.png", "map.png"]
    );
}

#[test]
fn the_text_tells_runs_waves_and_what_is_not_known() {
    let folder = simulated("");
    let text = folder.printed(&format!("{CALIBRATE} cap.vcd --z Z"));
    assert_says(
        &text,
        &[
            "enc.map: 2134 bytes, 2000 edges a revolution, full",
            "backward",
            "once a revolution",
            "edges within a line",
            "hysteresis of A less that of B: 0.0",
            "runs disagree most at",
            "cannot be told from the encoder's errors",
        ],
    );
}

#[test]
fn the_formats_and_several_captures_give_the_same_map() {
    let folder = simulated("");
    folder.printed(&format!("{CALIBRATE} cap.vcd --z Z"));
    let whole = std::fs::read(folder.path("enc.map")).unwrap();
    // In ns, as Logic 2 writes it.
    let recording = recorded(&folder);
    folder.write("cap.csv", saleae_csv(&recording, &["A", "B", "Z"], 0));
    folder.printed(&format!("{CALIBRATE} cap.csv --z Z"));
    assert!(std::fs::read(folder.path("enc.map")).unwrap() == whole);
    // Each run in a capture of its own, cut in the rest between: seeds are the same, so is the encoder.
    for (number, velocity) in ["83.3", "-83.3", "66.7", "-66.7"].iter().enumerate() {
        folder.printed(
            &format!("{SIM} --velocities {velocity}").replace("cap.vcd", &format!("{number}.vcd")),
        );
    }
    folder.printed(&format!("{CALIBRATE} 0.vcd 1.vcd 2.vcd 3.vcd --z Z"));
    let parts = std::fs::read(folder.path("enc.map")).unwrap();
    for direction in [Direction::Forward, Direction::Backward] {
        assert!(off_truth(&parts, direction) < 0.01);
    }
}

#[test]
fn samples_of_an_analyser_at_10_mhz_will_do() {
    let folder = simulated("--velocities 83.3,-66.7");
    let mut recording = recorded(&folder);
    // A sample sees an edge at its next instant.
    recording.clock_hz /= 100;
    recording.duration = recording.duration.div_ceil(100);
    for change in &mut recording.changes {
        change.time = change.time.div_ceil(100);
    }
    write_vcd(&folder, "coarse.vcd", &recording);
    folder.printed(&format!("{CALIBRATE} coarse.vcd --z Z"));
    let image = std::fs::read(folder.path("enc.map")).unwrap();
    let off = off_truth(&image, Direction::Forward);
    assert!(off < 0.01, "{off}");
    // sigrok's CSV has a row a sample: a short capture shows that it is read, and refused for its length.
    recording.changes.truncate(1000);
    recording.duration = recording.changes.last().unwrap().time + 1;
    folder.write("short.csv", sigrok_csv(&recording, &["A", "B", "Z"]));
    std::fs::remove_file(folder.path("enc.map")).unwrap();
    let refused = folder.refused(1, &format!("{CALIBRATE} short.csv --z Z"));
    assert_says(
        &refused,
        &["no run of 15.2 revolutions", "hold a constant feed"],
    );
}

#[test]
fn smaller_forms_and_no_index() {
    let folder = simulated("");
    for (form, bytes) in [("full", 2134), ("coarse", 134), ("phases", 68)] {
        let report = folder.json(&format!("{CALIBRATE} cap.vcd --z Z --form {form}"));
        assert_eq!(report["map_bytes"], bytes, "{form}");
        assert_eq!(report["form"], form);
    }
    let indexed = folder.json(&format!("{CALIBRATE} cap.vcd --z Z --form phases"));
    let report = folder.json(&format!("{CALIBRATE} cap.vcd --form phases"));
    for direction in ["forward", "backward"] {
        for phase in 0..4 {
            let pointer = format!("/phases/{direction}/{phase}");
            let off = number(&report, &pointer) - number(&indexed, &pointer);
            assert!(off.abs() < 0.0005, "{pointer}: {off}");
        }
    }
    let hysteresis = number(&report, "/hysteresis_a_less_b");
    assert!((hysteresis - 0.02).abs() < 0.002, "{hysteresis}");
    assert!(report["errors_after"].is_null() && report["disagreement"].is_null());
    let image = std::fs::read(folder.path("enc.map")).unwrap();
    assert_eq!(EncoderMap::from_bytes(&image).unwrap().form(), Form::Phases);
    let refused = folder.refused(2, &format!("{CALIBRATE} cap.vcd"));
    assert_says(&refused, &["--z", "--form phases"]);
}

#[test]
fn what_does_not_suffice_is_refused_with_what_to_do() {
    let folder = simulated("--velocities 83.3");
    let refused = |arguments: &str| folder.refused(1, &format!("{CALIBRATE} --z Z {arguments}"));
    assert_says(
        &refused("cap.vcd"),
        &["one direction", "add one the other way"],
    );
    assert_says(
        &refused("cap.vcd --accept-one-direction"),
        &["add a run at 1.2 times the speed"],
    );
    let accepted = "--accept-one-direction --accept-one-speed";
    assert_says(
        &refused(&format!("cap.vcd {accepted} --plot x.svg")),
        &["nothing can be drawn", "leave out --plot"],
    );
    let report = folder.json(&format!("{CALIBRATE} --z Z cap.vcd {accepted}"));
    assert!(report["hysteresis_a_less_b"].is_null() && report["phases"]["backward"].is_null());
    // 2000 edges a revolution taken for 4000 and for 1996, no Z at all, an edge lost.
    std::fs::remove_file(folder.path("enc.map")).unwrap();
    let wrong = CALIBRATE.replace("2000", "4000");
    let longer = folder.refused(1, &format!("{wrong} cap.vcd --z Z"));
    assert_says(&longer, &["no run of", "check the edges per revolution"]);
    let short = folder.refused(
        1,
        &format!("{} cap.vcd --z Z", CALIBRATE.replace("2000", "1996")),
    );
    assert_says(
        &short,
        &["cap.vcd: the run from", "index in revolution", "counts off"],
    );

    let good = recorded(&folder);
    let mut spoiled = good.clone();
    for change in &mut spoiled.changes {
        change.levels.z = false;
    }
    spoiled.initial.z = false;
    write_vcd(&folder, "dumb.vcd", &spoiled);
    assert_says(
        &refused("dumb.vcd"),
        &["dumb.vcd: the index is never high", "--z"],
    );
    let mut spoiled = good;
    spoiled.changes.remove(9000);
    write_vcd(&folder, "lost.vcd", &spoiled);
    assert_says(
        &refused("lost.vcd"),
        &["lost.vcd", "edge times missed", "wiring"],
    );
}

#[test]
fn what_makes_no_sense_is_bad_usage() {
    let folder = simulated("--velocities 83.3,-83.3");
    for (arguments, parts) in [
        (
            "--edges-per-rev 2001 --out m cap.vcd --z Z",
            ["2001", "4 times the lines"],
        ),
        (
            "--edges-per-rev 2000 --out cap.vcd cap.vcd --z Z",
            ["--out", "is the file that is read"],
        ),
        (
            "--edges-per-rev 2000 --out m cap.vcd --z Z --plot m.txt",
            ["m.txt", ".svg"],
        ),
        (
            "--edges-per-rev 2000 --out m.png cap.vcd --z Z --plot m.png",
            ["m.png", "twice"],
        ),
        (
            "--edges-per-rev 2000 --out m cap.vcd --z Z --tolerance 0",
            ["--tolerance", "0"],
        ),
        (
            "--edges-per-rev 2000 --out m cap.vcd --z Z --tick-hz 1",
            ["--tick-hz", "100"],
        ),
    ] {
        assert_says(
            &folder.refused(2, &format!("calibrate-encoder {arguments}")),
            &parts,
        );
    }
    for (arguments, part) in [
        ("--velocities 1", "--velocities"),
        ("--revolutions 0", "--revolutions"),
        ("--edges-per-rev 10", "--edges-per-rev"),
    ] {
        let message = folder.refused(2, &format!("sim-encoder --out x.vcd {arguments}"));
        assert_says(&message, &[part]);
    }
}
