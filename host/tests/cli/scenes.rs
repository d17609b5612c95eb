//! Captures that the tests replay.

use std::path::PathBuf;

use leadscrew_host::recording::{Change, Levels, Recording};

use crate::Folder;
use crate::capture_files::sigrok_vcd;

/// Levels of A and B in forward order.
const FORWARD: [(bool, bool); 4] = [(false, false), (true, false), (true, true), (false, true)];

/// x = t²/(14.13721 ms²) d, the motion of the sigrok project's own ramp.
const RAMP_MS2: f64 = 14.137_21;
/// Until then it accelerates, and after that as long again it mirrors itself, ms.
const RAMP_HALF_MS: f64 = 300.0;
/// Edges of the whole ramp.
pub const RAMP_EDGES: i64 = 12_732;

/// Levels at a count, the count 0 being both low.
pub fn levels_at(count: i64) -> Levels {
    let (a, b) = FORWARD[count.rem_euclid(4) as usize];
    Levels { a, b, z: false }
}

/// A recording at 1 MHz whose edges lie at these microseconds, each one count further.
fn forward(times: impl IntoIterator<Item = u64>, duration: u64) -> Recording {
    let change = |(count, time): (i64, u64)| Change {
        time,
        levels: levels_at(count),
    };
    Recording {
        clock_hz: 1_000_000,
        duration,
        initial: levels_at(0),
        changes: (1..).zip(times).map(change).collect(),
    }
}

/// The ramp, sampled at 1 MHz: an edge is seen by the first sample after it.
pub fn ramp() -> Recording {
    let top = RAMP_HALF_MS * RAMP_HALF_MS / RAMP_MS2;
    let time_ms = |boundary: i64| {
        let boundary = boundary as f64;
        if boundary <= top {
            (boundary * RAMP_MS2).sqrt()
        } else {
            2.0 * RAMP_HALF_MS - ((2.0 * top - boundary) * RAMP_MS2).sqrt()
        }
    };
    let time_us = |boundary| (time_ms(boundary) * 1000.0).ceil() as u64;
    forward((1..=RAMP_EDGES).map(time_us), 600_000)
}

/// Writes the ramp as sigrok's VCD, with sigrok's names.
pub fn put_ramp(folder: &Folder, name: &str) {
    folder.write(name, sigrok_vcd(&ramp(), &["0", "1"]));
}

/// The sigrok project's own file of the ramp, where there is a folder of captures.
pub fn real_ramp() -> Option<PathBuf> {
    let folder = std::env::var_os("LEADSCREW_CAPTURES");
    if folder.is_none() {
        eprintln!("skipped: LEADSCREW_CAPTURES is not set");
    }
    Some(PathBuf::from(folder?).join("rotary-ramp.vcd"))
}

/// A few edges in a VCD.
pub fn short_walk() -> String {
    sigrok_vcd(
        &forward((1..200).map(|edge| edge * 700), 150_000),
        &["A", "B"],
    )
}

/// A wander with reversals; every 97th change is of both channels at once.
pub fn wander() -> Recording {
    let mut phase = 0_i64;
    let change = |step: u64| {
        phase += match step {
            step if step % 97 == 96 => 2,
            step if step % 600 < 350 => 1,
            _ => -1,
        };
        Change {
            time: 40 * step + step * step % 17,
            levels: levels_at(phase),
        }
    };
    Recording {
        clock_hz: 1_000_000,
        duration: 160_000,
        initial: levels_at(0),
        changes: (1..=3900).map(change).collect(),
    }
}
