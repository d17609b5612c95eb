//! What the capture hardware hands over: its ring, its timer, the sampling instant.

use leadscrew_hal_mock::arc::{Arc, State};
use leadscrew_hal_mock::encoder::{Encoder, EncoderModel, EncoderParams};

use crate::statistics::{assert_sigma, mean_and_sigma};

fn encoder(params: EncoderParams, tick_hz: f64, position: f64) -> Encoder {
    Encoder::new(
        &EncoderModel {
            encoder: params,
            ..EncoderModel::ideal()
        },
        tick_hz,
        position,
        1,
    )
    .unwrap()
}

pub fn ideal() -> EncoderParams {
    EncoderModel::ideal().encoder
}

/// A shaft at constant velocity, tick by tick.
pub struct Shaft {
    pub encoder: Encoder,
    start: f64,
    pub position: f64,
    ticks: u32,
}

impl Shaft {
    pub fn new(params: EncoderParams, tick_hz: f64, position: f64) -> Self {
        Self {
            encoder: encoder(params, tick_hz, position),
            start: position,
            position,
            ticks: 0,
        }
    }

    pub fn turn(&mut self, velocity: f64) {
        self.encoder.advance(&Arc {
            start: State {
                position: self.position,
                velocity,
                acceleration: 0.0,
            },
            jerk: 0.0,
        });
        self.position += velocity;
        self.ticks += 1;
    }

    pub fn edges(&self) -> Vec<u32> {
        self.encoder.capture().edges.concat()
    }
}

#[test]
fn the_ring_hands_over_every_edge_once_and_in_order_also_where_it_wraps() {
    let mut shaft = Shaft::new(ideal(), 1000.0, 0.5);
    let (mut all, mut in_two_parts) = (Vec::new(), 0);
    for _ in 0..400 {
        shaft.turn(150.3);
        let capture = shaft.encoder.capture();
        in_two_parts += u32::from(capture.edges.iter().all(|part| !part.is_empty()));
        assert_eq!(capture.last_edge_at, shaft.edges().last().copied());
        assert!(!capture.overrun);
        all.extend(shaft.edges());
    }
    assert_eq!(all.len(), 60_120);
    // 60 120 edges wrap a ring of 4 096 fourteen times.
    assert!((10..=14).contains(&in_two_parts), "{in_two_parts}");
    for pair in all.windows(2) {
        let spacing = f64::from(pair[1].wrapping_sub(pair[0]));
        assert!((spacing - 84_000.0 / 150.3).abs() <= 1.0, "{spacing}");
    }
}

#[test]
fn beyond_the_ring_edges_are_lost_and_said_to_be_while_the_count_stays_right() {
    let mut shaft = Shaft::new(ideal(), 1000.0, 0.5);
    for (velocity, overrun) in [(4000.0, false), (6000.0, true), (100.0, false)] {
        shaft.turn(velocity);
        let capture = shaft.encoder.capture();
        assert_eq!(capture.overrun, overrun, "{velocity}");
        assert_eq!(f64::from(capture.count), shaft.position.floor());
        assert_eq!(
            shaft.edges().len() as f64,
            if overrun { 4096.0 } else { velocity }
        );
    }
}

#[test]
fn the_timer_wraps_without_a_trace() {
    // 250 MHz wrap after 17.2 s: ten times here.
    let mut shaft = Shaft::new(
        EncoderParams {
            timer_hz: 250e6,
            ..ideal()
        },
        100.0,
        0.55,
    );
    let (mut sampled, mut last) = (0_u32, None::<u32>);
    for _ in 0..17_200 {
        shaft.turn(0.3);
        let capture = shaft.encoder.capture();
        sampled = sampled.wrapping_add(2_500_000);
        assert_eq!(capture.sampled_at, sampled);
        for at in shaft.edges() {
            if let Some(last) = last {
                let spacing = f64::from(at.wrapping_sub(last));
                assert!((spacing - 2_500_000.0 / 0.3).abs() <= 1.0, "{spacing}");
            }
            last = Some(at);
        }
        assert_eq!(f64::from(capture.count), shaft.position.floor());
    }
}

#[test]
fn an_edge_after_standing_still_for_longer_than_the_timer_runs_has_its_own_time() {
    for standing_s in [5, 9, 14, 20, 40] {
        let mut shaft = Shaft::new(
            EncoderParams {
                timer_hz: 250e6,
                ..ideal()
            },
            100.0,
            0.5,
        );
        shaft.turn(1.0);
        (0..standing_s * 100).for_each(|_| shaft.turn(0.0));
        for _ in 0..5 {
            shaft.turn(1.0);
            let capture = shaft.encoder.capture();
            assert_eq!(
                f64::from(capture.count),
                shaft.position.floor(),
                "after {standing_s} s"
            );
            let since = capture
                .last_edge_at
                .map(|at| capture.sampled_at.wrapping_sub(at));
            assert!(
                since.is_some_and(|since| since.abs_diff(1_250_000) <= 1),
                "after {standing_s} s: {since:?}"
            );
        }
    }
}

#[test]
fn the_sampling_instant_jitters_by_its_sigma_before_the_end_of_the_tick() {
    let sigma_s = 1e-5;
    let mut shaft = Shaft::new(
        EncoderParams {
            sampling_jitter_s: sigma_s,
            ..ideal()
        },
        1000.0,
        0.5,
    );
    let mut early = Vec::new();
    for tick in 1..=5000_u32 {
        shaft.turn(20.0);
        early.push(
            f64::from((tick * 84_000).wrapping_sub(shaft.encoder.capture().sampled_at)) / 84_000.0,
        );
    }
    assert_sigma(&early, sigma_s * 1000.0);
    let (mean, sigma) = mean_and_sigma(&early);
    let scatter = 4.0 * sigma / (early.len() as f64).sqrt();
    assert!(
        (mean - shaft.encoder.sampling_advance()).abs() < scatter,
        "{mean}"
    );
    assert!(
        early.iter().all(|&early| early >= 0.0),
        "never after the tick's end, when the machine has not moved yet"
    );
}

#[test]
fn count_and_edges_of_a_jittered_sample_are_those_up_to_its_instant() {
    let mut shaft = Shaft::new(
        EncoderParams {
            sampling_jitter_s: 3e-5,
            ..ideal()
        },
        1000.0,
        0.5,
    );
    let mut edges = 0;
    for _ in 0..2000 {
        shaft.turn(20.3);
        let capture = shaft.encoder.capture();
        let position = shaft.start + 20.3 * f64::from(capture.sampled_at) / 84_000.0;
        // Within a clock of a boundary either count is right.
        if (position - position.round()).abs() > 20.3 / 84_000.0 {
            assert_eq!(f64::from(capture.count), position.floor());
        }
        assert!(shaft.edges().iter().all(|at| *at <= capture.sampled_at));
        edges += shaft.edges().len() as u32;
        assert_eq!(edges, capture.count, "none is lost or comes twice");
    }
}

#[test]
fn without_jitter_it_samples_at_the_end_of_each_tick() {
    let mut shaft = Shaft::new(ideal(), 2500.0, 0.5);
    for tick in 1..=100 {
        shaft.turn(3.0);
        assert_eq!(shaft.encoder.capture().sampled_at, tick * 33_600);
    }
    assert_eq!(shaft.encoder.sampling_advance(), 0.0);
}

#[test]
fn an_encoder_may_start_anywhere_and_counts_from_there() {
    for position in [-12_345.25, -0.5, 0.0, 9_999.5, 10_000.0, 123_456.75] {
        let mut shaft = Shaft::new(ideal(), 1000.0, position);
        for velocity in [0.0, 2.75, -6.5] {
            shaft.turn(velocity);
            assert_eq!(
                f64::from(shaft.encoder.capture().count as i32),
                shaft.position.floor(),
                "from {position}"
            );
        }
    }
}

#[test]
fn tick_rates_and_parameters_out_of_range_are_refused() {
    for tick_hz in [0.0, 50.0, 1e9, f64::NAN] {
        let error = Encoder::new(&EncoderModel::ideal(), tick_hz, 0.5, 1).unwrap_err();
        assert_eq!(
            (error.name, error.min, error.max),
            ("tick_hz", 100.0, 40_000.0)
        );
    }
    let model = EncoderModel {
        encoder: EncoderParams {
            noise_d: -1.0,
            ..ideal()
        },
        ..EncoderModel::ideal()
    };
    assert_eq!(
        Encoder::new(&model, 1000.0, 0.5, 1).unwrap_err().name,
        "noise_d"
    );
}
