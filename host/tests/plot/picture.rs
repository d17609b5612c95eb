//! What the reader sees.

use leadscrew_host::plot::{Colour, Figure, PlotError, Series};

use crate::examples::{motion, one_line, one_panel, sampled};
use crate::reading::{Picture, Text, elements, number, texts};

/// Size of tick labels, pixels: no other text has it.
const TICK_SIZE: f64 = 12.0;
/// Where the rotated label of the vertical axis ends, pixels from the left.
const AXIS_LABEL_END: f64 = 18.0;

#[test]
fn title_labels_and_names_are_written_once() {
    let mut figure = motion(100);
    figure.title = "costs $5 & <$6>\u{7}".to_owned();
    figure.panels[2].x_label = "time, ms".to_owned();
    let document = figure.to_svg().unwrap();
    let texts: Vec<String> = texts(&document)
        .into_iter()
        .map(|text| text.content)
        .collect();
    for expected in [
        "costs $5 &amp; &lt;$6&gt; ",
        "acceleration, d/tick²",
        "velocity, d/tick",
        "following error, d",
        "time, ms",
        "exponential",
        "Gaussian",
    ] {
        let count = texts.iter().filter(|text| *text == expected).count();
        assert_eq!(count, 1, "`{expected}` in {texts:?}");
    }
    assert!(
        !texts.contains(&"time, s".to_owned()),
        "only the bottom panel labels the time"
    );
    assert!(document.contains(r#"viewBox="0 0 1200 1050""#));
}

/// Left and right edges of the panels' frames.
fn frame_edges(document: &str) -> Vec<f64> {
    let upright = |line: &&str| number(line, "x1") == number(line, "x2");
    let long = |line: &&str| (number(line, "y2") - number(line, "y1")).abs() > 80.0;
    let framed = |line: &&str| line.contains("#444444");
    let lines = elements(document, "line");
    let edges = lines
        .iter()
        .filter(|line| framed(line) && upright(line) && long(line));
    let mut edges: Vec<f64> = edges.map(|line| number(line, "x1")).collect();
    edges.sort_by(f64::total_cmp);
    edges.dedup();
    edges
}

#[test]
fn panels_align_and_the_legend_stays_outside() {
    let mut figure = motion(100);
    figure.panels[0].series[0].name = "a rather long name of a series".to_owned();
    figure.panels[2].series[0].points = sampled(100, |t| 1e6 * t);
    let document = figure.to_svg().unwrap();
    let edges = frame_edges(&document);
    assert_eq!(edges.len(), 2, "frames at {edges:?}");
    let names = [
        "a rather long name of a series",
        "exponential",
        "truth",
        "encoder",
    ];
    let entries = texts(&document);
    let entries: Vec<_> = entries
        .iter()
        .filter(|text| names.contains(&text.content.as_str()))
        .collect();
    assert_eq!(entries.len(), 5);
    assert!(entries.iter().all(|text| text.x > edges[1]), "{entries:?}");
}

#[test]
fn series_are_drawn_in_their_order() {
    let document = motion(1000).to_svg().unwrap();
    let at = |colour: &str| document.find(&format!("stroke=\"{colour}\"")).unwrap();
    let order = ["#aaaaaa", "#0072b2", "#d55e00", "#009e73", "#000000"].map(at);
    assert!(order.is_sorted(), "{order:?}");
}

/// By the font's advances: the minus sign 0.84 of its size, digits 0.64, the point 0.32.
fn tick_label_width(text: &Text) -> f64 {
    let advance = |c| match c {
        '−' => 0.84,
        '.' => 0.32,
        _ => 0.64,
    };
    TICK_SIZE * text.content.chars().map(advance).sum::<f64>()
}

fn assert_ticks_are_legible(figure: &Figure) {
    let document = figure.to_svg().unwrap();
    let labels = texts(&document);
    let ticks = labels.iter().filter(|text| text.size == TICK_SIZE);
    let (beneath, beside): (Vec<_>, Vec<_>) = ticks.partition(|tick| tick.middle);
    assert!(beneath.len() >= 2 && beside.len() >= 3, "{labels:?}");
    for tick in beneath.iter().chain(&beside) {
        assert!(tick.content.chars().count() <= 14, "{tick:?}");
    }
    for pair in beneath.windows(2) {
        let apart = pair[1].x - pair[0].x;
        let halves = (tick_label_width(pair[0]) + tick_label_width(pair[1])) / 2.0;
        assert!(apart > halves, "{pair:?}");
    }
    for tick in beside {
        let start = tick.x - tick_label_width(tick);
        assert!(start > AXIS_LABEL_END, "{tick:?} runs into the axis label");
    }
}

#[test]
fn tick_labels_are_short_and_apart() {
    let ends = [
        (0.0, 5.0),
        (-0.003, 0.004),
        (1e9, 1.000_001e9),
        (0.0, 123_456.0),
        (-2e-7, 3e-7),
        (12.0, 12.01),
    ];
    for (low, high) in ends {
        // Every leading digit, so that ticks come as near as they can.
        for (width, stretch) in (1..10).flat_map(|digit| [(400, digit), (1200, digit)]) {
            let span = (high - low) * f64::from(stretch);
            let line = |part: f64| low + span * part;
            let points = [0.0, 0.3, 1.0].map(|part| (line(part), line(part)));
            assert_ticks_are_legible(&Figure {
                width,
                ..one_line(points.to_vec())
            });
        }
    }
}

#[test]
fn the_widest_tick_labels_have_room_in_any_panel() {
    for index in 0..3 {
        let mut figure = motion(100);
        figure.panels[index].series[0].points = sampled(100, |t| -1e6 * t);
        assert_ticks_are_legible(&figure);
    }
}

#[test]
fn curves_end_at_the_limits_of_the_axis() {
    let mut figure = one_line(sampled(500, |t| 1e6 * (t * 20.0).sin()));
    figure.panels[0].y_limits = Some((-1.0, 1.0));
    let document = figure.to_svg().unwrap();
    let curve = elements(&document, "path");
    let curve = curve.iter().find(|path| path.contains("#0072b2")).unwrap();
    let d = curve
        .split("d=\"")
        .nth(1)
        .unwrap()
        .split('"')
        .next()
        .unwrap();
    let heights = d
        .split(['M', 'L'])
        .filter_map(|point| point.split_once(' '));
    let heights: Vec<f64> = heights.map(|point| point.1.parse().unwrap()).collect();
    assert!(heights.len() > 20);
    assert!(
        heights.iter().all(|y| (16.0..=297.0).contains(y)),
        "{heights:?}"
    );
}

#[test]
fn a_png_has_the_size_asked_for_on_white() {
    let figure = Figure {
        width: 801,
        height: 503,
        ..motion(500)
    };
    let picture = Picture::of(&figure);
    assert_eq!((picture.width, picture.height), (801, 503));
    for (x, y) in [(0, 0), (800, 0), (0, 502), (800, 502)] {
        assert_eq!(picture.at(x, y), [255, 255, 255]);
    }
}

/// Columns of the picture where a curve's colour shows within the frame.
fn coloured_columns(figure: &Figure, colour: Colour) -> (Vec<bool>, usize) {
    let edges = frame_edges(&figure.to_svg().unwrap());
    let picture = Picture::of(figure);
    let (red, green, blue) = colour.rgb();
    let shows = |x| (0..picture.height).any(|y| picture.near(x, y, [red, green, blue]));
    // The frame itself is dark: stay clear of it.
    let columns = edges[0] as usize + 3..edges[1] as usize - 3;
    let shown: Vec<bool> = columns.map(shows).collect();
    let count = shown.iter().filter(|&&shown| shown).count();
    (shown, count)
}

#[test]
fn missing_samples_leave_a_gap_in_the_line() {
    let gap = |t: f64| {
        if (2.0..3.0).contains(&t) {
            f64::NAN
        } else {
            1.0
        }
    };
    let (shown, count) = coloured_columns(&one_line(sampled(5000, gap)), Colour::Blue);
    let part = |from: f64, to: f64| {
        let at = |t: f64| (t / 5.0 * shown.len() as f64) as usize;
        shown[at(from)..at(to)]
            .iter()
            .filter(|&&shown| shown)
            .count()
    };
    assert_eq!(part(2.05, 2.95), 0);
    let whole = shown.len() as f64;
    assert!(
        (0.78..0.82).contains(&(count as f64 / whole)),
        "{count} of {whole} columns"
    );
}

#[test]
fn dashes_stay_dashes_however_dense_the_points() {
    for count in [10, 5000] {
        let line = Series::dashed("", sampled(count, |_| 1.0), Colour::Black);
        let (shown, dark) = coloured_columns(&one_panel(vec![line]), Colour::Black);
        let starts = shown.windows(2).filter(|pair| !pair[0] && pair[1]).count();
        let part = dark as f64 / shown.len() as f64;
        assert!(
            (0.4..0.9).contains(&part),
            "{count} points: {part} of the line drawn"
        );
        assert!(starts > 40, "{count} points: {starts} dashes");
    }
}

#[test]
fn noise_keeps_its_envelope_in_the_picture() {
    let count = 100_000;
    let spikes = |k: usize| if k.is_multiple_of(997) { 1.0 } else { 0.0 };
    let points = (0..count).map(|k| (k as f64, spikes(k))).collect();
    let picture = Picture::of(&one_line(points));
    let (red, green, blue) = Colour::Blue.rgb();
    let rows: Vec<usize> = (0..picture.height)
        .filter(|&y| (90..picture.width - 140).any(|x| picture.near(x, y, [red, green, blue])))
        .collect();
    // Padding of 5 % above and below leaves 91 % of the frame.
    let tall = rows.last().unwrap() - rows.first().unwrap();
    assert!(tall > 230, "spikes {tall} pixels tall");
}

#[test]
fn decades_of_logarithmic_axes_are_as_wide_as_each_other() {
    let points = (0..=40).map(|at| 10_f64.powf(f64::from(at) / 10.0));
    let mut points: Vec<_> = points.map(|x| (x, x * x)).collect();
    points.push((0.0, -1.0));
    let mut figure = one_line(points).with_log_x();
    figure.panels[0].is_y_log = true;
    assert_ticks_are_legible(&figure);
    let labels = texts(&figure.to_svg().unwrap());
    let place = |content: &str| {
        let label = labels
            .iter()
            .find(|text| text.content == content && text.middle);
        label.expect(content).x
    };
    let first = place("10") - place("1");
    assert!((place("1000") - place("100") - first).abs() < 1e-6);
    assert_eq!(Picture::of(&figure).width, 1200);
    // Nothing that has a place.
    let mut empty = one_line(vec![(-1.0, 1.0)]).with_log_x();
    empty.panels[0] = empty.panels[0].clone().with_log_y();
    assert!(empty.to_svg().is_ok());
    empty.panels[0].y_limits = Some((0.0, 1.0));
    assert!(matches!(empty.to_svg(), Err(PlotError::Limits { .. })));
}
