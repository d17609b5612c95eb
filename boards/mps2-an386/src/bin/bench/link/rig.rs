//! The firmware of an axis with its link, tick by tick, each part of a tick counted by itself.

use board_mps2_an386::flash::{self, CAPACITY, Flash};
use board_mps2_an386::instructions::Counter;
use board_mps2_an386::timer::TIMER0;
use heapless::Vec;
use leadscrew::compensation::Stretch;
use leadscrew::compensation::table::POINTS;
use leadscrew::estimator::EstimatorConfig;
use leadscrew::protocol::client::{Answer, Client};
use leadscrew::protocol::reply::{CAN_LEARN, CAN_RECORD, CAN_SCOPE, Reply};
use leadscrew::protocol::request::Request;
use leadscrew::protocol::service::Identity;
use leadscrew::settings::Settings;
use leadscrew_app::axis_control::AxisControl;
use leadscrew_app::link::{Boot, Link, Maps, WORDS, WorkMemory};
use leadscrew_app::queues::Queues;
use leadscrew_app::report::Report;
use leadscrew_app::store::Interlock;
use leadscrew_app::tick::{Control as _, Counters};
use leadscrew_hal_mock::machine::{Machine, MachineParams};
use leadscrew_hal_mock::scenario::{MoveAndBack, ScenarioError};
use static_cell::ConstStaticCell;

use super::FEED_UM_PER_MIN;
use crate::samples::Samples;

const TICK_HZ: f64 = 1000.0;
/// Longer than the planner takes here, where nothing else runs.
const LEAD: u32 = 4;
const NM_PER_MM: i64 = 1_000_000;
/// Room for what a tick lets the link send.
const SENT: usize = 4096;
/// The longest move here, and some.
const MOVE_TICKS: u32 = 1500;

const NAMES: [&str; 21] = [
    "tick",
    "tick_scope",
    "tick_captures",
    "report",
    "report_record",
    "poll",
    "poll_stream",
    "poll_learn",
    "settle",
    "hello",
    "status",
    "renew",
    "refused",
    "parameter",
    "move",
    "samples_frame",
    "decode_frame",
    "decode_byte",
    "replan",
    "learn_end",
    "other",
];

/// Counts, in the order of [`NAMES`].
#[derive(Clone, Copy)]
pub enum Of {
    Tick,
    TickScope,
    TickCaptures,
    Report,
    ReportRecord,
    Poll,
    PollStream,
    PollLearn,
    Settle,
    Hello,
    Status,
    Renew,
    Refused,
    Parameter,
    Move,
    SamplesFrame,
    DecodeFrame,
    DecodeByte,
    /// A move while another one is under way.
    Replan,
    LearnEnd,
    /// Requests that come once; not told.
    Other,
}

type Table = [Samples; NAMES.len()];

static TABLE: ConstStaticCell<Table> = ConstStaticCell::new(Samples::of_each(&NAMES));
static QUEUES: ConstStaticCell<Queues> = ConstStaticCell::new(Queues::new());
static WORK: ConstStaticCell<WorkMemory<WORDS, WORDS>> =
    ConstStaticCell::new(WorkMemory::new());
static MAPS: ConstStaticCell<Maps> = ConstStaticCell::new(Maps::new());
static SCREW: ConstStaticCell<[Stretch; POINTS.1]> =
    ConstStaticCell::new([Stretch::EMPTY; POINTS.1]);
static INTERLOCK: Interlock = Interlock::new();
static COUNTERS: Counters = Counters::new();

/// An axis on its link.
pub struct Rig<'c> {
    pub counter: &'c mut Counter,
    pub table: &'static mut Table,
    control: AxisControl<Machine>,
    link: Link<Flash>,
    machine: Machine,
    client: Client,
    /// Frames of the axis that the tool has not seen.
    sent: Vec<u8, SENT>,
    report: Report,
    /// What ticks count as now.
    pub kinds: Kinds,
}

/// What a tick and its thread mode count as.
pub type Kinds = [Of; 3];

pub const PLAIN: Kinds = [Of::Tick, Of::Report, Of::Poll];

impl<'c> Rig<'c> {
    pub fn new(counter: &'c mut Counter) -> Result<Self, ScenarioError> {
        let scenario = MoveAndBack::standard(TICK_HZ);
        let machine = MachineParams::z_16k20f3();
        let estimator = EstimatorConfig::by_name("exponential")?.expect("it is one");
        let factory = Settings {
            axis: scenario.axis_params(&machine, estimator)?,
            ..Settings::new(estimator)
        };
        let Ok(flash) = flash::open(None) else {
            panic!("a flash that forgets is always there");
        };
        let boot = Boot {
            flash,
            range: 0..CAPACITY as u32,
            factory,
            identity: Identity {
                firmware: "0",
                build: "bench",
                board: "mps2-an386",
                capabilities: CAN_RECORD | CAN_SCOPE | CAN_LEARN,
                work_memory: (4 * WORDS) as u32,
                lead_ticks: LEAD,
            },
            queues: QUEUES.take(),
            work: WORK.take().lend(),
            maps: MAPS.take().places(),
            screw: SCREW.take(),
            interlock: &INTERLOCK,
            counters: &COUNTERS,
        };
        let (control, link, _) = boot.start()?;
        Ok(Self {
            counter,
            table: TABLE.take(),
            control,
            link,
            machine: Machine::new(&machine, TICK_HZ, 1)?,
            client: Client::new(),
            sent: Vec::new(),
            report: Report::default(),
            kinds: [Of::Other; 3],
        })
    }

    pub fn push(&mut self, of: Of, count: u32) {
        self.table[of as usize].push(count);
    }

    /// A tick and what thread mode makes of it.
    fn tick(&mut self) {
        let [of_tick, of_report, of_poll] = self.kinds;
        let Self {
            counter,
            control,
            link,
            machine,
            client,
            sent,
            report,
            ..
        } = self;
        let (command, enabled) = report.record.drive();
        machine.step(command, enabled);
        let tick = counter.count(|| *report = control.step(machine));
        let reported = counter
            .count(|| link.report(report, &mut |frame| sent.extend_from_slice(frame).is_ok()));
        let polled = counter.count_long(&TIMER0, || {
            link.poll(&mut |frame| sent.extend_from_slice(frame).is_ok());
        });
        let mut is_answered = false;
        client.receive(sent, |answer| {
            is_answered |= matches!(answer, Answer::Reply(..));
        });
        sent.clear();
        self.push(of_tick, tick);
        self.push(of_report, reported);
        self.push(if is_answered { Of::Settle } else { of_poll }, polled);
    }

    /// Asks, then lets a tick see it.
    pub fn ask(&mut self, of: Of, request: &Request<'_>) -> Option<u16> {
        let Self {
            counter,
            link,
            client,
            sent,
            ..
        } = self;
        let frame = client.request(request).expect("it fits a frame");
        // A plan takes long.
        let cost = counter.count_long(&TIMER0, || {
            link.receive(frame, &mut |frame| sent.extend_from_slice(frame).is_ok());
        });
        let mut refused = None;
        client.receive(sent, |answer| {
            if let Answer::Reply(_, Reply::Refused { reason, .. }) = answer {
                refused = Some(reason);
            }
        });
        sent.clear();
        self.push(of, cost);
        self.tick();
        refused
    }

    /// A tool at work: it renews its lease and looks at the axis in turn.
    pub fn ticks(&mut self, ticks: u32) {
        for _ in 0..ticks / 10 {
            let seen = self.report.record.tick;
            self.ask(Of::Renew, &Request::RenewLease { seen });
            self.ask(Of::Status, &Request::Status {});
            (0..8).for_each(|_| self.tick());
        }
    }

    pub fn enable(&mut self) {
        self.ask(Of::Other, &Request::Enable {});
        self.ticks(500);
    }

    pub fn order(&mut self, of: Of, target_mm: i64, feed_um_per_min: u32) -> Option<u16> {
        let target_nm = target_mm * NM_PER_MM;
        self.ask(
            of,
            &Request::Move {
                target_nm,
                feed_um_per_min,
            },
        )
    }

    /// Goes there, and counts the ticks as `kinds`.
    pub fn go(&mut self, target_mm: i64, kinds: Kinds) {
        let refused = self.order(Of::Move, target_mm, FEED_UM_PER_MIN);
        assert!(refused.is_none(), "the axis is ready");
        self.kinds = kinds;
        self.ticks(MOVE_TICKS);
        self.kinds = [Of::Other; 3];
    }
}
