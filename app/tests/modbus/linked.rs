//! The unit on the link of a real axis: what is written goes through the tick and into the store.

use leadscrew::axis::Inputs;
use leadscrew::compensation::table::{POINTS, Stretch};
use leadscrew::hal::Capture;
use leadscrew::protocol::client::{Answer, Client};
use leadscrew::protocol::reply::Reply;
use leadscrew::protocol::request::Request;
use leadscrew::protocol::service::Identity;
use leadscrew_app::axis_control::{AxisControl, Inlet};
use leadscrew_app::link::{Boot, Link, Maps, WORDS, WorkMemory};
use leadscrew_app::modbus::{Config, Modbus, Panel as _};
use leadscrew_app::queues::Queues;
use leadscrew_app::safe_state::reason::{HardFault, Place, Reason};
use leadscrew_app::safe_state::record::{Record, ResetFlags};
use leadscrew_app::store::Interlock;
use leadscrew_app::tick::{Control as _, Counters};

use crate::fake::{UNIT, asking, crc, framed, number, settings, words, writing};
use crate::flash::SimFlash;

type Flash = SimFlash<4096, 4>;

/// An encoder that stands at a count, drive and lines well.
struct Standing(u32);

impl Inlet for Standing {
    fn inputs(&self, enable: bool) -> Inputs<'_> {
        let capture = Capture {
            count: self.0,
            ..Capture::default()
        };
        Inputs::of(capture, enable)
    }
}

struct Board<'f> {
    control: AxisControl<Standing>,
    link: Link<&'f mut Flash>,
    modbus: Modbus,
    now_us: u32,
}

fn leak<T>(value: T) -> &'static mut T {
    Box::leak(Box::new(value))
}

/// Switches the board on.
fn on(flash: &mut Flash) -> Board<'_> {
    let end = flash.cells.len() as u32;
    let boot = Boot {
        flash,
        range: 0..end,
        factory: settings(),
        identity: Identity {
            firmware: "1",
            build: "test",
            board: "none",
            capabilities: 0x0f,
            work_memory: 0,
            lead_ticks: 2,
        },
        queues: leak(<Queues>::new()),
        work: leak(WorkMemory::<WORDS, WORDS>::new()).lend(),
        maps: leak(<Maps>::new()).places(),
        screw: leak([Stretch::default(); POINTS.1]),
        interlock: leak(Interlock::new()),
        counters: leak(Counters::new()),
    };
    let (control, link, _) = boot.start().unwrap();
    let config = Config::serial(UNIT, 19_200).unwrap();
    let modbus = Modbus::new(config, link.settings());
    Board {
        control,
        link,
        modbus,
        now_us: 0,
    }
}

impl Board<'_> {
    /// A tick of the axis; what the unit sends.
    fn tick(&mut self, count: u32) -> Vec<Vec<u8>> {
        let report = self.control.step(&Standing(count));
        self.link.report(&report, &mut |_| true);
        self.link.poll(&mut |_| true);
        self.now_us += 1_000;
        let mut sent = Vec::new();
        let send = &mut |frame: &[u8]| sent.push(frame.to_vec());
        self.modbus.poll(self.now_us, &mut self.link, send);
        sent
    }

    fn hear(&mut self, request: &[u8]) -> Vec<Vec<u8>> {
        let mut sent = Vec::new();
        let frame = framed(UNIT, request);
        let send = &mut |frame: &[u8]| sent.push(frame.to_vec());
        self.modbus
            .receive(&frame, self.now_us, &mut self.link, send);
        sent
    }

    #[track_caller]
    fn read(&mut self, address: u16, count: u16) -> Vec<u16> {
        let sent = self.hear(&asking(3, address, count));
        let (content, check) = sent[0].split_last_chunk().unwrap();
        assert_eq!(crc(content), u16::from_le_bytes(*check));
        let (pairs, _) = content[3..].as_chunks();
        assert_eq!(pairs.len(), usize::from(count), "{content:02x?}");
        pairs.iter().map(|pair| u16::from_be_bytes(*pair)).collect()
    }
}

fn place(name: &str) -> u16 {
    let names = crate::page::names();
    1000 + 4 * names.iter().position(|known| known == name).unwrap() as u16
}

#[test]
fn what_is_written_is_taken_by_the_tick_and_is_there_after_a_power_cycle() {
    let mut flash = Flash::new(16);
    let [feed, estimator] = ["motion.max_feed_mm_per_min", "estimator"].map(place);
    let mut board = on(&mut flash);
    for _ in 0..50 {
        assert!(board.tick(2_000).is_empty());
    }
    let status = board.read(0, 86);
    assert_eq!((status[2], status[3]), (0, 0));
    assert_ne!(status[1] & 1 << 9, 0, "settable");
    assert!((49..=50).contains(&status[7]), "tick {}", status[7]);
    // 1 000 d/mm; to a count.
    let position = i64::from(status[10]) << 16 | i64::from(status[11]);
    assert!(2_000_000_i64.abs_diff(position) <= 1_000, "{position}");

    assert!(
        board.hear(&writing(feed, &words(4321.5))).is_empty(),
        "on its way"
    );
    assert_eq!(board.tick(2_000), [framed(UNIT, &asking(16, feed, 4))]);
    assert!(board.hear(&writing(estimator, &words(1.0))).is_empty());
    assert_eq!(board.tick(2_000), [framed(UNIT, &asking(16, estimator, 4))]);
    assert_eq!(number(&board.read(feed, 4)), 4321.5);
    let refused = board.hear(&writing(feed, &words(1e5)));
    assert_eq!(
        refused,
        [framed(UNIT, &[0x90, 3])],
        "above what the drive gives"
    );
    assert_eq!(board.read(81, 1), [26]);

    let saved = board.hear(&asking(6, 5000, 0x5A5A));
    assert_eq!(saved, [framed(UNIT, &asking(6, 5000, 0x5A5A))]);
    drop(board);
    let mut board = on(&mut flash);
    board.tick(2_000);
    assert_eq!(number(&board.read(feed, 4)), 4321.5);
    assert_eq!(number(&board.read(estimator, 4)), 1.0);
}

#[test]
fn what_was_not_saved_is_gone_after_a_power_cycle() {
    let mut flash = Flash::new(16);
    let feed = place("motion.max_feed_mm_per_min");
    let mut board = on(&mut flash);
    board.tick(0);
    board.hear(&writing(feed, &words(4321.5)));
    board.tick(0);
    assert_eq!(number(&board.read(feed, 4)), 4321.5);
    drop(board);
    let mut board = on(&mut flash);
    let factory = settings().axis.motion.max_feed_mm_per_min;
    assert_eq!(number(&board.read(feed, 4)), factory);
}

/// Asks on the axis' own line, and gives what was understood of the answers.
fn ask<R>(
    board: &mut Board<'_>,
    tool: &mut Client,
    request: &Request<'_>,
    mut of: impl FnMut(Reply<'_>) -> Option<R>,
) -> Option<R> {
    let frame = tool.request(request).unwrap().to_vec();
    let mut sent = Vec::new();
    board.link.receive(&frame, &mut |bytes| {
        sent.extend_from_slice(bytes);
        true
    });
    let mut found = None;
    tool.receive(&sent, |answer| {
        if let Answer::Reply(_, reply) = answer {
            found = of(reply).or(found.take());
        }
    });
    found
}

#[test]
fn why_it_was_started_anew_is_told_on_the_axis_own_line() {
    let fault = HardFault {
        pc: 0x0801_2344,
        lr: 0x0801_0001,
        cfsr: 0x8200,
        hfsr: 0x4000_0000,
        address: 0xdead_beec,
    };
    let panic = Place::new("app/src/tick.rs", 42);
    let cases = [
        (None, (0, 0, 0, String::new())),
        (
            Some(Reason::Panic(panic)),
            (1, 1, 42, "app/src/tick.rs".into()),
        ),
        (
            Some(Reason::HardFault(fault)),
            (2, 1, fault.pc, String::new()),
        ),
        (
            Some(Reason::LateTicks { tick: 9 }),
            (4, 1, 9, String::new()),
        ),
    ];
    for (reason, expected) in cases {
        let mut flash = Flash::new(16);
        let mut board = on(&mut flash);
        board.tick(0);
        let kept = Record {
            reason,
            ..Record::default()
        };
        let flags = ResetFlags {
            watchdog: reason.is_some(),
            power: false,
        };
        board
            .link
            .set_reset(Record::after_reset(&kept.words(), flags));
        let mut tool = Client::new();
        let hello = Request::Hello {
            protocol: leadscrew::protocol::VERSION,
            nonce: 5,
        };
        ask(&mut board, &mut tool, &hello, |_| Some(()));
        let told = ask(
            &mut board,
            &mut tool,
            &Request::LastReset {},
            |reply| match reply {
                Reply::Reset {
                    reason,
                    resets,
                    place,
                    cfsr,
                    file,
                    ..
                } => {
                    assert_eq!(cfsr != 0, reason == 2);
                    Some((reason, resets, place, file.to_owned()))
                }
                _ => None,
            },
        );
        assert_eq!(told, Some(expected));
    }
}
