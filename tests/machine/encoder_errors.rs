//! What an encoder does besides the errors of its disc: hysteresis and noise; and that the disc is in its edges.

use leadscrew_hal_mock::arc::{Arc, State};
use leadscrew_hal_mock::disc::{Disc, DiscParams};
use leadscrew_hal_mock::encoder::{Encoder, EncoderModel, EncoderParams};

use crate::statistics::{assert_sigma, mean_and_sigma};

const CLOCKS: f64 = 84_000.0;

fn with(params: EncoderParams) -> EncoderModel {
    EncoderModel {
        encoder: params,
        ..EncoderModel::ideal()
    }
}

fn ideal() -> EncoderParams {
    EncoderModel::ideal().encoder
}

/// Place on the shaft of each edge passed at constant velocity over `ticks` from `start`, by its time, with
/// the boundary it belongs to.
fn places(
    encoder: &mut Encoder,
    start: f64,
    velocity: f64,
    first_tick: u32,
    ticks: u32,
) -> Vec<(i64, f64)> {
    let mut state = State {
        position: start,
        velocity,
        acceleration: 0.0,
    };
    let mut count = i64::from(encoder.capture().count as i32);
    let mut seen = Vec::new();
    for tick in first_tick..first_tick + ticks {
        let arc = Arc {
            start: state,
            jerk: 0.0,
        };
        encoder.advance(&arc);
        for at in encoder.capture().edges.concat() {
            let within = f64::from(at.wrapping_sub(tick.wrapping_mul(84_000)).cast_signed());
            let place = arc.at((within + 0.5) / CLOCKS).position;
            seen.push((if velocity > 0.0 { count + 1 } else { count }, place));
            count += if velocity > 0.0 { 1 } else { -1 };
        }
        state = arc.end();
    }
    seen
}

/// Error of the place of each edge: where it was seen less its boundary.
fn errors(places: &[(i64, f64)]) -> Vec<f64> {
    places
        .iter()
        .map(|&(boundary, place)| place - boundary as f64)
        .collect()
}

#[test]
fn a_backward_edge_lies_lower_than_the_forward_one_by_the_hysteresis_of_its_channel() {
    let model = with(EncoderParams {
        hysteresis_a_d: 0.04,
        hysteresis_b_d: 0.02,
        ..ideal()
    });
    let mut encoder = Encoder::new(&model, 1000.0, 0.5, 1).unwrap();
    let velocity = 0.9;
    let forward = places(&mut encoder, 0.5, velocity, 0, 200);
    let backward = places(&mut encoder, 180.5, -velocity, 200, 200);
    assert_eq!((forward.len(), backward.len()), (180, 180));
    // Half a clock at 0.9 d/tick is 5e-6 d.
    let bound = 1e-5;
    for &(boundary, place) in &forward {
        assert!(
            (place - boundary as f64).abs() < bound,
            "{boundary} at {place}"
        );
    }
    for &(boundary, place) in &backward {
        // Odd boundaries are edges of A.
        let hysteresis = if boundary % 2 == 0 { 0.02 } else { 0.04 };
        assert!(
            (place - (boundary as f64 - hysteresis)).abs() < bound,
            "{boundary} at {place}"
        );
    }
}

#[test]
fn within_the_hysteresis_a_shaft_that_trembles_gives_no_edge() {
    let model = with(EncoderParams {
        hysteresis_a_d: 0.04,
        ..ideal()
    });
    let mut encoder = Encoder::new(&model, 1000.0, 0.9, 1).unwrap();
    let mut state = State {
        position: 0.9,
        ..State::default()
    };
    let mut edges = Vec::new();
    // Over boundary 1, an edge of A, and then to and fro by less than 0.04 d about it.
    for step in [0.12, -0.03, 0.03, -0.03, 0.03, -0.05, 0.05] {
        state.velocity = step;
        let arc = Arc {
            start: state,
            jerk: 0.0,
        };
        encoder.advance(&arc);
        state = arc.end();
        edges.push(encoder.capture().edges.concat().len());
    }
    // 1.02, 0.99, … 1.02; then 0.97 is still above 0.96.
    assert_eq!(edges, [1, 0, 0, 0, 0, 0, 0]);
}

#[test]
fn edges_do_not_repeat_by_the_noise_of_place() {
    let mut encoder = Encoder::new(
        &with(EncoderParams {
            noise_d: 0.005,
            ..ideal()
        }),
        1000.0,
        0.5,
        4,
    )
    .unwrap();
    let seen = errors(&places(&mut encoder, 0.5, 7.3, 0, 1000));
    assert_sigma(&seen, 0.005);
    let (mean, _) = mean_and_sigma(&seen);
    assert!(
        mean.abs() < 4.0 * 0.005 / (seen.len() as f64).sqrt(),
        "{mean}"
    );
    // Backward the same.
    let start = 0.5 + 7300.0;
    assert_sigma(
        &errors(&places(&mut encoder, start, -7.3, 1000, 1000)),
        0.005,
    );
}

#[test]
fn edges_do_not_repeat_by_the_noise_of_time() {
    let mut encoder = Encoder::new(
        &with(EncoderParams {
            noise_s: 1e-7,
            ..ideal()
        }),
        1000.0,
        0.5,
        4,
    )
    .unwrap();
    let velocity = 100.0;
    let seen = errors(&places(&mut encoder, 0.5, velocity, 0, 100));
    let clocks: Vec<f64> = seen.iter().map(|place| place / velocity * CLOCKS).collect();
    // 8.4 clocks, and the twelfth of a clock² that the timer's step adds.
    assert_sigma(&clocks, (8.4_f64 * 8.4 + 1.0 / 12.0).sqrt());
}

#[test]
fn the_real_encoders_edges_lie_where_its_disc_has_them() {
    let seed = 9;
    let model = EncoderModel {
        encoder: ideal(),
        disc: DiscParams::default(),
    };
    let disc = Disc::new(&model.disc, seed).unwrap();
    let mut encoder = Encoder::new(&model, 1000.0, 0.5, seed).unwrap();
    // Two revolutions, both ways.
    let velocity = 23.7;
    let forward = places(&mut encoder, 0.5, velocity, 0, 850);
    let backward = places(&mut encoder, 0.5 + 850.0 * velocity, -velocity, 850, 850);
    assert!(forward.len() > 20_000 && backward.len() > 20_000);
    for (boundary, place) in forward.into_iter().chain(backward) {
        let error = disc.error_q32(boundary.rem_euclid(10_000) as usize) as f64 / 4_294_967_296.0;
        // Half a clock at this speed.
        assert!(
            (place - boundary as f64 - error).abs() < 0.6 * velocity / CLOCKS,
            "{boundary} at {place}"
        );
    }
}

#[test]
fn the_noise_of_other_seeds_is_another() {
    let model = with(EncoderParams {
        noise_d: 0.005,
        ..ideal()
    });
    let run = |seed| {
        places(
            &mut Encoder::new(&model, 1000.0, 0.5, seed).unwrap(),
            0.5,
            7.3,
            0,
            50,
        )
    };
    assert_eq!(run(1), run(1));
    assert_ne!(run(1), run(2));
}

#[test]
fn the_truth_of_the_placement_is_where_edges_are_seen_in_either_direction() {
    let quiet = EncoderModel {
        encoder: EncoderParams {
            noise_d: 0.0,
            noise_s: 0.0,
            ..EncoderParams::default()
        },
        ..EncoderModel::real().drifted(0.02)
    };
    let mut encoder = Encoder::new(&quiet, 1000.0, 0.5, 6).unwrap();
    assert_eq!(encoder.edges(), 10_000);
    let velocity = 23.7;
    for (start, velocity, first_tick) in
        [(0.5, velocity, 0), (0.5 + 450.0 * velocity, -velocity, 450)]
    {
        let seen = places(&mut encoder, start, velocity, first_tick, 450);
        assert!(seen.len() > 10_000);
        for (boundary, place) in seen {
            let edge = boundary.rem_euclid(10_000) as usize;
            let error = encoder.placement_error(edge, velocity < 0.0);
            // Half a clock at this speed.
            assert!(
                (place - boundary as f64 - error).abs() < 0.6 * velocity.abs() / CLOCKS,
                "{boundary} at {place}"
            );
        }
    }
    assert_eq!(
        encoder.placement_error(10_007, false),
        encoder.placement_error(7, false)
    );
}

#[test]
fn the_white_encoder_has_white_noise_and_nothing_else() {
    let mut encoder = Encoder::new(&EncoderModel::white(0.03), 1000.0, 0.5, 8).unwrap();
    let errors = errors(&places(&mut encoder, 0.5, 7.3, 0, 3000));
    assert_sigma(&errors, 0.03);
    let scatter = 1.0 / (errors.len() as f64).sqrt();
    let (mean, sigma) = mean_and_sigma(&errors);
    assert!(mean.abs() < 4.0 * sigma * scatter, "{mean}");
    // No edge tells of another: not of its neighbours, nor of the same phase of a line.
    for apart in 1..=8 {
        let pairs = errors.iter().zip(&errors[apart..]);
        let together: f64 = pairs.map(|(one, other)| one * other).sum();
        let correlation = together / (sigma * sigma * errors.len() as f64);
        assert!(correlation.abs() < 4.0 * scatter, "{apart}: {correlation}");
    }
}
