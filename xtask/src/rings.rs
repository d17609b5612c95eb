//! `cargo xtask test`: everything CI checks, from quick to slow, each ring timed.

use std::process::ExitCode;
use std::time::{Duration, Instant};

use crate::command::{Call, cargo};
use crate::packages::{AXIS_BOARD, BOARDS, CHIPS, EMULATOR, HOST, QEMU, TARGET};
use crate::summary::Tests;
use crate::{Result, bench, deny, image, no_panic, setup, size};

/// Asks tests that repeat something to repeat it often.
const LONG: &str = "LEADSCREW_LONG";

struct Ring {
    name: &'static str,
    work: fn(&Runner) -> Outcome,
}

/// Rings that the short run has.
const RINGS: &[Ring] = &[
    Ring {
        name: "format",
        work: |_| format().into(),
    },
    Ring {
        name: "dependencies",
        work: |_| deny::run().into(),
    },
    Ring {
        name: "clippy host",
        work: |_| clippy_host().into(),
    },
    Ring {
        name: "clippy boards",
        work: |_| clippy_boards().into(),
    },
    Ring {
        name: "board images",
        work: |_| board_images().into(),
    },
    Ring {
        name: "tests on board",
        work: |_| tests_on_board().into(),
    },
    Ring {
        name: "host tests",
        work: Runner::host,
    },
    Ring {
        name: "doc tests",
        work: |_| doc_tests(),
    },
    Ring {
        name: "qemu tests",
        work: Runner::qemu,
    },
    Ring {
        name: "flashed image",
        work: Runner::flashed,
    },
    Ring {
        name: "bench",
        work: |_| bench::run(false).into(),
    },
    Ring {
        name: "sizes",
        work: |_| size::run(false).into(),
    },
    Ring {
        name: "no panic",
        work: |_| no_panic::run().into(),
    },
    Ring {
        name: "documentation",
        work: |_| documentation().into(),
    },
];

/// Rings that `--long` adds.
const LONG_RINGS: &[Ring] = &[
    Ring {
        name: "long host tests",
        work: Runner::long_host,
    },
    Ring {
        name: "long qemu tests",
        work: Runner::long_qemu,
    },
    Ring {
        name: "long flashed",
        work: Runner::long_flashed,
    },
];

/// Tests of other packages that need QEMU, all of them marked `#[ignore]`.
const IN_QEMU: &[(&str, &str)] = &[
    ("leadscrew-host", "axis_in_qemu"),
    ("leadscrew-emulator", "cpu"),
];

/// What a ring came to.
struct Outcome {
    tests: Option<Tests>,
    result: Result<()>,
}

impl From<Result<()>> for Outcome {
    /// A ring without tests.
    fn from(result: Result<()>) -> Self {
        Self {
            tests: None,
            result,
        }
    }
}

struct Report {
    name: &'static str,
    time: Duration,
    outcome: Outcome,
}

/// Sets up and runs all rings, whatever becomes of the ones before.
pub fn run(long: bool) -> Result<ExitCode> {
    let started = Instant::now();
    setup::run()?;
    let runner = Runner::find();
    let mut reports = vec![Report {
        name: "set-up",
        time: started.elapsed(),
        outcome: Ok(()).into(),
    }];
    let long_rings = if long { LONG_RINGS } else { &[] };
    for ring in RINGS.iter().chain(long_rings) {
        println!("\n== {}", ring.name);
        let started = Instant::now();
        let outcome = (ring.work)(&runner);
        let time = started.elapsed();
        if let Err(error) = &outcome.result {
            eprintln!("error: {error}");
        }
        println!("== {} took {:.1} s", ring.name, time.as_secs_f64());
        reports.push(Report {
            name: ring.name,
            time,
            outcome,
        });
    }
    Ok(close(&reports, started.elapsed()))
}

/// The table of rings; the last line sums up the tests of all rings.
fn close(reports: &[Report], time: Duration) -> ExitCode {
    println!("\n{:<16} {:>8}   result", "ring", "seconds");
    let mut total = Tests::default();
    let mut failed = Vec::new();
    for report in reports {
        let Outcome { tests, result } = &report.outcome;
        let word = if result.is_ok() { "ok" } else { "FAILED" };
        let counts =
            tests.map(|tests| format!(", {} passed, {} failed", tests.passed, tests.failed));
        println!(
            "{:<16} {:>8.1}   {word}{}",
            report.name,
            report.time.as_secs_f64(),
            counts.unwrap_or_default()
        );
        total += tests.unwrap_or_default();
        if result.is_err() {
            failed.push(report.name);
        }
    }
    println!("{:<16} {:>8.1}", "all", time.as_secs_f64());
    if !failed.is_empty() {
        println!("rings failed: {}", failed.join(", "));
    }
    println!("{} passed, {} failed", total.passed, total.failed);
    if failed.is_empty() {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}

fn format() -> Result<()> {
    cargo(["fmt", "--all", "--check"]).run()
}

fn clippy_host() -> Result<()> {
    cargo(["clippy", "--all-targets"])
        .packages(HOST)
        .words(&["--", "-D", "warnings"])
        .run()
}

fn clippy_boards() -> Result<()> {
    BOARDS.iter().try_for_each(|(board, target, chip)| {
        cargo(["clippy", "--all-targets", "--package", board])
            .words(&["--target", target])
            .words(chip)
            .words(&["--", "-D", "warnings"])
            .run()
    })
}

/// What is flashed, for every chip of the axis board.
fn board_images() -> Result<()> {
    CHIPS.iter().try_for_each(|(chip, words)| {
        println!("{chip}");
        image::build(AXIS_BOARD, "firmware", words)
    })
}

/// They run on hardware alone; here they are linked.
fn tests_on_board() -> Result<()> {
    cargo([
        "test",
        "--no-run",
        "--package",
        AXIS_BOARD,
        "--target",
        TARGET,
    ])
    .words(&["--profile", "firmware", "--test", "axis_board"])
    .run()
}

fn documentation() -> Result<()> {
    let deny = |call: Call| call.env("RUSTDOCFLAGS", "-D warnings").run();
    deny(cargo(["doc", "--no-deps"]).packages(HOST))?;
    BOARDS.iter().try_for_each(|(board, target, chip)| {
        let doc = cargo(["doc", "--no-deps", "--package", board, "--target", target]);
        deny(doc.words(chip))
    })
}

fn doc_tests() -> Outcome {
    tests(cargo(["test", "--doc"]).packages(HOST))
}

/// As [`tests_if_any`], but no test at all is a failure.
fn tests(call: Call) -> Outcome {
    let mut outcome = tests_if_any(call);
    if outcome.result.is_ok() && outcome.tests.is_none_or(|tests| tests.passed == 0) {
        outcome.result = Err("no test ran".to_owned());
    }
    outcome
}

/// Runs a test runner and counts from what it prints.
fn tests_if_any(call: Call) -> Outcome {
    println!("{}", call.shown());
    let (text, result) = call.watch();
    let tests = Tests::read(&text);
    let result = match result {
        Ok(()) if tests.failed > 0 => Err("tests failed".to_owned()),
        result => result,
    };
    Outcome {
        tests: Some(tests),
        result,
    }
}

/// nextest if it is installed, else cargo's own.
struct Runner {
    nextest: bool,
}

impl Runner {
    fn find() -> Self {
        Self {
            nextest: cargo(["nextest", "--version"]).succeeds(),
        }
    }

    fn host(&self) -> Outcome {
        tests(self.call(Choice::Plain))
    }

    fn qemu(&self) -> Outcome {
        self.in_qemu(|call| call)
    }

    /// Those of the harness, and those of other packages; one call of nextest has all.
    fn in_qemu(&self, prepare: impl Fn(Call) -> Call) -> Outcome {
        let harness = tests(prepare(self.call(Choice::Qemu)));
        if self.nextest {
            return harness;
        }
        let mut sum = harness.tests.unwrap_or_default();
        let mut result = harness.result;
        for (package, binary) in IN_QEMU {
            let call = cargo(["test", "--no-fail-fast", "--package", package]);
            let call = call.words(&["--test", binary, "--", "--ignored"]);
            let others = tests(prepare(call));
            sum += others.tests.unwrap_or_default();
            result = result.and(others.result);
        }
        Outcome {
            tests: Some(sum),
            result,
        }
    }

    fn long_host(&self) -> Outcome {
        tests_if_any(self.call(Choice::LongHost).env(LONG, "1"))
    }

    fn long_qemu(&self) -> Outcome {
        self.in_qemu(|call| call.env(LONG, "1"))
    }

    fn flashed(&self) -> Outcome {
        self.on_the_image(|call| call)
    }

    fn long_flashed(&self) -> Outcome {
        self.on_the_image(|call| call.env(LONG, "1"))
    }

    /// Those that run the image that is flashed, which is built before.
    fn on_the_image(&self, prepare: impl Fn(Call) -> Call) -> Outcome {
        match image::build(AXIS_BOARD, "firmware", &[]) {
            Ok(()) => tests(prepare(self.call(Choice::Flashed))),
            Err(error) => Err(error).into(),
        }
    }

    fn call(&self, choice: Choice) -> Call {
        if self.nextest {
            let call = cargo(["nextest", "run", "--no-fail-fast", "--no-tests", "pass"]);
            let others = IN_QEMU
                .iter()
                .map(|(package, binary)| format!(" or (package({package}) and binary({binary}))"));
            let of_qemu = format!("(package({QEMU}){})", others.collect::<String>());
            let filter = match choice {
                Choice::Plain => return call.packages(HOST),
                Choice::Qemu => of_qemu,
                Choice::Flashed => format!("package({EMULATOR}) and binary(firmware)"),
                Choice::LongHost => format!("not ({of_qemu} or package({EMULATOR}))"),
            };
            call.packages(HOST)
                .words(&["--run-ignored", "only", "-E", &filter])
        } else {
            let call = cargo(["test", "--no-fail-fast", "--all-targets"]);
            let is_other = |name: &&str| ![QEMU, EMULATOR].contains(name);
            let others: Vec<_> = HOST.iter().copied().filter(is_other).collect();
            let packages: &[&str] = match choice {
                Choice::Plain => return call.packages(HOST),
                Choice::Qemu => &[QEMU],
                Choice::Flashed => &[EMULATOR],
                Choice::LongHost => &others,
            };
            call.packages(packages).words(&["--", "--ignored"])
        }
    }
}

/// Which tests.
#[derive(Clone, Copy)]
enum Choice {
    /// Those not marked `#[ignore]`.
    Plain,
    /// The ignored ones of the QEMU harness: they need QEMU.
    Qemu,
    /// The ignored ones of the emulated part: they need the image that is flashed.
    Flashed,
    /// The ignored ones of the others: they take long.
    LongHost,
}
