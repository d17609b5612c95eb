//! Over TCP and over a pseudo-terminal.

use std::fs::File;
use std::thread::sleep;
use std::time::Duration;

use leadscrew_qemu::Carrier;

use crate::{TRIES, command, done, guest, leadscrew, port, status, text};

/// Far enough to be under way for long.
const FAR: [&str; 4] = ["move", "300", "--feed", "600"];

/// A session of a day: looks, enables, homes, moves, switches off.
fn session(link: Carrier) {
    let guest = guest(link, None);
    let port = port(guest.link());
    // QEMU looks only once a second whether somebody has opened a terminal anew that was closed.
    let _open = (link == Carrier::Pty).then(|| File::open(&port).unwrap());
    assert!(!status(&port)["enabled"].as_bool().unwrap());
    let refused = leadscrew(&port, &["move", "10", "--feed", "1000"]);
    assert_eq!(refused.status.code(), Some(1), "{}", text(&refused));
    done(&port, &["enable"]);
    done(&port, &["home"]);
    done(&port, &["move", "20", "--feed", "3000"]);
    let at = status(&port);
    let position = at["position_mm"].as_f64().unwrap();
    assert!((position - 20.0).abs() < 0.02, "{at}");
    assert!(at["homed"].as_bool().unwrap(), "{at}");
    done(&port, &["disable"]);
    assert!(!status(&port)["enabled"].as_bool().unwrap());
    // The tick keeps its own time, whatever the wall does.
    let log = guest.log().unwrap();
    assert!(log.iter().all(|line| line.level != "error"), "{log:?}");
}

#[test]
#[ignore = "needs QEMU; run by cargo xtask test"]
fn a_session_over_tcp() {
    session(Carrier::Tcp { port: 0 });
}

#[test]
#[ignore = "needs QEMU; run by cargo xtask test"]
fn a_session_over_a_terminal() {
    session(Carrier::Pty);
}

#[test]
#[ignore = "needs QEMU; run by cargo xtask test"]
fn an_axis_that_is_switched_off_in_mid_move_is_lost() {
    for _ in 0..TRIES {
        let mut guest = guest(Carrier::Tcp { port: 0 }, None);
        let port = port(guest.link());
        done(&port, &["enable"]);
        let mut moving = command(&port, &FAR).spawn().unwrap();
        sleep(Duration::from_secs(2));
        if moving.try_wait().unwrap().is_some() {
            // Its lease has lapsed.
            continue;
        }
        guest.kill().unwrap();
        assert_eq!(moving.wait().unwrap().code(), Some(3));
        return;
    }
    panic!("it was never under way");
}

/// A tool that falls silent in mid-move: the axis stops by itself, and the next tool finds it off and at rest.
#[test]
#[ignore = "needs QEMU; run by cargo xtask test"]
fn an_axis_whose_tool_is_killed_in_mid_move_stops() {
    let guest = guest(Carrier::Tcp { port: 0 }, None);
    let port = port(guest.link());
    done(&port, &["enable"]);
    let mut moving = command(&port, &FAR).spawn().unwrap();
    sleep(Duration::from_secs(2));
    moving.kill().unwrap();
    moving.wait().unwrap();
    let mut at = status(&port);
    for _ in 0..50 {
        if !at["enabled"].as_bool().unwrap() {
            break;
        }
        at = status(&port);
    }
    assert!(!at["enabled"].as_bool().unwrap(), "{at}");
    let position = at["position_mm"].as_f64().unwrap();
    assert!((-0.1..150.0).contains(&position), "{at}");
    drop(guest);
}
