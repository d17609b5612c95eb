//! Edges that the counter loses or doubles, and times that do not fit.

use leadscrew_hal_mock::encoder::EncoderModel;
use leadscrew_hal_mock::faults::Fault;
use leadscrew_hal_mock::scene::Motion;

use super::{Seen, run};

#[test]
fn lost_and_doubled_edges_make_the_count_slip_and_the_index_shows_it() {
    for velocity in [-60.0, 60.0_f64] {
        for (fault, slip) in [
            (Fault::LostEdges { every: 100 }, -1),
            (Fault::DoubledEdges { every: 100 }, 1),
        ] {
            let motion = Motion::Steady { velocity };
            let seen = run(motion, EncoderModel::ideal(), fault, (0, 400, 400));
            let mut indices = 0;
            for (tick, (good, faulty)) in seen.iter().enumerate() {
                let moved = good.count.abs_diff(0) as i32;
                let slipped = slip * (moved / 100) * velocity.signum() as i32;
                assert_eq!(faulty.count - good.count, slipped, "{fault:?}, tick {tick}");
                if let (Some(good), Some(faulty)) = (good.index, faulty.index) {
                    let off = faulty.count.wrapping_sub(good.count).cast_signed();
                    let so_far = slip * (good.count.cast_signed().abs() / 100);
                    assert!(
                        (off - so_far * velocity.signum() as i32).abs() <= 1,
                        "{off}"
                    );
                    assert_ne!(off, 0);
                    indices += 1;
                }
            }
            let edges = |of: fn(&(Seen, Seen)) -> usize| -> usize { seen.iter().map(of).sum() };
            let (all, left) = (
                edges(|(good, _)| good.edges.len()),
                edges(|(_, faulty)| faulty.edges.len()),
            );
            assert_eq!(left as i32 - all as i32, slip * (all as i32 / 100));
            // 24 000 d: two revolutions.
            assert_eq!(indices, 2, "{fault:?}");
        }
    }
}

#[test]
fn an_overrun_keeps_the_first_times_and_the_count() {
    let motion = Motion::Steady { velocity: 9.5 };
    let fault = Fault::Overrun { kept: 9 };
    let mut overruns = 0;
    for (good, faulty) in run(motion, EncoderModel::ideal(), fault, (0, 100, 100)) {
        assert_eq!(good.count, faulty.count);
        assert_eq!(faulty.overrun, good.edges.len() > 9);
        assert_eq!(faulty.edges[..], good.edges[..good.edges.len().min(9)]);
        overruns += u32::from(faulty.overrun);
    }
    assert_eq!(overruns, 50);
}

#[test]
fn a_source_that_lost_times_keeps_its_count() {
    // 4 096 edge times are all that the simulated capture keeps.
    let motion = Motion::Steady { velocity: 5000.0 };
    let seen = run(
        motion,
        EncoderModel::ideal(),
        Fault::LostEdges { every: 1000 },
        (50, 60, 100),
    );
    for (good, faulty) in &seen[..50] {
        assert!(good.overrun);
        assert_eq!(good, faulty);
    }
    for (good, faulty) in &seen[60..] {
        // Every thousandth of the times that were kept, 4 096 a tick.
        assert_eq!(
            faulty.count - good.count,
            50 * 4096 / 1000 - 60 * 4096 / 1000
        );
    }
}
