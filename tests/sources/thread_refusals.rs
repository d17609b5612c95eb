//! Threads that cannot be cut, and what would disturb one.

use leadscrew::axis::ReconfigureError;
use leadscrew::setpoint::gearing::GearingParams;
use leadscrew::setpoint::profile::Profile;
use leadscrew::setpoint::thread::{SpindleWay, ThreadOrder, ThreadRefusal};
use leadscrew::setpoint::trajectory::QueueError;
use leadscrew::units::Position;
use leadscrew_host::threads::Lathe;

use crate::passes::{lathe, order};

fn refusal(lathe: &mut Lathe, order: &ThreadOrder) -> ThreadRefusal {
    let before = lathe.step().setpoint;
    let refusal = lathe.axis.arm_thread(order).unwrap_err();
    for _ in 0..20 {
        assert_eq!(lathe.step().setpoint, before, "{refusal}");
    }
    refusal
}

#[test]
fn what_cannot_be_cut_is_refused_before_anything_moves() {
    let mut young = lathe(500.0);
    assert_eq!(
        young.axis.arm_thread(&order()),
        Err(ThreadRefusal::Disabled)
    );
    // 20 ms from 77° do not pass the index.
    young.run(20);
    assert_eq!(refusal(&mut young, &order()), ThreadRefusal::NoIndex);

    let mut standing = lathe(0.0);
    standing.run(100);
    assert_eq!(
        refusal(&mut standing, &order()),
        ThreadRefusal::SpindleStands
    );

    let mut turning = lathe(1000.0);
    turning.run(300);
    let backward = ThreadOrder {
        spindle: SpindleWay::Backward,
        ..order()
    };
    assert_eq!(refusal(&mut turning, &backward), ThreadRefusal::WrongWay);
    let coarse = ThreadOrder {
        lead_mm: 10.0,
        ..order()
    };
    let message = refusal(&mut turning, &coarse).to_string();
    assert!(message.contains("the axis has 9000"), "{message}");
    let near = ThreadOrder {
        from_mm: 5.0,
        ..order()
    };
    let refused = refusal(&mut turning, &near);
    let ThreadRefusal::RunInTooShort {
        needed_mm,
        available_mm,
    } = refused
    else {
        panic!("{refused:?}");
    };
    assert!(
        needed_mm > 5.0 && needed_mm < 8.0 && available_mm == 3.0,
        "{refused}"
    );
    let turned = ThreadOrder {
        to_mm: 0.0,
        ..order()
    };
    assert_eq!(refusal(&mut turning, &turned), ThreadRefusal::Order);
    let start = ThreadOrder {
        starts: 2,
        start: 2,
        ..order()
    };
    let message = refusal(&mut turning, &start).to_string();
    assert_eq!(message, "start 2 of a thread with 2: expected 0 to 1");
    let wild = ThreadOrder {
        lead_mm: f64::NAN,
        ..order()
    };
    assert!(matches!(
        refusal(&mut turning, &wild),
        ThreadRefusal::Range(_)
    ));

    turning.axis.arm_thread(&order()).unwrap();
    turning.step();
    assert_eq!(
        turning.axis.arm_thread(&order()),
        Err(ThreadRefusal::Moving)
    );
    // Nor is the pass disturbed from outside.
    let mut config = *turning.axis.config();
    let profile = Profile::plan(Position::from_num(10), &config.limits).unwrap();
    let soon = turning.step().tick + 5;
    assert_eq!(turning.axis.queue(&profile, soon), Err(QueueError::Busy));
    config.sources.gearing = GearingParams {
        gear_axis_counts: 2.0,
        gear_master_counts: 1.0,
    }
    .quantise()
    .unwrap();
    assert_eq!(
        turning.axis.reconfigure(&config),
        Err(ReconfigureError::Sources)
    );
}
