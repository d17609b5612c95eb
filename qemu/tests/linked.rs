//! The axis firmware on its link.

use std::time::Duration;

use leadscrew::protocol::client::{Answer, Client};
use leadscrew::protocol::reply::{ENABLED, HOMED, Reply};
use leadscrew::protocol::request::Request;
use leadscrew_qemu::{Error, Guest, Lockstep, Start, build};

/// A safety net, for a machine that is busy with something else.
const PATIENCE: Duration = Duration::from_secs(120);
/// Ticks between two barriers.
const STEP: u16 = 10;

fn linked() -> Start {
    Start::new(build("linked", "firmware").unwrap())
}

/// A tool on a line in lockstep.
struct Tool {
    line: Lockstep,
    client: Client,
    /// Ticks that have run.
    tick: u32,
    /// The last tick that the axis told of.
    seen: u32,
    records: u32,
    /// Everything that came.
    bytes: Vec<u8>,
    flags: u16,
    position_nm: i64,
}

impl Tool {
    fn on(line: Lockstep) -> Self {
        Self {
            line,
            client: Client::new(),
            tick: 0,
            seen: 0,
            records: 0,
            bytes: Vec::new(),
            flags: 0,
            position_nm: 0,
        }
    }

    /// Asks, and lets the axis run to the next barrier.
    fn ask(&mut self, request: &Request<'_>) {
        let frame = self.client.request(request).unwrap().to_vec();
        let (tick, bytes) = self.line.exchange(STEP, &frame).unwrap();
        self.tick = tick;
        let Self {
            client,
            seen,
            records,
            flags,
            position_nm,
            ..
        } = self;
        client.receive(&bytes, |answer| match answer {
            Answer::Record(_) => *records += 1,
            Answer::Reply(_, Reply::Refused { reason, .. }) => {
                panic!("refused {request:?}: {reason}")
            }
            Answer::Reply(_, Reply::Ack { tick }) => *seen = tick,
            Answer::Reply(
                _,
                Reply::Status {
                    tick,
                    flags: now,
                    position_nm: at,
                    ..
                },
            ) => {
                (*seen, *flags, *position_nm) = (tick, now, at);
            }
            _ => {}
        });
        self.bytes.extend(bytes);
    }

    /// Asks for the status and renews the lease in turn, until it is so.
    fn until(&mut self, most_ticks: u32, is_so: impl Fn(&Self) -> bool) {
        let last = self.tick + most_ticks;
        while !is_so(self) {
            assert!(
                self.tick < last,
                "at {} nm, flags {:b}",
                self.position_nm,
                self.flags
            );
            self.ask(&Request::RenewLease { seen: self.seen });
            self.ask(&Request::Status {});
        }
    }

    /// From hello to an axis that is homed, every tick recorded.
    fn home(&mut self) {
        self.ask(&Request::Hello {
            protocol: 1,
            nonce: 7,
        });
        self.ask(&Request::TakeLease {});
        self.ask(&Request::Subscribe { every: 1 });
        self.ask(&Request::Enable {});
        self.until(3_000, |tool| tool.flags & ENABLED != 0);
        self.ask(&Request::Home {});
        self.until(60_000, |tool| tool.flags & HOMED != 0);
    }
}

fn start(guest: &Start) -> (Guest, Tool) {
    let mut guest = guest.clone().lockstep().start().unwrap();
    let line = guest.take_lockstep().unwrap();
    (guest, Tool::on(line))
}

/// Ends it, which it does well if no tick was late, overlong or unreported; the last of what it logged.
fn end(guest: &Guest, tool: &mut Tool) -> String {
    let ended = tool.line.exchange(0, &[]);
    assert!(matches!(ended, Err(Error::Ended { .. })), "{ended:?}");
    let log: Vec<_> = guest
        .log()
        .unwrap()
        .iter()
        .map(ToString::to_string)
        .collect();
    let log = log.join("\n");
    assert_eq!(guest.wait(PATIENCE).unwrap(), 0, "{log}");
    log
}

#[test]
#[ignore = "needs QEMU; run by cargo xtask test"]
fn ten_thousand_ticks_with_a_busy_link_are_all_in_time() {
    let (guest, mut tool) = start(&linked());
    tool.home();
    tool.until(20_000, |tool| tool.tick > 10_000);
    let log = end(&guest, &mut tool);
    assert!(log.contains("late 0 overlong 0 lost records 0"), "{log}");
    // All but those before they were asked for.
    assert!(
        tool.records + 3 * u32::from(STEP) >= tool.tick,
        "{}",
        tool.records
    );
    assert_eq!(tool.client.records_lost(), 0);
}
