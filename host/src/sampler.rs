//! Software decode of a recording: the captures that hardware would have given, tick by tick.
//!
//! Tick k samples at k / tick rate from the first timestamp, k = 0 … ⌊T·f⌋; an edge at t ≤ that
//! instant belongs to it. Instants are compared as integers.
//!
//! The count starts at the place of the initial levels in their cycle, 0 to 3, so that its two low bits tell the
//! levels as the core wants it; totals count from the start.

use leadscrew::hal::{Capture, Latch};
use leadscrew::quadrature::{Decoder, Step};

use crate::recording::{Change, Recording};

/// Timers the core takes, Hz: a finer recording is brought down, a coarser one is told more finely.
const TIMER_HZ: (u64, u64) = (1_000_000, 250_000_000);

/// Parts of a hertz in which the control rate is held.
const MICRO: f64 = 1e6;

/// What the decoding of a whole recording came to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Totals {
    /// Valid transitions of A or B.
    pub edges: u64,
    /// Simultaneous changes of A and B.
    pub illegal: u64,
    /// Count at the end less that at the start.
    pub final_count: i64,
}

/// Samples a recording at a control rate.
pub struct Sampler<'a> {
    recording: &'a Recording,
    /// Control rate in millionths of a hertz, so that instants stay integers. Products of it, of times and
    /// of clocks fit in 128 bits, since no tick lies beyond the recording's duration of 64.
    tick_microhertz: u128,
    timer_hz: u64,
    ticks: u64,
    tick: u64,
    next_change: usize,
    decoder: Decoder,
    index_level: bool,
    /// Since the start.
    moved: i64,
    start: i64,
    times: Vec<u32>,
    totals: Totals,
}

impl<'a> Sampler<'a> {
    /// Samples `recording` at `tick_hz`, which counts in steps of 1 µHz.
    #[must_use]
    pub fn new(recording: &'a Recording, tick_hz: f64) -> Self {
        let tick_microhertz = ((tick_hz * MICRO).round() as u128).max(1);
        let spans = u128::from(recording.duration) * tick_microhertz
            / (u128::from(recording.clock_hz) * MICRO as u128);
        let levels = recording.initial;
        let decoder = Decoder::new(levels.a, levels.b);
        Self {
            recording,
            tick_microhertz,
            timer_hz: recording.clock_hz.clamp(TIMER_HZ.0, TIMER_HZ.1),
            ticks: u64::try_from(spans).unwrap_or(u64::MAX).saturating_add(1),
            tick: 0,
            next_change: 0,
            decoder,
            index_level: levels.z,
            moved: 0,
            start: i64::from(decoder.phase()),
            times: Vec::new(),
            totals: Totals::default(),
        }
    }

    /// The same with times of a clock of `timer_hz`, so that recordings of different clocks go together.
    #[must_use]
    pub fn with_timer_hz(self, timer_hz: u64) -> Self {
        Self {
            timer_hz: timer_hz.clamp(TIMER_HZ.0, TIMER_HZ.1),
            ..self
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

    /// Count of the captures at the start, 0 to 3.
    #[must_use]
    pub const fn start_count(&self) -> i64 {
        self.start
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
            let at = self.timer(change.time);
            match self.decode(change) {
                Step::None => {}
                Step::Illegal => illegal = illegal.saturating_add(1),
                Step::Forward | Step::Backward => self.times.push(at),
            }
            if change.levels.z && !self.index_level {
                index = Some(Latch {
                    count: self.count(),
                    time: at,
                });
            }
            self.index_level = change.levels.z;
        }
        let sampled_at = self.instant();
        self.tick += 1;
        Some(Capture {
            count: self.count(),
            sampled_at,
            last_edge_at: self.times.last().copied(),
            edges: [&self.times, &[]],
            illegal,
            overrun: false,
            touching: false,
            index,
            probe: None,
            home: None,
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
            final_count: self.moved,
            ..self.totals
        }
    }

    /// The next change, if it belongs to this tick: t·f ≤ k.
    fn due_change(&mut self) -> Option<Change> {
        let change = *self.recording.changes.get(self.next_change)?;
        let due = u128::from(change.time) * self.tick_microhertz
            <= u128::from(self.tick) * u128::from(self.recording.clock_hz) * MICRO as u128;
        due.then(|| {
            self.next_change += 1;
            change
        })
    }

    /// The count as the hardware's counter would show it.
    const fn count(&self) -> u32 {
        (self.start + self.moved) as u32
    }

    fn decode(&mut self, change: Change) -> Step {
        let step = self.decoder.step(change.levels.a, change.levels.b);
        self.moved += i64::from(step.counts());
        match step {
            Step::None => {}
            Step::Illegal => self.totals.illegal += 1,
            Step::Forward | Step::Backward => self.totals.edges += 1,
        }
        step
    }

    /// The sampling instant as a reading of the timer, rounded down.
    fn instant(&self) -> u32 {
        (u128::from(self.tick) * u128::from(self.timer_hz) * MICRO as u128 / self.tick_microhertz)
            as u32
    }

    /// A time of the recording as a reading of the timer, which wraps, rounded down.
    fn timer(&self, clocks: u64) -> u32 {
        (u128::from(clocks) * u128::from(self.timer_hz) / u128::from(self.recording.clock_hz))
            as u32
    }
}
