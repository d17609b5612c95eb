//! Commands on an axis behind `--port`.

mod orders;
mod params;
mod probe;
mod refused;
mod script;
mod served;

use std::io::{BufRead as _, BufReader};
use std::process::{Child, Command, Output, Stdio};

use leadscrew::estimator::EstimatorConfig;
use leadscrew::settings::Settings;
use leadscrew_hal_mock::machine::MachineParams;
use leadscrew_hal_mock::scenario::MoveAndBack;
use leadscrew_host::axis_file;
use serde_json::Value;

use crate::{Folder, text};

const SIM: &str = "--port sim --flash axis.flash";

/// A folder with the flash of a simulated axis.
struct Bench(Folder);

impl Bench {
    /// Factory settings.
    fn new() -> Self {
        let folder = Folder::new();
        let output = folder.run(&format!("{SIM} status"));
        assert!(text(&output.stderr).contains("axis.flash: a new flash"));
        Self(folder)
    }

    /// A loop for its machine, saved, and in axis.toml.
    fn commissioned() -> Self {
        let bench = Self::new();
        bench
            .0
            .write("axis.toml", axis_file::dump(&loop_settings()));
        bench.printed("params restore axis.toml --save");
        bench
    }

    #[track_caller]
    fn printed(&self, arguments: &str) -> String {
        self.0.printed(&format!("{SIM} {arguments}"))
    }

    #[track_caller]
    fn json(&self, arguments: &str) -> Value {
        self.0.json(&format!("{SIM} {arguments}"))
    }

    #[track_caller]
    fn refused(&self, code: i32, arguments: &str) -> String {
        self.0.refused(code, &format!("{SIM} {arguments}"))
    }

    fn run(&self, arguments: &str) -> Output {
        self.0.run(&format!("{SIM} {arguments}"))
    }

    /// The same axis served on TCP.
    fn serve(&self) -> Served<'_> {
        let arguments = format!("{SIM} serve");
        let mut command = self.0.command(arguments.split_whitespace());
        let child = command.stdout(Stdio::piped()).stderr(Stdio::null()).spawn();
        let mut child = child.expect("the command starts");
        let mut line = String::new();
        let told = child.stdout.take().expect("a pipe");
        BufReader::new(told).read_line(&mut line).expect("a line");
        let port = line.split_whitespace().find_map(|word| {
            let word = word.trim_end_matches(',');
            word.starts_with("tcp:").then(|| word.to_owned())
        });
        Served {
            folder: &self.0,
            child,
            port: port.expect("a port"),
        }
    }
}

/// A loop for the reference machine, which homes towards its switch.
fn loop_settings() -> Settings {
    let estimator = EstimatorConfig::by_name("exponential").ok().flatten();
    let estimator = estimator.expect("an estimator");
    let scenario = MoveAndBack::standard(1000.0);
    let params = scenario.axis_params(&MachineParams::z_16k20f3(), estimator);
    let mut settings = Settings {
        axis: params.expect("parameters"),
        ..Settings::new(estimator)
    };
    settings.axis.homing.search_direction = -1.0;
    settings.axis.homing.search_feed_mm_per_min = 3000.0;
    settings
}

/// An axis that another process serves; it is switched off in the end.
struct Served<'f> {
    folder: &'f Folder,
    child: Child,
    port: String,
}

impl Served<'_> {
    fn command(&self, arguments: &str) -> Command {
        let arguments = format!("--port {} {arguments}", self.port);
        self.folder.command(arguments.split_whitespace())
    }

    #[track_caller]
    fn json(&self, arguments: &str) -> Value {
        self.folder
            .json(&format!("--port {} {arguments}", self.port))
    }

    /// The same of a jog, which says on standard error how it is ended.
    fn json_of_jog(&self, arguments: &str) -> Value {
        let output = self.command(&format!("{arguments} --json")).output();
        let output = output.expect("the command starts");
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
        serde_json::from_str(&text(&output.stdout)).expect("JSON alone on standard output")
    }

    /// A jog that is under way.
    fn jog(&self, feed: &str) -> Child {
        let mut jog = self.command(&format!("jog {feed} --json"));
        let jog = jog.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn();
        let mut jog = jog.expect("the command starts");
        let mut told = BufReader::new(jog.stderr.take().expect("a pipe"));
        let mut line = String::new();
        told.read_line(&mut line).expect("a line");
        assert_eq!(line, "jogging: Ctrl-C stops the axis\n");
        jog.stderr = Some(told.into_inner());
        jog
    }
}

impl Drop for Served<'_> {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// What Ctrl-C does.
fn interrupt(child: &Child) {
    let pid = child.id().to_string();
    let sent = Command::new("kill").args(["-INT", &pid]).status();
    assert!(sent.expect("kill is there").success());
}
