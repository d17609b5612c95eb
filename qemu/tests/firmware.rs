//! The firmware in QEMU.

use std::time::Duration;

use leadscrew_qemu::{Error, LARGEST_SHIFT, Output, Run, build};

fn axis() -> Run {
    Run::new(build("axis", "firmware").unwrap())
}

fn ended_well(run: &Run) -> Output {
    let output = run.run().unwrap();
    assert_eq!(output.exit_code, 0, "{output}");
    output
}

fn has_line(output: &Output, part: &str) -> bool {
    output
        .log_lines
        .iter()
        .any(|line| line.message.contains(part))
}

#[test]
#[ignore = "needs QEMU; run by cargo xtask test"]
fn runs_are_identical_to_the_byte() {
    for tick_hz in [1_000, 2_500] {
        // 200 ms, in which the board's clock wraps once.
        let run = axis()
            .arg(format!("tick-hz={tick_hz}"))
            .arg(format!("ticks={}", tick_hz / 5));
        let first = ended_well(&run);
        assert!(has_line(&first, "late 0 overlong 0"), "{first}");
        assert!(!first.log_bytes.is_empty());
        let second = ended_well(&run);
        assert!(
            first.log_bytes == second.log_bytes,
            "{first}\nand\n{second}"
        );
    }
}

#[test]
#[ignore = "needs QEMU; run by cargo xtask test"]
fn time_goes_on_through_the_wrap_of_the_boards_clock() {
    let output = ended_well(&axis().arg("tick-hz=1000").arg("ticks=200"));
    let times: Vec<f64> = output
        .log_lines
        .iter()
        .map(|line| line.timestamp.parse().unwrap())
        .collect();
    assert!(times.is_sorted(), "{output}");
    let last = times.last().unwrap();
    assert!((0.2..0.202).contains(last), "{output}");
}

#[test]
#[ignore = "needs QEMU; run by cargo xtask test"]
fn a_machine_that_is_not_done_in_time_fails_the_run() {
    // 1 µs an instruction: the 25 of a period at 40 kHz are too few for anything.
    let run = axis()
        .shift(LARGEST_SHIFT)
        .arg("tick-hz=40000")
        .arg("ticks=50");
    let output = run.run().unwrap();
    assert_eq!(output.exit_code, 1, "{output}");
    assert!(has_line(&output, "ticks 50 late"), "{output}");
    assert!(!has_line(&output, "late 0"), "{output}");
    assert!(has_line(&output, "failed: ticks were late"), "{output}");
}

#[test]
#[ignore = "needs QEMU; run by cargo xtask test"]
fn a_bad_argument_is_refused_with_what_is_allowed() {
    for (word, reason) in [
        ("tick-hz=0", "100"),
        ("tick-hz=1000000000", "40000"),
        ("speed=3", "UnknownKey"),
    ] {
        let output = axis().arg(word).run().unwrap();
        assert_eq!(output.exit_code, 1, "{output}");
        assert!(
            has_line(&output, word) && has_line(&output, reason),
            "{output}"
        );
    }
}

#[test]
#[ignore = "needs QEMU; run by cargo xtask test"]
fn a_guest_that_does_not_end_is_killed_and_its_log_kept() {
    let run = axis()
        .arg("ticks=864000000")
        .timeout(Duration::from_secs(2));
    match run.run() {
        Err(Error::Timeout { log, .. }) => assert!(!log.is_empty()),
        other => panic!("expected a timeout, got {other:?}"),
    }
}
