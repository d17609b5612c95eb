//! Passes of threads at the soft limits of travel.

use leadscrew::setpoint::thread::{SpindleTrouble, ThreadRefusal};
use leadscrew::setpoint::thread::{ThreadFigures, ThreadOrder, ThreadPhase, ThreadPlace};
use leadscrew::setpoint::travel::TravelLimits;
use leadscrew::units::Position;
use leadscrew_host::threads::Lathe;

use crate::passes::{lathe, order};

/// The axis stands 5 mm from its origin.
const ORIGIN_D: f64 = -5000.0;

/// A lathe whose axis counts from there, with the travel from `low_mm` to `high_mm`.
fn limited(low_mm: f64, high_mm: f64) -> Lathe<'static> {
    let mut lathe = lathe(500.0);
    lathe.run(500);
    let mut config = *lathe.axis.config();
    let [low, high] = [low_mm, high_mm].map(|mm| Position::from_num(mm * 1000.0));
    config.travel = Some(TravelLimits::new(low, high).unwrap());
    lathe.axis.reconfigure(&config).unwrap();
    lathe.axis.set_origin(Some(Position::from_num(ORIGIN_D)));
    lathe
}

fn figures() -> ThreadFigures {
    limited(-100.0, 100.0).axis.arm_thread(&order()).unwrap()
}

#[track_caller]
fn assert_refused(lathe: &mut Lathe, order: &ThreadOrder, place: ThreadPlace) -> String {
    let before = lathe.axis.outputs().setpoint;
    let refusal = lathe.axis.arm_thread(order).unwrap_err();
    assert!(
        matches!(refusal, ThreadRefusal::BeyondTravel { place: found, .. } if found == place),
        "{refusal:?}"
    );
    assert_eq!(lathe.axis.thread_phase(), ThreadPhase::Idle);
    for _ in 0..200 {
        assert_eq!(lathe.step().setpoint, before, "{refusal}");
    }
    refusal.to_string()
}

#[test]
fn a_pass_that_would_leave_the_travel_is_refused_before_anything_moves() {
    let rest_mm = figures().rest_mm;
    assert!(rest_mm > 30.5, "{rest_mm}");
    // The thread itself lies within, its run-out does not.
    let message = assert_refused(&mut limited(0.0, 30.5), &order(), ThreadPlace::Rest);
    let says = format!(
        "the run-out ends at {rest_mm:.3} mm, and the soft limits of travel are 0.000 to 30.500 mm: end the thread \
         earlier, or turn slower"
    );
    assert_eq!(message, says);
    // So does its start, and its take-up of 1 mm does not.
    let message = assert_refused(&mut limited(1.5, 100.0), &order(), ThreadPlace::TakeUp);
    let says = "the take-up before the start begins at 1.000 mm, and the soft limits of travel are 1.500 to 100.000 mm: \
                start farther inside, or lower thread_take_up_mm";
    assert_eq!(message, says);
    // Toward the low end it is the other way round.
    let back = ThreadOrder {
        start_mm: 38.0,
        from_mm: 30.0,
        to_mm: 10.0,
        ..order()
    };
    assert_refused(&mut limited(9.5, 100.0), &back, ThreadPlace::Rest);
    assert_refused(&mut limited(0.0, 38.5), &back, ThreadPlace::TakeUp);
    // An axis that stands beyond its travel may come back, but not to a start that lies beyond too.
    let beyond = ThreadOrder {
        start_mm: 2.0,
        from_mm: -6.0,
        to_mm: -20.0,
        ..order()
    };
    assert_refused(&mut limited(-100.0, 1.0), &beyond, ThreadPlace::TakeUp);
    assert_refused(&mut limited(4.0, 100.0), &order(), ThreadPlace::TakeUp);
}

#[test]
fn a_pass_that_just_fits_is_cut_and_never_leaves_the_travel() {
    let (low_mm, high_mm) = (1.0, figures().rest_mm + 0.001);
    let mut lathe = limited(low_mm, high_mm);
    lathe.axis.arm_thread(&order()).unwrap();
    let mut seen = (f64::MAX, f64::MIN);
    while lathe.axis.thread_phase() != ThreadPhase::Idle {
        let position = lathe.step().setpoint.position.to_num::<f64>();
        let mm = (position - ORIGIN_D) / 1000.0;
        seen = (seen.0.min(mm), seen.1.max(mm));
    }
    assert_eq!(lathe.axis.outputs().fault, None);
    assert!(
        (seen.0 - low_mm).abs() < 1e-3 && seen.0 >= low_mm,
        "{seen:?}"
    );
    assert!(high_mm - 0.01 < seen.1 && seen.1 <= high_mm, "{seen:?}");
}

#[test]
fn a_pass_that_ends_early_stops_within_the_travel_wherever_it_was() {
    let high_mm = figures().rest_mm + 0.001;
    // In the run-in, on the line, where the run-out begins, and in it.
    for lost_at_mm in [4.0, 8.0, 20.0, 29.98, 30.4] {
        let mut lathe = limited(1.0, high_mm);
        lathe.axis.arm_thread(&order()).unwrap();
        let mm = |position: Position| (position.to_num::<f64>() - ORIGIN_D) / 1000.0;
        let has_begun = |lathe: &Lathe| {
            use ThreadPhase::{Cutting, RunIn, RunOut};
            matches!(lathe.axis.thread_phase(), RunIn | Cutting | RunOut)
        };
        while !has_begun(&lathe) || mm(lathe.axis.outputs().setpoint.position) < lost_at_mm {
            lathe.step();
        }
        lathe.lines.master_lost = true;
        lathe.step();
        assert_eq!(lathe.axis.spindle_trouble(), Some(SpindleTrouble::NoSignal));
        for _ in 0..1000 {
            let setpoint = lathe.step().setpoint;
            assert!(
                mm(setpoint.position) <= high_mm,
                "{lost_at_mm} {setpoint:?}"
            );
        }
        assert_eq!(lathe.axis.outputs().setpoint.velocity, 0);
    }
}
