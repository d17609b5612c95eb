//! The quadrature encoder and its capture hardware: from the motion of a shaft to [`Capture`]s.
//!
//! Boundary k between the counts k − 1 and k lies at k + e(k) d for a forward edge; a backward edge
//! lies lower by the hysteresis of its channel (odd boundaries are edges of A, even ones of B). The
//! index pulse spans some discretes from boundary 0 of the revolution on; its front latches.

use leadscrew::hal::{Capture, Latch};
use leadscrew::parameter_table::ParameterTable;
use leadscrew::units::{RangeError, checked};

use crate::arc::Arc;
use crate::disc::{Disc, DiscParams};
use crate::random::{Noise, bell_scale_q32};
use crate::track::{Inverse, POSITION_FRAC, TICK, Track, to_q32};

leadscrew::parameter_table! {
    /// What does not repeat, what depends on direction, and the capture. The default is the encoder "real".
    pub struct EncoderParams {
        /// Noise of an edge's place
        noise_d: 0.005, "d", 0.0..=0.1;
        /// Noise of an edge's time
        noise_s: 2e-8, "s", 0.0..=1e-5;
        /// How much lower an edge of A lies when it is passed backward
        hysteresis_a_d: 0.04, "d", 0.0..=0.3;
        /// How much lower an edge of B lies when it is passed backward
        hysteresis_b_d: 0.02, "d", 0.0..=0.3;
        /// Width of the index pulse
        index_width_d: 3.0, "d", 1.0..=8.0;
        /// Clock of the edge timer
        timer_hz: 84e6, "Hz", 1e6..=250e6;
        /// Jitter of the sampling instant, standard deviation
        sampling_jitter_s: 0.0, "s", 0.0..=1e-4;
    }
}

/// Systematic and other errors of an encoder together.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EncoderModel {
    /// Where the edges lie.
    pub disc: DiscParams,
    /// What else there is.
    pub encoder: EncoderParams,
}

impl EncoderModel {
    /// The encoder "real" of the reference machine.
    #[must_use]
    pub fn real() -> Self {
        Self::default()
    }

    /// The encoder "ideal": edges where they belong, no noise; the timer stays.
    #[must_use]
    pub fn ideal() -> Self {
        Self {
            disc: DiscParams {
                phase_offset_d: 0.0,
                line_sigma_d: 0.0,
                edge_sigma_d: 0.0,
                eccentricity_d: 0.0,
                second_harmonic_d: 0.0,
                ..DiscParams::default()
            },
            encoder: EncoderParams {
                noise_d: 0.0,
                noise_s: 0.0,
                hysteresis_a_d: 0.0,
                hysteresis_b_d: 0.0,
                ..EncoderParams::default()
            },
        }
    }
}

/// Edge times kept for one capture: the fastest motion the core takes, and the next tick's beginning.
const RING: usize = 4096;
/// Sub-intervals of a tick in which the shaft may turn round.
const SLOW_PARTS: i32 = 16;

/// Age of an edge beyond which its time means nothing to the next one, timer clocks.
const OLD_EDGE: i32 = 1 << 30;

/// Direction of an edge: +1 or −1 counts.
type Direction = i32;

/// The encoder on a shaft.
#[derive(Clone, Debug)]
pub struct Encoder {
    disc: Disc,
    noise: Noise,
    sampling_noise: Noise,
    place_scale: i64,
    /// Scale of time noise in 2⁻³² timer clocks.
    time_scale: i64,
    hysteresis: [i64; 2],
    index_width: i64,
    /// Timer clocks of a tick, Q.32.
    clocks_per_tick: u64,
    jitter_scale: i64,
    sampling_advance: f64,
    /// Start of the tick in timer clocks, Q.32; wraps.
    clock: u64,
    count: i64,
    /// Edge of the disc at boundary `count`, and the thresholds on both sides, Q.32 d.
    edge: usize,
    upper: Option<i64>,
    lower: Option<i64>,
    times: [u32; RING],
    directions: [i8; RING],
    /// Ring positions: captured so far, written so far.
    taken: u32,
    capture_start: u32,
    written: u32,
    newest: u32,
    overrun: bool,
    index: Option<Latch>,
    sampled_at: u32,
    sampled_count: i64,
}

impl Encoder {
    /// An encoder with the errors of `model` drawn by `seed`, on a shaft at `position` d, for a tick rate
    /// of `tick_hz`.
    ///
    /// # Errors
    /// A parameter out of range.
    pub fn new(
        model: &EncoderModel,
        tick_hz: f64,
        position: f64,
        seed: u64,
    ) -> Result<Self, RangeError> {
        let params = &model.encoder;
        params.check()?;
        let tick_hz = checked(
            "tick_hz",
            tick_hz,
            leadscrew::units::TICK_HZ.0,
            leadscrew::units::TICK_HZ.1,
        )?;
        let jitter_clocks = params.sampling_jitter_s * params.timer_hz;
        let advance_clocks = jitter_clocks * 510.0 / 147.800_54;
        let mut encoder = Self {
            disc: Disc::new(&model.disc, seed)?,
            noise: Noise::new(seed, 2),
            sampling_noise: Noise::new(seed, 3),
            place_scale: bell_scale_q32(params.noise_d),
            time_scale: bell_scale_q32(params.noise_s * params.timer_hz),
            hysteresis: [to_q32(params.hysteresis_b_d), to_q32(params.hysteresis_a_d)],
            index_width: params.index_width_d as i64,
            clocks_per_tick: (params.timer_hz / tick_hz * 4_294_967_296.0) as u64,
            jitter_scale: bell_scale_q32(jitter_clocks),
            sampling_advance: advance_clocks / (params.timer_hz / tick_hz),
            clock: 0,
            count: 0,
            edge: 0,
            upper: None,
            lower: None,
            times: [0; RING],
            directions: [0; RING],
            taken: 0,
            capture_start: 0,
            written: 0,
            newest: 0,
            overrun: false,
            index: None,
            sampled_at: 0,
            sampled_count: 0,
        };
        encoder.settle(to_q32(position));
        Ok(encoder)
    }

    /// Finds the count of a shaft that stands at `position`.
    fn settle(&mut self, position: i64) {
        self.count = position >> POSITION_FRAC;
        self.edge = self.count.rem_euclid(self.disc.edges() as i64) as usize;
        while position >= self.upper_threshold() {
            self.step_up();
        }
        while position < self.lower_threshold() {
            self.step_down();
        }
        self.sampled_count = self.count;
    }

    /// How much before the end of a tick the sampling instant lies on average, ticks: the jitter is to
    /// both sides of it.
    #[must_use]
    pub const fn sampling_advance(&self) -> f64 {
        self.sampling_advance
    }

    /// Moves the shaft through one tick and samples at its end.
    pub fn advance(&mut self, arc: &Arc) {
        self.capture_start = self.taken;
        self.index = None;
        self.overrun = false;
        self.forget_old_edge();
        let track = Track::new(arc);
        if track.never_turns() {
            self.pass_edges(&track, 0, TICK, Some(&Inverse::new(&track)));
        } else {
            for part in 0..SLOW_PARTS {
                self.pass_edges(
                    &track,
                    TICK / SLOW_PARTS * part,
                    TICK / SLOW_PARTS * (part + 1),
                    None,
                );
            }
        }
        self.clock = self.clock.wrapping_add(self.clocks_per_tick);
        self.sample();
    }

    /// Keeps the newest edge within reach of a comparison by sign, however long the shaft stands.
    fn forget_old_edge(&mut self) {
        let now = (self.clock >> 32) as u32;
        if now.wrapping_sub(self.newest).cast_signed() > OLD_EDGE {
            self.newest = now.wrapping_sub(OLD_EDGE.cast_unsigned());
        }
    }

    /// What the hardware saw up to the last sampling instant.
    #[must_use]
    pub fn capture(&self) -> Capture<'_> {
        let edges = self.taken.wrapping_sub(self.capture_start) as usize;
        let first = self.capture_start as usize % RING;
        let end = first + edges;
        let ring = if end <= RING {
            [&self.times[first..end], &[][..]]
        } else {
            [&self.times[first..], &self.times[..end - RING]]
        };
        Capture {
            count: self.sampled_count as u32,
            sampled_at: self.sampled_at,
            last_edge_at: (edges > 0).then(|| self.times[(end - 1) % RING]),
            edges: ring,
            illegal: 0,
            overrun: self.overrun,
            index: self.index,
            probe: None,
        }
    }

    /// Finds all edges between two times of the tick, in which the shaft turns one way.
    fn pass_edges(&mut self, track: &Track, from: i32, to: i32, inverse: Option<&Inverse>) {
        let end = track.position(to);
        let direction = if end >= track.position(from) { 1 } else { -1 };
        let mut from = from;
        while let Some(threshold) = self.next_threshold(direction, end) {
            from = match inverse {
                Some(inverse) => inverse.time_of(track, threshold),
                None => track.time_of_slowly(threshold, direction > 0, from, to),
            };
            self.pass(direction, from);
        }
    }

    /// The next edge in a direction, if it comes before `end`.
    fn next_threshold(&mut self, direction: Direction, end: i64) -> Option<i64> {
        if direction > 0 {
            let upper = self.upper_threshold();
            (end >= upper).then_some(upper)
        } else {
            let lower = self.lower_threshold();
            (end < lower).then_some(lower)
        }
    }

    fn upper_threshold(&mut self) -> i64 {
        if let Some(threshold) = self.upper {
            return threshold;
        }
        let threshold = self.threshold(self.count + 1, self.next_edge());
        self.upper = Some(threshold);
        threshold
    }

    fn lower_threshold(&mut self) -> i64 {
        if let Some(threshold) = self.lower {
            return threshold;
        }
        let forward = self.threshold(self.count, self.edge);
        let threshold = forward - self.hysteresis[self.edge & 1];
        self.lower = Some(threshold);
        threshold
    }

    fn threshold(&mut self, boundary: i64, edge: usize) -> i64 {
        let noise = self.noise.scaled_bell(self.place_scale);
        (boundary << POSITION_FRAC) + self.disc.error_q32(edge) + noise
    }

    /// Counts an edge at a time within the tick.
    fn pass(&mut self, direction: Direction, time: i32) {
        let passed = if direction > 0 {
            self.step_up()
        } else {
            self.step_down()
        };
        let noise = self.noise.scaled_bell(self.time_scale);
        let within = part_of_tick(self.clocks_per_tick, time);
        let at = (self.clock.wrapping_add_signed(within.wrapping_add(noise)) >> 32) as u32;
        // Edge times never run backward, whatever the noise.
        let at = if at.wrapping_sub(self.newest).cast_signed() < 0 {
            self.newest
        } else {
            at
        };
        self.newest = at;
        if passed as i64 == if direction > 0 { 0 } else { self.index_width } {
            self.index = Some(Latch {
                count: self.count as u32,
                time: at,
            });
        }
        self.record(at, direction);
    }

    /// Moves one count up; returns the edge of the disc that was passed.
    fn step_up(&mut self) -> usize {
        self.count += 1;
        self.edge = self.next_edge();
        self.forget_thresholds();
        self.edge
    }

    fn step_down(&mut self) -> usize {
        let passed = self.edge;
        self.count -= 1;
        self.edge = if passed == 0 {
            self.disc.edges() - 1
        } else {
            passed - 1
        };
        self.forget_thresholds();
        passed
    }

    const fn next_edge(&self) -> usize {
        if self.edge + 1 == self.disc.edges() {
            0
        } else {
            self.edge + 1
        }
    }

    const fn forget_thresholds(&mut self) {
        self.upper = None;
        self.lower = None;
    }

    fn record(&mut self, at: u32, direction: Direction) {
        if self.written.wrapping_sub(self.capture_start) as usize >= RING {
            self.overrun = true;
            return;
        }
        let slot = self.written as usize % RING;
        self.times[slot] = at;
        self.directions[slot] = direction as i8;
        self.written = self.written.wrapping_add(1);
    }

    /// Samples count and time; edges after a jittered instant wait for the next tick.
    fn sample(&mut self) {
        self.sampled_at = (self.clock.wrapping_sub(self.sampling_delay()) >> 32) as u32;
        let mut waiting = 0;
        let mut last = self.written;
        while last != self.taken {
            let slot = last.wrapping_sub(1) as usize % RING;
            if self.sampled_at.wrapping_sub(self.times[slot]).cast_signed() >= 0 {
                break;
            }
            waiting += i64::from(self.directions[slot]);
            last = last.wrapping_sub(1);
        }
        self.taken = last;
        self.sampled_count = self.count - waiting;
    }

    /// How long before the end of the tick it is sampled, Q.32 clocks.
    fn sampling_delay(&mut self) -> u64 {
        if self.jitter_scale == 0 {
            return 0;
        }
        (self.sampling_noise.scaled_bell(self.jitter_scale) + 510 * self.jitter_scale)
            .cast_unsigned()
    }
}

/// `time` (Q.30 ticks) in timer clocks, Q.32.
fn part_of_tick(clocks_per_tick: u64, time: i32) -> i64 {
    let time = u64::from(time.cast_unsigned());
    let whole = (clocks_per_tick >> 32) * (time << 2);
    let fraction = ((clocks_per_tick & 0xffff_ffff) * time) >> 30;
    (whole + fraction).cast_signed()
}
