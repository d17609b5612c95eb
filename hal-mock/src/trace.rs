//! The digest of a run: one number that is equal only if every input and output of every tick was.

use crc::{CRC_64_XZ, Crc, Digest, Table};
use leadscrew::axis::{Inputs, Outputs};
use leadscrew::hal::Latch;
use leadscrew::telemetry::Record;

/// One table is enough: a slice-by-sixteen one would be 32 KB.
static CRC: Crc<u64, Table<1>> = Crc::<u64, Table<1>>::new(&CRC_64_XZ);

/// A running CRC-64 over fixed-width inputs and outputs.
#[derive(Clone)]
pub struct TraceDigest(Digest<'static, u64, Table<1>>);

impl Default for TraceDigest {
    fn default() -> Self {
        Self(CRC.digest())
    }
}

impl TraceDigest {
    /// The digest of no tick.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Takes in one tick.
    pub fn update(&mut self, inputs: &Inputs<'_>, outputs: &Outputs) {
        let capture = &inputs.capture;
        self.word(capture.count);
        self.word(capture.sampled_at);
        self.option(capture.last_edge_at);
        self.word(capture.edges.iter().map(|part| part.len() as u32).sum());
        for &time in capture.edges.into_iter().flatten() {
            self.word(time);
        }
        self.word(
            u32::from(capture.illegal)
                | u32::from(capture.overrun) << 16
                | u32::from(inputs.enable) << 17,
        );
        for latch in [capture.index, capture.probe] {
            self.option(latch.map(|Latch { count, .. }| count));
            self.option(latch.map(|Latch { time, .. }| time));
        }
        self.0.update(&Record::new(outputs).to_bytes());
    }

    /// The digest so far.
    #[must_use]
    pub fn value(&self) -> u64 {
        self.0.clone().finalize()
    }

    fn word(&mut self, word: u32) {
        self.0.update(&word.to_le_bytes());
    }

    fn option(&mut self, word: Option<u32>) {
        self.word(u32::from(word.is_some()));
        self.word(word.unwrap_or(0));
    }
}
