//! Machines that cannot be identified, and experiments that are cut short.

use leadscrew::axis::{Axis, Inputs, StartError};
use leadscrew::hal::Encoder;
use leadscrew::identification::experiment::{Ending, Experiment};
use leadscrew::identification::program::{Bounds, Program, Segment, command};
use leadscrew::identification::{Identification, IdentifyParams, Refusal};
use leadscrew::units::Command;
use leadscrew_hal_mock::machine::Machine;

use crate::support::{Bench, MEMORY};

#[test]
fn wrong_polarity_is_found_within_a_few_millimetres() {
    for mut bench in [Bench::bare(), Bench::full()] {
        bench.polarity = -1;
        let outcome = bench.run();
        assert!(
            matches!(outcome.result, Err(Refusal::WrongPolarity { .. })),
            "{:?}",
            outcome.result
        );
        assert!(outcome.furthest_d < 1500.0, "{}", outcome.furthest_d);
        assert_eq!(outcome.last_command, Command::ZERO);
    }
}

#[test]
fn a_dead_encoder_and_a_blocked_axis_are_no_motion() {
    let mut dead = Bench::full();
    dead.machine.mount.coupling_slip = 1.0;
    let mut blocked = Bench::full();
    blocked.machine.drive.friction_mm_per_min = 50_000.0;
    for bench in [dead, blocked] {
        let outcome = bench.run();
        let Err(Refusal::NoMotion { level, moved_d }) = outcome.result else {
            panic!("{:?}", outcome.result);
        };
        // The supervisor may lose patience with the encoder before the largest pulse.
        assert!(level >= 0.04 && moved_d.abs() < 16.0, "{level} {moved_d}");
        assert!(outcome.largest_command <= 0.1601);
    }
}

#[test]
fn a_refusal_says_what_to_do() {
    let mut bench = Bench::full();
    bench.polarity = -1;
    let refusal = bench.run().result.unwrap_err().to_string();
    assert!(refusal.contains("exchange A and B"), "{refusal}");
}

#[test]
fn a_window_that_is_too_small_is_refused() {
    let mut bench = Bench::full();
    bench.params.window_mm = 1.0;
    let outcome = bench.run();
    assert!(outcome.result.is_err(), "{:?}", outcome.result);
    assert!(outcome.furthest_d < 1000.0, "{}", outcome.furthest_d);
}

#[test]
fn parameters_and_memory_are_checked() {
    let bench = Bench::full();
    let mut memory = vec![0; MEMORY];
    let mut params = IdentifyParams {
        proof_distance_mm: 0.01,
        ..IdentifyParams::default()
    };
    let refused = |params: &IdentifyParams, memory: &mut [i32]| {
        Identification::new(params, bench.scale(), 160.0, memory).unwrap_err()
    };
    assert!(matches!(
        refused(&params, &mut memory),
        Refusal::TooCoarse { .. }
    ));
    params.proof_distance_mm = -1.0;
    assert!(matches!(refused(&params, &mut memory), Refusal::Range(_)));
    let few = refused(&IdentifyParams::default(), &mut memory[..100]);
    assert!(matches!(few, Refusal::WorkMemory { given: 100, .. }));
}

/// An axis on the full machine, enabled and at rest.
struct Ready {
    machine: Machine,
    axis: Axis<'static>,
}

impl Ready {
    fn new() -> Self {
        let bench = Bench::full();
        let mut ready = Self {
            machine: Machine::new(&bench.machine, 1000.0, 1).unwrap(),
            axis: bench.axis(),
        };
        ready.run(20, true);
        ready
    }

    fn run(&mut self, ticks: u32, enable: bool) {
        for _ in 0..ticks {
            let outputs = self.axis.outputs();
            self.machine.step(outputs.command, outputs.enabled);
            self.axis.step(&Inputs::of(self.machine.capture(), enable));
        }
    }

    fn ending(&self) -> Option<Ending> {
        self.axis.experiment().and_then(Experiment::ending)
    }
}

fn program(bounds: Bounds) -> Program {
    Program::new(&[Segment::level(0.3, 5000)], bounds)
}

const BOUNDS: Bounds = Bounds {
    window_d: 2000,
    speed_d_per_tick: 100,
    ticks: 400,
    command: Command::ONE,
};

#[test]
fn every_bound_ends_an_experiment_at_zero_command() {
    let slow = Bounds {
        speed_d_per_tick: 20,
        ..BOUNDS
    };
    let short = Bounds {
        ticks: 30,
        ..BOUNDS
    };
    for (bounds, expected) in [
        (BOUNDS, Ending::WindowLeft),
        (slow, Ending::TooFast),
        (short, Ending::TooLong),
    ] {
        let mut ready = Ready::new();
        ready.axis.start_experiment(&program(bounds)).unwrap();
        ready.run(400, true);
        assert_eq!(ready.ending(), Some(expected));
        assert_eq!(ready.axis.outputs().command, Command::ZERO);
        // It braked: bounds are kept but for the way of braking.
        assert!(ready.machine.truth().shaft.position < 2000.0 + 48.0 * 40.0);
    }
}

#[test]
fn a_command_is_bounded_whatever_a_segment_says() {
    let bounds = Bounds {
        command: command(0.01),
        ..BOUNDS
    };
    let mut ready = Ready::new();
    ready.axis.start_experiment(&program(bounds)).unwrap();
    for _ in 0..100 {
        ready.run(1, true);
        assert!(ready.axis.outputs().command <= command(0.01));
    }
}

#[test]
fn an_experiment_ends_on_request_and_with_the_permit() {
    let mut ready = Ready::new();
    ready.axis.start_experiment(&program(BOUNDS)).unwrap();
    ready.run(10, true);
    assert_eq!(
        ready.axis.start_experiment(&program(BOUNDS)),
        Err(StartError::Running)
    );
    ready.axis.abort_experiment();
    ready.run(1, true);
    assert_eq!(ready.ending(), Some(Ending::Aborted));
    assert_eq!(ready.axis.outputs().command, Command::ZERO);

    let mut ready = Ready::new();
    ready.axis.start_experiment(&program(BOUNDS)).unwrap();
    ready.run(10, true);
    ready.run(1, false);
    assert_eq!(ready.ending(), Some(Ending::NotPermitted));
    ready.run(2000, false);
    assert!(!ready.axis.outputs().enabled);
    ready.axis.release_experiment();
    ready.run(2000, true);
    assert_eq!(ready.axis.outputs().command, Command::ZERO);
}

#[test]
fn no_experiment_without_enable_or_in_motion() {
    let bench = Bench::full();
    let mut axis = bench.axis();
    assert_eq!(
        axis.start_experiment(&program(BOUNDS)),
        Err(StartError::NotReady)
    );
    let mut ready = Ready::new();
    ready.axis.start_experiment(&program(BOUNDS)).unwrap();
    ready.run(30, true);
    ready.axis.release_experiment();
    // Still rolling.
    ready.run(1, true);
    assert_eq!(
        ready.axis.start_experiment(&program(BOUNDS)),
        Err(StartError::NotAtRest)
    );
}

#[test]
fn an_excitation_is_added_to_the_closed_loop() {
    let mut ready = Ready::new();
    let excited = program(BOUNDS).closed();
    ready.axis.start_experiment(&excited).unwrap();
    ready.run(5, true);
    assert_eq!(ready.axis.outputs().command, command(0.3));
    ready.axis.abort_experiment();
    ready.run(2, true);
    assert_eq!(ready.axis.outputs().command, Command::ZERO);
}
