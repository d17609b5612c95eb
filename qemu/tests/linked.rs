//! The axis firmware on its link.

mod support;

use std::io::{Read, Write};
use std::net::TcpStream;
use std::time::Duration;

use leadscrew::protocol::client::{Answer, Client};
use leadscrew::protocol::reply::Reply;
use leadscrew::protocol::request::Request;
use leadscrew_qemu::{Carrier, Endpoint};
use support::{PATIENCE, STEP, Tool, end, linked, start};

/// For the rest of an answer that has begun.
const REST: Duration = Duration::from_millis(500);

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
    tool.until(6_000, |tool| {
        (tool.heard.position_nm - there).abs() < 10_000
    });
    tool.until(20_000, |tool| tool.tick > 10_000);
    let log = end(&guest, &mut tool);
    assert!(log.contains("late 0 overlong 0 lost records 0"), "{log}");
    // All but those before they were asked for.
    assert!(
        tool.heard.records + 3 * u32::from(STEP) >= tool.tick,
        "{}",
        tool.heard.records
    );
    assert_eq!(tool.lost().0, 0);
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
        (tool.heard.bytes, log)
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
    tool.begin_anew();
    tool.hello(2);
    tool.ask(&parameter);
    assert_eq!(tool.heard.value, Some(4321.0));
    powered.kill().unwrap();

    let (powered, mut tool) = start(&guest);
    tool.hello(1);
    tool.ask(&parameter);
    assert_eq!(tool.heard.value, Some(4321.0));
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

/// Ticks from the barrier that brings a request to the one that takes its answer away.
fn ticks_to_answer(tool: &mut Tool, request: &Request<'_>) -> u32 {
    let asked = tool.tick;
    let answers = tool.heard.answers;
    tool.step(1, Some(request));
    while tool.heard.answers == answers {
        tool.step(1, None);
    }
    tool.tick - asked
}

#[test]
#[ignore = "needs QEMU; run by cargo xtask test"]
fn what_only_asks_is_answered_within_a_tick_and_an_order_by_the_tick_that_takes_it() {
    let (guest, mut tool) = start(&linked());
    tool.home();
    let mut ticks = |request| ticks_to_answer(&mut tool, &request);
    let status = ticks(Request::Status {});
    let refused = ticks(Request::LearnRun { revolutions: 12 });
    let order = ticks(Request::Override { percent: 100 });
    let ordered = ticks(Request::Move {
        target_nm: 50_000_000,
        feed_um_per_min: 3_000_000,
    });
    println!("ticks: status {status}, refused {refused}, override {order}, move {ordered}");
    assert_eq!((status, refused), (1, 1));
    // The plan is made first, which takes most of its lead of 16 ms.
    assert!((2..=16).contains(&ordered), "{ordered}");
    end(&guest, &mut tool);
}
