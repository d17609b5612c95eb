//! Bursts of interference.

use leadscrew_hal_mock::encoder::EncoderModel;
use leadscrew_hal_mock::faults::{Bursts, Fault};
use leadscrew_hal_mock::scene::Motion;

use super::{Seen, TIMER_HZ, run};

#[test]
fn bursts_add_pairs_of_edges_at_their_rate_and_leave_the_count() {
    for (burst_hz, motion) in [
        (100.0, Motion::Steady { velocity: 0.0 }),
        (300.0, Motion::Steady { velocity: 0.0 }),
        (300.0, Motion::Steady { velocity: 150.0 }),
        (100.0, Motion::Steady { velocity: -7.3 }),
    ] {
        let fault = Fault::FalseEdges(Bursts::at(burst_hz, TIMER_HZ));
        let (mut added, mut bursts) = (0, 0);
        for (tick, (good, faulty)) in run(motion, EncoderModel::real(), fault, (0, 1000, 1000))
            .into_iter()
            .enumerate()
        {
            assert_eq!(good.count, faulty.count, "tick {tick}");
            assert_eq!(good.index, faulty.index);
            let false_edges = faulty.edges.len() - good.edges.len();
            assert!(false_edges % 2 == 0 && false_edges <= 6, "tick {tick}");
            assert!(good.edges.iter().all(|edge| faulty.edges.contains(edge)));
            added += false_edges;
            bursts += u32::from(false_edges > 0);
        }
        // Three pulses of two edges; a burst over a sampling instant shows in two ticks.
        assert_eq!(added as f64, 6.0 * burst_hz, "{burst_hz}");
        assert!((f64::from(bursts) - burst_hz).abs() <= 3.0, "{bursts}");
    }
}

#[test]
fn interference_on_both_lines_is_illegal_and_makes_no_edge() {
    let fault = Fault::IllegalTransitions(Bursts::at(100.0, TIMER_HZ));
    let motion = Motion::Steady { velocity: 20.0 };
    let mut illegal = 0;
    for (good, faulty) in run(motion, EncoderModel::real(), fault, (0, 1000, 1000)) {
        illegal += u32::from(faulty.illegal);
        assert_eq!(
            Seen {
                illegal: 0,
                ..faulty
            },
            good
        );
    }
    assert_eq!(illegal, 600);
}
