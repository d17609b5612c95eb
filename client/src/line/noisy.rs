//! A line that loses, flips, doubles and delays frames and is cut, as often as it is told to: for tests of tools. What it
//! does is drawn from a seed, so that a run is the same every time.

use std::cell::Cell;
use std::collections::VecDeque;
use std::io;
use std::rc::Rc;
use std::time::Duration;

use super::Line;

/// How bad a line is: shares of the frames, each way, 0 to 1.
#[derive(Clone, Copy, Debug, Default)]
pub struct Faults {
    /// Frames that never arrive.
    pub drops: f64,
    /// Frames in which one bit is another one.
    pub flips: f64,
    /// Frames that arrive twice.
    pub doubles: f64,
    /// Frames that arrive late.
    pub delays: f64,
    /// How late.
    pub delay: Duration,
    /// The line is dead for so long, from the first moment of every period but the first one.
    pub cut: Duration,
    /// The period; none of zero.
    pub cut_every: Duration,
}

/// What it did.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Done {
    /// Frames that were sent, both ways.
    pub frames: u32,
    /// Frames that the tool sent again.
    pub repeated: u32,
    /// Frames that never arrived.
    pub dropped: u32,
    /// Frames with a wrong bit.
    pub flipped: u32,
    /// Frames that arrived twice.
    pub doubled: u32,
    /// Frames that arrived late.
    pub delayed: u32,
    /// Frames that fell into a cut.
    pub cut: u32,
}

/// A line with faults.
pub struct Noisy<L> {
    line: L,
    faults: Faults,
    random: u64,
    now: Duration,
    to_axis: Way,
    to_tool: Way,
    done: Rc<Cell<Done>>,
    /// The frame that the tool sent last.
    last: Vec<u8>,
}

/// One direction.
#[derive(Default)]
struct Way {
    /// A frame that has not ended.
    partial: Vec<u8>,
    late: VecDeque<(Duration, Vec<u8>)>,
}

impl Faults {
    /// True while the line is dead.
    fn is_cut(&self, now: Duration) -> bool {
        let period = self.cut_every.as_nanos();
        period > 0 && now.as_nanos() >= period && now.as_nanos() % period < self.cut.as_nanos()
    }
}

impl<L: Line> Noisy<L> {
    /// A line with `faults` over one without.
    pub fn new(line: L, faults: Faults, seed: u64) -> Self {
        Self {
            line,
            faults,
            random: seed,
            now: Duration::ZERO,
            to_axis: Way::default(),
            to_tool: Way::default(),
            done: Rc::default(),
            last: Vec::new(),
        }
    }
}

impl<L> Noisy<L> {
    /// What it has done, also while somebody else has the line.
    #[must_use]
    pub fn done(&self) -> Rc<Cell<Done>> {
        Rc::clone(&self.done)
    }
}

/// The next number of SplitMix64.
fn next(random: &mut u64) -> u64 {
    *random = random.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut z = *random;
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

impl Way {
    /// What of `bytes` arrives, and when.
    fn pass(
        &mut self,
        bytes: &[u8],
        now: Duration,
        faults: &Faults,
        random: &mut u64,
        done: &mut Done,
    ) -> Vec<u8> {
        let mut arrives = Vec::new();
        for &byte in bytes {
            self.partial.push(byte);
            if byte != 0 {
                continue;
            }
            let mut frame = std::mem::take(&mut self.partial);
            if faults.is_cut(now) {
                done.cut += u32::from(frame.len() > 1);
                continue;
            }
            if frame.len() == 1 {
                // The zero before a frame: it bounds what the faults have left.
                arrives.extend(frame);
                continue;
            }
            let mut is = |share: f64| {
                (next(random) >> 11) as f64 / (1_u64 << 53) as f64 <= share && share > 0.0
            };
            let [drops, flips, doubles, delays] = [
                is(faults.drops),
                is(faults.flips),
                is(faults.doubles),
                is(faults.delays),
            ];
            done.frames += 1;
            done.dropped += u32::from(drops);
            done.flipped += u32::from(flips);
            done.doubled += u32::from(doubles);
            done.delayed += u32::from(delays);
            if drops {
                continue;
            }
            if flips {
                let bit = next(random) as usize % (frame.len() * 8);
                frame[bit / 8] ^= 1 << (bit % 8);
            }
            if doubles {
                frame.extend_from_within(..);
            }
            if delays {
                self.late.push_back((now + faults.delay, frame));
            } else {
                arrives.extend(frame);
            }
        }
        while self.late.front().is_some_and(|(due, _)| *due <= now) {
            // A zero, since it may come within another frame's bytes on a real line.
            arrives.push(0);
            arrives.extend(
                self.late
                    .pop_front()
                    .into_iter()
                    .flat_map(|(_, frame)| frame),
            );
        }
        arrives
    }
}

impl<L: Line> Line for Noisy<L> {
    fn exchange(&mut self, out: &[u8], received: &mut Vec<u8>) -> io::Result<Duration> {
        let Self { faults, random, .. } = self;
        let mut done = self.done.get();
        if !out.is_empty() {
            done.repeated += u32::from(self.last == out);
            self.last = out.to_vec();
        }
        let out = self.to_axis.pass(out, self.now, faults, random, &mut done);
        let mut came = Vec::new();
        self.now = self.line.exchange(&out, &mut came)?;
        let came = self
            .to_tool
            .pass(&came, self.now, faults, random, &mut done);
        self.done.set(done);
        received.extend(came);
        Ok(self.now)
    }

    fn name(&self) -> String {
        self.line.name()
    }

    fn is_lockstep(&self) -> bool {
        self.line.is_lockstep()
    }
}
