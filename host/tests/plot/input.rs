//! Figures that cannot be drawn are refused; odd data is drawn.

use leadscrew_host::plot::{Colour, Figure, MAX_SIDE, Panel, PlotError, Series};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use crate::examples::{Points, motion, one_line, one_panel, sampled};

fn config() -> ProptestConfig {
    ProptestConfig {
        cases: 128,
        rng_seed: RngSeed::Fixed(2),
        failure_persistence: None,
        ..ProptestConfig::default()
    }
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn any_two_values_make_a_figure(low in any::<f64>(), high in any::<f64>(), x in any::<f64>()) {
        let points = vec![(0.0, low), (1.0, high), (x, low)];
        let document = one_line(points).to_svg().unwrap();
        prop_assert!(!document.contains("NaN") && !document.contains("inf"), "{document}");
    }
}

#[test]
fn figures_that_cannot_be_laid_out_are_refused() {
    let empty = Figure::new("", Vec::new());
    assert!(matches!(empty.to_svg(), Err(PlotError::NoPanels)));
    for (width, height) in [
        (0, 0),
        (399, 700),
        (1200, 479),
        (1200, MAX_SIDE + 1),
        (u32::MAX, 700),
    ] {
        let figure = Figure {
            width,
            height,
            ..motion(10)
        };
        let error = figure.to_png().unwrap_err();
        assert!(
            matches!(
                error,
                PlotError::Size {
                    min_height: 480,
                    ..
                }
            ),
            "{width} × {height}"
        );
    }
    for (low, high) in [
        (1.0, 1.0),
        (2.0, -2.0),
        (f64::NAN, 1.0),
        (0.0, f64::INFINITY),
    ] {
        let panel = Panel::new("x", "speed, d/tick", Vec::new()).with_y_limits(low, high);
        let error = Figure::new("", vec![panel]).to_svg().unwrap_err();
        assert!(error.to_string().contains("speed, d/tick"), "{error}");
    }
}

#[test]
fn odd_data_is_drawn_without_a_panic() {
    let odd: [Points; 9] = [
        vec![],
        vec![(1.0, 2.0)],
        sampled(100, |_| 70.25),
        sampled(100, |_| 0.0),
        vec![
            (0.0, f64::NAN),
            (f64::NAN, 0.0),
            (f64::INFINITY, f64::NEG_INFINITY),
        ],
        vec![(3.0, 1.0), (3.0, -1.0), (3.0, 0.0)],
        vec![
            (0.0, f64::MAX),
            (1.0, f64::MIN),
            (2.0, 1e150),
            (3.0, -1e150),
        ],
        vec![(0.0, 5e-324), (5e-324, 0.0)],
        vec![(1e15, 1e15), (1e15 + 0.125, 1e15 + 0.125)],
    ];
    for points in odd {
        let series = [
            Series::line("line", points.clone(), Colour::Blue),
            Series::dashed("dashed", points.clone(), Colour::Black).with_width(f64::NAN),
            Series::dots("dots", points.clone(), Colour::Grey).with_width(-1.0),
        ];
        let mut figure = one_panel(series.to_vec());
        figure.panels.push(Panel::default());
        figure.height = 320;
        assert!(!figure.to_svg().unwrap().contains("NaN"), "{points:?}");
        figure.to_png().unwrap();
    }
}
