//! The peer does what it is known for, and its hand tunings are what the search finds.

use leadscrew_host::tracking::linuxcnc::PidParams;
use leadscrew_host::tracking::linuxcnc::bench::Bench;
use leadscrew_host::tracking::linuxcnc::hand::{self, Manner};
use leadscrew_host::tracking::linuxcnc::margins::Margins;
use leadscrew_host::tracking::linuxcnc::relay::Ultimate;
use leadscrew_host::tracking::scene::Scene;
use leadscrew_host::tracking::trace::MoveFigures;

/// On the bare machine, whose drive has no delay, the loop oscillates where the drive is a quarter turn late: at its
/// natural frequency, with a gain of 2ζω_n, but for the half ticks of hold and sampling and the describing function.
#[test]
fn the_relay_finds_the_ultimate_gain_of_a_drive_that_is_known() {
    let machine = Scene::bare().nominal;
    let bench = Bench::new(&machine, &machine, 1).unwrap();
    let effort = 0.05 * bench.full_d_per_s();
    let ultimate = Ultimate::measure(bench, effort).unwrap();
    let omega = std::f64::consts::TAU / machine.drive.natural_period_s;
    let gain = 2.0 * machine.drive.damping * omega;
    assert!((ultimate.gain / gain - 1.0).abs() < 0.1, "{ultimate:?}");
    let period = machine.drive.natural_period_s;
    assert!(
        (ultimate.period_s / period - 1.0).abs() < 0.1,
        "{ultimate:?}"
    );
}

/// On the bare machine at the acceleration a the drive is 2ζ/ω_n·a slower than it should be; a loop of P = 10/s lets
/// that grow with a time constant of 100 ticks to a hundred times as many d: in 200 ticks of 0.5 d/tick² to 619 d. FF2
/// takes it off and leaves what a step of acceleration lacks in jerk, a/ω_n² = 103 d.
#[test]
fn feedforward_of_acceleration_takes_off_the_drive_s_lag() {
    let scene = Scene::bare();
    let mut place = 0.0;
    let mut speed = 0.0;
    let setpoints: Vec<f64> = (0..4000)
        .map(|tick| {
            speed += match tick {
                100..300 => 0.5,
                1000..1200 => -0.5,
                _ => 0.0,
            };
            place += speed;
            place
        })
        .collect();
    let peak = |ff2| {
        let params = PidParams {
            p: 10.0,
            ff1: 1.0,
            ff2,
            ..PidParams::default()
        };
        let bench = Bench::new(&scene.nominal, &scene.nominal, 1).unwrap();
        MoveFigures::of(&bench.follow(&params, &setpoints)).peak
    };
    let lag = scene.nominal.drive.natural_period_s / std::f64::consts::TAU;
    let (without, with) = (peak(0.0), peak(lag));
    assert!((without / 619.0 - 1.0).abs() < 0.1, "{without}");
    assert!((with / 103.0 - 1.0).abs() < 0.1, "{with}");
}

#[test]
fn the_hand_tunings_have_in_hand_what_they_say() {
    let drive = Scene::of_moves()[1].nominal.drive;
    assert!(Margins::of(&Manner::WithMargins.found(), &drive).suffice());
    assert!(!Margins::of(&Manner::ToTheEdge.found(), &drive).suffice());
}

#[test]
#[ignore = "long: cargo xtask test --long"]
fn the_search_finds_the_reference_again() {
    for manner in Manner::ALL {
        let lessons = hand::lessons(manner).unwrap();
        let tuned = hand::search(&lessons, manner).unwrap();
        assert_eq!(tuned.params, manner.found(), "{manner:?}");
    }
}

/// No gain of the reference alone can be changed by 3 % for a better peak.
#[test]
fn the_reference_cannot_be_bettered_by_a_little() {
    let manner = Manner::WithMargins;
    let lessons = hand::lessons(manner).unwrap();
    let found = hand::judge(&lessons, &manner.found(), manner, f64::INFINITY).unwrap();
    let gains: [fn(&mut PidParams) -> &mut f64; 5] = [
        |params| &mut params.p,
        |params| &mut params.i,
        |params| &mut params.d,
        |params| &mut params.ff1,
        |params| &mut params.ff2,
    ];
    for (index, gain) in gains.iter().enumerate() {
        for factor in [0.97, 1.03] {
            let mut params = manner.found();
            *gain(&mut params) *= factor;
            let tried = hand::judge(&lessons, &params, manner, 0.97 * found.cost).unwrap();
            assert!(
                tried.cost >= 0.97 * found.cost,
                "{index} {factor}: {tried:?} {found:?}"
            );
        }
    }
}
