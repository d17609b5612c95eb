//! The queues of a line, between the interrupt of its UART and thread mode.
//!
//! ```text
//! wire ─► interrupt ─► Ends::came ─► queue ─► Line::read   (thread mode)
//! wire ◄─ interrupt ◄─ Ends::next ◄─ queue ◄─ Line::send   (thread mode; asks for the interrupt)
//! ```
//!
//! Nobody waits: what finds no room is counted, or refused as a whole.

use core::sync::atomic::{AtomicU32, Ordering};

use heapless::spsc::{Consumer, Producer, Queue};

use crate::isr_cell::IsrCell;

/// Bytes on a line, as thread mode sees it.
pub trait Bytes {
    /// Moves what has come to the front of `place`; the number of bytes.
    fn read(&mut self, place: &mut [u8]) -> usize;
    /// Sends all of `bytes` if there is room for them, else nothing.
    fn send(&mut self, bytes: &[u8]) -> bool;
    /// Whether all that was to be sent is on its way.
    fn is_sent(&self) -> bool;
}

/// The UART below the queues.
pub trait Wire: 'static {
    /// Has the interrupt look for what is to be sent.
    fn ask_to_send(&self);
    /// Whether nothing that the interrupt took is still in the UART.
    fn is_idle(&self) -> bool;
    /// The interrupt's ends.
    fn ends(&self) -> &Ends;
}

/// The queues of a line: `RECEIVED` and `TO_SEND` bytes, less one each.
#[derive(Default)]
pub struct Queues<const RECEIVED: usize, const TO_SEND: usize> {
    received: Queue<u8, RECEIVED>,
    to_send: Queue<u8, TO_SEND>,
}

impl<const RECEIVED: usize, const TO_SEND: usize> Queues<RECEIVED, TO_SEND> {
    /// Empty ones.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            received: Queue::new(),
            to_send: Queue::new(),
        }
    }
}

/// The interrupt's ends of the queues.
pub struct Ends {
    received: IsrCell<Producer<'static, u8>>,
    to_send: IsrCell<Consumer<'static, u8>>,
    lost: AtomicU32,
}

impl Default for Ends {
    fn default() -> Self {
        Self::new()
    }
}

impl Ends {
    /// Of no queues yet.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            received: IsrCell::empty(),
            to_send: IsrCell::empty(),
            lost: AtomicU32::new(0),
        }
    }

    /// The interrupt alone calls this: a byte has come.
    pub fn came(&self, byte: u8) {
        let kept = self.received.with(|queue| queue.enqueue(byte).is_ok());
        if kept != Some(true) {
            self.note_lost();
        }
    }

    /// The interrupt alone calls this: a byte came and was overwritten by the next.
    pub fn note_lost(&self) {
        let before = self.lost.load(Ordering::Relaxed);
        self.lost.store(before.wrapping_add(1), Ordering::Relaxed);
    }

    /// The interrupt alone calls this: the next byte to be sent.
    pub fn next(&self) -> Option<u8> {
        self.to_send.with(Consumer::dequeue).flatten()
    }
}

/// Thread mode's end of a line.
pub struct Line<W: Wire> {
    wire: &'static W,
    received: Consumer<'static, u8>,
    to_send: Producer<'static, u8>,
}

impl<W: Wire> Line<W> {
    /// Puts queues between a UART and thread mode; the UART's interrupts have to be masked.
    ///
    /// # Panics
    /// With an interrupt that works with the ends at this moment.
    pub fn open<const RECEIVED: usize, const TO_SEND: usize>(
        wire: &'static W,
        queues: &'static mut Queues<RECEIVED, TO_SEND>,
    ) -> Self {
        let (came, received) = queues.received.split();
        let (to_send, going) = queues.to_send.split();
        let ends = wire.ends();
        assert!(
            ends.received.put(came) && ends.to_send.put(going),
            "interrupts are masked"
        );
        Self {
            wire,
            received,
            to_send,
        }
    }

    /// Bytes that came and were lost; wraps.
    #[must_use]
    pub fn lost(&self) -> u32 {
        self.wire.ends().lost.load(Ordering::Relaxed)
    }
}

impl<W: Wire> Bytes for Line<W> {
    fn read(&mut self, place: &mut [u8]) -> usize {
        let came = core::iter::from_fn(|| self.received.dequeue());
        let mut count = 0;
        for (byte, came) in place.iter_mut().zip(came) {
            *byte = came;
            count += 1;
        }
        count
    }

    fn send(&mut self, bytes: &[u8]) -> bool {
        let room = self.to_send.capacity() - self.to_send.len();
        if bytes.len() > room {
            return false;
        }
        for byte in bytes {
            // There is room: this is the only producer.
            let _ = self.to_send.enqueue(*byte);
        }
        self.wire.ask_to_send();
        true
    }

    fn is_sent(&self) -> bool {
        self.to_send.is_empty() && self.wire.is_idle()
    }
}

#[cfg(test)]
mod tests {
    extern crate std;

    use core::sync::atomic::AtomicBool;
    use std::boxed::Box;

    use super::*;

    #[derive(Default)]
    struct Uart {
        ends: Ends,
        is_asked: AtomicBool,
    }

    impl Wire for Uart {
        fn ask_to_send(&self) {
            self.is_asked.store(true, Ordering::Relaxed);
        }

        fn is_idle(&self) -> bool {
            true
        }

        fn ends(&self) -> &Ends {
            &self.ends
        }
    }

    fn opened() -> (&'static Uart, Line<Uart>) {
        let uart: &'static Uart = Box::leak(Box::default());
        let queues: &'static mut Queues<4, 4> = Box::leak(Box::default());
        (uart, Line::open(uart, queues))
    }

    #[test]
    fn bytes_come_in_their_order_and_those_without_room_are_counted() {
        let (uart, mut line) = opened();
        uart.ends.note_lost();
        (1..=4).for_each(|byte| uart.ends.came(byte));
        assert_eq!(line.lost(), 2);
        let mut place = [0; 2];
        assert_eq!((line.read(&mut place), place), (2, [1, 2]));
        assert_eq!((line.read(&mut place), place), (1, [3, 2]));
        assert_eq!(line.read(&mut place), 0, "the fourth found no room");
    }

    #[test]
    fn bytes_are_sent_as_a_whole_or_not_at_all() {
        let (uart, mut line) = opened();
        assert!(line.send(&[1, 2]) && uart.is_asked.swap(false, Ordering::Relaxed));
        assert!(!line.send(&[3, 4]), "there is room for one");
        assert!(!uart.is_asked.load(Ordering::Relaxed) && !line.is_sent());
        assert_eq!(uart.ends.next(), Some(1));
        assert!(line.send(&[3, 4]), "there is room again");
        let sent = core::iter::from_fn(|| uart.ends.next());
        assert_eq!(sent.collect::<std::vec::Vec<_>>(), [2, 3, 4]);
        assert!(line.is_sent());
    }

    #[test]
    fn a_uart_that_was_not_opened_keeps_nothing() {
        let ends = Ends::new();
        ends.came(1);
        assert_eq!((ends.next(), ends.lost.load(Ordering::Relaxed)), (None, 1));
    }
}
