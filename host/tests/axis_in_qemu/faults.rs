//! The worst line of the table in docs/wire-format.md, before the real firmware. Every tick that it tells of is looked at
//! where its bytes are still whole.

use std::cell::RefCell;
use std::io;
use std::path::Path;
use std::rc::Rc;
use std::time::Duration;

use leadscrew::protocol::decoder::Decoder;
use leadscrew::protocol::frame::Channel;
use leadscrew::protocol::record::record_from_bytes;
use leadscrew_client::noisy::Noisy;
use leadscrew_client::{Axis, DEFAULT_BAUD, Line, Options, SerialLine, TcpLine};
use leadscrew_host::axis::QemuLine;
use leadscrew_qemu::{Carrier, Endpoint};

use crate::guest;
use crate::shuttle::{Run, shuttle, worst};
use crate::watch::Watch;

/// Moves of a run: cuts come every 3 s, and most moves see faults of each kind.
const MOVES: u32 = 8;
const COUNTS_PER_MM: f64 = 1000.0;

/// A line whose records are looked at on their way.
struct Tapped<L> {
    line: L,
    decoder: Decoder,
    seen: Rc<RefCell<Watch>>,
    ticks: Rc<RefCell<u32>>,
}

impl<L: Line> Line for Tapped<L> {
    fn exchange(&mut self, out: &[u8], received: &mut Vec<u8>) -> io::Result<Duration> {
        let before = received.len();
        let now = self.line.exchange(out, received)?;
        let (seen, ticks) = (&self.seen, &self.ticks);
        let mut came = out;
        self.decoder.feed_all(&received[before..], |frame, _| {
            if frame.header.channel == Channel::Telemetry
                && let Some(record) = record_from_bytes(frame.body)
            {
                // What was sent came before the first tick of the exchange.
                seen.borrow_mut().tick(&record, std::mem::take(&mut came));
                *ticks.borrow_mut() += 1;
            }
        });
        Ok(now)
    }

    fn name(&self) -> String {
        self.line.name()
    }

    fn is_lockstep(&self) -> bool {
        self.line.is_lockstep()
    }
}

/// Moves over `line` with the faults before it.
fn moved_over(line: impl Line + 'static) -> Run {
    let seen = Rc::new(RefCell::new(Watch::new(COUNTS_PER_MM)));
    let ticks = Rc::default();
    let tapped = Tapped {
        line,
        decoder: Decoder::new(),
        seen: Rc::clone(&seen),
        ticks: Rc::clone(&ticks),
    };
    let noisy = Noisy::new(tapped, worst(), 1);
    let done = noisy.done();
    let options = Options {
        seed: Some(1),
        ..Options::default()
    };
    let mut tool = Axis::open(noisy, options).unwrap();
    let run = shuttle(&mut tool, MOVES, &seen, &done, |tool| tool.subscribe(1));
    println!("{} ticks seen: {run:?}", ticks.borrow());
    assert!(
        *ticks.borrow() > 2000,
        "{} ticks were told of",
        ticks.borrow()
    );
    let done = run.done;
    let all = [
        done.dropped,
        done.flipped,
        done.doubled,
        done.delayed,
        done.cut,
    ];
    assert!(all.iter().all(|count| *count > 0), "{done:?}");
    assert_eq!((run.made, run.seen.wrong), (MOVES, 0), "{run:?}");
    run
}

#[test]
#[ignore = "needs QEMU; run by cargo xtask test"]
fn the_worst_line_in_lockstep_moves_nothing_wrongly_and_stops_it() {
    let run = moved_over(QemuLine::start(|start| start).unwrap());
    assert!(run.seen.stops > 0, "no stop was seen: {run:?}");
    // Two leases, the tick of the lapse, and the stop itself.
    assert!(run.seen.deaf_ms <= 200 + run.seen.longest_ms, "{run:?}");
}

#[test]
#[ignore = "needs QEMU; run by cargo xtask test"]
fn the_worst_line_over_tcp_moves_nothing_wrongly() {
    let guest = guest(Carrier::Tcp { port: 0 }, None);
    let Some(Endpoint::Tcp(address)) = guest.link() else {
        panic!("it has no socket");
    };
    moved_over(TcpLine::connect(&address.to_string()).unwrap());
}

#[test]
#[ignore = "needs QEMU; run by cargo xtask test"]
fn the_worst_line_over_a_terminal_moves_nothing_wrongly() {
    let guest = guest(Carrier::Pty, None);
    let Some(Endpoint::Pty(path)) = guest.link() else {
        panic!("it has no terminal");
    };
    moved_over(SerialLine::open(Path::new(path), DEFAULT_BAUD).unwrap());
}
