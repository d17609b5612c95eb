//! The quadrature encoder and its capture hardware: from the motion of a shaft to [`Capture`]s.
//!
//! Boundary k between the counts k − 1 and k lies at k + e(k) d for a forward edge; a backward edge
//! lies lower by the hysteresis of its channel (odd boundaries are edges of A, even ones of B). The
//! index pulse spans some discretes from boundary 0 of the revolution on; its front latches.

mod edge_timer;
mod head;
mod model;
mod ring;

use leadscrew::hal::{Capture, Latch};
use leadscrew::parameter_table::ParameterTable;
use leadscrew::units::{RangeError, checked};

pub use self::model::{EncoderModel, EncoderParams};

use self::edge_timer::EdgeTimer;
use self::head::Head;
pub(crate) use self::ring::{Direction, Ring};
use crate::arc::Arc;
use crate::disc::Disc;
use crate::random::{LARGEST_BELL, Noise, bell_scale_q32};
use crate::track::{Inverse, TICK, Track, Turning, to_q32};

/// Sub-intervals of a tick in which the shaft may turn round.
const SLOW_PARTS: i32 = 16;

/// The encoder on a shaft.
#[derive(Clone, Debug)]
pub struct Encoder {
    head: Head,
    timer: EdgeTimer,
    ring: Ring,
    index: Option<Latch>,
    /// An index after the sampling instant: the next capture's.
    next_index: Option<Latch>,
    jitter: Noise,
    /// Scale of the jitter in clocks, Q.32.
    jitter_scale: i64,
    sampling_advance: f64,
    sampled_at: u32,
    sampled_count: i32,
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
        let (lowest, highest) = leadscrew::units::TICK_HZ;
        let tick_hz = checked("tick_hz", tick_hz, lowest, highest)?;
        let disc = Disc::new(&model.disc, seed)?;
        let noise = |stream| Noise::new(seed, stream);
        let head = Head::new(params, disc, noise(2), to_q32(position));
        let jitter_clocks = params.sampling_jitter_s * params.timer_hz;
        let jitter_scale = bell_scale_q32(jitter_clocks);
        let clocks_per_tick = params.timer_hz / tick_hz;
        Ok(Self {
            timer: EdgeTimer::new(params.timer_hz, tick_hz, params.noise_s, noise(4)),
            ring: Ring::new(),
            index: None,
            next_index: None,
            jitter: noise(3),
            jitter_scale,
            sampling_advance: (jitter_scale * LARGEST_BELL) as f64
                / (clocks_per_tick * 4_294_967_296.0),
            sampled_at: 0,
            sampled_count: head.count(),
            head,
        })
    }

    /// How much before the end of a tick the sampling instant lies on average, ticks: the jitter is to
    /// both sides of it.
    #[must_use]
    pub const fn sampling_advance(&self) -> f64 {
        self.sampling_advance
    }

    /// The timer when a share of the tick just past was over, without noise; shares above 1 lie in ticks to come.
    #[must_use]
    pub fn time_at(&self, share: f64) -> u32 {
        self.timer.time_at(share)
    }

    /// Edges a revolution.
    #[must_use]
    pub const fn edges(&self) -> usize {
        self.head.edges()
    }

    /// The truth that a learned map is to find: how far above boundary k the edge k modulo
    /// [`Self::edges`] lies when it is passed forward or backward, d. What does not repeat is left out.
    #[must_use]
    pub fn placement_error(&self, edge: usize, backward: bool) -> f64 {
        let error = self.head.placement_error(edge % self.edges(), backward);
        error as f64 / 4_294_967_296.0
    }

    /// Moves the shaft through one tick and samples at its end.
    pub fn advance(&mut self, arc: &Arc) {
        self.ring.release();
        self.sampled_at = self.sampling_instant();
        self.index = self
            .next_index
            .take_if(|latch| is_reached(latch.time, self.sampled_at));
        let track = Track::new(arc);
        if !self.head.is_clear_of(&track) {
            if track.keeps_going() {
                self.go_on(&Inverse::new(&track));
            } else {
                self.turn(&Turning::new(&track));
            }
        }
        self.timer.end_tick();
        // Edges after a jittered instant wait for the next tick.
        let waiting = self.ring.take(self.sampled_at);
        self.sampled_count = self.head.count().wrapping_sub(waiting);
    }

    /// What the hardware saw up to the last sampling instant.
    #[must_use]
    pub fn capture(&self) -> Capture<'_> {
        let edges = self.ring.captured();
        let newest = edges[1].last().or(edges[0].last());
        Capture {
            count: self.sampled_count.cast_unsigned(),
            sampled_at: self.sampled_at,
            last_edge_at: newest.copied(),
            edges,
            illegal: 0,
            overrun: self.ring.overrun(),
            touching: false,
            index: self.index,
            probe: None,
            home: None,
        }
    }

    /// The edges of the last capture: when they came, and +1 or −1 for their direction. What a capture does not tell,
    /// and whoever drives the lines of a real counter needs.
    pub fn passed(&self) -> impl Iterator<Item = (u32, i8)> + '_ {
        self.ring.passed()
    }

    /// Passes all edges of a tick in which the shaft keeps going.
    fn go_on(&mut self, inverse: &Inverse) {
        if inverse.is_backward() {
            while let Some(time) = inverse.time_of(self.head.lower()) {
                self.pass_lower(time);
            }
        } else {
            while let Some(time) = inverse.time_of(self.head.upper()) {
                self.pass_upper(time);
            }
        }
    }

    /// Passes all edges of a tick in which the shaft is slow or turns round: in each part of it, those between its
    /// ends.
    fn turn(&mut self, turning: &Turning<'_>) {
        let mut start = turning.position(0);
        for part in 0..SLOW_PARTS {
            let mut from = TICK / SLOW_PARTS * part;
            let to = TICK / SLOW_PARTS * (part + 1);
            let end = turning.position(to);
            if end.wrapping_sub(start) >= 0 {
                while end.wrapping_sub(self.head.upper()) >= 0 {
                    from = turning.time_of(self.head.upper(), true, from, to);
                    self.pass_upper(from);
                }
            } else {
                while end.wrapping_sub(self.head.lower()) < 0 {
                    from = turning.time_of(self.head.lower(), false, from, to);
                    self.pass_lower(from);
                }
            }
            start = end;
        }
    }

    /// Counts up at a time within the tick.
    fn pass_upper(&mut self, time: i32) {
        let at_index = self.head.pass_upper();
        self.record(time, 1, at_index);
    }

    /// Counts down at a time within the tick.
    fn pass_lower(&mut self, time: i32) {
        let at_index = self.head.pass_lower();
        self.record(time, -1, at_index);
    }

    fn record(&mut self, time: i32, direction: Direction, at_index: bool) {
        let time = self.timer.stamp(time);
        if at_index {
            let latch = Some(Latch {
                count: self.head.count().cast_unsigned(),
                time,
            });
            // With its edge: what a capture has not seen it must not tell.
            if is_reached(time, self.sampled_at) {
                self.index = latch;
            } else {
                self.next_index = latch;
            }
        }
        self.ring.push(time, direction);
    }

    /// When this tick is sampled, by the timer.
    fn sampling_instant(&mut self) -> u32 {
        let delay = if self.jitter_scale == 0 {
            0
        } else {
            self.jitter.scaled_bell(self.jitter_scale) + LARGEST_BELL * self.jitter_scale
        };
        let at = self.timer.end().wrapping_sub(delay.cast_unsigned());
        (at >> 32) as u32
    }
}

/// True if a stamp is not after a sampling instant; both are of about the same time.
pub(crate) const fn is_reached(time: u32, sampled_at: u32) -> bool {
    sampled_at.wrapping_sub(time).cast_signed() >= 0
}
