//! The hardware: a counter and a timer that see edges through paths of their own, a DMA stream, the trigger of the tick.

use std::cell::Cell;

use leadscrew_app::edge_ring::{EdgeRing, Progress, Sample, Taken};

/// An edge of A or B.
#[derive(Clone, Copy, Debug)]
pub struct Edge {
    /// Clocks at the pin.
    pub at: i64,
    /// +1 or −1.
    pub step: i32,
}

/// Delays in clocks.
#[derive(Clone, Copy, Debug, Default)]
pub struct Delays {
    /// From the pin to the counter.
    pub count: i64,
    /// From the pin to the capture.
    pub stamp: i64,
    /// From the capture to the word in memory; the stream's position moves one clock earlier.
    pub dma: i64,
}

/// Hardware that has run up to a time.
pub struct Model<const WORDS: usize> {
    pub ring: [u32; WORDS],
    pub delays: Delays,
    /// The 32-bit timer at time 0, the counter at its start.
    pub time_origin: u32,
    pub count_origin: u32,
    edges: Vec<Edge>,
    written: usize,
    /// Of the stream's flags, in words that had been moved when they were read.
    flags_read_at: usize,
}

/// What a tick gave.
pub struct Ticked<const WORDS: usize> {
    pub taken: Taken<WORDS>,
    pub edges: Vec<u32>,
}

impl<const WORDS: usize> Model<WORDS> {
    pub fn new(delays: Delays, edges: Vec<Edge>) -> Self {
        Self {
            ring: [0; WORDS],
            delays,
            time_origin: 0,
            count_origin: 0,
            edges,
            written: 0,
            flags_read_at: 0,
        }
    }

    /// Starts with the stream's position at `place`, as if so many edges had come long before.
    pub fn starting_at(mut self, place: usize) -> Self {
        let before = (0..place).map(|index| Edge {
            at: -1_000_000 + 100 * index as i64,
            step: 1,
        });
        self.count_origin = self.count_origin.wrapping_sub(place as u32);
        self.edges = before.chain(self.edges).collect();
        self
    }

    pub fn time(&self, at: i64) -> u32 {
        self.time_origin.wrapping_add(at as u32)
    }

    fn arrived(&self, at: i64, delay: i64) -> usize {
        self.edges.partition_point(|edge| edge.at + delay <= at)
    }

    /// The latched sample of a trigger at `at`.
    pub fn sample(&self, at: i64) -> Sample {
        let counted = self.arrived(at, self.delays.count);
        let net: i32 = self.edges[..counted].iter().map(|edge| edge.step).sum();
        Sample {
            count: self.count_origin.wrapping_add(net as u32),
            time: self.time(at),
        }
    }

    /// Edges that the sample at `at` counted, as stamps.
    pub fn counted_stamps(&self, at: i64) -> Vec<u32> {
        let counted = self.arrived(at, self.delays.count);
        self.edges[..counted]
            .iter()
            .map(|edge| self.time(edge.at + self.delays.stamp))
            .collect()
    }

    /// Lets the stream write up to `at`.
    fn write_up_to(&mut self, at: i64) {
        let due = self.arrived(at, self.delays.stamp + self.delays.dma);
        while self.written < due {
            let edge = self.edges[self.written];
            self.ring[self.written % WORDS] = self.time(edge.at + self.delays.stamp);
            self.written += 1;
        }
    }

    /// What the registers of the stream say at `at`.
    fn progress(&mut self, at: i64) -> Progress {
        let delay = self.delays.stamp + self.delays.dma - 1;
        let moved = self.arrived(at, delay.max(self.delays.stamp));
        let crossed =
            |mark: usize| (self.flags_read_at + 1..=moved).any(|position| position % WORDS == mark);
        let progress = Progress {
            remaining: (WORDS - moved % WORDS) as u16,
            passed_middle: crossed(WORDS / 2),
            passed_end: crossed(0),
            is_lossy: false,
        };
        self.flags_read_at = moved;
        progress
    }

    /// A tick whose trigger was at `sampled`, whose handler reads the position at `read` and each word one clock after the
    /// last, and whose slices are used at `used`.
    pub fn tick(
        &mut self,
        ring: &mut EdgeRing<WORDS>,
        sampled: i64,
        read: i64,
        used: i64,
    ) -> Ticked<WORDS> {
        let sample = self.sample(sampled);
        let progress = self.progress(read);
        let model = Cell::new(Some(self));
        let clock = Cell::new(read);
        let taken = ring.take(sample, progress, |index| {
            let this = model.take().expect("not nested");
            this.write_up_to(clock.get());
            clock.set(clock.get() + 1);
            let word = this.ring[index];
            model.set(Some(this));
            word
        });
        let this = model.take().expect("given back");
        this.write_up_to(used);
        let edges = taken.span.slices(&this.ring).concat();
        Ticked { taken, edges }
    }
}
