//! The command as a user meets it: the real binary, in a folder of its own.

mod accuracy;
mod autotune;
mod axis;
mod bad_files;
mod calibrate_axis;
mod calibrate_encoder;
mod calibrate_probe;
#[path = "../support/capture_files.rs"]
mod capture_files;
mod correct;
mod demo;
mod deviations;
mod help;
mod identify;
mod machine_files;
mod measure;
mod outputs;
mod pictures;
mod plan;
mod prove_out;
mod replay;
mod replay_estimator;
mod replay_faults;
mod replay_map;
mod replay_options;
mod scenarios;
mod scenes;
mod sigrok;
mod sim;
mod sim_usage;
mod table;
mod tracking;
mod tune_filter;

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;
use tempfile::TempDir;

/// A folder to run the command in.
struct Folder(TempDir);

impl Folder {
    fn new() -> Self {
        Self(tempfile::tempdir().expect("a temporary folder"))
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        std::fs::write(self.path(name), content).expect("the file is written");
    }

    fn read(&self, name: &str) -> String {
        std::fs::read_to_string(self.path(name)).expect(name)
    }

    /// Names of what is in it, sorted.
    fn listing(&self) -> Vec<String> {
        let entries = std::fs::read_dir(self.0.path()).expect("the folder is there");
        let name = |entry: std::io::Result<std::fs::DirEntry>| {
            let name = entry.expect("an entry").file_name();
            name.into_string().expect("names of tests are text")
        };
        let mut names: Vec<_> = entries.map(name).collect();
        names.sort();
        names
    }

    fn command(&self, arguments: impl IntoIterator<Item = impl AsRef<OsStr>>) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_leadscrew"));
        command.args(arguments).current_dir(self.0.path());
        // A panic would show a backtrace, which the tests of errors look for.
        command.env("RUST_BACKTRACE", "1");
        command
    }

    fn run(&self, arguments: &str) -> Output {
        let output = self.command(arguments.split_whitespace()).output();
        output.expect("the command starts")
    }

    /// What a run that succeeds prints.
    #[track_caller]
    fn printed(&self, arguments: &str) -> String {
        let output = self.run(arguments);
        let errors = text(&output.stderr);
        assert_eq!(output.status.code(), Some(0), "{arguments}: {errors}");
        assert_eq!(errors, "", "{arguments}: nothing but results is printed");
        text(&output.stdout)
    }

    /// The JSON that a run prints, alone.
    #[track_caller]
    fn json(&self, arguments: &str) -> Value {
        let printed = self.printed(&format!("{arguments} --json"));
        serde_json::from_str(&printed).expect("JSON alone on standard output")
    }

    /// What a run says that ends with that exit code, having printed and written nothing.
    #[track_caller]
    fn refused(&self, code: i32, arguments: &str) -> String {
        let before = self.listing();
        let output = self.run(arguments);
        let errors = text(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "{arguments}: {errors}");
        assert_eq!(text(&output.stdout), "", "{arguments}");
        assert_eq!(self.listing(), before, "{arguments}: something was written");
        assert_clear(&errors);
        errors
    }
}

/// The folder of this name in the repository holds `target/`; paths of tests are text.
fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).expect("UTF-8")
}

/// An error message is one for people, not a crash.
#[track_caller]
fn assert_clear(message: &str) {
    assert!(message.starts_with("error: "), "{message}");
    for trace in [
        "panicked",
        "backtrace",
        "RUST_",
        ".rs:",
        ".tmp",
        "Some(",
        "Err(",
    ] {
        assert!(!message.contains(trace), "`{trace}` is in: {message}");
    }
}

/// Asserts that the message has all of these parts.
#[track_caller]
fn assert_says(message: &str, parts: &[&str]) {
    for part in parts {
        assert!(message.contains(part), "`{part}` is not in: {message}");
    }
}

/// A number in a JSON document by its path, such as `/estimators/simple/velocity_peak`.
#[track_caller]
fn number(document: &Value, pointer: &str) -> f64 {
    let value = document.pointer(pointer).expect(pointer);
    value.as_f64().expect(pointer)
}

/// Keys of an object, in the order of the document.
fn keys(document: &Value) -> Vec<&str> {
    let object = document.as_object().expect("an object");
    object.keys().map(String::as_str).collect()
}

/// `--a x` on a path with any characters: the arguments of `run` are split at blanks.
fn in_folder(folder: &Folder, arguments: &[&str], file: &Path) -> Output {
    let mut command = folder.command(arguments);
    command.arg(file).output().expect("the command starts")
}
