//! Child processes: run, run and watched, or just asked.

use std::env;
use std::ffi::OsString;
use std::io::{BufRead, BufReader, Read, Write};
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread;

use crate::Result;

/// A program and its words, run at the workspace root.
pub struct Call {
    command: Command,
    shown: String,
}

/// The workspace root.
pub fn root() -> &'static Path {
    let crate_root = Path::new(env!("CARGO_MANIFEST_DIR"));
    crate_root.parent().unwrap_or(crate_root)
}

/// A call of the cargo that runs us.
pub fn cargo<const N: usize>(words: [&str; N]) -> Call {
    let cargo = env::var_os("CARGO").unwrap_or_else(|| OsString::from("cargo"));
    let mut command = Command::new(cargo);
    command.current_dir(root());
    let call = Call {
        command,
        shown: "cargo".to_owned(),
    };
    call.words(&words)
}

/// A call of `program` on the path.
pub fn program<const N: usize>(program: &str, words: [&str; N]) -> Call {
    let mut command = Command::new(program);
    command.current_dir(root());
    let call = Call {
        command,
        shown: program.to_owned(),
    };
    call.words(&words)
}

impl Call {
    /// Adds words.
    pub fn words(mut self, words: &[&str]) -> Self {
        for word in words {
            self.command.arg(word);
            self.shown.push(' ');
            self.shown.push_str(word);
        }
        self
    }

    /// Adds `--package` for each of `packages`.
    pub fn packages(self, packages: &[&str]) -> Self {
        packages
            .iter()
            .fold(self, |call, package| call.words(&["--package", package]))
    }

    /// Sets a variable of the child's environment.
    pub fn env(mut self, name: &str, value: &str) -> Self {
        self.command.env(name, value);
        self.shown = format!("{name}='{value}' {}", self.shown);
        self
    }

    /// The call as it can be typed.
    pub fn shown(&self) -> &str {
        &self.shown
    }

    /// Runs with our own output; an error names the call.
    pub fn run(mut self) -> Result<()> {
        let status = self.command.stdin(Stdio::null()).status();
        succeeded(&self.shown, status)
    }

    /// Runs quietly; whether it succeeded.
    pub fn succeeds(mut self) -> bool {
        self.command
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .status()
            .is_ok_and(|status| status.success())
    }

    /// Runs with standard error as our own, and gives standard output.
    pub fn output(mut self) -> Result<String> {
        let output = self
            .command
            .stdin(Stdio::null())
            .stderr(Stdio::inherit())
            .output();
        let (status, stdout) = match output {
            Ok(output) => (Ok(output.status), output.stdout),
            Err(e) => (Err(e), Vec::new()),
        };
        let stdout = String::from_utf8_lossy(&stdout).into_owned();
        if !matches!(&status, Ok(status) if status.success()) {
            eprint!("{stdout}");
        }
        succeeded(&self.shown, status).map(|()| stdout)
    }

    /// Runs with its output passed on as it comes; gives the output too, whatever the outcome.
    pub fn watch(mut self) -> (String, Result<()>) {
        let child = self
            .command
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn();
        match child {
            Ok(child) => {
                let (text, status) = pass_on(child);
                (text, succeeded(&self.shown, status))
            }
            Err(e) => (String::new(), succeeded(&self.shown, Err(e))),
        }
    }
}

fn succeeded(shown: &str, status: std::io::Result<ExitStatus>) -> Result<()> {
    match status {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(format!("`{shown}` failed ({status})")),
        Err(e) => Err(format!("cannot run `{shown}`: {e}")),
    }
}

fn pass_on(mut child: Child) -> (String, std::io::Result<ExitStatus>) {
    let stdout = child.stdout.take();
    let stderr = child.stderr.take();
    let errors = thread::spawn(move || copy_lines(stderr, std::io::stderr()));
    let mut text = copy_lines(stdout, std::io::stdout());
    text.push_str(&errors.join().unwrap_or_default());
    (text, child.wait())
}

fn copy_lines(from: Option<impl Read>, mut to: impl Write) -> String {
    let mut text = String::new();
    let Some(from) = from else { return text };
    for line in BufReader::new(from)
        .split(b'\n')
        .map_while(std::result::Result::ok)
    {
        let line = String::from_utf8_lossy(&line).into_owned();
        // Nobody may be listening any more; the text is still needed.
        let _ = writeln!(to, "{line}");
        text.push_str(&line);
        text.push('\n');
    }
    text
}
