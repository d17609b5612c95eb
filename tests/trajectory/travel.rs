//! Soft limits for setpoints that no plan made.

use leadscrew::estimator::EstimatorConfig;
use leadscrew::hal::Reference;
use leadscrew::params::AxisParams;
use leadscrew::setpoint::Setpoint;
use leadscrew::setpoint::follower::{Config, Follower};
use leadscrew::setpoint::limits::Limits;
use leadscrew::setpoint::sources::{Source, Sources};
use leadscrew::setpoint::travel::TravelLimits;
use leadscrew::supervisor::{Fault, Permit};
use leadscrew::units::{Position, Velocity};
use proptest::prelude::*;

use crate::moves::machine_limits;
use crate::seeded::seeded;

/// Follows `targets`, each for its ticks, until the guard refuses; then stops. The way of the stop.
fn drive(
    limits: &Limits,
    travel: &TravelLimits,
    targets: &[(f64, u32)],
) -> (Option<Fault>, Vec<Setpoint>) {
    let config = Config::new(limits);
    let mut source = Follower::new(config);
    let mut seen = vec![Setpoint::default()];
    for (share, ticks) in targets {
        let target = Velocity::from_num(limits.velocity().to_num::<f64>() * share);
        for _ in 0..*ticks {
            match travel.guard(&config, source.step(target)) {
                Ok(next) => seen.push(next),
                Err(fault) => {
                    let mut stop = Follower::new(config);
                    stop.take_over(seen.last().unwrap());
                    while !stop.is_at_rest() {
                        seen.push(stop.step(Velocity::ZERO));
                    }
                    return (Some(fault), seen);
                }
            }
        }
    }
    (None, seen)
}

proptest! {
    #![proptest_config(seeded(600))]

    #[test]
    fn whatever_a_source_does_the_axis_stops_within_its_travel(
        limits in machine_limits(),
        (low, high) in (1.0..20_000.0_f64, 1.0..20_000.0_f64),
        targets in prop::collection::vec((-1.0..1.0_f64, 1..300_u32), 1..20),
    ) {
        let travel = TravelLimits::new(Position::from_num(-low), Position::from_num(high)).unwrap();
        let (_, seen) = drive(&limits, &travel, &targets);
        for setpoint in seen {
            prop_assert!(travel.contains(setpoint.position), "{:?}: {:?}", travel, setpoint);
        }
    }
}

#[test]
fn a_source_that_runs_into_a_limit_is_stopped_close_before_it() {
    let limits = Limits::new(100.0, 0.9, 0.05).unwrap();
    for (share, end) in [(0.9, 5000.0), (-0.9, -3000.0), (0.01, 5000.0)] {
        let travel =
            TravelLimits::new(Position::from_num(-3000), Position::from_num(5000)).unwrap();
        let (fault, seen) = drive(&limits, &travel, &[(share, 20_000)]);
        assert_eq!(fault, Some(Fault::SoftLimit));
        let last = seen.last().unwrap();
        let spare = (end - last.position.to_num::<f64>()).abs();
        // A tick of the way at full speed, and what the bound of the stop is too much.
        assert!(spare <= 90.0 + 4.0, "{spare} d before {end}");
    }
}

#[test]
fn an_axis_beyond_its_limits_may_come_back_and_go_no_further() {
    let limits = Limits::new(100.0, 0.9, 0.05).unwrap();
    let config = Config::new(&limits);
    let travel = TravelLimits::new(Position::from_num(-3000), Position::from_num(5000)).unwrap();
    let beyond = Position::from_num(6000);
    for (target, admitted) in [(-20, true), (20, false)] {
        let mut source = Follower::new(config);
        source.stand(beyond);
        let target = Velocity::from_num(target);
        let all = (0..40).all(|_| travel.guard(&config, source.step(target)).is_ok());
        assert_eq!(all, admitted);
    }
    let mut standing = Follower::new(config);
    standing.stand(beyond);
    assert!(travel.admits(&config, &standing.step(Velocity::ZERO)));
}

#[test]
fn limits_that_leave_no_way_are_refused_with_their_figures() {
    let error = TravelLimits::new(Position::from_num(5), Position::from_num(5)).unwrap_err();
    assert_eq!(
        error.to_string(),
        "limits of travel from 5 to 5 d leave no way: the low one must be below the high one"
    );
}

#[test]
fn pulses_into_a_soft_limit_stop_the_axis_within_it_and_say_so() {
    let limits = Limits::new(50.0, 0.9, 0.05).unwrap();
    let travel = TravelLimits::new(Position::from_num(-3000), Position::from_num(5000)).unwrap();
    let estimator = EstimatorConfig::by_name("simple").unwrap().unwrap();
    let config = AxisParams::new(estimator).validate().unwrap();
    let mut sources = Sources::new(&limits, &config.sources);
    sources.hold(Position::ZERO);
    sources.set_travel(Some(travel));
    sources.select(Source::StepDir).unwrap();
    let (mut steps, mut trouble, mut last) = (0, None, Setpoint::default());
    for tick in 0..2000_u32 {
        // Up to speed by 0.5 d/tick².
        steps += (tick / 2).min(40);
        let reference = Reference {
            steps,
            ..Reference::default()
        };
        last = sources.step(tick, &reference, Permit::Follow);
        assert!(travel.contains(last.position), "{last:?}");
        trouble = trouble.or(sources.trouble());
    }
    assert_eq!(trouble, Some(Fault::SoftLimit));
    assert_eq!(last.velocity, Velocity::ZERO);
    assert!(last.position > 4900, "{last:?}");
}
