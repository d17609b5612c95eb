//! The index pulse: where it latches, and in which capture it comes.

use leadscrew_hal_mock::encoder::EncoderParams;

use crate::encoder_capture::{Shaft, ideal};

#[test]
fn the_index_latches_count_and_time_at_its_front_in_either_direction() {
    // Three d wide from boundary 0 of the revolution on.
    for (velocity, start, fronts) in [
        (7.3, -0.5, [0, 10_000, 20_000]),
        (-7.3, 20_003.5, [20_003, 10_003, 3]),
    ] {
        let mut shaft = Shaft::new(ideal(), 1000.0, start);
        let mut seen = Vec::new();
        for _ in 0..2800 {
            shaft.turn(velocity);
            if let Some(latch) = shaft.encoder.capture().index {
                let exact = (f64::from(fronts[seen.len()]) - start) / velocity * 84_000.0;
                assert!(
                    (f64::from(latch.time) - exact).abs() <= 1.0,
                    "{latch:?} instead of {exact}"
                );
                // The count just after the edge.
                seen.push(latch.count as i32 + i32::from(velocity < 0.0));
            }
        }
        assert_eq!(seen, fronts, "at {velocity}");
    }
}

/// Turns over many revolutions and checks that each capture tells of the index just when it has its edge;
/// gives how many came in the tick after the one in which the shaft passed them.
fn late_indexes(params: EncoderParams, start: f64, velocity: f64, ticks: u32) -> u32 {
    let mut shaft = Shaft::new(params, 1000.0, start);
    let (mut seen, mut late) = (Vec::new(), 0);
    let mut edges_before = 0_i32;
    for _ in 0..ticks {
        shaft.turn(velocity);
        let capture = shaft.encoder.capture();
        let edges = shaft.edges();
        if let Some(latch) = capture.index {
            let place = edges.iter().position(|at| *at == latch.time);
            let place = place.expect("the edge of the index is in its capture");
            assert!(latch.time <= capture.sampled_at, "{latch:?}: {capture:?}");
            // Stamps may coincide: the count is then that of one of these edges.
            let passed = edges.iter().filter(|at| **at == latch.time).count();
            let way = (latch.count as i32 - start.floor() as i32).abs() - edges_before;
            assert!(
                (place as i32 + 1..=(place + passed) as i32).contains(&way),
                "{latch:?}: edge {way} of the capture instead of {place} and on"
            );
            let ahead = f64::from(latch.count as i32) - (shaft.position - velocity).floor();
            late += u32::from(ahead * velocity <= 0.0);
            // The count just after the edge.
            seen.push(latch.count as i32 + i32::from(velocity < 0.0));
        }
        edges_before += edges.len() as i32;
    }
    // Backward, the front lies three d above boundary 0 of the revolution; the last may still wait.
    let (low, high) = if velocity > 0.0 {
        (start, shaft.position - velocity)
    } else {
        (shaft.position - velocity - 3.0, start - 3.0)
    };
    let first = (low / 10_000.0).ceil() as i32;
    let mut fronts: Vec<i32> = (first..=(high / 10_000.0).floor() as i32)
        .map(|turn| turn * 10_000)
        .collect();
    if velocity < 0.0 {
        fronts.reverse();
        fronts.iter_mut().for_each(|front| *front += 3);
    }
    assert!(fronts.len() >= 30, "{}", fronts.len());
    seen.truncate(fronts.len());
    assert_eq!(seen, fronts, "at {velocity}");
    late
}

#[test]
fn an_index_comes_once_and_with_its_edge_however_the_sampling_jitters() {
    let params = EncoderParams {
        sampling_jitter_s: 1e-4,
        noise_s: 2e-8,
        ..ideal()
    };
    let mut late = 0;
    for (velocity, ticks) in [(107.3, 3_000), (613.7, 1_000), (1733.1, 1_000)] {
        late += late_indexes(params, -0.5, velocity, ticks);
        late += late_indexes(params, 0.5, -velocity, ticks);
    }
    assert!(late > 50, "{late}: the sampling hardly ever splits a tick");
}

#[test]
fn an_index_that_noise_puts_behind_the_sample_waits_with_its_edge() {
    // Each revolution of 20 ticks ends a clock before a tick does, or with it; the noise is 84 clocks.
    let params = EncoderParams {
        noise_s: 1e-6,
        ..ideal()
    };
    let mut late = 0;
    for (start, velocity) in [(-499.999, 500.0), (502.999, -500.0)] {
        late += late_indexes(params, start, velocity, 1_200);
    }
    assert!((30..90).contains(&late), "{late} of 120");
}
