//! Runs of the tables: what the axis does, tick by tick.

use leadscrew::supervisor::Fault;

use super::error::TrackingError;
use super::rig::Rig;
use super::trace::{Tick, Trace};

/// Rest between moves, s: the standing error is judged for a second.
const DWELL_S: f64 = 1.2;
/// Rest at the end of a run, s: limit cycles are looked for in 10 s.
const REST_S: f64 = 11.0;

/// A run as it is recorded.
#[derive(Default)]
struct Recorder {
    trace: Trace,
    /// The first fault, and its tick.
    fault: Option<(Fault, u32)>,
}

impl Recorder {
    fn push(&mut self, rig: &Rig<'_>) {
        let outputs = rig.outputs();
        let truth = rig.machine().truth();
        let setpoint: f64 = outputs.setpoint.position.to_num();
        let behind: f64 = outputs.following_error.to_num();
        self.trace.push(Tick {
            setpoint,
            shaft: truth.shaft.position,
            seen: setpoint - behind,
            carriage: truth.carriage.position,
            command: outputs.command.to_num(),
        });
        if self.fault.is_none() {
            self.fault = outputs.fault.map(|fault| (fault, outputs.tick));
        }
    }

    fn rest(&mut self, rig: &mut Rig<'_>, time_s: f64) {
        rig.rest(time_s, |rig, _| self.push(rig));
    }

    /// A rest and a move.
    fn go(&mut self, rig: &mut Rig<'_>, way: f64, feed: f64) -> Result<(), TrackingError> {
        self.rest(rig, DWELL_S);
        self.check()?;
        rig.travel(way, feed, |rig, _| self.push(rig))?;
        self.check()
    }

    const fn check(&self) -> Result<(), TrackingError> {
        match self.fault {
            Some((fault, tick)) => Err(TrackingError::Fault { fault, tick }),
            None => Ok(()),
        }
    }
}

/// Over the index and back; then a rest, a move by `way` mm, a rest, the way back, and a long rest.
///
/// # Errors
/// A move that cannot be planned, or a fault.
pub fn there_and_back(
    rig: &mut Rig<'_>,
    way: f64,
    feed_mm_per_min: f64,
) -> Result<Trace, TrackingError> {
    rig.approach()?;
    let mut recorder = Recorder::default();
    for way in [way, -way] {
        recorder.go(rig, way, feed_mm_per_min)?;
    }
    recorder.rest(rig, REST_S);
    recorder.check()?;
    Ok(recorder.trace)
}

/// Over the index and back; then a rest and a move by `way` mm at a feed.
///
/// # Errors
/// A move that cannot be planned, or a fault.
pub fn feed(rig: &mut Rig<'_>, way: f64, feed_mm_per_min: f64) -> Result<Trace, TrackingError> {
    rig.approach()?;
    let mut recorder = Recorder::default();
    recorder.go(rig, way, feed_mm_per_min)?;
    Ok(recorder.trace)
}
