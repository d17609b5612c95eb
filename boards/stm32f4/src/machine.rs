//! What the board sees of its machine at a tick.

use leadscrew::axis::Inputs;
use leadscrew::hal::{Latch, Lines, Reference};
use leadscrew::units::Command;
use leadscrew_app::axis_control::Inlet;
use leadscrew_app::edge_ring::{EdgeRing, Progress, Sample, Taken, count_at};
use leadscrew_app::input_filter::InputFilter;

use crate::encoder::{self, RING};
use crate::latches::{self, Stamp};
use crate::lines;
use crate::references::References;
use crate::ring::EDGES;
use crate::watchdog;

/// The machine at the tick.
pub struct Machine {
    ring: EdgeRing<RING>,
    /// The ring is long enough to borrow from.
    is_held: bool,
    taken: Taken<RING>,
    index: Option<Latch>,
    /// When the newest index came.
    index_at: Option<u32>,
    probe: Option<Latch>,
    /// The probe is deflected.
    touching: bool,
    home: Option<Latch>,
    lines: Lines,
    references: References,
    /// What the converter said last that it puts out.
    pub readback: Option<Command>,
    missed: u16,
}

impl Machine {
    /// The machine as it stands; encoder and latches are started. `is_held`: the ring is long enough for whatever passes `filter` in a
    /// tick ([`leadscrew_app::edge_ring::hold`]); else edge times are not used.
    pub fn new(filter: InputFilter, is_held: bool, references: References) -> Self {
        let mut ring = EdgeRing::new(filter.skew_clocks());
        let sample = Sample {
            count: encoder::count_now(),
            time: encoder::now(),
        };
        let taken = ring.take(sample, Progress::default(), |index| EDGES.word(index));
        Self {
            // The first tick is the origin.
            ring: EdgeRing::new(filter.skew_clocks()),
            is_held,
            taken,
            index: None,
            index_at: None,
            probe: None,
            touching: lines::is_probe_deflected(),
            home: None,
            lines: lines::read(),
            references,
            readback: None,
            missed: 0,
        }
    }

    /// Takes in the tick of `sample`, `missed` ticks after the last one.
    pub fn sample(&mut self, sample: Sample, progress: Progress, missed: u16) {
        self.lines = lines::read();
        self.touching = lines::is_probe_deflected();
        self.references.sample();
        self.taken = self.ring.take(sample, progress, |index| EDGES.word(index));
        self.missed = missed;
        self.note_index();
        self.probe = self.counted(&latches::PROBE);
        self.home = self.counted(&latches::HOME);
    }

    /// An index that came after the sample is the next tick's.
    fn note_index(&mut self) {
        let sampled_at = self.taken.sampled_at;
        self.index = encoder::take_index(sampled_at, self.index_at);
        self.index_at = self.index.map(|latch| latch.time).or(self.index_at);
    }

    /// A stamp with its count: by the edges if they tell, else as its interrupt read it.
    fn counted(&self, stamp: &Stamp) -> Option<Latch> {
        let latch = stamp.take(self.taken.sampled_at)?;
        if !self.is_held {
            return Some(latch);
        }
        let count = count_at(&self.taken, self.edges(), latch.time);
        Some(Latch {
            count: count.unwrap_or(latch.count),
            ..latch
        })
    }

    fn edges(&self) -> [&[u32]; 2] {
        if self.is_held {
            EDGES.slices(&self.taken.span)
        } else {
            [&[], &[]]
        }
    }
}

impl Inlet for Machine {
    fn inputs(&self, enable: bool) -> Inputs<'_> {
        let mut capture = self.taken.capture(self.edges());
        capture.index = self.index;
        capture.probe = self.probe;
        capture.touching = self.touching;
        capture.home = self.home;
        Inputs {
            capture,
            // While a period that outlasts an erasure is in force, nobody would end a tick that hangs.
            enable: enable && watchdog::PERIOD.may_enable(),
            lines: self.lines,
            reference: Reference {
                steps: self.references.steps(),
                master: Some(self.references.master()),
                analog: self.references.analog(),
            },
            readback: self.readback,
            missed_ticks: self.missed,
        }
    }
}
