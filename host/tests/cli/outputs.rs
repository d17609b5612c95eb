//! Files and streams that results go to: whole or not at all, and nothing destroyed.

use std::fs::File;
use std::io::pipe;

use crate::scenes::{put_ramp, short_walk};
use crate::{Folder, assert_clear, assert_says, in_folder, text};

/// The subcommands, on little data.
const COMMANDS: [&str; 2] = ["sim --move-mm 1", "replay walk.vcd"];

fn folder() -> Folder {
    let folder = Folder::new();
    folder.write("walk.vcd", short_walk());
    folder
}

#[test]
fn folders_that_do_not_exist() {
    let folder = folder();
    for command in COMMANDS {
        for output in [
            "--csv absent/x.csv",
            "--plot absent/x.svg",
            "--plot absent/x.png",
        ] {
            let message = folder.refused(1, &format!("{command} {output} --json"));
            let file = output.split_once(' ').expect("two words").1;
            assert_says(&message, &[file, "check that its directory exists"]);
        }
    }
}

#[test]
fn formats_of_plots_that_do_not_exist_are_refused_before_the_work() {
    let folder = folder();
    for command in COMMANDS {
        for plot in ["x.pdf", "x", "png", "x.svg.gz"] {
            let message = folder.refused(2, &format!("{command} --csv x.csv --plot {plot}"));
            assert_says(&message, &[plot, ".svg or .png"]);
        }
    }
}

#[test]
fn what_was_there_stays_on_an_error_and_is_replaced_on_success() {
    let folder = folder();
    folder.write("x.csv", "old");
    folder.write("x.svg", "old");
    let outputs = "--csv x.csv --plot x.svg";
    folder.refused(2, &format!("sim --feed 9500 {outputs}"));
    folder.refused(1, &format!("replay absent.vcd {outputs}"));
    folder.refused(2, &format!("replay walk.vcd --tick-hz 0 {outputs}"));
    folder.refused(1, "replay walk.vcd --csv x.csv/y.csv");
    assert_eq!(
        (folder.read("x.csv"), folder.read("x.svg")),
        ("old".into(), "old".into())
    );
    for command in COMMANDS {
        folder.printed(&format!("{command} {outputs}"));
        assert!(folder.read("x.csv").starts_with("tick,"));
        assert!(folder.read("x.svg").contains("<svg"));
    }
    assert_eq!(folder.listing(), ["walk.vcd", "x.csv", "x.svg"]);
}

#[test]
fn the_input_is_never_overwritten() {
    let folder = folder();
    let walk = folder.read("walk.vcd");
    std::fs::create_dir(folder.path("sub")).expect("a folder");
    for same in ["walk.vcd", "./walk.vcd", "sub/../walk.vcd"] {
        let message = folder.refused(2, &format!("replay walk.vcd --csv {same}"));
        assert_says(&message, &["--csv", "is the file that is read"]);
    }
    folder.write("machine.toml", "[drive]\n");
    folder.refused(2, "sim --machine machine.toml --csv machine.toml");
    assert_eq!(
        (folder.read("walk.vcd"), folder.read("machine.toml")),
        (walk, "[drive]\n".into())
    );
}

#[test]
fn two_results_do_not_share_a_file() {
    let folder = folder();
    for command in COMMANDS {
        let message = folder.refused(2, &format!("{command} --csv x.svg --plot x.svg"));
        assert_says(&message, &["--csv and --plot are both x.svg"]);
    }
}

#[test]
fn folders_are_not_replaced() {
    let folder = folder();
    std::fs::create_dir(folder.path("folder.svg")).expect("a folder");
    for command in COMMANDS {
        folder.refused(2, &format!("{command} --csv folder.svg"));
        folder.refused(2, &format!("{command} --plot folder.svg"));
    }
}

// Not on a device of the machine: were it replaced after all, every other program would suffer.
#[cfg(unix)]
#[test]
fn sockets_are_not_replaced() {
    let folder = folder();
    let socket = folder.path("socket.svg");
    let _open = std::os::unix::net::UnixListener::bind(socket).expect("a socket");
    for command in COMMANDS {
        for option in ["--csv", "--plot"] {
            let message = folder.refused(2, &format!("{command} {option} socket.svg"));
            assert_says(&message, &["socket.svg", "not an ordinary file"]);
        }
    }
}

#[test]
fn names_with_blanks_and_other_letters() {
    let folder = folder();
    let name = "пробный ход.csv";
    let output = in_folder(&folder, &["sim", "--move-mm", "1", "--csv"], name.as_ref());
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert!(folder.read(name).starts_with("tick,"));
}

#[test]
fn a_reader_that_goes_away_is_no_crash() {
    let folder = folder();
    put_ramp(&folder, "ramp.vcd");
    for arguments in [
        "replay ramp.vcd",
        "replay ramp.vcd --json",
        "sim --move-mm 1",
        "sim --dump-machine",
    ] {
        let (reader, writer) = pipe().expect("a pipe");
        // Before the command starts, so that it never finds a reader.
        drop(reader);
        let mut command = folder.command(arguments.split_whitespace());
        let output = command.stdout(writer).output().expect("the command starts");
        let errors = text(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{arguments}: {errors}");
        assert_clear(&errors);
    }
}

#[test]
fn errors_without_a_reader_keep_their_exit_code() {
    let folder = folder();
    for (code, arguments) in [
        (1, "replay absent.vcd"),
        (2, "sim --feed 0"),
        (2, "sim --feed x"),
    ] {
        let (reader, writer) = pipe().expect("a pipe");
        drop(reader);
        let mut command = folder.command(arguments.split_whitespace());
        let status = command.stderr(writer).status().expect("the command starts");
        assert_eq!(status.code(), Some(code), "{arguments}");
    }
}

#[test]
fn a_full_disk_at_standard_output_is_told() {
    let Ok(full) = File::options().write(true).open("/dev/full") else {
        eprintln!("skipped: there is no /dev/full");
        return;
    };
    let folder = folder();
    let mut command = folder.command(["replay", "walk.vcd"]);
    let output = command.stdout(full).output().expect("the command starts");
    let errors = text(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{errors}");
    assert_says(&errors, &["error: the report cannot be printed"]);
}
