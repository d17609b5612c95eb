//! The tapered average of a run: one sum an edge.

use super::reference::{POSITION_FRAC, Reference};
use super::repeats::Repeats;
use super::segments::{SEGMENTS, segment_start};
use super::taper::{ORDER, Taper, WEIGHT_FRAC};

/// Largest residual, Q.16 d: 16 384 d.
const LARGEST_RESIDUAL: u64 = 1 << 30;

/// Exponent of a weight's unit.
const FROM_WEIGHT: i32 = -(WEIGHT_FRAC as i32);

/// The average over the revolutions of a run, of residuals r = x_ref(t) − j of edges j counted in the direction of
/// motion. Forward r is the edge's error, backward its negative.
#[derive(Clone, Debug)]
pub struct Average {
    edges: u32,
    revolutions: u32,
    backward: bool,
    reference: Reference,
    taper: Taper,
    /// Shorter tapers over the first and the second half.
    halves: [Taper; 2],
    /// Second half less first half, mean of each segment in the order of motion, Q.16 d.
    difference: [i32; SEGMENTS],
    repeats: Repeats,
    revolution: u32,
    /// Number of the next edge in its revolution, in the direction of motion.
    next: u32,
    segment: u32,
    segment_end: u32,
    /// Edge of the segment that ends the triple watched for noise.
    triple_end: u32,
    segment_sum: i64,
    weight: i32,
    weight_step: i32,
    /// Weight at the end of the segment; the taper begins at zero.
    end_weight: i32,
    /// Residual of the first edge of the revolution.
    at_start: i32,
    /// Mean of v_ref/v − 1.
    stretch: f64,
    out_of_range: bool,
}

/// What came with an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Passed {
    /// An edge within a revolution.
    Edge,
    /// The first edge of a revolution: by how much the revolution before was longer than expected, Q.16 d.
    NewRevolution(i32),
    /// The motion is not what the reference says.
    Lost,
}

impl Average {
    /// An average over `revolutions` (a multiple of 4) of `edges` that begins now; the next edge is boundary 0.
    pub fn new(edges: u32, revolutions: u32, backward: bool, reference: Reference) -> Self {
        let half_box = (revolutions / (2 * ORDER)).max(1);
        let second = revolutions.saturating_sub(half_box.saturating_mul(ORDER));
        let mut average = Self {
            edges,
            revolutions,
            backward,
            reference,
            taper: Taper::new(revolutions / ORDER, 0),
            halves: [Taper::new(half_box, 0), Taper::new(half_box, second)],
            difference: [0; SEGMENTS],
            repeats: Repeats::new(),
            revolution: 0,
            next: 0,
            segment: 0,
            segment_end: 0,
            triple_end: 0,
            segment_sum: 0,
            weight: 0,
            weight_step: 0,
            end_weight: 0,
            at_start: 0,
            stretch: 0.0,
            out_of_range: false,
        };
        average.begin_segment();
        average
    }

    /// True when all revolutions are in; what comes then is not taken.
    pub const fn is_complete(&self) -> bool {
        self.revolution >= self.revolutions
    }

    /// Revolutions of a complete average.
    pub const fn revolutions(&self) -> u32 {
        self.revolutions
    }

    /// Takes the time of the next edge.
    #[inline]
    pub fn pass(&mut self, time: u32, sums: &mut [i32]) -> Passed {
        if self.is_complete() {
            return Passed::Edge;
        }
        let number = self.next;
        let at = i64::from(number).wrapping_shl(POSITION_FRAC);
        let exact = self.reference.position(time).wrapping_sub(at);
        self.out_of_range |= exact.unsigned_abs() > LARGEST_RESIDUAL;
        let residual = exact as i32;

        if let Some(sum) = sums.get_mut(self.edge(number)) {
            *sum = sum.wrapping_add(weighted(residual, self.weight));
        }
        self.weight = self.weight.wrapping_add(self.weight_step);
        self.segment_sum = self.segment_sum.wrapping_add(i64::from(residual));
        if number == self.triple_end {
            self.repeats
                .end_triple(residual, self.segment, self.revolution == 0);
        }
        self.repeats.push(residual);
        self.next = number.wrapping_add(1);
        if self.next == self.segment_end {
            return self.end_segment();
        }
        if number == 0 {
            return Passed::NewRevolution(self.end_revolution(residual));
        }
        Passed::Edge
    }

    /// The edge of the disc that has a number in the direction of motion.
    #[inline]
    const fn edge(&self, number: u32) -> usize {
        if self.backward && number != 0 {
            self.edges.wrapping_sub(number) as usize
        } else {
            number as usize
        }
    }

    fn end_segment(&mut self) -> Passed {
        if self.out_of_range {
            return Passed::Lost;
        }
        self.compare_halves();
        self.segment = self.segment.wrapping_add(1);
        if self.next == self.edges {
            self.next = 0;
            self.segment = 0;
            self.revolution = self.revolution.wrapping_add(1);
            if self.is_complete() {
                return Passed::Edge;
            }
            if self.reference.next_revolution().is_none() {
                return Passed::Lost;
            }
        }
        self.begin_segment();
        Passed::Edge
    }

    /// A revolution ended, and the next began with `residual`; gives by how much that one was longer than expected.
    fn end_revolution(&mut self, residual: i32) -> i32 {
        let off = residual.wrapping_sub(self.at_start);
        self.at_start = residual;
        let weight = self.taper.at(f64::from(self.revolution) - 0.5);
        let part = f64::from(off) / libm::ldexp(f64::from(self.edges), POSITION_FRAC.cast_signed());
        self.stretch += libm::ldexp(f64::from(weight), FROM_WEIGHT) * part;
        off
    }

    fn begin_segment(&mut self) {
        let from = segment_start(self.edges, self.segment);
        let to = segment_start(self.edges, self.segment.wrapping_add(1));
        self.segment_end = to;
        self.triple_end = from.wrapping_add(3);
        self.segment_sum = 0;
        let end = f64::from(self.revolution) + f64::from(to) / f64::from(self.edges);
        let sign = if self.backward { -1 } else { 1_i32 };
        let begin = self.end_weight;
        self.end_weight = self.taper.at(end).wrapping_mul(sign);
        self.weight = begin;
        let rise = self.end_weight.wrapping_sub(begin);
        let length = to.wrapping_sub(from).cast_signed();
        self.weight_step = rise.checked_div(length).unwrap_or(0);
    }

    /// Adds the mean of the segment to the difference of the halves.
    fn compare_halves(&mut self) {
        let from = segment_start(self.edges, self.segment);
        let length = i64::from(self.segment_end.wrapping_sub(from));
        let mean = self.segment_sum.checked_div(length).unwrap_or(0) as i32;
        let middle = f64::from(from.wrapping_add(self.segment_end)) / (2.0 * f64::from(self.edges));
        let place = middle + f64::from(self.revolution);
        let [first, second] = self.halves;
        let weight = second.at(place).wrapping_sub(first.at(place));
        if let Some(difference) = self.difference.get_mut(self.segment as usize) {
            *difference = difference.wrapping_add(weighted(mean, weight));
        }
    }

    /// Number of the revolution, from 0.
    pub const fn revolution(&self) -> u32 {
        self.revolution
    }

    /// Number of the next edge in its revolution, in the direction of motion.
    pub const fn next(&self) -> u32 {
        self.next
    }

    /// By how much the average shows errors too large, as a factor: the residual of an edge is its error times
    /// v_ref/v.
    pub fn magnification(&self) -> f64 {
        1.0 + self.stretch
    }

    /// Mean velocity of a complete average, d/clock.
    pub fn velocity(&self) -> f64 {
        let whole = self.revolutions.saturating_sub(1);
        f64::from(whole) * f64::from(self.edges) / self.reference.elapsed()
    }

    /// Standard deviation of one pass of an edge, d.
    pub fn pass_sigma_d(&self) -> f64 {
        self.repeats.sigma_d(self.revolutions)
    }

    /// What the average leaves of the variance of a pass.
    pub fn noise_gain(&self) -> f64 {
        self.taper.noise_gain()
    }

    /// Second half less first half in a segment, d; the constant means nothing.
    pub fn halves_difference_d(&self, segment: usize) -> f64 {
        f64::from(self.difference.get(segment).copied().unwrap_or(0)) / 65_536.0
    }
}

/// A residual times a weight, rounded.
#[inline]
const fn weighted(residual: i32, weight: i32) -> i32 {
    let product = (residual as i64).wrapping_mul(weight as i64);
    (product.wrapping_add(1 << (WEIGHT_FRAC - 1)) >> WEIGHT_FRAC) as i32
}
