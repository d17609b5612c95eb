//! Between screw and carriage: resonance, screw error, play.

use leadscrew::units::AxisScale;
use leadscrew_hal_mock::arc::State;
use leadscrew_hal_mock::carriage::{Carriage, CarriageParams};

fn carriage(params: &CarriageParams, tick_hz: f64) -> Carriage {
    Carriage::new(params, AxisScale::new(1000.0, tick_hz).unwrap(), 0.0).unwrap()
}

fn bare() -> CarriageParams {
    CarriageParams::default().bare()
}

/// Position of the carriage when the shaft has gone to `position` in one step.
fn follow(carriage: &mut Carriage, position: f64) -> f64 {
    carriage.step(State {
        position,
        ..State::default()
    });
    carriage.state().position
}

#[test]
fn bare_it_is_where_the_shaft_is() {
    let mut carriage = carriage(&bare(), 1000.0);
    for position in [0.0, 0.25, 100.0, -7.5] {
        assert_eq!(follow(&mut carriage, position), position);
    }
}

#[test]
fn it_rings_at_60_hz_with_a_damping_of_a_twentieth() {
    // The trapezoidal rule lowers a frequency by (ωT)²/12: 1.2 % at 1 kHz, 0.2 % at 2.5 kHz.
    for (tick_hz, bound) in [(1000.0, 0.013), (2500.0, 0.0025)] {
        let params = CarriageParams {
            resonance_hz: 60.0,
            resonance_damping: 0.05,
            ..bare()
        };
        let mut carriage = carriage(&params, tick_hz);
        let swing: Vec<f64> = (0..1000)
            .map(|_| follow(&mut carriage, 1.0) - 1.0)
            .collect();
        // Rising passages through the rest position, by linear interpolation.
        let passages: Vec<f64> = swing
            .windows(2)
            .enumerate()
            .filter(|(_, pair)| pair[0] < 0.0 && pair[1] >= 0.0)
            .map(|(tick, pair)| tick as f64 + pair[0] / (pair[0] - pair[1]))
            .collect();
        let period = (passages[5] - passages[0]) / 5.0 / tick_hz;
        let natural_hz = 1.0 / period / (1.0_f64 - 0.05 * 0.05).sqrt();
        assert!(
            (natural_hz / 60.0 - 1.0).abs() < bound,
            "{tick_hz} Hz: {natural_hz} Hz"
        );
        // Energy-like amplitude over five periods, taken as the rms of each.
        let rms = |from: f64| {
            let (first, end) = (from as usize, (from + period * tick_hz) as usize);
            super::statistics::mean_and_sigma(&swing[first..end]).1
        };
        let decrement = (rms(passages[0]) / rms(passages[5])).ln() / (5.0 * std::f64::consts::TAU);
        let damping = decrement / decrement.hypot(1.0);
        // The period is not a whole number of ticks: the rms leaves out up to a seventeenth of one.
        assert!(
            (damping / 0.05 - 1.0).abs() < 0.06,
            "{tick_hz} Hz: {damping}"
        );
    }
}

#[test]
fn at_constant_speed_it_keeps_up_with_the_shaft() {
    let params = CarriageParams {
        resonance_hz: 60.0,
        ..bare()
    };
    let mut carriage = carriage(&params, 1000.0);
    for tick in 0..2000 {
        follow(&mut carriage, 100.0 * f64::from(tick));
    }
    let State {
        position,
        velocity,
        acceleration,
    } = carriage.state();
    assert!(
        (position - 199_900.0).abs() < 1e-6
            && (velocity - 100.0).abs() < 1e-6
            && acceleration.abs() < 1e-6
    );
}

#[test]
fn the_screw_is_8_d_long_over_300_mm_and_wobbles_by_2_d_a_revolution() {
    let params = CarriageParams {
        resonance_hz: 0.0,
        ..CarriageParams::default()
    };
    let mut carriage = carriage(&params, 1000.0);
    // Whole revolutions: the slope alone. The parameter has five digits.
    assert!((follow(&mut carriage, 300_000.0) - 300_008.0).abs() < 1e-3);
    let errors: Vec<f64> = (0..10_000)
        .map(|place| {
            let shaft = f64::from(place);
            follow(&mut carriage, shaft) - shaft * (1.0 + 0.026_667e-3)
        })
        .collect();
    assert!((super::statistics::amplitude(&errors, 1) - 2.0).abs() < 1e-3);
    assert!(super::statistics::amplitude(&errors, 2) < 1e-3);
}

#[test]
fn backlash_of_3_d_is_lost_at_each_reversal() {
    let params = CarriageParams {
        backlash_mm: 0.003,
        ..bare()
    };
    let mut carriage = carriage(&params, 1000.0);
    assert_eq!(follow(&mut carriage, 100.0), 98.5);
    // 3 d back without the carriage, then with it.
    for (shaft, expected) in [
        (99.0, 98.5),
        (97.5, 98.5),
        (97.0, 98.5),
        (96.0, 97.5),
        (50.0, 51.5),
    ] {
        assert_eq!(follow(&mut carriage, shaft), expected, "at {shaft}");
    }
    for (shaft, expected) in [(52.0, 51.5), (53.0, 51.5), (54.0, 52.5)] {
        assert_eq!(follow(&mut carriage, shaft), expected, "at {shaft}");
    }
}
