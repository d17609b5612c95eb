//! Lines in pixels: cut at the panel's edges, cut into dashes, thinned to dots.

use std::collections::HashSet;
use std::fmt::Write;

/// A point in pixels, y downwards.
pub(super) type Pixel = (f64, f64);

/// The parts of a line between two heights.
pub(super) fn clip(line: &[Pixel], top: f64, bottom: f64) -> Vec<Vec<Pixel>> {
    let inside = |point: &Pixel| (top..=bottom).contains(&point.1);
    if let [only] = line {
        // A lone sample between two gaps: a line of no length, drawn as a dot.
        return if inside(only) {
            vec![vec![*only, *only]]
        } else {
            Vec::new()
        };
    }
    let mut parts: Vec<Vec<Pixel>> = Vec::new();
    let mut joined = false;
    for pair in line.windows(2) {
        let Some((from, to)) = clip_segment(pair[0], pair[1], top, bottom) else {
            joined = false;
            continue;
        };
        match parts.last_mut() {
            Some(part) if joined => part.push(to),
            _ => parts.push(vec![from, to]),
        }
        joined = inside(&pair[1]);
    }
    parts
}

fn clip_segment(from: Pixel, to: Pixel, top: f64, bottom: f64) -> Option<(Pixel, Pixel)> {
    if from.1.max(to.1) < top || from.1.min(to.1) > bottom {
        return None;
    }
    let limit = |end: Pixel| {
        let y = end.1.clamp(top, bottom);
        if y == end.1 {
            return end;
        }
        let part = (y - from.1) / (to.1 - from.1);
        (from.0 + (to.0 - from.0) * part, y)
    };
    Some((limit(from), limit(to)))
}

/// A line cut into dashes `on` long, `off` apart. The pattern runs on over corners.
pub(super) fn dashes(line: &[Pixel], on: f64, off: f64) -> Vec<Vec<Pixel>> {
    let mut pieces = Vec::new();
    let mut dash: Vec<Pixel> = line.first().copied().into_iter().collect();
    let (mut drawing, mut left) = (true, on);
    for pair in line.windows(2) {
        let (mut from, to) = (pair[0], pair[1]);
        loop {
            let length = (to.0 - from.0).hypot(to.1 - from.1);
            if length <= left {
                left -= length;
                if drawing {
                    dash.push(to);
                }
                break;
            }
            let part = left / length;
            from = (
                from.0 + (to.0 - from.0) * part,
                from.1 + (to.1 - from.1) * part,
            );
            dash.push(from);
            if drawing {
                pieces.push(std::mem::take(&mut dash));
            }
            drawing = !drawing;
            left = if drawing { on } else { off };
        }
    }
    if drawing && dash.len() > 1 {
        pieces.push(dash);
    }
    pieces
}

/// One dot, the first, in every square cell of this side that has any.
pub(super) fn distinct(dots: impl Iterator<Item = Pixel>, cell: f64) -> Vec<Pixel> {
    let mut taken = HashSet::new();
    dots.filter(|dot| taken.insert(((dot.0 / cell) as i64, (dot.1 / cell) as i64)))
        .collect()
}

/// The lines as the `d` attribute of one SVG path, to hundredths of a pixel.
pub(super) fn svg_path(lines: &[Vec<Pixel>]) -> String {
    let mut d = String::new();
    for line in lines {
        for (index, &(x, y)) in line.iter().enumerate() {
            let command = if index == 0 { 'M' } else { 'L' };
            d.push(command);
            push_number(&mut d, x);
            d.push(' ');
            push_number(&mut d, y);
        }
    }
    d
}

fn push_number(d: &mut String, value: f64) {
    let start = d.len();
    // Writing to a string cannot fail.
    let _ = write!(d, "{value:.2}");
    let kept = d[start..].trim_end_matches('0').trim_end_matches('.').len();
    d.truncate(start + kept);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn length(lines: &[Vec<Pixel>]) -> f64 {
        let segment = |pair: &[Pixel]| (pair[1].0 - pair[0].0).hypot(pair[1].1 - pair[0].1);
        lines
            .iter()
            .flat_map(|line| line.windows(2).map(segment))
            .sum()
    }

    #[test]
    fn a_line_leaving_the_panel_ends_at_its_edge() {
        let line = [(0.0, 5.0), (10.0, 25.0), (20.0, 5.0)];
        let parts = clip(&line, 0.0, 15.0);
        assert_eq!(
            parts,
            [[(0.0, 5.0), (5.0, 15.0)], [(15.0, 15.0), (20.0, 5.0)]]
        );
    }

    #[test]
    fn a_line_across_the_panel_keeps_its_slope() {
        assert_eq!(
            clip(&[(0.0, -10.0), (40.0, 30.0)], 0.0, 20.0),
            [[(10.0, 0.0), (30.0, 20.0)]]
        );
        assert!(clip(&[(0.0, 30.0), (5.0, 40.0)], 0.0, 20.0).is_empty());
    }

    #[test]
    fn dashes_do_not_depend_on_the_number_of_points() {
        let coarse = [(0.0, 0.0), (100.0, 0.0)];
        let fine: Vec<Pixel> = (0..=1000).map(|i| (f64::from(i) * 0.1, 0.0)).collect();
        let (coarse, fine) = (dashes(&coarse, 6.0, 4.0), dashes(&fine, 6.0, 4.0));
        assert_eq!((coarse.len(), fine.len()), (10, 10));
        assert!((length(&coarse) - 60.0).abs() < 1e-9);
        assert!((length(&fine) - 60.0).abs() < 1e-6);
    }

    #[test]
    fn svg_numbers_are_short() {
        assert_eq!(
            svg_path(&[vec![(1.0, 2.5), (100.0, -0.126)]]),
            "M1 2.5L100 -0.13"
        );
    }
}
