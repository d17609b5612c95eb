//! The firmware in QEMU and the simulation on the host are the same run, bit for bit.

use leadscrew::estimator::EstimatorConfig;
use leadscrew_hal_mock::machine::MachineParams;
use leadscrew_hal_mock::scenario::{BUILT_IN, MoveAndBack, Runner, Simulation};
use leadscrew_qemu::{Run, build};

/// Runs of the firmware at each rate.
fn repeats() -> usize {
    if std::env::var_os("LEADSCREW_LONG").is_some() {
        10
    } else {
        2
    }
}

/// Digest of the standard move on the host, as the firmware logs it.
fn host_digest(tick_hz: u32, estimator: &str) -> String {
    let estimator = EstimatorConfig::by_name(estimator).unwrap().unwrap();
    let scenario = MoveAndBack::standard(f64::from(tick_hz));
    let machine = MachineParams::z_16k20f3();
    let mut simulation = Simulation::prepare(&scenario, &machine, estimator, 1).unwrap();
    while simulation.step().unwrap().is_some() {}
    format!(
        "digest {:016x} of {} ticks",
        simulation.digest(),
        simulation.ticks()
    )
}

fn the_same_in_qemu(tick_hz: u32, estimator: &str, repeats: usize) {
    let expected = host_digest(tick_hz, estimator);
    let run = Run::new(build("axis", "firmware").unwrap())
        .arg(format!("tick-hz={tick_hz}"))
        .arg(format!("estimator={estimator}"));
    for _ in 0..repeats {
        let output = run.run().unwrap();
        assert_eq!(output.exit_code, 0, "{output}");
        let found = output.log_lines.iter().any(|line| line.message == expected);
        assert!(found, "expected `{expected}` in\n{output}");
        let in_time = output
            .log_lines
            .iter()
            .any(|line| line.message.contains("late 0 overlong 0"));
        assert!(in_time, "{output}");
    }
}

#[test]
#[ignore = "needs QEMU; run by cargo xtask test"]
fn the_standard_move_at_1000_hz_is_that_of_the_host() {
    the_same_in_qemu(1000, "exponential", repeats());
}

#[test]
#[ignore = "needs QEMU; run by cargo xtask test"]
fn the_standard_move_at_2500_hz_is_that_of_the_host() {
    the_same_in_qemu(2500, "exponential", repeats());
}

#[test]
#[ignore = "needs QEMU; run by cargo xtask test"]
fn estimation_from_edge_times_is_that_of_the_host() {
    the_same_in_qemu(1000, "polynomial", 1);
    the_same_in_qemu(1000, "observer", 1);
}

#[test]
#[ignore = "needs QEMU; run by cargo xtask test"]
fn scenarios_are_those_of_the_host() {
    for (name, scenario) in BUILT_IN {
        let mut runner = Runner::new(scenario).unwrap();
        let mut refused = 0;
        while runner
            .step(|happening| refused += u32::from(happening.refused.is_some()))
            .is_some()
        {}
        assert_eq!((refused, runner.violation()), (0, None), "{name}");
        let expected = format!(
            "digest {:016x} of {} ticks",
            runner.digest(),
            runner.ticks()
        );
        let run = Run::new(build("axis", "firmware").unwrap()).arg(format!("scenario={name}"));
        let output = run.run().unwrap();
        assert_eq!(output.exit_code, 0, "{output}");
        let found = output.log_lines.iter().any(|line| line.message == expected);
        assert!(found, "expected `{expected}` in\n{output}");
    }
}
