//! Whether a sampled path goes along another.

use std::ops::Range;

use leadscrew_nc::coordinates::Coordinates;

/// Goes along a path with the places of another, none farther than `bound` from it, never back and to its end. Else how far a
/// place is from where the path may have been by then, mm, and the place. Where the path crosses itself or comes back, all that it
/// may mean is followed, up to so many lines ahead.
pub fn strays(
    places: &[Coordinates],
    path: &[Coordinates],
    bound: f64,
    ahead: usize,
) -> Option<(f64, Coordinates)> {
    let last = path.len() - 2;
    let mut along: Range<usize> = 0..1;
    for place in places {
        // Rounding may put a place a little back.
        let window = along.start.saturating_sub(3)..(along.end + ahead).min(last + 1);
        let off = |line: usize| to_segment(place, &path[line], &path[line + 1]);
        let mut near = window.clone().filter(|line| off(*line) <= bound);
        let Some(first) = near.next() else {
            let least = window.map(off).fold(f64::INFINITY, f64::min);
            return Some((least, *place));
        };
        along = first..near.next_back().unwrap_or(first) + 1;
    }
    (along.end <= last).then(|| (f64::INFINITY, path[along.end]))
}

fn to_segment(place: &Coordinates, from: &Coordinates, to: &Coordinates) -> f64 {
    let (way, off) = (*to - *from, *place - *from);
    let dot = |a: &Coordinates, b: &Coordinates| a.iter().map(|(axis, v)| v * b[axis]).sum::<f64>();
    let squared = dot(&way, &way);
    let along = if squared > 0.0 {
        (dot(&off, &way) / squared).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (off - way * along).length_mm()
}
