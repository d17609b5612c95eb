//! Options that belong to the other place of a command that works on an axis, and without one.

use clap::error::ErrorKind;
use clap::parser::ValueSource;
use clap::{ArgMatches, CommandFactory as _, FromArgMatches as _};

use super::Cli;

/// A command of both kinds.
struct Both {
    command: &'static str,
    /// Options that only the simulation or the captures have, by their name in the code.
    without_axis: &'static [&'static str],
    /// Options that only an axis has.
    on_axis: &'static [&'static str],
}

const MACHINE: [&str; 5] = [
    "machine",
    "tick_hz",
    "seed",
    "nominal_feed",
    "reverse_drive",
];
const BOTH: [Both; 3] = [
    Both {
        command: "identify",
        without_axis: &MACHINE,
        on_axis: &["yes"],
    },
    Both {
        command: "autotune",
        without_axis: &MACHINE,
        on_axis: &["yes", "room_minus", "room_plus"],
    },
    Both {
        command: "calibrate-encoder",
        without_axis: &[
            "edges_per_rev",
            "a",
            "b",
            "z",
            "samplerate",
            "tick_hz",
            "coast",
            "accept_one_direction",
            "accept_one_speed",
            "tolerance",
        ],
        on_axis: &["yes", "room_minus", "room_plus", "revolutions", "feeds"],
    },
];

impl Cli {
    /// Reads the command line; what is wrong ends the program with a message.
    #[must_use]
    pub fn read() -> Self {
        let matches = Self::command().get_matches();
        check(&matches).unwrap_or_else(|error| error.exit());
        Self::from_arg_matches(&matches).unwrap_or_else(|error| error.exit())
    }
}

/// Refuses an option that would be left unheard.
fn check(matches: &ArgMatches) -> Result<(), clap::Error> {
    let Some((name, of_command)) = matches.subcommand() else {
        return Ok(());
    };
    let Some(both) = BOTH.iter().find(|both| both.command == name) else {
        return Ok(());
    };
    let is_given = |id: &&&str| of_command.value_source(id) == Some(ValueSource::CommandLine);
    // The port may stand before or behind the command.
    let (unheard, why) = if of_command.contains_id("port") || matches.contains_id("port") {
        (
            both.without_axis,
            "is for a simulated machine or a capture, and the axis at --port has its own: leave it out",
        )
    } else {
        (
            both.on_axis,
            "is for an axis: name its port (--port), or leave it out",
        )
    };
    let Some(id) = unheard.iter().find(is_given) else {
        return Ok(());
    };
    let option = id.replace('_', "-");
    let message = format!("--{option} {why}");
    Err(Cli::command().error(ErrorKind::ArgumentConflict, message))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn said(words: &[&str]) -> Option<String> {
        let matches = Cli::command().get_matches_from([&["leadscrew"], words].concat());
        check(&matches).err().map(|error| error.to_string())
    }

    #[test]
    fn the_options_are_those_of_their_commands() {
        let cli = Cli::command();
        for both in &BOTH {
            let command = cli.find_subcommand(both.command).unwrap();
            for id in both.without_axis.iter().chain(both.on_axis) {
                let is_there = command.get_arguments().any(|arg| arg.get_id() == id);
                assert!(is_there, "{} has no {id}", both.command);
            }
        }
    }

    #[test]
    fn an_option_that_would_be_left_unheard_is_refused() {
        let words = ["--port", "sim", "identify", "--machine", "16k20f3"];
        assert!(
            said(&words)
                .unwrap()
                .contains("--machine is for a simulated")
        );
        let words = ["autotune", "--tick-hz", "2500", "--port", "sim"];
        assert!(said(&words).unwrap().contains("--tick-hz"));
        let words = ["calibrate-encoder", "run.vcd", "--room-minus", "3"];
        assert!(said(&words).unwrap().contains("name its port"));
        assert_eq!(
            said(&["--port", "sim", "identify", "--window-mm", "10"]),
            None
        );
        assert_eq!(said(&["identify", "--machine", "16k20f3-bare"]), None);
        assert_eq!(said(&["status", "--port", "sim"]), None);
    }
}
