//! A tool on a guest in lockstep.

#![allow(dead_code, reason = "every test file uses a part of it")]

use std::time::Duration;

use leadscrew::protocol::client::{Answer, Client};
use leadscrew::protocol::refusal::Refusal;
use leadscrew::protocol::reply::{HOMED, PLANNED, Reply};
use leadscrew::protocol::request::Request;
use leadscrew_qemu::{Error, Guest, Lockstep, Start, build};

/// A safety net, for a machine that is busy with something else.
pub const PATIENCE: Duration = Duration::from_secs(120);
/// Ticks between two barriers.
pub const STEP: u16 = 10;

/// The axis on its link.
pub fn linked() -> Start {
    Start::new(build("linked", "firmware").unwrap())
}

/// A tool on a line in lockstep.
pub struct Tool {
    pub line: Lockstep,
    pub heard: Heard,
    client: Client,
    /// Ticks that have run.
    pub tick: u32,
}

/// What a tool was told.
#[derive(Default)]
pub struct Heard {
    /// Everything that came.
    pub bytes: Vec<u8>,
    /// The last tick that the axis told of.
    pub seen: u32,
    pub flags: u16,
    pub position_nm: i64,
    /// Answers to requests.
    pub answers: u32,
    pub records: u32,
    /// Samples of signals.
    pub samples: u32,
    /// Samples that did not follow the one before.
    pub gaps: u32,
    last_sample: Option<u32>,
    /// The parameter that was told last.
    pub value: Option<f64>,
    /// Late, overlong and lost ticks, and the worst end, as asked for last.
    pub counters: Option<Counters>,
    /// Revolutions that the learner has averaged over, and its runs.
    pub learned: (u32, u8),
    /// How the scope stands.
    pub scope: u8,
    /// Moves whose start had passed before they were planned.
    pub too_late: u32,
}

/// What the ticks counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Counters {
    pub ticks: u32,
    pub late: u32,
    pub overlong: u32,
    pub lost: u32,
    /// Clocks after it was due.
    pub worst_end: u32,
}

impl Heard {
    /// Takes an answer; a refusal ends the test.
    pub fn take(&mut self, answer: Answer<'_>) {
        self.answers += u32::from(matches!(answer, Answer::Reply(..)));
        let reply = match answer {
            Answer::Record(_) => return self.records += 1,
            Answer::Samples(frame) => {
                let every = u32::from(frame.every);
                return frame.iter().for_each(|(tick, _)| self.sample(tick, every));
            }
            Answer::Reply(_, reply) => reply,
        };
        match reply {
            Reply::Refused { reason, .. } if reason == Refusal::TooLate as u16 => {
                self.too_late += 1;
            }
            Reply::Refused { reason, .. } if reason == Refusal::NotLearning as u16 => {}
            Reply::Refused { reason, .. } => panic!("refused: {reason}"),
            Reply::Parameter { value, .. } => self.value = Some(value),
            Reply::Ack { tick } => self.seen = tick,
            Reply::Status {
                tick,
                flags,
                position_nm,
                ..
            } => {
                (self.seen, self.flags, self.position_nm) = (tick, flags, position_nm);
            }
            Reply::Counters {
                ticks,
                late,
                overlong,
                lost_records,
                worst_end,
                ..
            } => {
                self.counters = Some(Counters {
                    ticks,
                    late,
                    overlong,
                    lost: lost_records,
                    worst_end,
                });
            }
            Reply::Learning {
                revolutions, runs, ..
            } => self.learned = (revolutions, runs),
            Reply::Scope { phase, .. } => self.scope = phase,
            _ => {}
        }
    }

    fn sample(&mut self, tick: u32, every: u32) {
        let follows = self.last_sample.is_none_or(|last| tick == last + every);
        self.gaps += u32::from(!follows);
        self.last_sample = Some(tick);
        self.samples += 1;
    }
}

impl Tool {
    fn on(line: Lockstep) -> Self {
        Self {
            line,
            heard: Heard::default(),
            client: Client::new(),
            tick: 0,
        }
    }

    /// Asks, and lets the axis run to the next barrier.
    pub fn ask(&mut self, request: &Request<'_>) {
        self.step(STEP, Some(request));
    }

    /// Lets so many ticks pass, with or without a request before them.
    pub fn step(&mut self, ticks: u16, request: Option<&Request<'_>>) {
        let frame = request.map_or_else(Vec::new, |request| {
            self.client.request(request).unwrap().to_vec()
        });
        let (tick, bytes) = self.line.exchange(ticks, &frame).unwrap();
        self.tick = tick;
        let Self { client, heard, .. } = self;
        client.receive(&bytes, |answer| heard.take(answer));
        heard.bytes.extend(bytes);
    }

    /// Forgets the session, as a tool that begins anew.
    pub fn begin_anew(&mut self) {
        self.client = Client::new();
    }

    /// Frames of records and of samples that did not arrive.
    pub fn lost(&self) -> (u32, u32) {
        (self.client.records_lost(), self.client.samples_lost())
    }

    /// Asks for the status and renews the lease in turn, until it is so.
    pub fn until(&mut self, most_ticks: u32, is_so: impl Fn(&Self) -> bool) {
        let last = self.tick + most_ticks;
        while !is_so(self) {
            assert!(
                self.tick < last,
                "at {} nm, flags {:b}",
                self.heard.position_nm,
                self.heard.flags
            );
            self.ask(&Request::RenewLease {
                seen: self.heard.seen,
            });
            self.ask(&Request::Status {});
        }
    }

    pub fn hello(&mut self, nonce: u32) {
        self.ask(&Request::Hello { protocol: 1, nonce });
    }

    /// From hello to an axis that is ready, every tick recorded.
    pub fn enable(&mut self) {
        self.hello(7);
        self.ask(&Request::TakeLease {});
        self.ask(&Request::Subscribe { every: 1 });
        self.ask(&Request::Enable {});
        self.until(3_000, |tool| tool.heard.flags & PLANNED != 0);
    }

    /// The same, and homed.
    pub fn home(&mut self) {
        self.enable();
        self.ask(&Request::Home {});
        // It still comes to rest when it is.
        self.until(60_000, |tool| {
            tool.heard.flags & (HOMED | PLANNED) == HOMED | PLANNED
        });
    }
}

pub fn start(guest: &Start) -> (Guest, Tool) {
    let mut guest = guest.clone().lockstep().start().unwrap();
    let line = guest.take_lockstep().unwrap();
    (guest, Tool::on(line))
}

/// The last counts of the ticks that were asked for.
impl Tool {
    pub fn counters(&mut self) -> Counters {
        self.ask(&Request::Counters {});
        self.heard.counters.unwrap()
    }
}

/// Ends it, which it does well if no tick was late, overlong or unreported; the last of what it logged.
pub fn end(guest: &Guest, tool: &mut Tool) -> String {
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
