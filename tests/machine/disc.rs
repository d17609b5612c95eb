//! Placement errors of the disc: each term alone has the stated size.

use leadscrew_hal_mock::disc::{Disc, DiscParams};
use leadscrew_hal_mock::encoder::EncoderModel;

use crate::statistics::{amplitude, assert_sigma, mean_and_sigma};

/// One unit of the table of errors, which cuts towards zero.
const UNIT: f64 = 1.0 / 4096.0;

fn none() -> DiscParams {
    DiscParams {
        phase_offset_d: 0.0,
        line_sigma_d: 0.0,
        edge_sigma_d: 0.0,
        eccentricity_d: 0.0,
        second_harmonic_d: 0.0,
        ..DiscParams::default()
    }
}

/// Errors of all edges of a revolution, d.
fn errors(params: &DiscParams, seed: u64) -> Vec<f64> {
    let disc = Disc::new(params, seed).unwrap();
    (0..disc.edges())
        .map(|edge| disc.error_q32(edge) as f64 / 4_294_967_296.0)
        .collect()
}

#[test]
fn an_ideal_disc_has_no_error() {
    assert!(errors(&none(), 5).iter().all(|&error| error == 0.0));
    assert_eq!(errors(&none(), 5).len(), 10_000);
}

#[test]
fn the_four_phases_are_off_by_constants_spread_up_to_the_stated_offset() {
    let params = DiscParams {
        phase_offset_d: 0.12,
        ..none()
    };
    let mut offsets = Vec::new();
    for seed in 0..200 {
        let errors = errors(&params, seed);
        assert!(
            errors.chunks(4).all(|line| *line == errors[..4]),
            "the same all round"
        );
        offsets.extend_from_slice(&errors[..4]);
    }
    assert!(offsets.iter().all(|offset| offset.abs() <= 0.12));
    let largest = offsets
        .iter()
        .fold(0.0_f64, |largest, offset| largest.max(offset.abs()));
    assert!(largest > 0.115, "{largest}");
    // A uniform spread has σ = 0.12/√3; that of its estimate is smaller than a normal one's.
    assert_sigma(&offsets, 0.12 / 3.0_f64.sqrt());
}

#[test]
fn lines_scatter_by_their_sigma_and_their_four_edges_together() {
    let errors = errors(
        &DiscParams {
            line_sigma_d: 0.10,
            ..none()
        },
        3,
    );
    let lines: Vec<f64> = errors.chunks(4).map(|line| line[0]).collect();
    assert!(
        errors
            .chunks(4)
            .all(|line| line.iter().all(|edge| *edge == line[0]))
    );
    assert_sigma(&lines, 0.10);
    // Independent of the line before: a correlation of n samples scatters by 1/√n.
    let (mean, sigma) = mean_and_sigma(&lines);
    let together: f64 = lines
        .windows(2)
        .map(|pair| (pair[0] - mean) * (pair[1] - mean))
        .sum();
    let correlation = together / (sigma * sigma * lines.len() as f64);
    assert!(
        correlation.abs() < 4.0 / (lines.len() as f64).sqrt(),
        "{correlation}"
    );
}

#[test]
fn edges_scatter_by_their_sigma() {
    let errors = errors(
        &DiscParams {
            edge_sigma_d: 0.03,
            ..none()
        },
        3,
    );
    assert_sigma(&errors, 0.03);
}

#[test]
fn eccentricity_and_its_harmonic_have_their_amplitudes() {
    for seed in [1, 2, 3] {
        let errors = errors(
            &DiscParams {
                eccentricity_d: 1.5,
                second_harmonic_d: 0.3,
                ..none()
            },
            seed,
        );
        assert!((amplitude(&errors, 1) - 1.5).abs() < UNIT);
        assert!((amplitude(&errors, 2) - 0.3).abs() < UNIT);
        assert!(amplitude(&errors, 3) < UNIT);
    }
}

#[test]
fn the_phases_of_the_harmonics_are_drawn() {
    let params = DiscParams {
        eccentricity_d: 1.5,
        ..none()
    };
    let starts: Vec<f64> = (0..100).map(|seed| errors(&params, seed)[0]).collect();
    // A sine at a random phase: half of the squares on average, 35 % of that as the scatter of one.
    let mean_square = starts.iter().map(|start| start * start).sum::<f64>() / 100.0;
    assert!(
        (mean_square / (1.5 * 1.5 / 2.0) - 1.0).abs() < 0.3,
        "{mean_square}"
    );
}

#[test]
fn the_terms_of_the_real_encoder_add_up() {
    let errors = errors(&DiscParams::default(), 11);
    assert!(
        (amplitude(&errors, 1) - 1.5).abs() < 0.02,
        "lines add 0.10·√(2/2500) = 0.003 at each order"
    );
    assert!((amplitude(&errors, 2) - 0.3).abs() < 0.02);
}

#[test]
fn phases_drift_each_by_a_constant_and_leave_the_rest_as_it_was() {
    let mut drifts = Vec::new();
    for seed in 0..100 {
        let before = errors(&DiscParams::default(), seed);
        let model = EncoderModel::real().drifted(0.02);
        let after = errors(&model.disc, seed);
        let moved: Vec<f64> = before.iter().zip(&after).map(|(b, a)| a - b).collect();
        for (edge, drift) in moved.iter().enumerate() {
            // Both tables cut to a unit, towards zero.
            let off = (drift - moved[edge % 4]).abs();
            assert!(off <= 2.0 * UNIT, "{seed}: {edge} is off by {off}");
        }
        drifts.extend_from_slice(&moved[..4]);
    }
    assert!(drifts.iter().all(|drift| drift.abs() <= 0.02 + UNIT));
    assert_sigma(&drifts, 0.02 / 3.0_f64.sqrt());
}

#[test]
fn a_drift_of_nothing_is_the_disc_itself() {
    let model = EncoderModel::real();
    assert_eq!(model.drifted(0.0), model);
    // The drift is no share of anything else: what is drawn is the same without it.
    let offset = DiscParams {
        phase_drift_d: 0.02,
        ..none()
    };
    let seen = errors(&offset, 3);
    assert!(seen.chunks(4).all(|line| *line == seen[..4]));
    assert!(seen[..4].iter().all(|error| *error != 0.0));
}

#[test]
fn edges_keep_their_order_and_distance_whatever_is_drawn() {
    let wild = DiscParams {
        phase_offset_d: 0.3,
        line_sigma_d: 0.5,
        edge_sigma_d: 0.3,
        ..DiscParams::default()
    };
    for seed in 0..5 {
        let errors = errors(&wild, seed);
        for pair in errors.windows(2) {
            // The least distance of 0.05 d, and the table's unit.
            assert!(1.0 + pair[1] - pair[0] >= 0.05 - UNIT, "{pair:?}");
        }
    }
}

#[test]
fn discs_of_one_seed_are_equal_and_of_others_different() {
    let params = DiscParams::default();
    assert_eq!(errors(&params, 1), errors(&params, 1));
    assert_ne!(errors(&params, 1), errors(&params, 2));
}

#[test]
fn edges_that_are_not_whole_lines_are_refused() {
    let disc = |edges_per_revolution| {
        Disc::new(
            &DiscParams {
                edges_per_revolution,
                ..none()
            },
            1,
        )
    };
    assert_eq!(disc(4096.0).unwrap().edges(), 4096);
    for edges in [10_001.0, 10_002.5, 15.0, 16_388.0] {
        let message = disc(edges).unwrap_err().to_string();
        assert!(
            message.starts_with(&format!("edges_per_revolution = {edges} is out of range")),
            "{message}"
        );
    }
}
