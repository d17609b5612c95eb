//! Errors by wavelength.

use super::segments::{SEGMENTS, segment_start};

/// Harmonics of the revolution that are told one by one.
pub const ORDERS: usize = 32;

/// Errors by wavelength, d rms.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Bands {
    /// Once a revolution.
    pub first: f64,
    /// Twice a revolution.
    pub second: f64,
    /// Orders 3 to 10.
    pub third_to_tenth: f64,
    /// Orders 11 to 32.
    pub eleventh_to_32nd: f64,
    /// Shorter than that, down to lines against their neighbours.
    pub lines: f64,
    /// Edges within their line; the four phases are not in it.
    pub edges: f64,
}

/// Means of the segments of a revolution.
pub type Segments = [f64; SEGMENTS];

/// Harmonics of the revolution from the means of its segments.
#[derive(Clone, Copy, Debug)]
pub struct Harmonics {
    /// Cosine and sine parts of the orders from 1 on, d.
    parts: [(f64, f64); ORDERS],
    /// What the segments hold besides, d rms.
    rest: f64,
}

impl Harmonics {
    /// Takes the harmonics out of the means of segments of a revolution of `edges`.
    pub fn of(edges: u32, mut segments: Segments) -> Self {
        let mean = segments.iter().sum::<f64>() / SEGMENTS as f64;
        for segment in &mut segments {
            *segment -= mean;
        }
        let mut parts = [(0.0, 0.0); ORDERS];
        for (part, order) in parts.iter_mut().zip(1_u32..) {
            *part = take_out(edges, f64::from(order), &mut segments);
        }
        let squares: f64 = segments.iter().map(|rest| rest * rest).sum();
        Self {
            parts,
            rest: libm::sqrt(squares / SEGMENTS as f64),
        }
    }

    /// Orders from 1 on with their amplitudes, d.
    pub fn amplitudes(&self) -> impl Iterator<Item = (u32, f64)> + '_ {
        let amplitude = |&(cosine, sine): &(f64, f64)| libm::hypot(cosine, sine);
        (1..).zip(self.parts.iter().map(amplitude))
    }

    /// Bands of the harmonics, without lines and edges.
    pub fn bands(&self) -> Bands {
        let rms = |from, to| {
            let squares: f64 = self
                .amplitudes()
                .filter(|(order, _)| (from..=to).contains(order))
                .map(|(_, amplitude)| amplitude * amplitude / 2.0)
                .sum();
            libm::sqrt(squares)
        };
        Bands {
            first: rms(1, 1),
            second: rms(2, 2),
            third_to_tenth: rms(3, 10),
            eleventh_to_32nd: rms(11, ORDERS as u32),
            lines: self.rest,
            edges: 0.0,
        }
    }
}

/// Takes one order out of the segments; a segment shows sinc(h/128) of it.
fn take_out(edges: u32, order: f64, segments: &mut Segments) -> (f64, f64) {
    let half_width = core::f64::consts::PI * order / SEGMENTS as f64;
    let shown = libm::sin(half_width) / half_width;
    let phase = |segment: u32| {
        let ends = segment_start(edges, segment)
            .wrapping_add(segment_start(edges, segment.wrapping_add(1)));
        let middle = (f64::from(ends) - 1.0) / 2.0;
        libm::sincos(core::f64::consts::TAU * order * middle / f64::from(edges))
    };
    let (mut cosine, mut sine) = (0.0, 0.0);
    for (value, segment) in segments.iter().zip(0..) {
        let (s, c) = phase(segment);
        cosine += value * c;
        sine += value * s;
    }
    cosine *= 2.0 / SEGMENTS as f64;
    sine *= 2.0 / SEGMENTS as f64;
    for (value, segment) in segments.iter_mut().zip(0..) {
        let (s, c) = phase(segment);
        *value -= cosine * c + sine * s;
    }
    (cosine / shown, sine / shown)
}

/// Means of the segments of a revolution whose edges have the errors `errors`.
pub fn segment_means(edges: u32, mut errors: impl Iterator<Item = f64>) -> Segments {
    let mut means = [0.0; SEGMENTS];
    for (mean, segment) in means.iter_mut().zip(0..) {
        let length = segment_length(edges, segment);
        *mean = errors.by_ref().take(length).sum::<f64>() / length as f64;
    }
    means
}

/// All bands of the errors of a revolution of `edges`; `errors` gives them from edge 0 on, anew each time.
pub fn bands<I: Iterator<Item = f64>>(edges: u32, errors: impl Fn() -> I) -> Bands {
    let means = segment_means(edges, errors());
    let mut bands = Harmonics::of(edges, means).bands();
    let mut all = errors();
    let (mut line_squares, mut edge_squares) = (0.0, 0.0);
    for segment in 0..SEGMENTS {
        let lines = segment_length(edges, segment as u32) / 4;
        for line in 0..lines {
            let place = (line as f64 + 0.5) / lines as f64 - 0.5;
            let mut four = [0.0; 4];
            for (slot, error) in four.iter_mut().zip(all.by_ref()) {
                *slot = error;
            }
            let mean = four.iter().sum::<f64>() / 4.0;
            let off = mean - between(&means, segment, place);
            line_squares += off * off;
            edge_squares += four
                .iter()
                .map(|error| (error - mean) * (error - mean))
                .sum::<f64>();
        }
    }
    let edges = f64::from(edges);
    bands.lines = libm::sqrt(line_squares * 4.0 / edges + bands.lines * bands.lines);
    bands.edges = libm::sqrt(edge_squares / edges);
    bands
}

/// Means taken as points in the middle of their segments, joined by straight lines: the value at `place` (±½)
/// from the middle of a segment.
fn between(means: &Segments, segment: usize, place: f64) -> f64 {
    let at = |index: usize| means.get(index % SEGMENTS).copied().unwrap_or(0.0);
    let here = at(segment);
    if place < 0.0 {
        here + place * (here - at(segment.wrapping_add(SEGMENTS - 1)))
    } else {
        here + place * (at(segment.wrapping_add(1)) - here)
    }
}

fn segment_length(edges: u32, segment: u32) -> usize {
    let end = segment_start(edges, segment.wrapping_add(1));
    end.wrapping_sub(segment_start(edges, segment)) as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_band_shows_what_is_in_it() {
        let edges = 10_000;
        let wave = |order: f64, amplitude: f64| {
            move |edge: u32| {
                amplitude
                    * libm::sin(core::f64::consts::TAU * order * f64::from(edge) / 10_000.0 + 0.7)
            }
        };
        let root = core::f64::consts::SQRT_2;
        let seen = |error: &dyn Fn(u32) -> f64| bands(edges, || (0..edges).map(error));
        let close =
            |seen: f64, expected: f64| assert!((seen - expected).abs() < 0.03, "{seen} {expected}");
        close(seen(&wave(1.0, 1.5)).first, 1.5 / root);
        close(seen(&wave(2.0, 1.0)).second, 1.0 / root);
        close(seen(&wave(7.0, 1.0)).third_to_tenth, 1.0 / root);
        close(seen(&wave(30.0, 1.0)).eleventh_to_32nd, 1.0 / root);
        close(seen(&wave(50.0, 1.0)).lines, 1.0 / root);
        close(seen(&wave(300.0, 1.0)).lines, 1.0 / root);
        close(seen(&wave(4000.0, 1.0)).edges, 1.0 / root);
        // And not what is not: a first harmonic is in no other band.
        let first = seen(&wave(1.0, 1.5));
        let others = [
            first.second,
            first.third_to_tenth,
            first.eleventh_to_32nd,
            first.lines,
            first.edges,
        ];
        assert!(others.iter().all(|&other| other < 0.002), "{first:?}");
    }
}
