//! Bad input: each is refused with a sentence that says what to do, and nothing is changed.

use std::io::{Read as _, Write as _};
use std::net::TcpListener;
use std::thread;

use leadscrew::protocol::decoder::Decoder;
use leadscrew::protocol::frame::{Channel, FrameBuffer, Header};
use leadscrew::protocol::reply::Reply;
use leadscrew::protocol::request::Request;

use super::Bench;
use crate::{Folder, assert_says};

#[test]
fn values_that_cannot_be_are_refused_with_what_can() {
    let bench = Bench::new();
    for (arguments, parts) in [
        (
            "params set motion.max_fed_mm_per_min 1",
            &[
                "no parameter `motion.max_fed_mm_per_min`",
                "did you mean `motion.max_feed_mm_per_min`?",
            ][..],
        ),
        (
            "params set max_feed_mm_per_min=1",
            &["did you mean `motion.max_feed_mm_per_min`?"],
        ),
        (
            "params set motion.counts_per_mm -5",
            &[
                "motion.counts_per_mm = -5",
                "range of 0.001 to 10000000 d/mm",
            ],
        ),
        (
            "params set motion.max_feed_mm_per_min 5m",
            &["its unit is mm/min, not m", "5mm/min"],
        ),
        (
            "params set motion.max_feed_mm_per_min fast",
            &["this is no number", "mm/min"],
        ),
        (
            "params set estimator=polinomial",
            &["did you mean `polynomial`?"],
        ),
        ("params set motion.max_feed_mm_per_min", &["NAME=VALUE"]),
        (
            "params get nonsense",
            &["no parameter `nonsense`", "List them"],
        ),
        (
            "params list motions",
            &["no section `motions`", "did you mean `motion`?"],
        ),
        ("params reset", &["--yes", "params backup"]),
        ("params backup kept.map", &["FILE.toml"]),
        ("override 300", &["0 to 200 %"]),
        ("move 10 --feed 0", &["above 0 mm/min"]),
        ("move 10", &["--feed"]),
        ("jog 100 --for -1", &["0 to 86400 s"]),
        ("serve --listen here", &["HOST:PORT"]),
        ("serve --pty", &["--port qemu"]),
        (
            "run nowhere",
            &["nowhere: cannot be read", "check the path"],
        ),
    ] {
        let message = bench.refused(2, arguments);
        assert_says(&message, parts);
    }
    assert_eq!(bench.printed("params diff"), "no difference\n");
}

#[test]
fn what_does_not_go_with_the_others_is_refused_as_a_whole() {
    let bench = Bench::new();
    let message = bench.refused(
        1,
        "params set motion.max_feed_mm_per_min=9500 motion.max_jerk_m_s3=20",
    );
    assert_says(
        &message,
        &["Setting parameters was refused", "other parameters"],
    );
    assert_eq!(bench.printed("params diff"), "no difference\n");
}

#[test]
fn orders_to_an_axis_that_is_off_say_how_to_switch_it_on() {
    let bench = Bench::new();
    for arguments in ["move 10 --feed 500", "jog 500", "home"] {
        let message = bench.refused(1, arguments);
        assert_says(&message, &["nable", "leadscrew run", "leadscrew serve"]);
    }
}

#[test]
fn files_that_are_no_backup_are_refused_with_their_line() {
    let bench = Bench::new();
    for (content, parts) in [
        (
            "[motion]\ncounts_per_m = 1\n",
            &["bad.toml:2:", "did you mean `counts_per_mm`?"][..],
        ),
        (
            "[motion]\n\ncounts_per_mm = 0\n",
            &["bad.toml:3:", "out of range", "d/mm"],
        ),
        ("estimator = \"kalman\"\n", &["bad.toml:1:", "exponential"]),
        ("[motion\n", &["bad.toml:1:"]),
        (
            "[motion]\nmax_feed_mm_per_min = 9500\n",
            &[
                "bad.toml",
                "max_feed_mm_per_min = 9500",
                "Nothing was changed",
            ],
        ),
    ] {
        bench.0.write("bad.toml", content);
        let message = bench.refused(1, "params restore bad.toml");
        assert_says(&message, parts);
    }
    let message = bench.refused(1, "params restore nowhere.toml");
    assert_says(&message, &["nowhere.toml: cannot be read"]);
    bench.0.write("good.toml", "");
    let message = bench.refused(2, "params restore good.toml --calibration");
    assert_says(
        &message,
        &["good.map", "good.screw", "Leave --calibration out"],
    );
    bench.0.write("good.map", "no map at all");
    let message = bench.refused(1, "params restore good.toml --calibration");
    assert_says(
        &message,
        &["encoder map of good.map", "backup of that kind"],
    );
}

#[test]
fn ports_that_are_none_are_told_with_what_there_is() {
    let folder = Folder::new();
    let message = folder.refused(2, "status");
    assert_says(&message, &["which axis?", "--port", "qemu"]);
    let message = folder.refused(2, "--port ttyUSB0 status");
    assert_says(&message, &["no port `ttyUSB0`", "A port is"]);
    let message = folder.refused(2, "--port tcp:lathe status");
    assert_says(&message, &["tcp:HOST:PORT"]);
    let message = folder.refused(1, "--port /dev/no-such-port status");
    assert_says(
        &message,
        &["cannot open /dev/no-such-port", "Plug the board in"],
    );
    let closed = TcpListener::bind("127.0.0.1:0").and_then(|listener| listener.local_addr());
    let closed = closed.expect("a port");
    let message = folder.refused(1, &format!("--port tcp:{closed} status"));
    assert_says(&message, &["Nobody listens there"]);
    let message = folder.refused(2, "--port tcp:127.0.0.1:5 serve");
    assert_says(&message, &["runs by itself", "--port sim or qemu"]);
}

#[test]
fn another_version_of_the_protocol_is_told_with_what_to_do() {
    let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
    let address = listener.local_addr().expect("an address");
    let server = thread::spawn(move || answer_hello(&listener));
    let message = Folder::new().refused(1, &format!("--port tcp:{address} status"));
    assert_says(
        &message,
        &[
            "version 7",
            "9.9.9",
            "Use the tool of the firmware's version",
        ],
    );
    server.join().expect("the server ends");
}

/// An axis of a version to come.
fn answer_hello(listener: &TcpListener) {
    let (mut tool, _) = listener.accept().expect("a tool");
    let mut decoder: Decoder = Decoder::new();
    let mut buffer = [0; 512];
    while let Ok(count @ 1..) = tool.read(&mut buffer) {
        let mut out = Vec::new();
        decoder.feed_all(&buffer[..count], |frame, _| {
            let Some(Request::Hello { nonce, .. }) = frame.message() else {
                return;
            };
            let hello = Reply::Hello {
                protocol: 7,
                nonce,
                session: 1,
                tick_hz: 1000,
                lease_ticks: 100,
                tick: 1,
                capabilities: 0,
                work_memory: 0,
                firmware: "9.9.9",
                build: "",
                board: "of a time to come",
            };
            let header = Header {
                channel: Channel::Reply,
                ..frame.header
            };
            let mut frame = FrameBuffer::default();
            out.extend_from_slice(frame.message(header, &hello).expect("it fits"));
        });
        tool.write_all(&out).expect("the tool listens");
    }
}
