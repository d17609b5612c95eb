//! Software decode of a recording: the captures that hardware would have given, tick by tick.
//!
//! Tick k samples at k / tick rate from the first timestamp, k = 0 … ⌊T·f⌋; an edge at t ≤ that
//! instant belongs to it. Instants are compared as integers.

use leadscrew::hal::{Capture, Latch};
use leadscrew::quadrature::{Decoder, Step};

use crate::recording::{Change, Recording};

/// Fastest timer the core takes, Hz; a finer recording is brought down to it.
const MAX_TIMER_HZ: u64 = 250_000_000;

/// What the decoding of a whole recording came to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Totals {
    /// Valid transitions of A or B.
    pub edges: u64,
    /// Simultaneous changes of A and B.
    pub illegal: u64,
    /// Count at the end.
    pub final_count: i64,
}

/// Samples a recording at a control rate.
pub struct Sampler<'a> {
    recording: &'a Recording,
    /// Control rate in thousandths of a hertz, so that instants stay integers.
    tick_millihertz: u128,
    timer_hz: u64,
    ticks: u64,
    tick: u64,
    next_change: usize,
    decoder: Decoder,
    index_level: bool,
    count: i64,
    times: Vec<u32>,
    totals: Totals,
}

impl<'a> Sampler<'a> {
    /// Samples `recording` at `tick_hz`, at least 0.001 Hz.
    #[must_use]
    pub fn new(recording: &'a Recording, tick_hz: f64) -> Self {
        let tick_millihertz = ((tick_hz * 1000.0).round() as u128).max(1);
        let spans = u128::from(recording.duration) * tick_millihertz
            / (u128::from(recording.clock_hz) * 1000);
        let levels = recording.initial;
        Self {
            recording,
            tick_millihertz,
            timer_hz: recording.clock_hz.min(MAX_TIMER_HZ),
            ticks: spans as u64 + 1,
            tick: 0,
            next_change: 0,
            decoder: Decoder::new(levels.a, levels.b),
            index_level: levels.z,
            count: 0,
            times: Vec::new(),
            totals: Totals::default(),
        }
    }

    /// Ticks in the recording.
    #[must_use]
    pub const fn ticks(&self) -> u64 {
        self.ticks
    }

    /// Clock of the times in the captures, Hz.
    #[must_use]
    pub const fn timer_hz(&self) -> u64 {
        self.timer_hz
    }

    /// The capture of the next tick, or `None` at the end.
    pub fn next_capture(&mut self) -> Option<Capture<'_>> {
        if self.tick == self.ticks {
            return None;
        }
        self.times.clear();
        let mut index = None;
        let mut illegal = 0_u16;
        while let Some(change) = self.due_change() {
            let at = self.timer(u128::from(change.time));
            match self.decode(change) {
                Step::None => {}
                Step::Illegal => illegal = illegal.saturating_add(1),
                Step::Forward | Step::Backward => self.times.push(at),
            }
            if change.levels.z && !self.index_level {
                index = Some(Latch {
                    count: self.count as u32,
                    time: at,
                });
            }
            self.index_level = change.levels.z;
        }
        let sampled_at = self.timer(self.instant_clocks());
        self.tick += 1;
        Some(Capture {
            count: self.count as u32,
            sampled_at,
            last_edge_at: self.times.last().copied(),
            edges: [&self.times, &[]],
            illegal,
            overrun: false,
            index,
            probe: None,
        })
    }

    /// Totals over the whole recording, what lies after the last tick included.
    #[must_use]
    pub fn totals(mut self) -> Totals {
        while let Some(&change) = self.recording.changes.get(self.next_change) {
            self.next_change += 1;
            self.decode(change);
        }
        Totals {
            final_count: self.count,
            ..self.totals
        }
    }

    /// The next change, if it belongs to this tick: t·f ≤ k.
    fn due_change(&mut self) -> Option<Change> {
        let change = *self.recording.changes.get(self.next_change)?;
        let due = u128::from(change.time) * self.tick_millihertz
            <= u128::from(self.tick) * u128::from(self.recording.clock_hz) * 1000;
        due.then(|| {
            self.next_change += 1;
            change
        })
    }

    fn decode(&mut self, change: Change) -> Step {
        let step = self.decoder.step(change.levels.a, change.levels.b);
        self.count += i64::from(step.counts());
        match step {
            Step::None => {}
            Step::Illegal => self.totals.illegal += 1,
            Step::Forward | Step::Backward => self.totals.edges += 1,
        }
        step
    }

    /// The sampling instant in clocks of the recording, rounded down.
    fn instant_clocks(&self) -> u128 {
        u128::from(self.tick) * u128::from(self.recording.clock_hz) * 1000 / self.tick_millihertz
    }

    /// Clocks of the recording as a reading of the timer, which wraps.
    fn timer(&self, clocks: u128) -> u32 {
        (clocks * u128::from(self.timer_hz) / u128::from(self.recording.clock_hz)) as u32
    }
}
