//! Runs of the full machine under the check.

use leadscrew::estimator::EstimatorConfig;
use leadscrew::tachogenerator::{Config, CrossCheck, Disagreement, TachogeneratorParams};
use leadscrew::units::{AxisScale, Velocity};
use leadscrew_hal_mock::machine::MachineParams;
use leadscrew_hal_mock::scenario::{MoveAndBack, Simulation};

/// What a run came to.
pub struct Watched {
    pub check: CrossCheck,
    /// The disagreement after each tick.
    pub seen: Vec<Option<Disagreement>>,
    /// True velocity of the motor at each tick, by the tachogenerator, d/tick.
    pub speed: Vec<f64>,
}

impl Watched {
    /// First tick with a disagreement.
    pub fn first(&self) -> Option<usize> {
        self.seen.iter().position(Option::is_some)
    }
}

/// The axis in a move under the check, its readings changed by `wired`.
pub fn watch(
    machine: &MachineParams,
    scenario: &MoveAndBack,
    estimator: &str,
    seed: u64,
    wired: impl Fn(usize, f64) -> f64,
) -> Watched {
    let estimator = EstimatorConfig::by_name(estimator).unwrap().unwrap();
    let mut simulation = Simulation::prepare(scenario, machine, estimator, seed).unwrap();
    let scale = AxisScale::new(machine.mount.counts_per_mm, scenario.tick_hz).unwrap();
    let config = Config::new(&TachogeneratorParams::default(), scale).unwrap();
    let mut watched = Watched {
        check: CrossCheck::new(config),
        seen: Vec::new(),
        speed: Vec::new(),
    };
    while let Some(outputs) = simulation.step().unwrap() {
        let reading = simulation.machine.read_tachogenerator();
        let told = Velocity::saturating_from_num(wired(watched.seen.len(), reading));
        let estimate = outputs.estimate;
        let found = watched
            .check
            .update(estimate.velocity, estimate.lags.velocity, told);
        watched.seen.push(found);
        watched.speed.push(reading);
    }
    watched
}

fn no_alarm(scenario: &MoveAndBack, estimator: &str, seed: u64) -> Watched {
    let machine = MachineParams::z_16k20f3();
    let watched = watch(&machine, scenario, estimator, seed, |_, reading| reading);
    let first = watched.first();
    assert_eq!(first, None, "{estimator}, {scenario:?}, seed {seed}");
    assert_eq!(watched.check.health().disagreements, 0);
    watched
}

#[test]
fn the_standard_move_raises_no_alarm_and_finds_the_gain() {
    for estimator in EstimatorConfig::NAMES {
        for (tick_hz, seed) in [
            (1000.0, 1),
            (1000.0, 2),
            (1000.0, 3),
            (2500.0, 1),
            (2500.0, 2),
        ] {
            let watched = no_alarm(&MoveAndBack::standard(tick_hz), estimator, seed);
            assert!(watched.check.is_learned());
            let gain: f64 = watched.check.gain().to_num();
            let offset: f64 = watched.check.offset().to_num();
            assert!((gain - 1.0).abs() < 0.005, "{estimator}: gain {gain}");
            assert!(offset.abs() < 0.15, "{estimator}: offset {offset}");
        }
    }
}

#[test]
fn neither_rest_nor_creep_raises_an_alarm() {
    // 60 mm/min is 1 d/tick, where friction makes the axis stick and slip; 0.2 mm/s is 0.2 d/tick, below a step of the
    // oscilloscope.
    for (feed_mm_per_min, move_mm) in [(60.0, 2.0), (12.0, 0.4), (600.0, 20.0), (9000.0, 0.0)] {
        let scenario = MoveAndBack {
            feed_mm_per_min,
            move_mm,
            dwell_s: 1.0,
            ..MoveAndBack::standard(1000.0)
        };
        for estimator in EstimatorConfig::NAMES {
            no_alarm(&scenario, estimator, 1);
        }
    }
}

#[test]
fn a_coupling_with_play_and_a_scale_on_the_carriage_raise_no_alarm() {
    let mut play = MachineParams::z_16k20f3();
    play.mount.coupling_play_mm = 0.0005;
    let mut scale = MachineParams::z_16k20f3();
    scale.mount.linear_scale = 1.0;
    for machine in [play, scale] {
        let scenario = MoveAndBack::standard(1000.0);
        let watched = watch(&machine, &scenario, "exponential", 1, |_, reading| reading);
        assert_eq!(watched.first(), None);
    }
}
