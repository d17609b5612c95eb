//! The axis firmware on its link.

use std::io::{Read, Write};
use std::net::TcpStream;
use std::time::Duration;

use leadscrew::protocol::client::{Answer, Client};
use leadscrew::protocol::reply::{ENABLED, HOMED, PLANNED, Reply};
use leadscrew::protocol::request::Request;
use leadscrew_qemu::{Carrier, Endpoint, Error, Guest, Lockstep, Start, build};

/// A safety net, for a machine that is busy with something else.
const PATIENCE: Duration = Duration::from_secs(120);
/// For the rest of an answer that has begun.
const REST: Duration = Duration::from_millis(500);
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
    /// The parameter that was told last.
    value: f64,
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
            value: f64::NAN,
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
            value,
            ..
        } = self;
        client.receive(&bytes, |answer| match answer {
            Answer::Record(_) => *records += 1,
            Answer::Reply(_, Reply::Refused { reason, .. }) => {
                panic!("refused {request:?}: {reason}")
            }
            Answer::Reply(_, Reply::Parameter { value: told, .. }) => *value = told,
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

    fn hello(&mut self, nonce: u32) {
        self.ask(&Request::Hello { protocol: 1, nonce });
    }

    /// From hello to an axis that is homed, every tick recorded.
    fn home(&mut self) {
        self.hello(7);
        self.ask(&Request::TakeLease {});
        self.ask(&Request::Subscribe { every: 1 });
        self.ask(&Request::Enable {});
        self.until(3_000, |tool| tool.flags & ENABLED != 0);
        self.ask(&Request::Home {});
        // It still comes to rest when it is.
        self.until(60_000, |tool| {
            tool.flags & (HOMED | PLANNED) == HOMED | PLANNED
        });
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
    // The most edges a tick that there are.
    let there = 300_000_000;
    tool.ask(&Request::Move {
        target_nm: there,
        feed_um_per_min: 9_000_000,
    });
    tool.until(6_000, |tool| (tool.position_nm - there).abs() < 10_000);
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

#[test]
#[ignore = "needs QEMU; run by cargo xtask test"]
fn what_the_axis_says_to_the_same_words_is_the_same() {
    let said = || {
        let (guest, mut tool) = start(&linked().arg("tick-hz=2000"));
        tool.hello(3);
        tool.ask(&Request::TakeLease {});
        tool.ask(&Request::Subscribe { every: 1 });
        tool.ask(&Request::Enable {});
        tool.until(3_000, |tool| tool.tick > 500);
        let log = end(&guest, &mut tool);
        (tool.bytes, log)
    };
    let first = said();
    assert!(first.0.len() > 10_000);
    assert!(first == said());
}

#[test]
#[ignore = "needs QEMU; run by cargo xtask test"]
fn what_was_saved_is_there_after_a_restart_and_after_a_power_cut() {
    const NAME: &str = "motion.max_feed_mm_per_min";
    let folder = tempfile::tempdir().unwrap();
    let guest = linked().flash(&folder.path().join("flash"));
    let (mut powered, mut tool) = start(&guest);
    let parameter = Request::Parameter { name: NAME };
    tool.hello(1);
    tool.ask(&Request::TakeLease {});
    tool.ask(&Request::SetParameter {
        name: NAME,
        value: 4321.0,
    });
    tool.ask(&Request::SaveParameters {});
    tool.ask(&Request::Restart {});
    assert!(tool.tick > 0, "it is acknowledged before");
    let (tick, said) = tool.line.exchange(STEP, &[]).unwrap();
    assert_eq!((tick, said), (0, vec![]));
    tool.client = Client::new();
    tool.hello(2);
    tool.ask(&parameter);
    assert_eq!(tool.value, 4321.0);
    powered.kill().unwrap();

    let (powered, mut tool) = start(&guest);
    tool.hello(1);
    tool.ask(&parameter);
    assert_eq!(tool.value, 4321.0);
    end(&powered, &mut tool);
}

/// Sends until something comes back.
fn asked(socket: &mut TcpStream, question: &[u8]) -> Vec<u8> {
    socket.set_read_timeout(Some(PATIENCE)).unwrap();
    socket.write_all(question).unwrap();
    let mut answer = vec![0; 256];
    let count = socket.read(&mut answer).unwrap();
    answer.truncate(count);
    // The rest of it, a byte at a time as QEMU passes them on.
    socket.set_read_timeout(Some(REST)).unwrap();
    let mut byte = [0];
    while matches!(socket.read(&mut byte), Ok(1)) {
        answer.extend(byte);
    }
    answer
}

fn socket(endpoint: Option<&Endpoint>) -> TcpStream {
    let Some(Endpoint::Tcp(address)) = endpoint else {
        panic!("not on a socket: {endpoint:?}");
    };
    TcpStream::connect(address).unwrap()
}

#[test]
#[ignore = "needs QEMU; run by cargo xtask test"]
fn link_and_modbus_are_answered_on_their_uarts() {
    let any = Carrier::Tcp { port: 0 };
    let guest = linked().link(any).modbus(any).start().unwrap();
    let (mut link, mut modbus) = (socket(guest.link()), socket(guest.modbus()));

    let mut client = Client::new();
    let hello = Request::Hello {
        protocol: 1,
        nonce: 9,
    };
    let answer = asked(&mut link, client.request(&hello).unwrap());
    let mut board = String::new();
    client.receive(&answer, |answer| {
        if let Answer::Reply(_, Reply::Hello { board: told, .. }) = answer {
            told.clone_into(&mut board);
        }
    });
    assert_eq!(board, "mps2-an386");

    // Unit 1, function 4: registers 40 and 41, the control rate; the last two bytes are the CRC.
    let answer = asked(&mut modbus, &[1, 4, 0, 40, 0, 2, 0xf1, 0xc3]);
    assert_eq!(
        answer.get(..7),
        Some(&[1, 4, 4, 0, 0, 0x03, 0xe8][..]),
        "{answer:x?}"
    );
}
