//! What is no map is refused, with a reason.

use leadscrew::encoder_map::encode::{MapContent, encode};
use leadscrew::encoder_map::error::{EncodeError, MapError};
use leadscrew::encoder_map::format::image_len;
use leadscrew::encoder_map::{EncoderMap, Form, Residual};
use leadscrew_hal_mock::encoder::EncoderModel;

use crate::content::{Errors, RESIDUAL};

const FORMS: [Form; 3] = [Form::Full, Form::Coarse, Form::Phases];

fn small() -> Errors {
    Errors {
        edges: (0..128).map(|edge| (edge * 7919) % 9000 - 4500).collect(),
        phases: [[3000, -2000, 100, -900]; 2],
        fronts: [Some(-1), Some(3)],
    }
}

#[test]
fn every_flipped_bit_is_found() {
    for form in FORMS {
        let good = small().encode(form);
        assert!(EncoderMap::from_bytes(&good).is_ok());
        for bit in 0..good.len() * 8 {
            let mut image = good.clone();
            image[bit / 8] ^= 1 << (bit % 8);
            assert!(
                EncoderMap::from_bytes(&image).is_err(),
                "{form:?}: bit {bit}"
            );
        }
    }
}

#[test]
fn every_cut_is_found() {
    for form in FORMS {
        let image = small().encode(form);
        for len in 0..image.len() {
            let result = EncoderMap::from_bytes(&image[..len]).map(|map| map.edges());
            assert!(
                matches!(result, Err(MapError::Cut { given, needed }) if given == len && needed > len),
                "{form:?} of {len}: {result:?}"
            );
        }
    }
}

#[test]
fn errors_say_what_is_wrong() {
    let good = small().encode(Form::Full);
    let message = |offset: usize, bytes: &[u8]| {
        let mut image = good.clone();
        image[offset..][..bytes.len()].copy_from_slice(bytes);
        EncoderMap::from_bytes(&image).unwrap_err().to_string()
    };
    for (offset, bytes, words) in [
        (0, &b"LSEX"[..], "no encoder map"),
        (4, &[2, 0], "version 2, expected 1"),
        (6, &[3], "form at byte 6"),
        (
            7,
            &[11],
            "step of the bytes at byte 7 of the encoder map is out of range: allowed 7 to 10",
        ),
        (8, &[12, 0, 0, 0], "edges a revolution at byte 8"),
        (8, &[130, 0, 0, 0], "multiple of 4"),
        (8, &[4, 0, 1, 0], "16 to 65536"),
        (12, &[63, 0], "spacing of the base"),
        (14, &[4, 0], "fronts known"),
        (16, &[128, 0], "index front"),
        (
            36,
            &f32::NAN.to_le_bytes(),
            "residual of short waves at byte 36",
        ),
        (52, &(-1.0_f32).to_le_bytes(), "noise of time at byte 52"),
        (56, &f32::INFINITY.to_le_bytes(), "hysteresis at byte 56"),
        (60, &[0; 4], "length at byte 60"),
        (100, &[0; 4], "damaged"),
    ] {
        let text = message(offset, bytes);
        assert!(text.contains(words), "{text:?} instead of {words:?}");
    }
}

/// Makes a full map of 256 edges that all lie right except as `error` says.
fn refused(change: impl FnOnce(&mut MapContent<'_>), error: &dyn Fn(u32) -> i32) -> EncodeError {
    let mut content = MapContent {
        edges: 256,
        error,
        phases: [[0; 4]; 2],
        fronts: [None; 2],
        residual: RESIDUAL,
    };
    change(&mut content);
    encode(&content, Form::Full, &mut [0; 1000]).unwrap_err()
}

#[test]
fn what_does_not_fit_makes_no_map() {
    const D: i32 = 65_536;
    let right = |_: u32| 0;
    let outlier = |edge: u32| if edge == 77 { -5 * D / 4 } else { 0 };
    let error = refused(|_| {}, &outlier);
    assert!(
        matches!(error, EncodeError::Misfit { edge: 77, misfit } if (-5 * D / 4..-D).contains(&misfit)),
        "{error:?}"
    );
    assert!(error.to_string().contains("edge 77 lies -1.2"), "{error}");

    let wide = |edge: u32| if (64..192).contains(&edge) { 9 * D } else { 0 };
    let error = refused(|_| {}, &wide);
    assert!(
        matches!(error, EncodeError::Base { edge: 128, .. }),
        "{error:?}"
    );

    let error = refused(|content| content.phases[1][2] = -3 * D, &right);
    assert_eq!(error, EncodeError::Phase { error: -3 * D });
    for edges in [0, 12, 18, 65_540] {
        let error = refused(|content| content.edges = edges, &right);
        assert_eq!(error, EncodeError::Edges { edges });
    }
    let nothing = Residual {
        noise_d: f32::NAN,
        ..RESIDUAL
    };
    let error = refused(|content| content.residual = nothing, &right);
    assert_eq!(error, EncodeError::Figure);
    let error = refused(|content| content.fronts = [Some(256), None], &right);
    assert_eq!(error, EncodeError::Figure);
    let needed = image_len(10_000, Form::Full);
    let errors = Errors::true_of(&EncoderModel::real(), 1);
    let given = |edge: u32| errors.edges[edge as usize];
    assert_eq!(
        encode(&errors.content(&given), Form::Full, &mut [0; 100]),
        Err(EncodeError::Memory { given: 100, needed })
    );
}

#[test]
fn the_step_is_the_finest_that_holds() {
    let d = |share: f64| (share * 65_536.0) as i32;
    for (largest, step_bits) in [(0.12, 10), (0.13, 9), (0.26, 8), (0.51, 7)] {
        // Both ways alike, so that the base stays at 0 but for a 64th of it.
        let error = move |edge: u32| match edge {
            130 => d(largest),
            131 => -d(largest),
            _ => 0,
        };
        let mut image = [0; 1000];
        let content = MapContent {
            edges: 256,
            error: &error,
            phases: [[0; 4]; 2],
            fronts: [None; 2],
            residual: RESIDUAL,
        };
        encode(&content, Form::Full, &mut image).unwrap();
        assert_eq!(image[7], step_bits, "{largest}");
    }
}
