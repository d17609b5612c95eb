//! From errors to an image and back.

use leadscrew::encoder_map::Direction::{Backward, Forward};
use leadscrew::encoder_map::format::image_len;
use leadscrew::encoder_map::{EncoderMap, Form};
use leadscrew_hal_mock::encoder::EncoderModel;
use proptest::prelude::*;

use crate::content::{Errors, RESIDUAL, errors};
use crate::seeded::seeded;

/// Error of an edge by direction, Q.16 d: the mean one, half the difference of the phases to either side.
fn wanted(errors: &Errors, edge: u32) -> [i32; 2] {
    let [forward, backward] = errors.phases.map(|phases| phases[(edge % 4) as usize]);
    let half = (forward - backward) / 2;
    let mean = errors.edges[edge as usize];
    [mean + half, mean - half]
}

/// Coarsest step whose bytes hold all misfits up to `largest`, Q.16 d: what the map may be wrong by is half of it.
fn step(largest: i32) -> i32 {
    (7..=10)
        .map(|bits| 65_536 >> bits)
        .filter(|step| largest <= step * 127)
        .min()
        .expect("such a map was made")
}

proptest! {
    #![proptest_config(seeded(64))]

    #[test]
    fn a_full_map_gives_each_edge_back_to_half_a_step(errors in errors()) {
        let image = errors.encode(Form::Full);
        let map = EncoderMap::from_bytes(&image).unwrap();
        prop_assert_eq!(map.edges() as usize, errors.edges.len());
        let coarse = errors.encode(Form::Coarse);
        let coarse = EncoderMap::from_bytes(&coarse).unwrap();
        // The map is of errors less the slow part at edge 0, the same for all edges.
        let mut offsets = Vec::new();
        let mut largest = 0;
        for edge in 0..map.edges() {
            let [forward, backward] = wanted(&errors, edge);
            offsets.push(forward - map.error(edge, Forward));
            offsets.push(backward - map.error(edge, Backward));
            largest = largest.max((map.error(edge, Forward) - coarse.error(edge, Forward)).abs());
        }
        // Phases are written in 4 of these units; with their means the rest is rounded twice.
        let spread = offsets.iter().max().unwrap() - offsets.iter().min().unwrap();
        prop_assert!(spread <= step(largest) + 10, "{} for {}", spread, step(largest));
    }

    #[test]
    fn the_base_is_zero_at_edge_0(errors in errors()) {
        let image = errors.encode(Form::Coarse);
        let map = EncoderMap::from_bytes(&image).unwrap();
        for direction in [Forward, Backward] {
            prop_assert_eq!(map.error(0, direction), map.phase_error(0, direction));
        }
    }
}

#[test]
fn the_map_of_the_reference_encoder_takes_ten_kilobytes() {
    let errors = Errors::true_of(&EncoderModel::real(), 1);
    let image = errors.encode(Form::Full);
    assert_eq!(image.len(), 64 + 158 * 2 + 10_000 + 4);
    assert!((10 * 1024..=11 * 1024).contains(&image.len()));
    assert_eq!(image_len(10_000, Form::Coarse), 384);
    assert_eq!(image_len(10_000, Form::Phases), 68);
}

#[test]
fn the_rest_comes_back_as_it_was() {
    let errors = Errors::true_of(&EncoderModel::real(), 1);
    for form in [Form::Full, Form::Coarse, Form::Phases] {
        let mut image = errors.encode(form);
        // A page of flash is longer than the map.
        image.extend([0xff; 100]);
        let map = EncoderMap::from_bytes(&image).unwrap();
        assert_eq!((map.form(), map.edges()), (form, 10_000));
        assert_eq!(*map.residual(), RESIDUAL);
        let fronts = [Forward, Backward].map(|direction| map.front(direction));
        let expected = if form == Form::Phases {
            [None, None]
        } else {
            [Some(0), Some(2)]
        };
        assert_eq!(fronts, expected);
        for (direction, phases) in [Forward, Backward].into_iter().zip(errors.phases) {
            for (phase, wanted) in (0..).zip(phases) {
                assert!((map.phase_error(phase, direction) - wanted).abs() <= 2);
            }
        }
    }
}

#[test]
fn the_coarse_form_leaves_the_lines_but_not_the_eccentricity() {
    let errors = Errors::true_of(&EncoderModel::real(), 1);
    let rms = |form| {
        let image = errors.encode(form);
        let map = EncoderMap::from_bytes(&image).unwrap();
        let left: Vec<f64> = (0..10_000)
            .map(|edge| f64::from(wanted(&errors, edge)[0] - map.error(edge, Forward)) / 65536.0)
            .collect();
        let mean = left.iter().sum::<f64>() / left.len() as f64;
        let squares = left.iter().map(|left| (left - mean).powi(2)).sum::<f64>();
        (squares / left.len() as f64).sqrt()
    };
    // Eccentricity 1.5 d and 0.3 d; lines 0.10 d with edges 0.03 d; steps of 1/256 d.
    assert!(
        (rms(Form::Phases) - 1.09).abs() < 0.05,
        "{}",
        rms(Form::Phases)
    );
    assert!(
        (rms(Form::Coarse) - 0.104).abs() < 0.005,
        "{}",
        rms(Form::Coarse)
    );
    assert!(
        rms(Form::Full) < 1.1 / 256.0 / 12_f64.sqrt(),
        "{}",
        rms(Form::Full)
    );
}
