//! Encoder faults on demand, on the same seam: a good capture in, the capture of a faulty encoder out.
//!
//! A capture tells times and a count only. From them the edges are followed one by one: where the count
//! moved by less than the number of edges, as if the shaft had turned round once within the tick.

mod fault;
mod interference;
mod lines;

use core::ops::Range;

use leadscrew::hal::{self, Capture, Latch};
use leadscrew::units::RangeError;

pub use self::fault::{Bursts, Channel, Fault};

use self::interference::Interference;
use self::lines::{Lines, Transition};
use crate::encoder::{Direction, Ring, is_reached};

/// An encoder with a fault, fed with the captures of a good one that keeps all edge times.
#[derive(Clone, Debug)]
pub struct FaultyEncoder {
    fault: Fault,
    ticks: Range<u32>,
    /// Captures seen.
    tick: u32,
    interference: Option<Interference>,
    /// The good encoder: its count as the edges go by, and which way it went last.
    source_count: i32,
    forward: bool,
    /// The lines as the decoder sees them, and the count it makes of them.
    lines: Lines,
    count: i32,
    /// Steps that the counter has seen, for those that it loses or doubles.
    steps: u32,
    ring: Ring,
    /// Time of the newest edge, if it is not before the last sampling instant.
    newest: Option<u32>,
    /// An index whose edge is still to come.
    index: Option<Latch>,
    seen: Seen,
}

/// What a capture says besides its edges.
#[derive(Clone, Copy, Debug, Default)]
struct Seen {
    count: i32,
    sampled_at: u32,
    /// Edge times of the tick so far.
    times: u32,
    illegal: u16,
    overrun: bool,
    index: Option<Latch>,
    touching: bool,
    probe: Option<Latch>,
    home: Option<Latch>,
}

impl FaultyEncoder {
    /// An encoder that has `fault` in `ticks`, counted from the next capture on as 0, and whose newest
    /// capture, still good, is `capture`.
    ///
    /// # Errors
    /// A figure of the fault out of range.
    pub fn new(fault: Fault, ticks: Range<u32>, capture: &Capture<'_>) -> Result<Self, RangeError> {
        fault.check()?;
        let count = capture.count.cast_signed();
        Ok(Self {
            fault,
            ticks,
            tick: 0,
            interference: None,
            source_count: count,
            forward: true,
            lines: Lines::at(count),
            count,
            steps: 0,
            ring: Ring::new(),
            newest: None,
            index: None,
            seen: Seen {
                count,
                sampled_at: capture.sampled_at,
                ..Seen::default()
            },
        })
    }

    /// Has `fault` instead, in `ticks` counted from the next capture on as 0. What the last fault did to the count stays.
    ///
    /// # Errors
    /// A figure of the fault out of range.
    pub fn inject(&mut self, fault: Fault, ticks: Range<u32>) -> Result<(), RangeError> {
        fault.check()?;
        let after = |tick: u32| self.tick.saturating_add(tick);
        self.ticks = after(ticks.start)..after(ticks.end);
        self.fault = fault;
        self.interference = None;
        Ok(())
    }

    /// The capture of the faulty encoder where the good one has `capture`; call it with every capture.
    pub fn apply(&mut self, capture: &Capture<'_>) -> Capture<'_> {
        self.ring.release();
        let before = self.seen.sampled_at;
        self.seen = Seen {
            sampled_at: capture.sampled_at,
            illegal: capture.illegal,
            overrun: capture.overrun,
            touching: capture.touching,
            probe: capture.probe,
            home: capture.home,
            ..Seen::default()
        };
        self.start_tick(before.wrapping_add(1));
        let alone = self.follow(capture);
        self.disturb(capture.sampled_at);
        // Where the source lost times its count is still good.
        let missed = capture.count.cast_signed().wrapping_sub(self.source_count);
        self.source_count = self.source_count.wrapping_add(missed);
        if missed != 0 && !matches!(self.fault(), Some(Fault::LineLoss | Fault::DeadChannel(_))) {
            self.count = self.count.wrapping_add(missed);
            self.lines = Lines::at(self.source_count);
        }
        if let Some(latch) = alone {
            let slip = self.count.wrapping_sub(self.source_count);
            let count = latch.count.wrapping_add_signed(slip);
            self.index = Some(Latch { count, ..latch });
        }
        self.end_tick(capture.sampled_at);
        hal::Encoder::capture(self)
    }

    /// The fault, while it lasts.
    fn fault(&self) -> Option<Fault> {
        self.ticks.contains(&self.tick).then_some(self.fault)
    }

    fn start_tick(&mut self, time: u32) {
        self.interference = match self.fault() {
            Some(Fault::FalseEdges(bursts) | Fault::IllegalTransitions(bursts)) => Some(
                self.interference
                    .unwrap_or_else(|| Interference::new(bursts, time)),
            ),
            _ => None,
        };
        // Lines that come to life again jump to where they belong.
        self.look(time);
    }

    /// Follows the edges of the good encoder, and takes over the index with its edge; gives an index whose
    /// edge is not found.
    fn follow(&mut self, capture: &Capture<'_>) -> Option<Latch> {
        let mut index = capture.index;
        let edges = capture.edges[0].len() + capture.edges[1].len();
        let moved = capture.count.cast_signed().wrapping_sub(self.source_count);
        let edges = i32::try_from(edges).unwrap_or(i32::MAX);
        let up = (edges.saturating_add(moved) / 2).clamp(0, edges);
        let down = edges - up;
        // It goes on as it went before it turns.
        let (turn, first) = if self.forward && up > 0 || down == 0 {
            (up, 1)
        } else {
            (down, -1)
        };
        for (edge, &time) in (0..).zip(capture.edges.into_iter().flatten()) {
            let step = if edge < turn { first } else { -first };
            self.disturb(time);
            self.source_count = self.source_count.wrapping_add(step.into());
            self.forward = step > 0;
            let stamped = self.look(self.delayed(time, step));
            let count = self.source_count.cast_unsigned();
            if index
                .take_if(|latch| *latch == Latch { count, time })
                .is_some()
            {
                self.index = Some(Latch {
                    count: self.count.cast_unsigned(),
                    time: stamped.unwrap_or(time),
                });
            }
        }
        index
    }

    /// Lets the pulses of interference come that start until `latest`, and end by then.
    fn disturb(&mut self, latest: u32) {
        while let Some((start, end)) = self
            .interference
            .as_mut()
            .and_then(|interference| interference.next_until(latest))
        {
            let end = if is_reached(end, latest) { end } else { latest };
            let good = self.lines;
            let bad = if matches!(self.fault, Fault::FalseEdges(_)) {
                good.with_a_flipped()
            } else {
                good.flipped()
            };
            self.decode(start, bad);
            self.decode(end, good);
        }
    }

    /// When an edge of the good encoder, just passed, is there.
    fn delayed(&self, time: u32, step: Direction) -> u32 {
        // A is high from boundary 1 to boundary 3 of each four.
        let falls = if step > 0 {
            self.source_count & 3 == 3
        } else {
            self.source_count & 3 == 0
        };
        match self.fault() {
            Some(Fault::DutyDrift { delay_clocks }) if falls => time.wrapping_add(delay_clocks),
            _ => time,
        }
    }

    /// Sees the lines as they are now; gives the time of the edge that it saw.
    fn look(&mut self, time: u32) -> Option<u32> {
        let good = Lines::at(self.source_count);
        let lines = match self.fault() {
            Some(Fault::DeadChannel(channel)) => good.holding(channel, self.lines),
            Some(Fault::LineLoss) => self.lines,
            _ => good,
        };
        self.decode(time, lines)
    }

    fn decode(&mut self, time: u32, lines: Lines) -> Option<u32> {
        let transition = self.lines.transition(lines);
        self.lines = lines;
        match transition {
            Transition::None => None,
            Transition::Step(step) => self.count_step(time, step),
            Transition::Illegal => {
                self.seen.illegal = self.seen.illegal.saturating_add(1);
                None
            }
        }
    }

    fn count_step(&mut self, time: u32, step: Direction) -> Option<u32> {
        self.steps = self.steps.wrapping_add(1);
        let is_nth = |every: u32| self.steps.is_multiple_of(every);
        match self.fault() {
            Some(Fault::LostEdges { every }) if is_nth(every) => None,
            Some(Fault::DoubledEdges { every }) if is_nth(every) => {
                self.record(time, step);
                self.record(time, step)
            }
            _ => self.record(time, step),
        }
    }

    fn record(&mut self, time: u32, step: Direction) -> Option<u32> {
        let time = match self.newest {
            Some(newest) if !is_reached(newest, time) => newest,
            _ => time,
        };
        self.newest = Some(time);
        self.count = self.count.wrapping_add(step.into());
        self.seen.times += 1;
        if matches!(self.fault(), Some(Fault::Overrun { kept }) if self.seen.times > kept) {
            self.seen.overrun = true;
        } else {
            self.ring.push(time, step);
        }
        Some(time)
    }

    fn end_tick(&mut self, sampled_at: u32) {
        if matches!(self.fault(), Some(Fault::LineLoss)) {
            self.index = None;
        }
        self.seen.index = self
            .index
            .take_if(|latch| is_reached(latch.time, sampled_at));
        // Edges that are late wait for the next tick.
        let waiting = self.ring.take(sampled_at);
        self.seen.count = self.count.wrapping_sub(waiting);
        self.newest = self.newest.filter(|&time| !is_reached(time, sampled_at));
        self.tick = self.tick.saturating_add(1);
    }
}

impl hal::Encoder for FaultyEncoder {
    fn capture(&self) -> Capture<'_> {
        let edges = self.ring.captured();
        let newest = edges[1].last().or(edges[0].last());
        Capture {
            count: self.seen.count.cast_unsigned(),
            sampled_at: self.seen.sampled_at,
            last_edge_at: newest.copied(),
            edges,
            illegal: self.seen.illegal,
            overrun: self.seen.overrun || self.ring.overrun(),
            touching: self.seen.touching,
            index: self.seen.index,
            probe: self.seen.probe,
            home: self.seen.home,
        }
    }
}
