//! What the command says of itself.

use crate::{Folder, assert_says};

#[test]
fn help_names_every_option_its_unit_and_its_default() {
    let folder = Folder::new();
    let general = folder.printed("--help");
    assert_says(
        &general,
        &[
            "sim",
            "replay",
            "calibrate-encoder",
            "sim-encoder",
            "tune-filter",
            "identify",
            "autotune",
            "target/leadscrew of the current directory",
            "Exit codes: 0 done, 1 the job failed, 2 bad usage",
        ],
    );
    let sim = folder.printed("sim --help");
    assert_says(
        &sim,
        &[
            "--scenario",
            "--machine",
            "16k20f3-bare",
            "--move-mm",
            "[default: 300]",
            "--feed",
            "mm/min",
            "[default: 9000]",
            "--tick-hz",
            "100 to 40000",
            "--estimator",
            "gaussian",
            "--seed",
            "--dump-machine",
            "--json",
            "--csv",
            "--plot",
        ],
    );
    let replay = folder.printed("replay --help");
    assert_says(
        &replay,
        &[
            "<FILE>",
            "VCD",
            "sigrok CSV",
            "Saleae",
            "--tick-hz",
            "[default: 1000]",
            "--a",
            "--b",
            "--z",
            "--samplerate",
            "--estimator",
            "--from-s",
            "--to-s",
            "--window",
            "--answer",
            "centre",
            "--map",
            "--json",
            "--csv",
            "--plot",
        ],
    );
    let calibrate = folder.printed("calibrate-encoder --help");
    assert_says(
        &calibrate,
        &[
            "[FILES]...",
            "--edges-per-rev",
            "--out",
            "--form",
            "[default: full]",
            "--coast",
            "--accept-one-direction",
            "--accept-one-speed",
            "--tolerance",
            "[default: 0.01]",
        ],
    );
    let sim_encoder = folder.printed("sim-encoder --help");
    assert_says(
        &sim_encoder,
        &[
            "--velocities",
            "d/ms",
            "--revolutions",
            "--seed",
            "--steady",
        ],
    );
    let tune = folder.printed("tune-filter --help");
    assert_says(
        &tune,
        &[
            "[FILE]",
            "--scene",
            "table-1",
            "real-slow",
            "flywheel",
            "--lag-weight",
            "[default: 0.03]",
            "--sigma-weight",
            "[default: 0.97]",
            "has no truth",
            "101 ticks",
            "--map",
            "--from-s",
            "--json",
            "--plot",
        ],
    );
}

#[test]
fn help_names_what_works_on_an_axis() {
    let folder = Folder::new();
    let general = folder.printed("--help");
    assert_says(
        &general,
        &[
            "--port", "--flash", "status", "faults", "clear", "enable", "disable", "home", "move",
            "jog", "hold", "resume", "stop", "override", "counters", "restart", "params", "run",
            "serve",
        ],
    );
    let params = folder.printed("params --help");
    let subcommands = [
        "list", "get", "set", "save", "backup", "restore", "diff", "reset",
    ];
    assert_says(&params, &subcommands);
    assert_says(&folder.printed("move --help"), &["TARGET_MM", "mm/min"]);
    assert_says(&folder.printed("run --help"), &["--keep", "--check"]);
}

#[test]
fn the_version_is_that_of_the_package() {
    let printed = Folder::new().printed("--version");
    assert_eq!(
        printed.trim(),
        concat!("leadscrew ", env!("CARGO_PKG_VERSION"))
    );
}

#[test]
fn unknown_words_are_bad_usage() {
    let folder = Folder::new();
    for arguments in [
        "simulate",
        "sim extra",
        "sim --speed 5",
        "replay",
        "--json",
        "sim --csv",
    ] {
        let message = folder.refused(2, arguments);
        assert_says(&message, &["--help"]);
    }
}
