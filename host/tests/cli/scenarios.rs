//! Scenario files as a user meets them.

use crate::{Folder, assert_says, number};

const FAULT: &str = "duration_s = 1.2\n\
                     [[at]]\ntime_s = 0.0\naction = 'enable'\n\
                     [[at]]\ntime_s = 0.1\naction = 'move-by'\ndistance_mm = 50\n\
                     [[at]]\ntime_s = 0.4\naction = 'drive-fault'\n\
                     [expect]\nfault = 'drive-fault'\nzero_output_within_ticks = 0\nstopped_within_s = 0.4\n";

/// Refuses a file of that content at that line.
#[track_caller]
fn refused(line: u32, content: &str, parts: &[&str]) {
    let folder = Folder::new();
    folder.write("run.toml", content);
    let message = folder.refused(1, "sim --scenario run.toml --csv x.csv --plot x.svg --json");
    let place = format!("error: run.toml:{line}: ");
    assert!(message.starts_with(&place), "{message}");
    assert_eq!(message.trim_end().lines().count(), 1, "{message}");
    assert_says(&message, parts);
}

#[test]
fn a_run_as_expected_tells_what_happened() {
    let folder = Folder::new();
    folder.write("run.toml", FAULT);
    let printed = folder.printed("sim --scenario run.toml --csv run.csv --plot run.svg");
    assert_says(
        &printed,
        &[
            "0.1000  action   move-by distance_mm=50",
            "0.4000  fault    drive-fault",
            "zero output after 0 ticks",
            "met     stopped_within_s",
        ],
    );
    assert!(!printed.contains("NOT MET"), "{printed}");
    assert_eq!(folder.read("run.csv").lines().count(), 1201);
    assert_says(&folder.read("run.svg"), &["trouble", "fault", "setpoint"]);

    let report = folder.json("sim --scenario run.toml");
    assert_eq!(report["schema"], "leadscrew/scenario/1");
    assert_eq!(report["passed"], true);
    let stop = &report["stops"][0];
    assert_eq!(
        (&stop["fault"], &stop["number"]),
        (&"drive-fault".into(), &10.into())
    );
    assert_eq!(number(stop, "/time_s"), 0.4);
    assert!(
        (1.0..20.0).contains(&number(stop, "/stopped_after_mm")),
        "{stop}"
    );
    let fault = report["events"].as_array().expect("a list").iter();
    assert_eq!(fault.filter(|event| event["event"] == "fault").count(), 1);
}

#[test]
fn a_run_that_is_not_as_expected_fails_after_its_report() {
    let folder = Folder::new();
    folder.write(
        "run.toml",
        FAULT.replace("stopped_within_s = 0.4", "stopped_within_s = 0.01"),
    );
    let output = folder.run("sim --scenario run.toml");
    let (printed, errors) = (crate::text(&output.stdout), crate::text(&output.stderr));
    assert_eq!(output.status.code(), Some(1), "{errors}");
    assert_says(
        &printed,
        &["NOT MET stopped_within_s: expected ≤ 0.01, found 0."],
    );
    assert_says(
        &errors,
        &["error: run.toml: 1 of the expectations is not met"],
    );

    folder.write("quiet.toml", FAULT.replace("fault = 'drive-fault'\n", ""));
    let output = folder.run("sim --scenario quiet.toml --json");
    assert_eq!(output.status.code(), Some(1), "a fault that nobody expects");
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON alone");
    assert_eq!(report["passed"], false);
}

#[test]
fn what_the_axis_refuses_is_told_and_counted() {
    let folder = Folder::new();
    let early = "duration_s = 0.2\n[[at]]\ntime_s = 0.1\naction = 'move-by'\ndistance_mm = 1\n[expect]\nrefused = 1\n";
    folder.write("run.toml", early);
    let printed = folder.printed("sim --scenario run.toml");
    assert_says(
        &printed,
        &["refused: the axis is not enabled: enable it first"],
    );
}

#[test]
fn a_machine_file_is_found_from_the_scenarios_folder() {
    let folder = Folder::new();
    std::fs::create_dir(folder.path("sub")).expect("a folder");
    folder.write("sub/mine.toml", "[drive]\ndamping = 0.7\n");
    let run = |machine: &str| {
        folder.write("sub/run.toml", format!("duration_s = 0.3\n{machine}"));
        folder.json("sim --scenario sub/run.toml")["digest"].to_string()
    };
    let by_file = run("[machine]\nfile = 'mine.toml'\n");
    assert_eq!(by_file, run("[machine.drive]\ndamping = 0.7\n"));
}

#[test]
fn mistakes_are_shown_with_file_and_line() {
    let at = |rest: &str| format!("duration_s = 1\n[[at]]\ntime_s = 0.1\n{rest}");
    refused(4, &at("action = 'enabel'"), &["did you mean `enable`?"]);
    refused(2, &at(""), &["needs an `action`", "\"enable\""]);
    refused(
        2,
        &at("action = 'move-to'"),
        &["needs `position_mm`", "(mm)"],
    );
    refused(
        5,
        &at("action = 'move-to'\nposition = 5"),
        &[
            "unknown key `position` of action \"move-to\"",
            "did you mean `position_mm`?",
        ],
    );
    refused(
        5,
        &at("action = 'missed-ticks'\nticks = 2.5"),
        &["ticks must be a whole number from 1 to 1000"],
    );
    refused(
        5,
        &at("action = 'dead-channel'\nchannel = 'c'"),
        &["expected one of a, b"],
    );
    refused(
        2,
        "duration_s = 1\n[[at]]\ntime_s = 2\naction = 'enable'",
        &["time_s = 2 is after the end of the run"],
    );
    refused(1, "[expect]", &["needs `duration_s`"]);
    refused(
        3,
        "duration_s = 1\n[expect]\nfault = 'drive-falt'",
        &["did you mean `drive-fault`?"],
    );
    refused(
        3,
        "duration_s = 1\n[axis.motion]\nmax_feed_mm_per_mi = 5",
        &["in [axis.motion]", "did you mean `max_feed_mm_per_min`?"],
    );
    refused(
        2,
        "duration_s = 1\n[machine.switchs]\nhome_mm = 5",
        &["did you mean `switches`?"],
    );
    refused(
        3,
        "duration_s = 1\n[machine]\nfile = 'absent.toml'",
        &["absent.toml: cannot be read"],
    );
    refused(2, "duration_s = 1\nat = 5", &["write [[at]]"]);
    refused(
        2,
        "duration_s = 1\nspeed = 5",
        &["unknown key or section `speed`"],
    );
}

#[test]
fn mistakes_of_tuning_screw_and_experiments_say_what_to_do() {
    let quick = |rest: &str| format!("duration_s = 1\n{rest}");
    refused(
        4,
        &quick("[axis]\ntuning = 'autotune'\nbandwidth_rad_per_s = 50"),
        &[
            "autotune finds the bandwidth itself",
            "leave bandwidth_rad_per_s out",
        ],
    );
    refused(
        3,
        &quick("[axis]\ntuning = 'auto'"),
        &["did you mean `autotune`?"],
    );
    refused(
        3,
        &quick("[encoder]\ndisplay = 'polynom'"),
        &["did you mean `polynomial`?"],
    );
    let point = "[[screw]]\nposition_mm = 1\nforward_um = 3\n";
    refused(2, &quick(point), &["once the axis is homed", "\"home\""]);
    let home = "[[at]]\ntime_s = 0.1\naction = 'home'\n";
    refused(
        4,
        &quick(&format!("{}{home}", point.replace("_um", ""))),
        &["did you mean `forward_um`?"],
    );
    refused(2, &quick("[screw]\nposition_mm = 1"), &["write [[screw]]"]);
    refused(
        2,
        &quick("[[at]]\ntime_s = 0\naction = 'experiment'\nlevel = 0.1\nlength_s = 0.1"),
        &["needs `window_mm`"],
    );

    let folder = Folder::new();
    folder.write("run.toml", quick(&format!("{point}{home}")));
    let message = folder.refused(1, "sim --scenario run.toml");
    assert_says(&message, &["run.toml: [[screw]]: ", "allowed 2 to 256"]);
}

#[test]
fn a_scenario_and_a_move_exclude_each_other() {
    let folder = Folder::new();
    folder.write("run.toml", FAULT);
    for option in [
        "--feed 5",
        "--machine 16k20f3",
        "--seed 2",
        "--estimator simple",
    ] {
        let message = folder.refused(2, &format!("sim --scenario run.toml {option}"));
        assert_says(&message, &["cannot be used with"]);
    }
}
