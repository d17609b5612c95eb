//! What an outer control and a second encoder give to the image: steps, a voltage, counts.

use std::time::Duration;

use leadscrew::scope::{Setup, Signal, Signals, Trigger};
use leadscrew::setpoint::sources::Source;
use leadscrew::supervisor::Fault;
use leadscrew_client::{Axis, ScopePhase};
use leadscrew_emulator::{AxisMachine, Part};
use leadscrew_hal_mock::scenario::{Base, Outer, Scenario, Setting, Trouble, workshop};

use crate::motion::set_up;
use crate::session::Board;

/// So slow that nothing comes.
const STANDS: f64 = 1e-3;
/// Steps of the machine that a trouble lasts: a second.
const LASTS: u32 = 20_000;
/// A spindle that is there, and turns when it is told to.
const SPINDLE: &[Setting] = &[Setting {
    section: "spindle",
    key: "rpm",
    value: 1e-6,
}];

fn wait_ms(tool: &mut Axis, milliseconds: u64) {
    tool.wait(Duration::from_millis(milliseconds)).unwrap();
}

/// An axis that is enabled and follows a source.
fn following(source: Source) -> (Board, Axis) {
    let board = Board::blank();
    let mut tool = board.tool();
    set_up(&mut tool);
    tool.enable().unwrap();
    tool.select(source).unwrap();
    wait_ms(&mut tool, 20);
    (board, tool)
}

#[test]
#[ignore = "needs the image; run by cargo xtask test"]
fn the_setpoint_follows_steps_one_to_one_forward_and_back() {
    let (board, mut tool) = following(Source::StepDir);
    let counts_per_mm = tool.scale().unwrap().counts_per_mm;
    let begin = tool.status().unwrap();
    let mut told = Vec::new();
    // Up to 3 600 mm/min and back again, and more steps than the counter has.
    for (steps_per_s, milliseconds) in [
        (20e3, 100),
        (40e3, 100),
        (60e3, 1_200),
        (30e3, 100),
        (-1e3, 100),
        (-30e3, 200),
        (-10e3, 100),
    ] {
        board.machine(|machine| machine.step_at(steps_per_s));
        wait_ms(&mut tool, milliseconds);
        // The source smooths what jumps, over 24 ms.
        let status = tool.status().unwrap();
        assert_eq!(status.fault_number, 0, "{status:?}");
        told.push(board.machine(|machine| machine.steps()));
    }
    board.machine(|machine| machine.step_at(STANDS));
    wait_ms(&mut tool, 500);
    let (end, steps) = (
        tool.status().unwrap(),
        board.machine(|machine| machine.steps()),
    );
    assert!(told[2] > 1 << 16, "{told:?}");
    let moved = (end.setpoint_mm - begin.setpoint_mm) * counts_per_mm;
    println!("{told:?}, then {steps} steps: the setpoint moved by {moved:.3} d");
    // The link tells whole nm.
    assert!((moved - steps as f64).abs() < 0.01, "{moved} of {steps}");
    assert!(!end.is_moving, "{end:?}");
    let apart = end.following_error_mm * counts_per_mm;
    assert!(apart.abs() < 5.0, "{apart} d from the setpoint");
}

#[test]
#[ignore = "needs the image; run by cargo xtask test"]
fn the_axis_goes_as_fast_as_the_analog_command_says() {
    let (board, mut tool) = following(Source::Analog);
    let deadband = 0.001;
    for level in [0.2, -0.35, 0.0] {
        board.machine(|machine| machine.set_analog(level));
        wait_ms(&mut tool, 700);
        let status = tool.status().unwrap();
        let beyond: f64 = level - deadband * level.signum() * f64::from(level != 0.0);
        let expected = beyond / (1.0 - deadband) * 9000.0;
        println!(
            "{level} of full scale: {:.1} mm/min, expected {expected:.1}",
            status.velocity_mm_per_min
        );
        assert_eq!(status.fault_number, 0, "{status:?}");
        // One step of the converter are 4.4 mm/min; the loop and its estimate have the rest.
        let apart = (status.velocity_mm_per_min - expected).abs();
        assert!(apart < 15.0, "{status:?}, expected {expected}");
    }
}

/// Counts of the second encoder, and its speed, as ticks saw them.
fn master(tool: &mut Axis) -> Vec<[i32; 2]> {
    let setup = Setup {
        signals: Signals::new(&[Signal::MasterCount, Signal::MasterVelocity]).unwrap(),
        every: 1,
        trigger: Trigger::Now,
        pre: 0,
        samples: 50,
    };
    tool.arm_scope(&setup).unwrap();
    let scope = tool.wait_for_scope(Duration::from_secs(1)).unwrap();
    let scope = scope.expect("it ends");
    assert_eq!(scope.phase, ScopePhase::Complete, "{scope:?}");
    let samples = tool.read_scope(&scope).unwrap();
    let pairs = samples.iter().map(|words| words.as_slice().try_into());
    pairs.collect::<Result<_, _>>().unwrap()
}

/// Whole counts of the spindle's encoder since power-on.
fn spindle_count(board: &Board) -> i64 {
    use leadscrew::hal::Encoder as _;
    board.machine(|machine| {
        let spindle = machine.world().spindle.as_ref().expect("there is one");
        i64::from(spindle.capture().count.cast_signed())
    })
}

#[test]
#[ignore = "needs the image; run by cargo xtask test"]
fn the_second_encoder_is_counted_to_the_last_edge_through_wraps_and_back() {
    let scenario = Scenario {
        machine: SPINDLE,
        ..workshop(Base::Full, 1000.0, 1)
    };
    let board = Board::at(AxisMachine::of(&scenario).unwrap(), Part::blank_flash());
    let mut tool = board.tool();
    let (begin, turned) = (master(&mut tool)[0][0], spindle_count(&board));
    for (rpm, milliseconds) in [(1500.0, 2_500), (-600.0, 2_500), (0.0, 800)] {
        board.machine(|machine| machine.world_mut().set(&Outer::SpindleSpeed { rpm }));
        wait_ms(&mut tool, milliseconds);
        let seen = master(&mut tool);
        let per_tick = rpm / 60.0 * 4096.0 / 1000.0;
        let (first, last) = (seen[0], seen[seen.len() - 1]);
        let mean = f64::from(last[0].wrapping_sub(first[0])) / (seen.len() - 1) as f64;
        let velocity = f64::from(last[1]) / f64::from(1 << 20);
        println!(
            "{rpm} rpm: {mean:.2} d/tick counted, {velocity:.2} estimated, {per_tick:.2} turned"
        );
        // Its speed ripples by 1 %.
        let share = 0.02 * per_tick.abs() + 0.5;
        assert!((mean - per_tick).abs() < share && (velocity - per_tick).abs() < share);
    }
    let passed = spindle_count(&board) - turned;
    let counted = master(&mut tool)[0][0].wrapping_sub(begin);
    println!("{counted} d counted of {passed}");
    assert!(passed > 1 << 17, "{passed}");
    assert_eq!(i64::from(counted), passed);
}

#[test]
#[ignore = "needs the image; run by cargo xtask test"]
fn a_gear_keeps_its_ratio_and_a_lost_master_ends_it() {
    // A feed of 1 mm a turn: 4 096 d of the spindle for 1 000 of the axis.
    const RATIO: (f64, f64) = (1000.0, 4096.0);
    let scenario = Scenario {
        machine: SPINDLE,
        ..workshop(Base::Full, 1000.0, 1)
    };
    let board = Board::at(AxisMachine::of(&scenario).unwrap(), Part::blank_flash());
    let mut tool = board.tool();
    set_up(&mut tool);
    tool.edit_parameters(|edit| {
        edit.set_parameter("gearing.gear_axis_counts", RATIO.0)?;
        edit.set_parameter("gearing.gear_master_counts", RATIO.1)
    })
    .unwrap();
    tool.enable().unwrap();
    tool.select(Source::Gearing).unwrap();
    tool.engage_gear(true).unwrap();
    wait_ms(&mut tool, 100);
    let counts_per_mm = tool.scale().unwrap().counts_per_mm;
    let (begin, turned) = (tool.status().unwrap(), spindle_count(&board));
    for (rpm, milliseconds) in [(600.0, 1_500), (-300.0, 1_000), (0.0, 1_500)] {
        board.machine(|machine| machine.world_mut().set(&Outer::SpindleSpeed { rpm }));
        wait_ms(&mut tool, milliseconds);
        let status = tool.status().unwrap();
        assert_eq!(status.fault_number, 0, "{status:?}");
    }
    let end = tool.status().unwrap();
    let moved = (end.setpoint_mm - begin.setpoint_mm) * counts_per_mm;
    let master = (spindle_count(&board) - turned) as f64;
    let expected = master * RATIO.0 / RATIO.1;
    println!("the setpoint moved by {moved:.2} d for {expected:.2}");
    assert!(expected > 5_000.0, "{expected}");
    // A count of the master at each end, and the estimate of where in it the spindle is.
    assert!((moved - expected).abs() < 1.0, "{moved} of {expected}");

    board.machine(|machine| machine.world_mut().set(&Outer::SpindleSpeed { rpm: 300.0 }));
    wait_ms(&mut tool, 500);
    let lost = Trouble::MasterLost;
    board.machine(|machine| machine.world_mut().begin(&lost, LASTS).unwrap());
    wait_ms(&mut tool, 1_000);
    let status = tool.status().unwrap();
    println!("{:?}", status.fault());
    assert_eq!(status.fault(), Some(Fault::SetpointLost), "{status:?}");
    assert!(!status.is_moving, "{status:?}");
}
