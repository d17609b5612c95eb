//! Captures of the tick handed to thread mode, edge times and all, as words of a queue.
//!
//! ```text
//! count, sampled_at, last_edge_at, info │ index count, index time │ edge times, oldest first
//!                                        (only with an index)
//! info: bits 0 to 15 edges, 16 last_edge_at is there, 17 overrun, 18 index is there, 19 illegal transitions
//! ```
//!
//! A capture that finds no room is left out, and the next one says that times were lost.

use heapless::spsc::{Consumer, Producer};
use leadscrew::hal::{Capture, Latch};

/// Words of the queue: three ticks of 1 200 edges.
pub const WORDS: usize = 4096;
/// Most edges of a capture, where there is room.
pub const EDGES: usize = 1536;
const HEAD: usize = 4;

const HAS_LAST: u32 = 1 << 16;
const OVERRUN: u32 = 1 << 17;
const HAS_INDEX: u32 = 1 << 18;
const ILLEGAL: u32 = 1 << 19;

/// The tick's end.
pub struct CaptureSender {
    words: Producer<'static, u32>,
    /// Most edges of a capture.
    edges: usize,
    is_open: bool,
    /// One was left out.
    is_lossy: bool,
}

impl CaptureSender {
    /// A closed end: it passes nothing on. Captures of more than `edges` are left out.
    pub const fn new(words: Producer<'static, u32>, edges: usize) -> Self {
        Self {
            words,
            edges,
            is_open: false,
            is_lossy: false,
        }
    }

    /// Opens or closes it.
    pub const fn open(&mut self, is_open: bool) {
        self.is_open = is_open;
        self.is_lossy = false;
    }

    /// Passes a capture on, if it is open and there is room. Some 20 instructions an edge: `link/tick_captures` of the bench.
    pub fn send(&mut self, capture: &Capture<'_>) {
        if self.is_open {
            self.pass(capture);
        }
    }

    #[cold]
    #[inline(never)]
    fn pass(&mut self, capture: &Capture<'_>) {
        let [older, newer] = capture.edges;
        let edges = older.len() + newer.len();
        let index = capture.index.map(|latch| [latch.count, latch.time]);
        let needed = HEAD + 2 + edges;
        if edges > self.edges || self.words.capacity() - self.words.len() < needed {
            self.is_lossy = true;
            return;
        }
        let flag = |is_set: bool, bit: u32| if is_set { bit } else { 0 };
        let info = edges as u32
            | flag(capture.last_edge_at.is_some(), HAS_LAST)
            | flag(capture.overrun || self.is_lossy, OVERRUN)
            | flag(index.is_some(), HAS_INDEX)
            | flag(capture.illegal > 0, ILLEGAL);
        self.is_lossy = false;
        let last = capture.last_edge_at.unwrap_or(0);
        let head = [capture.count, capture.sampled_at, last, info];
        let index = index.iter().flatten();
        // Within, not from outside: slice by slice.
        let words = head.iter().chain(index).chain(older).chain(newer);
        words.for_each(|word| {
            // There is room: it was counted above.
            let _ = self.words.enqueue(*word);
        });
    }
}

/// Thread mode's end. The tick preempts thread mode and not the other way, so that a capture is always there as a whole.
pub struct CaptureReceiver {
    words: Consumer<'static, u32>,
    edges: &'static mut [u32],
}

impl CaptureReceiver {
    /// The other end of a sender's queue; `edges` has room for those of a capture.
    pub const fn new(words: Consumer<'static, u32>, edges: &'static mut [u32]) -> Self {
        Self { words, edges }
    }

    /// Gives the next capture to `take`; `None` if there is none.
    pub fn next<R>(&mut self, take: impl FnOnce(&Capture<'_>) -> R) -> Option<R> {
        let mut word = || self.words.dequeue();
        let [count, sampled_at, last, info] = [word()?, word()?, word()?, word()?];
        let index = if info & HAS_INDEX == 0 {
            None
        } else {
            let [count, time] = [word()?, word()?];
            Some(Latch { count, time })
        };
        let edges = self.edges.get_mut(..(info & 0xffff) as usize)?;
        for edge in edges.iter_mut() {
            *edge = word()?;
        }
        Some(take(&Capture {
            count,
            sampled_at,
            last_edge_at: (info & HAS_LAST != 0).then_some(last),
            edges: [edges, &[]],
            illegal: u16::from(info & ILLEGAL != 0),
            overrun: info & OVERRUN != 0,
            index,
            ..Capture::default()
        }))
    }

    /// Forgets what is there.
    pub fn clear(&mut self) {
        while self.words.dequeue().is_some() {}
    }
}

#[cfg(test)]
mod tests {
    extern crate std;

    use std::boxed::Box;

    use heapless::spsc::Queue;

    use super::*;

    fn ends() -> (CaptureSender, CaptureReceiver) {
        let queue: &'static mut Queue<u32, 64> = Box::leak(Box::new(Queue::new()));
        let (producer, consumer) = queue.split();
        let edges = Box::leak(Box::new([0; EDGES]));
        (
            CaptureSender::new(producer, EDGES),
            CaptureReceiver::new(consumer, edges),
        )
    }

    #[test]
    fn captures_come_out_as_they_went_in() {
        let (mut sender, mut receiver) = ends();
        let edges = [[1_u32, 2, 3].as_slice(), &[7, 8]];
        let latch = Latch { count: 9, time: 2 };
        let captures = [
            Capture {
                count: 5,
                sampled_at: 10,
                last_edge_at: Some(8),
                edges,
                index: Some(latch),
                ..Capture::default()
            },
            Capture {
                count: u32::MAX,
                sampled_at: 20,
                illegal: 1,
                overrun: true,
                ..Capture::default()
            },
        ];
        sender.send(&captures[0]);
        assert!(receiver.next(|_| ()).is_none(), "closed");
        sender.open(true);
        captures.iter().for_each(|capture| sender.send(capture));
        let first = receiver.next(|capture| {
            assert_eq!(capture.edges[0], [1, 2, 3, 7, 8]);
            (
                capture.count,
                capture.sampled_at,
                capture.last_edge_at,
                capture.index,
                capture.overrun,
            )
        });
        assert_eq!(first, Some((5, 10, Some(8), Some(latch), false)));
        let second = receiver.next(|capture| (capture.count, capture.illegal, capture.overrun));
        assert_eq!(second, Some((u32::MAX, 1, true)));
        assert!(receiver.next(|_| ()).is_none());
    }

    #[test]
    fn one_that_found_no_room_is_told_by_the_next() {
        let (mut sender, mut receiver) = ends();
        sender.open(true);
        let many = [0; 40];
        let capture = Capture {
            edges: [&many, &[]],
            ..Capture::default()
        };
        sender.send(&capture);
        sender.send(&capture);
        assert_eq!(receiver.next(|capture| capture.overrun), Some(false));
        assert!(receiver.next(|_| ()).is_none());
        sender.send(&capture);
        assert_eq!(receiver.next(|capture| capture.overrun), Some(true));
        sender.send(&capture);
        assert_eq!(receiver.next(|capture| capture.overrun), Some(false));
    }
}
