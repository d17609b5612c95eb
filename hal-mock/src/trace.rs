//! The digest of a run: one number that is equal only if every tick had the same inputs and record.

use leadscrew::axis::Inputs;
use leadscrew::hal::{Capture, Latch, Lines, Reference};
use leadscrew::telemetry::Record;

/// Odd, and without pattern in its bits: Knuth's multiplier for congruential generators.
const MULTIPLIER: u64 = 6_364_136_223_846_793_005;

/// A running hash over fixed-width inputs and outputs, word by word.
///
/// A step maps both states and words one to one: runs that differ in a single word have different digests
/// for certain, others have equal ones with a chance of 2⁻⁶⁴.
#[derive(Clone, Debug)]
pub struct TraceDigest(u64);

impl Default for TraceDigest {
    fn default() -> Self {
        // Not zero, so that leading zeros count.
        Self(MULTIPLIER)
    }
}

impl TraceDigest {
    /// The digest of no tick.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Takes in one tick.
    pub fn update(&mut self, inputs: &Inputs<'_>, record: &Record) {
        self.capture(&inputs.capture);
        let Lines {
            drive_ready,
            drive_fault,
            encoder_lost,
            master_lost,
            limit_low,
            limit_high,
            home,
            emergency_stop,
        } = inputs.lines;
        let levels = [
            inputs.enable,
            drive_ready,
            drive_fault,
            encoder_lost,
            master_lost,
            limit_low,
            limit_high,
            home,
            emergency_stop,
        ];
        let levels = levels
            .into_iter()
            .fold(0, |word, level| word << 1 | u32::from(level));
        self.word(levels << 16 | u32::from(inputs.missed_ticks));
        let Reference {
            steps,
            master,
            analog,
        } = inputs.reference;
        self.word(steps);
        self.word(analog.to_bits().cast_unsigned());
        self.option(
            inputs
                .readback
                .map(|command| command.to_bits().cast_unsigned()),
        );
        self.word(u32::from(master.is_some()));
        if let Some(master) = &master {
            self.capture(master);
        }
        for &word in record.to_bytes().as_chunks().0 {
            self.word(u32::from_le_bytes(word));
        }
    }

    fn capture(&mut self, capture: &Capture<'_>) {
        self.word(capture.count);
        self.word(capture.sampled_at);
        self.option(capture.last_edge_at);
        self.word(capture.edges.iter().map(|part| part.len() as u32).sum());
        for part in capture.edges {
            part.iter().for_each(|&time| self.word(time));
        }
        let flags = u32::from(capture.overrun) | u32::from(capture.touching) << 1;
        self.word(u32::from(capture.illegal) | flags << 16);
        for latch in [capture.index, capture.probe, capture.home] {
            self.option(latch.map(|Latch { count, .. }| count));
            self.option(latch.map(|Latch { time, .. }| time));
        }
    }

    /// The digest so far.
    #[must_use]
    pub const fn value(&self) -> u64 {
        self.0
    }

    fn word(&mut self, word: u32) {
        // Turned round, so that the high half, which depends on most, meets the next word.
        self.0 = (self.0 ^ u64::from(word))
            .wrapping_mul(MULTIPLIER)
            .rotate_left(32);
    }

    fn option(&mut self, word: Option<u32>) {
        self.word(u32::from(word.is_some()));
        self.word(word.unwrap_or(0));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn digest(capture: Capture<'_>, record: &Record) -> u64 {
        let mut digest = TraceDigest::new();
        let enable = true;
        digest.update(&Inputs::of(capture, enable), record);
        digest.update(&Inputs::of(capture, enable), &Record::default());
        digest.value()
    }

    #[test]
    fn every_bit_of_every_edge_time_counts() {
        let times = [7, 0xffff_0000, 3, 0, 0];
        let of = |times: &[u32; 5], split| {
            let (older, newer) = times.split_at(split);
            let edges = [older, newer];
            let capture = Capture {
                edges,
                ..Capture::default()
            };
            digest(capture, &Record::default())
        };
        for place in 0..times.len() {
            for bit in 0..32 {
                let mut other = times;
                other[place] ^= 1 << bit;
                assert_ne!(of(&times, 2), of(&other, 2), "bit {bit} of {place}");
            }
        }
        assert_eq!(
            of(&times, 2),
            of(&times, 5),
            "where the ring wraps does not matter"
        );
    }

    #[test]
    fn what_is_not_there_differs_from_zero() {
        let none = Capture::default();
        let latch = Some(Latch { count: 0, time: 0 });
        let others = [
            Capture {
                last_edge_at: Some(0),
                ..none
            },
            Capture {
                edges: [&[0], &[]],
                ..none
            },
            Capture {
                index: latch,
                ..none
            },
            Capture {
                probe: latch,
                ..none
            },
            Capture {
                overrun: true,
                ..none
            },
            Capture {
                touching: true,
                ..none
            },
            Capture { illegal: 1, ..none },
        ];
        let of_none = digest(none, &Record::default());
        for other in others {
            assert_ne!(digest(other, &Record::default()), of_none, "{other:?}");
        }
        let record = Record {
            flags: 1,
            ..Record::default()
        };
        assert_ne!(digest(none, &record), of_none);
    }
}
