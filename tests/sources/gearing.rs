//! Gearing: exact for ever, locked without lag, and engaged without a kick.

use leadscrew::hal::Capture;
use leadscrew::setpoint::Setpoint;
use leadscrew::setpoint::gearing::{Gear, Gearing, GearingParams};
use leadscrew::setpoint::master::Master;
use leadscrew::setpoint::profile::Limits;
use leadscrew::units::Position;
use leadscrew_hal_mock::encoder::EncoderModel;
use leadscrew_hal_mock::scene::{Motion, Scene};

use crate::master::{master, scene};

fn limits() -> Limits {
    Limits::new(150.0, 0.9, 0.01).unwrap()
}

fn gearing(over: f64, under: f64, limits: &Limits) -> Gearing {
    let params = GearingParams {
        gear_axis_counts: over,
        gear_master_counts: under,
    };
    Gearing::new(params.quantise().unwrap(), limits)
}

/// A master on a scene, and the gear on it.
struct Stand {
    scene: Scene,
    master: Master,
    gearing: Gearing,
}

impl Stand {
    fn new(motion: Motion, over: f64, under: f64) -> Self {
        let mut stand = Self {
            scene: scene(motion, &EncoderModel::ideal()),
            master: master(10_000.0),
            gearing: gearing(over, under, &limits()),
        };
        stand.gearing.start(Position::from_num(1000));
        for _ in 0..100 {
            assert_eq!(stand.step().position, Position::from_num(1000));
        }
        stand
    }

    fn step(&mut self) -> Setpoint {
        self.scene.step();
        self.master.step(Some(&self.scene.capture()), false);
        self.gearing.step(&self.master)
    }

    fn engage(&mut self, engaged: bool) {
        assert!(self.gearing.engage(engaged, &self.master, &limits()));
    }
}

/// Setpoints agree with one another and keep acceleration and jerk, with what the estimate adds.
fn assert_smooth(last: &Setpoint, next: &Setpoint, most_acceleration: f64) {
    let way = (next.position - last.position).to_num::<f64>();
    let mean = (next.velocity.to_num::<f64>() + last.velocity.to_num::<f64>()) / 2.0;
    assert!((way - mean).abs() < 0.02, "{last:?} {next:?}");
    let gained = (next.velocity - last.velocity).to_num::<f64>();
    let acceleration =
        (next.acceleration.to_num::<f64>() + last.acceleration.to_num::<f64>()) / 2.0;
    assert!((gained - acceleration).abs() < 0.01, "{last:?} {next:?}");
    assert!(next.acceleration.to_num::<f64>().abs() < most_acceleration);
    let jerk = (next.acceleration - last.acceleration).to_num::<f64>();
    assert!(jerk.abs() < 0.01 + 0.002, "{last:?} {next:?}");
}

#[test]
fn a_turning_master_is_caught_up_with_locked_and_let_go_of_without_a_kick() {
    for (over, under) in [(3.0, 4.0), (-7.0, 3.0), (1.0, 1000.0)] {
        let mut stand = Stand::new(Motion::Steady { velocity: 40.0 }, over, under);
        stand.engage(true);
        let mut last = stand.step();
        let mut ticks = 0;
        while stand.gearing.gear() == Gear::Engaging {
            let next = stand.step();
            assert_smooth(&last, &next, 0.9);
            last = next;
            ticks += 1;
        }
        assert!(ticks < 250, "{ticks}");
        let ratio = over / under;
        let offset = last.position.to_num::<f64>() - ratio * stand.scene.truth().position;
        for _ in 0..500 {
            let next = stand.step();
            assert_smooth(&last, &next, 0.05);
            let error = next.position.to_num::<f64>() - ratio * stand.scene.truth().position;
            assert!(
                (error - offset).abs() < 0.01 * ratio.abs() + 1e-4,
                "{error} {offset}"
            );
            last = next;
        }
        assert!(stand.gearing.is_moving());
        stand.engage(false);
        while stand.gearing.gear() == Gear::Disengaging {
            let next = stand.step();
            assert_smooth(&last, &next, 0.9);
            last = next;
        }
        assert!(!stand.gearing.is_moving() && !stand.gearing.is_lost());
        let rest = stand.step();
        assert_smooth(&last, &rest, 0.9);
        assert_eq!(stand.step(), rest);
    }
}

#[test]
fn an_accelerating_master_is_followed_without_lag() {
    let ramp = Motion::Ramp {
        velocity: 5.0,
        acceleration: 0.2,
    };
    let mut stand = Stand::new(ramp, 2.0, 3.0);
    stand.engage(true);
    while stand.gearing.gear() != Gear::Locked {
        stand.step();
    }
    let start = stand.step().position.to_num::<f64>() - stand.scene.truth().position * 2.0 / 3.0;
    for _ in 0..300 {
        let setpoint = stand.step();
        let truth = stand.scene.truth();
        let error = setpoint.position.to_num::<f64>() - truth.position * 2.0 / 3.0 - start;
        assert!(error.abs() < 0.01, "{error}");
        assert!((setpoint.velocity.to_num::<f64>() - truth.velocity * 2.0 / 3.0).abs() < 0.01);
    }
}

#[test]
fn a_thousand_million_counts_leave_the_phase_where_it_was() {
    let limits = Limits::new(2047.0, 0.9, 0.01).unwrap();
    let mut gearing = gearing(355.0, 113.0, &limits);
    let mut master = master(10_000.0);
    let mut count = 0_u32;
    let mut feed = |gearing: &mut Gearing, master: &mut Master, by: u32| {
        count = count.wrapping_add(by);
        let capture = Capture {
            count,
            ..Capture::default()
        };
        master.step(Some(&capture), false);
        gearing.step(master)
    };
    feed(&mut gearing, &mut master, 0);
    assert!(gearing.engage(true, &master, &limits));
    while gearing.gear() != Gear::Locked {
        feed(&mut gearing, &mut master, 0);
    }
    let start = feed(&mut gearing, &mut master, 0).position;
    let mut total = 0_i128;
    while total < 1_000_000_000 {
        total += 641;
        let setpoint = feed(&mut gearing, &mut master, 641);
        let way = (total * 355 * 65_536).div_euclid(113);
        assert_eq!(i128::from((setpoint.position - start).to_bits()), way);
    }
    assert!(!gearing.is_lost());
}

#[test]
fn what_the_axis_cannot_follow_is_lost() {
    let mut fast = Stand::new(Motion::Steady { velocity: 160.0 }, 1.0, 1.0);
    fast.engage(true);
    fast.step();
    assert!(fast.gearing.is_lost());

    let mut stand = Stand::new(Motion::Steady { velocity: 30.0 }, 1.0, 1.0);
    stand.engage(true);
    for _ in 0..300 {
        stand.step();
    }
    assert_eq!(stand.gearing.gear(), Gear::Locked);
    assert!(!stand.gearing.is_lost());
    stand.master.step(None, false);
    stand.gearing.step(&stand.master);
    assert!(stand.gearing.is_lost());
}
