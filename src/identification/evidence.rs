//! What the records of the proof and of the ramps say.

use super::drive::{Drive, Vector};
use super::recorder::Records;

/// Travel that shows that a ramp broke the axis away, d: three counts, and what a map may take off them.
const BROKE_AWAY_D: f64 = 2.75;
/// The same as the shaft goes: it stands anywhere within its first count, so that three counts are this in the mean.
const BROKE_AWAY_IN_THE_MEAN_D: f64 = 2.5;

/// A ramp that broke the axis away.
#[derive(Clone, Copy, Debug)]
pub struct Broke {
    /// Command a tick, of full command.
    pub slope: f64,
    /// Ticks from its start until the axis had moved.
    pub ticks: u32,
}

/// By how much a positive pulse moved the axis more than a negative one, and the drift of the rest before them, d.
pub fn pulses(records: Records<'_>) -> [f64; 2] {
    let mut sign = 0.0;
    let (mut rest, mut up, mut down) = ((0.0, 0.0), (0.0, 0.0), (0.0, 0.0));
    for record in records.iter() {
        if record.command != 0.0 {
            sign = libm::copysign(1.0, record.command);
        }
        let (travel, count) = if sign > 0.0 {
            &mut up
        } else if sign < 0.0 {
            &mut down
        } else {
            &mut rest
        };
        *travel += record.travel_d;
        *count += 1.0;
    }
    let drift = rest.0 / f64::max(rest.1, 1.0);
    [up.0 - down.0 - drift * (up.1 - down.1), rest.0]
}

/// Records from the start of the ramp of that sign until it had broken the axis away.
pub fn broke_away(records: Records<'_>, sign: f64) -> Option<u32> {
    let mut begun = None;
    let mut travel = 0.0;
    for (index, record) in records.iter().enumerate() {
        let driven = record.command * sign > 0.0;
        match begun {
            None if driven => begun = Some(index),
            None => continue,
            // Past the end of the ramp.
            Some(_) if !driven => return None,
            Some(_) => {}
        }
        travel += record.travel_d;
        if libm::fabs(travel) >= BROKE_AWAY_D {
            let count = index.wrapping_sub(begun.unwrap_or(index)).wrapping_add(1);
            return u32::try_from(count).ok();
        }
    }
    None
}

/// Ticks in which a ramp breaks that drive away, as [`broke_away`] sees it.
pub fn broken_away_after(vector: &Vector, held: f64, slope: f64, most: u32) -> u32 {
    let mut drive = Drive::new(vector, Some([held; 2]));
    // The first record that counts is the first one with a command.
    let ramp = |tick: isize| slope * tick.saturating_add(1).max(0) as f64;
    for tick in 0..most {
        drive.step(ramp, tick as isize);
        if libm::fabs(drive.travel) >= BROKE_AWAY_IN_THE_MEAN_D {
            return tick.wrapping_add(1);
        }
    }
    most
}
