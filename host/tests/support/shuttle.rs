//! Moves to and fro over a line with faults, watched tick by tick.

use std::cell::{Cell, RefCell};
use std::time::Duration;

use leadscrew_client::noisy::{Done, Faults};
use leadscrew_client::{Axis, Error};

use crate::watch::Watch;

const TARGETS_MM: [f64; 4] = [10.0, -20.0, 30.0, 0.0];
const FEED_MM_PER_MIN: f64 = 4000.0;
/// Times that it may begin anew before the test gives up.
const MOST_TRIES: u32 = 400;

/// How a run went.
#[derive(Debug, Default)]
pub struct Run {
    /// Moves that arrived.
    pub made: u32,
    /// Times that the tool was told of a lapse of its lease, or of an axis that was off when it should not be.
    pub lapsed: u32,
    /// Sessions that ended, each followed by a new one.
    pub lost: u32,
    pub done: Done,
    pub seen: Watch,
}

/// So many moves; each order that fails is given anew. `begin` prepares a session that is new.
pub fn shuttle(
    tool: &mut Axis,
    moves: u32,
    seen: &RefCell<Watch>,
    done: &Cell<Done>,
    begin: fn(&mut Axis) -> Result<(), Error>,
) -> Run {
    let mut run = Run::default();
    let mut is_new = true;
    while run.made < moves {
        assert!(run.lapsed + run.lost < MOST_TRIES, "{run:?}");
        let target_mm = TARGETS_MM[run.made as usize % TARGETS_MM.len()];
        seen.borrow_mut().target_mm = target_mm;
        let begun = if is_new { begin(tool) } else { Ok(()) };
        is_new &= begun.is_err();
        let moved = begun
            .and_then(|()| tool.enable())
            .and_then(|_| tool.move_and_wait(target_mm, FEED_MM_PER_MIN));
        match moved {
            Ok(status) => {
                assert!((status.setpoint_mm - target_mm).abs() < 1e-3, "{status:?}");
                run.made += 1;
            }
            Err(Error::LeaseLapsed | Error::DisabledMeanwhile { .. }) => run.lapsed += 1,
            Err(error) if error.is_lost() => {
                run.lost += 1;
                assert!((0..20).any(|_| tool.reconnect().is_ok()), "{run:?}");
                is_new = true;
            }
            Err(error) => panic!("{error}: {run:?}"),
        }
    }
    run.done = done.get();
    run.seen = *seen.borrow();
    run
}

pub const NONE: Faults = Faults {
    drops: 0.0,
    flips: 0.0,
    doubles: 0.0,
    delays: 0.0,
    delay: Duration::ZERO,
    cut: Duration::ZERO,
    cut_every: Duration::ZERO,
};

/// A fifth of the frames is late by so many milliseconds.
pub const fn late(delay_ms: u64) -> Faults {
    Faults {
        delays: 0.2,
        delay: Duration::from_millis(delay_ms),
        ..NONE
    }
}

/// Half a second of silence in every three.
pub const fn cuts() -> Faults {
    Faults {
        cut: Duration::from_millis(500),
        cut_every: Duration::from_millis(3000),
        ..NONE
    }
}

/// All at once.
pub const fn worst() -> Faults {
    Faults {
        drops: 0.05,
        flips: 0.05,
        doubles: 0.2,
        cut: cuts().cut,
        cut_every: cuts().cut_every,
        ..late(120)
    }
}
