//! The whole machine: what the encoder is coupled to, and that a seed determines everything.

use leadscrew::hal::Encoder;
use leadscrew::units::Command;
use leadscrew_hal_mock::carriage::CarriageParams;
use leadscrew_hal_mock::encoder::EncoderModel;
use leadscrew_hal_mock::machine::{Machine, MachineParams, MountParams, START_D};

fn machine(params: &MachineParams) -> Machine {
    Machine::new(params, 1000.0, 1).unwrap()
}

fn bare() -> MachineParams {
    MachineParams::z_16k20f3().bare()
}

/// Commands that start, reverse, creep and stop, 400 ticks each.
const DEMANDS: [f64; 6] = [0.3, -0.3, 0.01, -0.01, 0.9, 0.0];

/// Runs `machine` through [`DEMANDS`].
fn exercise(machine: &mut Machine, mut look: impl FnMut(&mut Machine)) {
    for demand in DEMANDS {
        for _ in 0..400 {
            machine.step(Command::from_num(demand), true);
            look(machine);
        }
    }
}

/// True where a position is too near a boundary for the rounding of the edge search, 2⁻³⁰ d.
fn on_boundary(position: f64) -> bool {
    (position - position.round()).abs() < 1e-9
}

#[test]
fn it_stands_in_the_middle_of_a_discrete_until_it_is_told() {
    assert_eq!(machine(&bare()).capture().count, 0);
    let mut machine = machine(&MachineParams::z_16k20f3());
    let count = machine.capture().count as i32;
    assert!(count.abs() <= 2);
    for _ in 0..100 {
        // The offset of −0.5 % is below static friction.
        machine.step(Command::ZERO, true);
        let capture = machine.capture();
        // A real encoder's boundaries lie elsewhere, by up to two d.
        assert_eq!(capture.count as i32, count);
        assert_eq!(
            (capture.last_edge_at, capture.edges.concat().len()),
            (None, 0)
        );
        assert_eq!(machine.truth().shaft.position, START_D);
    }
}

#[test]
fn bare_the_encoder_counts_the_shaft_and_the_carriage_is_there() {
    exercise(&mut machine(&bare()), |machine| {
        let truth = machine.truth();
        let position = truth.shaft.position;
        assert!((truth.carriage.position - position).abs() < 1e-9);
        if !on_boundary(position) {
            assert_eq!(machine.capture().count as i32, position.floor() as i32);
        }
    });
}

#[test]
fn play_in_the_coupling_takes_half_a_discrete_from_the_encoder() {
    let params = MachineParams {
        mount: MountParams {
            coupling_play_mm: 0.0005,
            ..bare().mount
        },
        ..bare()
    };
    let (mut least, mut most) = (0.0_f64, 0.0_f64);
    exercise(&mut machine(&params), |machine| {
        let truth = machine.truth();
        let behind = truth.carriage.position - truth.shaft.position;
        (least, most) = (least.min(behind), most.max(behind));
    });
    // The bare carriage is where the drive's shaft is; the encoder trails it by half the play either way.
    assert!(
        (most - 0.25).abs() < 1e-9 && (least + 0.25).abs() < 1e-9,
        "{least} to {most}"
    );
}

#[test]
fn play_is_taken_up_without_the_encoder_turning_back() {
    // 0.2 mm, so that the shaft comes to the other end of the play at speed, and a resolution at which it
    // leaves an end with some d/tick.
    let params = MachineParams {
        mount: MountParams {
            counts_per_mm: 20_000.0,
            coupling_play_mm: 0.2,
            ..bare().mount
        },
        ..bare()
    };
    let mut machine = machine(&params);
    let mut count = machine.capture().count;
    exercise(&mut machine, |machine| {
        let capture = machine.capture();
        let moved = capture
            .count
            .wrapping_sub(count)
            .cast_signed()
            .unsigned_abs() as usize;
        assert_eq!(
            capture.edges.concat().len(),
            moved,
            "edges of a shaft that does not turn back within the tick"
        );
        count = capture.count;
    });
}

#[test]
fn a_linear_scale_puts_the_backlash_into_the_loop() {
    let params = MachineParams {
        carriage: CarriageParams {
            backlash_mm: 0.003,
            ..bare().carriage
        },
        mount: MountParams {
            linear_scale: 1.0,
            ..bare().mount
        },
        ..bare()
    };
    let mut scaled = machine(&params);
    // The same drive with the encoder on the screw, for where the shaft is.
    let mut direct = machine(&bare());
    let (mut least, mut most) = (0.0_f64, 0.0_f64);
    exercise(&mut scaled, |scaled| {
        assert_eq!(
            scaled.truth().shaft.position,
            scaled.truth().carriage.position
        );
    });
    let mut scaled = machine(&params);
    for demand in DEMANDS {
        for _ in 0..400 {
            scaled.step(Command::from_num(demand), true);
            direct.step(Command::from_num(demand), true);
            let position = scaled.truth().shaft.position;
            let behind = direct.truth().shaft.position - position;
            (least, most) = (least.min(behind), most.max(behind));
            if !on_boundary(position) {
                assert_eq!(scaled.capture().count as i32, position.floor() as i32);
            }
        }
    }
    assert!(
        (most - 1.5).abs() < 1e-9 && (least + 1.5).abs() < 1e-9,
        "{least} to {most}"
    );
}

#[test]
fn a_slipping_coupling_takes_its_share_from_the_encoder_and_none_from_the_tachogenerator() {
    for lost in [1.0, 0.4] {
        let params = MachineParams {
            mount: MountParams {
                coupling_slip: lost,
                slip_from_s: 0.5,
                ..bare().mount
            },
            ..bare()
        };
        let (mut slipping, mut sound) = (machine(&params), machine(&bare()));
        let mut start = None;
        for tick in 0..1000 {
            let command = Command::lit("0.5");
            slipping.step(command, true);
            sound.step(command, true);
            let (seen, shaft) = (slipping.truth().shaft, sound.truth().shaft);
            assert_eq!(slipping.read_tachogenerator(), sound.read_tachogenerator());
            if tick < 500 {
                assert_eq!((seen, slipping.capture()), (shaft, sound.capture()));
                start = Some(shaft.position);
                continue;
            }
            let way = (shaft.position - start.unwrap()) * (1.0 - lost);
            assert!((seen.position - start.unwrap() - way).abs() < 1e-8);
            assert!((seen.velocity - shaft.velocity * (1.0 - lost)).abs() < 1e-12);
            if !on_boundary(seen.position) {
                assert_eq!(
                    slipping.capture().count as i32,
                    seen.position.floor() as i32
                );
            }
        }
        // At 80 d/tick for half a second.
        assert!(sound.truth().shaft.position - start.unwrap() > 30_000.0);
    }
}

/// Counts and times of a run.
fn trace(params: &MachineParams, seed: u64) -> Vec<(u32, u32, Vec<u32>)> {
    let mut seen = Vec::new();
    exercise(
        &mut Machine::new(params, 1000.0, seed).unwrap(),
        |machine| {
            let capture = machine.capture();
            seen.push((capture.count, capture.sampled_at, capture.edges.concat()));
        },
    );
    seen
}

#[test]
fn a_seed_determines_everything_and_another_gives_another_machine() {
    let full = MachineParams::z_16k20f3();
    assert!(trace(&full, 7) == trace(&full, 7));
    assert!(trace(&full, 7) != trace(&full, 8));
    let ideal = MachineParams {
        encoder: EncoderModel::ideal(),
        ..full
    };
    assert!(
        trace(&ideal, 7) == trace(&ideal, 8),
        "nothing is drawn for an ideal encoder"
    );
}

#[test]
fn a_copy_goes_on_like_the_original() {
    let mut machine = machine(&MachineParams::z_16k20f3());
    exercise(&mut machine, |_| ());
    let mut copy = machine.clone();
    for _ in 0..500 {
        machine.step(Command::lit("0.2"), true);
        copy.step(Command::lit("0.2"), true);
        assert_eq!(machine.capture(), copy.capture());
        assert_eq!(machine.truth(), copy.truth());
    }
}
