//! The parts beside the gains: filter sections, prediction, friction, dead time.

use leadscrew::controller::biquad::{Section, State};
use leadscrew::controller::config::{Config, Extras, Gains};
use leadscrew::controller::friction::{Config as FrictionConfig, Friction, State as FrictionState};
use leadscrew::controller::learning::State as Learned;
use leadscrew::controller::{Controller, dead_time};
use leadscrew::estimator::{Delay, Lags};
use leadscrew::setpoint::{Setpoint, Turn};
use leadscrew::units::{Acceleration, Command, Jerk, Velocity};

use crate::signals::{LSB, demanded, standing};

const FULL: i32 = 1 << Command::FRAC_NBITS;

#[test]
fn a_section_ends_at_a_constant_input_to_two_lsb_and_stays_there() {
    for section in [
        Section::low_pass(0.01, 0.7).unwrap(),
        Section::low_pass(0.3, 0.1).unwrap(),
        Section::notch(0.06, 0.05).unwrap(),
    ] {
        for input in [0, 1, -1, 12_345, FULL / 3, -FULL] {
            let mut state = State::steady(FULL / 7);
            for _ in 0..20_000 {
                state.step(&section, input);
            }
            for _ in 0..2_000 {
                let left = state.step(&section, input) - input;
                assert!(left.abs() <= 2, "{section:?} {input}: {left}");
            }
        }
    }
}

#[test]
fn a_notch_takes_its_frequency_out_and_a_low_pass_what_is_above() {
    let peak = |section: &Section, share: f64| {
        let mut state = State::steady(0);
        let mut peak = 0.0_f64;
        for tick in 0..8_000 {
            let angle = std::f64::consts::TAU * share * f64::from(tick);
            let output = state.step(section, (0.1 * f64::from(FULL) * angle.sin()) as i32);
            if tick > 6_000 {
                peak = peak.max(f64::from(output).abs() / (0.1 * f64::from(FULL)));
            }
        }
        peak
    };
    let notch = Section::notch(0.06, 0.2).unwrap();
    assert!(peak(&notch, 0.06) < 1e-4);
    assert!((peak(&notch, 0.005) - 1.0).abs() < 0.01);
    let low_pass = Section::low_pass(0.02, 0.7).unwrap();
    // Two octaves and more above: (f/f₀)² = 25 down.
    assert!(peak(&low_pass, 0.1) < 0.045);
    assert!((peak(&low_pass, 0.002) - 1.0).abs() < 0.01);
}

#[test]
fn frequencies_that_a_tick_cannot_carry_are_refused() {
    for share in [0.0, 0.5, f64::NAN] {
        assert!(Section::notch(share, 0.5).is_err());
        assert!(Section::low_pass(share, 0.5).is_err());
    }
}

fn moving(velocity: f64) -> Setpoint {
    Setpoint {
        velocity: Velocity::from_num(velocity),
        ..Setpoint::default()
    }
}

#[test]
fn friction_follows_the_stribeck_curve_by_direction_and_comes_at_its_rate() {
    let friction = Friction {
        kinetic: [0.01, 0.02],
        breakaway: [0.02, 0.05],
        stribeck: 1.0,
        least_speed: 0.001,
        rise_ticks: 10.0,
        lead_ticks: 2.5,
        dead_ticks: 0.0,
    };
    let config = FrictionConfig::new(&friction).unwrap();
    for (speed, level) in [
        (0.01, 0.02),
        (1.0, 0.015),
        (100.0, 0.01),
        (-1.0, -0.035),
        (-100.0, -0.02),
        (0.0, 0.0),
    ] {
        let mut state = FrictionState::new();
        let mut before = 0;
        for _ in 0..100 {
            let now = state.step(&config, &moving(speed), &Learned::new());
            assert!((now - before).abs() <= (0.005 * f64::from(FULL)) as i32 + 1);
            before = now;
        }
        let seen = f64::from(before) / f64::from(FULL);
        assert!((seen - level).abs() < 2e-5, "{speed}: {seen}");
    }
}

#[test]
fn what_a_dead_time_swallows_is_given_back_whole() {
    let config = dead_time::Config::new(5.0, 0.0, 1e-4).unwrap();
    let mut state = dead_time::State::new();
    let law = |sign: i32| sign * (FULL / 10);
    for _ in 0..20 {
        assert_eq!(state.step(&config, law(1), 0, false).0, law(1));
    }
    let mut extra = 0;
    for tick in 0..300 {
        let given = state.step(&config, law(-1), 0, false).0 - law(-1);
        assert!(tick >= 5 || given == 0);
        extra += given;
    }
    // What is owed has 24 fractional bits, and up to eight of its units stay.
    assert!((extra - 5 * law(-1)).abs() <= 8 << 6, "{extra}");
}

#[test]
fn filters_neither_kick_at_a_change_nor_leave_an_offset() {
    let gains = Gains {
        position: 0.01,
        ..Gains::default()
    };
    let with = |sections, taps| {
        let extras = Extras {
            sections,
            taps,
            ..Extras::default()
        };
        Config::with_extras(
            &gains,
            Delay::from(&Lags::default()),
            0.0,
            0.0,
            20.0,
            &extras,
        )
        .unwrap()
    };
    let plain = with([None, None], [0.0; 8]);
    let filtered = with(
        [Some(Section::low_pass(0.02, 0.7).unwrap()), None],
        [0.0; 8],
    );
    let mut taps = [0.0; 8];
    taps[0] = 0.3;
    taps[1] = 0.1;
    let predicted = with([None, None], taps);
    let mut controller = Controller::new(plain);
    let signals = standing(20.0);
    let mut last = 0.0;
    for (config, end) in [(plain, 0.2), (filtered, 0.2), (predicted, 0.2 / 1.4)] {
        controller.reconfigure(config, Command::from_num(last));
        for tick in 0..1000 {
            let now = demanded(&mut controller, &signals);
            // The jump is let in over 20 ticks.
            assert!((now - last).abs() <= 0.2 / 20.0 + LSB, "tick {tick}");
            last = now;
        }
        assert!((last - end).abs() < 1e-8, "{last}");
    }
}

#[test]
fn before_an_announced_start_half_of_the_kinetic_level_turns_the_command_in_time() {
    let friction = Friction {
        kinetic: [0.01, 0.02],
        breakaway: [0.02, 0.05],
        stribeck: 1.0,
        least_speed: 0.001,
        rise_ticks: 1.0,
        lead_ticks: 3.0,
        dead_ticks: 5.0,
    };
    let config = FrictionConfig::new(&friction).unwrap();
    assert_eq!(config.notice(), 8);
    for (jerk, level) in [(0.1, 0.005), (-0.1, -0.01)] {
        let before = |ticks| Setpoint {
            turn: Turn {
                ticks,
                jerk: Jerk::from_num(jerk),
            },
            ..Setpoint::default()
        };
        let level_at = |ticks| {
            let mut state = FrictionState::new();
            let level = state.step(&config, &before(ticks), &Learned::new());
            f64::from(level) / f64::from(FULL)
        };
        assert_eq!(level_at(9), 0.0);
        assert!((level_at(8) - level).abs() < 1e-6, "{}", level_at(8));
        // 2.5 ticks into the motion the level is that of its speed, near the static one.
        assert!(level_at(0).abs() > 3.0 * level.abs(), "{}", level_at(0));
    }
}

#[test]
fn at_the_end_of_a_motion_the_level_goes_with_the_speed_and_not_beyond() {
    let friction = Friction {
        kinetic: [0.01; 2],
        breakaway: [0.02; 2],
        stribeck: 1.0,
        least_speed: 0.001,
        rise_ticks: 1.0,
        lead_ticks: 3.0,
        dead_ticks: 0.0,
    };
    let config = FrictionConfig::new(&friction).unwrap();
    // The last ticks of a stop with the jerk 0.01: v = j·n²/2, a = −j·n.
    for left in 0..4_u32 {
        let n = f64::from(left);
        let setpoint = Setpoint {
            velocity: Velocity::from_num(0.005 * n * n),
            acceleration: Acceleration::from_num(-0.01 * n),
            jerk: Jerk::from_num(0.01),
            turn: Turn {
                ticks: left,
                jerk: Jerk::ZERO,
            },
            ..Setpoint::default()
        };
        let level = FrictionState::new().step(&config, &setpoint, &Learned::new());
        assert_eq!(level, 0, "{left} ticks before the end");
    }
}
