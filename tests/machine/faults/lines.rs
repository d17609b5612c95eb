//! Lines that are dead or late.

use leadscrew_hal_mock::encoder::EncoderModel;
use leadscrew_hal_mock::faults::{Channel, Fault};
use leadscrew_hal_mock::scene::Motion;

use super::{Seen, run};

#[test]
fn with_a_dead_channel_the_count_dithers_by_one_at_the_edges_of_the_other() {
    for channel in [Channel::A, Channel::B] {
        for velocity in [60.3, -60.3, 0.7] {
            let motion = Motion::Steady { velocity };
            let seen = run(
                motion,
                EncoderModel::ideal(),
                Fault::DeadChannel(channel),
                (100, 500, 600),
            );
            let frozen = seen[99].1.count;
            let (mut least, mut most) = (frozen, frozen);
            for (good, faulty) in &seen[100..500] {
                (least, most) = (least.min(faulty.count), most.max(faulty.count));
                let half = good.edges.len() / 2;
                assert!(faulty.edges.len().abs_diff(half) <= 1);
                assert_eq!(faulty.illegal, 0);
                assert!(faulty.edges.iter().all(|edge| good.edges.contains(edge)));
            }
            assert_eq!(most - least, 1, "{channel:?} at {velocity}");
            // It counts again when the channel lives again.
            let (from, to) = (&seen[501], &seen[599]);
            assert_eq!(to.1.count - from.1.count, to.0.count - from.0.count);
        }
    }
}

#[test]
fn lost_lines_give_no_edge_and_a_frozen_count() {
    let motion = Motion::Steady { velocity: -90.0 };
    let seen = run(
        motion,
        EncoderModel::real(),
        Fault::LineLoss,
        (100, 400, 500),
    );
    let frozen = seen[99].1.count;
    let mut indices = 0;
    for (good, faulty) in &seen[100..400] {
        let nothing = Seen {
            count: frozen,
            sampled_at: good.sampled_at,
            edges: Vec::new(),
            last_edge_at: None,
            illegal: 0,
            overrun: false,
            index: None,
        };
        assert_eq!(*faulty, nothing);
        indices += u32::from(good.index.is_some());
    }
    assert!(indices >= 2, "there was an index to lose");
    let (from, to) = (&seen[400], &seen[499]);
    assert_eq!(to.1.count - from.1.count, to.0.count - from.0.count);
    assert_ne!(to.1.count, to.0.count);
}

#[test]
fn duty_drift_shifts_the_falling_edges_of_a_by_its_delay_times_the_speed() {
    // A delay is a shift that grows with the speed: 0.15 d at 150 d/tick.
    let delay_clocks = 84;
    for velocity in [150.0, 30.0, -30.0_f64] {
        let motion = Motion::Steady { velocity };
        let fault = Fault::DutyDrift { delay_clocks };
        let seen = run(motion, EncoderModel::ideal(), fault, (0, 300, 300));
        let (mut good_edges, mut faulty_edges) = (Vec::new(), Vec::new());
        for (good, faulty) in &seen {
            good_edges.extend_from_slice(&good.edges);
            faulty_edges.extend_from_slice(&faulty.edges);
            // The count waits with its edge.
            let waiting = good_edges.len() - faulty_edges.len();
            assert_eq!(good.count.abs_diff(faulty.count) as usize, waiting);
        }
        for (edge, (good, faulty)) in good_edges.iter().zip(&faulty_edges).enumerate() {
            let edge = edge as i64;
            let boundary = if velocity > 0.0 { edge + 1 } else { -edge };
            // A rises at boundary 1 going up, and falls there going down.
            let falls = boundary.rem_euclid(4) == if velocity > 0.0 { 3 } else { 1 };
            let expected = if falls { delay_clocks } else { 0 };
            assert_eq!(faulty - good, expected, "boundary {boundary}");
        }
    }
}
