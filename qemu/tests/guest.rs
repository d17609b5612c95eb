//! A guest that lives long: its ports, its flash image, its restart, and the line in lockstep.

use std::fs::{File, OpenOptions};
use std::io::{Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::time::Duration;

use leadscrew_qemu::{
    Carrier, Endpoint, Error, Guest, LARGEST_SHIFT, Lockstep, LogLine, Start, build,
};

const RESTART: u8 = 0x12;
/// A safety net, for a machine that is busy with something else.
const PATIENCE: Duration = Duration::from_secs(120);

fn peripherals() -> Start {
    Start::new(build("peripherals", "firmware").unwrap()).shift(LARGEST_SHIFT)
}

/// The bytes that come back.
fn echoed(line: &mut (impl Read + Write), bytes: &[u8]) -> Vec<u8> {
    line.write_all(bytes).unwrap();
    let mut back = vec![0; bytes.len()];
    line.read_exact(&mut back).unwrap();
    back
}

fn socket(endpoint: Option<&Endpoint>) -> TcpStream {
    let Some(Endpoint::Tcp(address)) = endpoint else {
        panic!("not on a socket: {endpoint:?}");
    };
    let socket = TcpStream::connect(address).unwrap();
    socket.set_read_timeout(Some(PATIENCE)).unwrap();
    socket
}

fn terminal(endpoint: Option<&Endpoint>) -> File {
    let Some(Endpoint::Pty(path)) = endpoint else {
        panic!("not on a terminal: {endpoint:?}");
    };
    OpenOptions::new()
        .read(true)
        .write(true)
        .open(path)
        .unwrap()
}

/// Every byte but the one that restarts.
fn all_bytes() -> Vec<u8> {
    (0..=u8::MAX).filter(|byte| *byte != RESTART).collect()
}

fn count(log: &[LogLine], part: &str) -> usize {
    log.iter()
        .filter(|line| line.message.contains(part))
        .count()
}

#[test]
#[ignore = "needs QEMU; run by cargo xtask test"]
fn what_is_sent_over_sockets_comes_back_from_each() {
    let any = Carrier::Tcp { port: 0 };
    let guest = peripherals().link(any).modbus(any).start().unwrap();
    let (mut link, mut modbus) = (socket(guest.link()), socket(guest.modbus()));
    assert_eq!(echoed(&mut link, &all_bytes()), all_bytes());
    assert_eq!(echoed(&mut modbus, b"another"), b"another");
}

#[test]
#[ignore = "needs QEMU; run by cargo xtask test"]
fn what_is_sent_over_terminals_comes_back_from_each() {
    let guest = peripherals()
        .link(Carrier::Pty)
        .modbus(Carrier::Pty)
        .start()
        .unwrap();
    let (mut link, mut modbus) = (terminal(guest.link()), terminal(guest.modbus()));
    assert_eq!(echoed(&mut link, &all_bytes()), all_bytes());
    assert_eq!(echoed(&mut modbus, b"another"), b"another");
    // The log is not mixed with what QEMU tells of its terminals.
    assert_eq!(count(&guest.log().unwrap(), "up"), 1);
}

#[test]
#[ignore = "needs QEMU; run by cargo xtask test"]
fn a_guest_that_restarts_comes_up_again() {
    let any = Carrier::Tcp { port: 0 };
    let guest = peripherals().link(any).start().unwrap();
    let mut link = socket(guest.link());
    for life in 1..=3 {
        assert_eq!(echoed(&mut link, b"there"), b"there");
        assert_eq!(count(&guest.log().unwrap(), "up"), life);
        link.write_all(&[RESTART]).unwrap();
        while count(&guest.log().unwrap(), "up") == life {
            assert_eq!(guest.ended().unwrap(), None);
        }
    }
}

/// What a guest in lockstep says to the same words, and what it logs.
fn played() -> (Vec<(u32, Vec<u8>)>, Vec<u8>) {
    let mut guest = peripherals().lockstep().start().unwrap();
    let mut line = guest.take_lockstep().unwrap();
    let mut said = Vec::new();
    for turn in 1..200_u16 {
        let bytes = vec![turn as u8 | 0x80; usize::from(turn % 7)];
        said.push(line.exchange(turn % 13 + 1, &bytes).unwrap());
    }
    end(&guest, &mut line);
    (said, guest.log_bytes().unwrap())
}

fn end(guest: &Guest, line: &mut Lockstep) {
    let ended = line.exchange(0, &[]);
    assert!(matches!(ended, Err(Error::Ended { .. })), "{ended:?}");
    assert_eq!(guest.wait(PATIENCE).unwrap(), 0);
}

#[test]
#[ignore = "needs QEMU; run by cargo xtask test"]
fn runs_in_lockstep_are_identical_to_the_byte() {
    let (first, second) = (played(), played());
    let mut tick = 0;
    for (turn, (at, bytes)) in (1_u16..).zip(&first.0) {
        tick += u32::from(turn % 13 + 1);
        assert_eq!(*at, tick, "a barrier is at its tick");
        // Answered in the tick that they come in.
        assert_eq!(*bytes, vec![turn as u8 | 0x80; usize::from(turn % 7)]);
    }
    assert_eq!(first.0.len(), 199);
    assert!(!first.1.is_empty());
    assert!(first == second);
}

#[test]
#[ignore = "needs QEMU; run by cargo xtask test"]
fn a_restart_and_a_power_cut_are_seen_in_lockstep() {
    let mut guest = peripherals().lockstep().start().unwrap();
    let mut line = guest.take_lockstep().unwrap();
    assert_eq!(line.exchange(10, b"x").unwrap(), (10, b"x".to_vec()));
    assert_eq!(line.exchange(10, &[RESTART]).unwrap(), (0, vec![]));
    assert_eq!(line.exchange(5, b"y").unwrap(), (5, b"y".to_vec()));
    guest.kill().unwrap();
    let ended = line.exchange(10, &[]);
    assert!(matches!(ended, Err(Error::Ended { .. })), "{ended:?}");
}

/// The number that a guest with this flash image begins with.
fn number_found(image: &Path) -> i32 {
    let mut guest = peripherals().flash(image).lockstep().start().unwrap();
    let mut line = guest.take_lockstep().unwrap();
    line.exchange(1, &[]).unwrap();
    end(&guest, &mut line);
    let log = guest.log().unwrap();
    let mut numbers = log
        .iter()
        .filter_map(|line| line.message.strip_prefix("store: number "));
    numbers.next().unwrap().parse().unwrap()
}

#[test]
#[ignore = "needs QEMU; run by cargo xtask test"]
fn what_was_saved_outlives_a_power_cut_at_any_moment() {
    let folder = tempfile::tempdir().unwrap();
    let image = folder.path().join("flash");
    let mut last = 0;
    for cut in 0..8_u32 {
        let saving = peripherals().arg("save=yes").flash(&image);
        let mut guest = saving.link(Carrier::Tcp { port: 0 }).start().unwrap();
        let mut link = socket(guest.link());
        let mut told = Vec::new();
        let mut bytes = [0; 64];
        while told.len() < 40 + 53 * cut as usize {
            let count = link.read(&mut bytes).unwrap();
            assert!(count > 0, "{:?}", guest.log());
            told.extend_from_slice(&bytes[..count]);
        }
        guest.kill().unwrap();
        let whole = told.split_inclusive(|byte| *byte == b'\n');
        let mut whole = whole.filter(|line| line.ends_with(b"\n"));
        let saved = whole
            .next_back()
            .map(|line| String::from_utf8_lossy(line).trim().parse::<i32>());
        let saved = saved.unwrap().unwrap();
        assert!(saved > last);
        last = number_found(&image);
        assert!(last >= saved, "{saved} was saved, {last} found");
    }
}

#[test]
#[ignore = "needs QEMU; run by cargo xtask test"]
fn an_image_of_another_length_is_refused_and_left_alone() {
    let folder = tempfile::tempdir().unwrap();
    let image = folder.path().join("flash");
    std::fs::write(&image, b"something else").unwrap();
    let refused = peripherals().flash(&image).lockstep().start().unwrap_err();
    assert!(refused.to_string().contains("65536"), "{refused}");
    assert_eq!(std::fs::read(&image).unwrap(), b"something else");
}

#[test]
#[ignore = "needs QEMU; run by cargo xtask test"]
fn a_port_that_is_taken_and_a_word_with_a_space_are_told() {
    let any = Carrier::Tcp { port: 0 };
    let guest = peripherals().link(any).start().unwrap();
    let Some(Endpoint::Tcp(address)) = guest.link() else {
        panic!("not on a socket");
    };
    let port = address.port();
    let taken = peripherals().link(Carrier::Tcp { port }).start();
    assert!(matches!(taken, Err(Error::Port { port: told, .. }) if told == port));
    let word = peripherals().flash(Path::new("/tmp/two words")).start();
    assert!(matches!(word, Err(Error::Word { .. })));
}
