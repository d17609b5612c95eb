//! Motion: orders in mm and mm/min, and waiting for their end.

use std::time::Duration;

use leadscrew::protocol::refusal::Refusal;
use leadscrew::protocol::request::Request;
use leadscrew::setpoint::sources::Source;
use leadscrew::supervisor::State;

use super::Axis;
use crate::error::Error;
use crate::status::{NM_PER_MM, Status, UM_PER_MM};

/// An axis whose setpoint is as near as this has arrived: below any encoder, above every rounding.
const ARRIVED_NM: u64 = 50;
pub(super) const WATCH: &str = "Look how the axis stands, and give the order anew";

impl Axis {
    /// Finds the origin, and waits until it is found.
    ///
    /// # Errors
    /// [`Error::Refused`], [`Error::Faulted`]; [`Error::NotReached`] if it ends without an origin.
    pub fn home(&mut self) -> Result<Status, Error> {
        self.order(&Request::Home {})?;
        self.wait_for("not homed", WATCH, |status| {
            still_enabled(status, "it was homed")?;
            Ok(status.is_homed && status.is_planned && !status.is_moving)
        })
    }

    /// Sends the axis to a place, mm from the origin, with a feed in mm/min; does not wait for its arrival.
    ///
    /// # Errors
    /// [`Error::Refused`] with the limits, [`Error::NoNumber`].
    pub fn move_to(&mut self, target_mm: f64, feed_mm_per_min: f64) -> Result<(), Error> {
        let target_nm = nm(target_mm)?;
        self.start_move(target_nm, feed_mm_per_min)
    }

    /// The same, and waits until it has arrived. A feed hold is waited for.
    ///
    /// # Errors
    /// As of [`Self::move_to`]; [`Error::NotReached`] if it stands elsewhere, as after a stop from elsewhere.
    pub fn move_and_wait(&mut self, target_mm: f64, feed_mm_per_min: f64) -> Result<Status, Error> {
        let target_nm = nm(target_mm)?;
        self.start_move(target_nm, feed_mm_per_min)?;
        let what = "it arrived";
        self.wait_for("not at its target", WATCH, |status| {
            still_enabled(status, what)?;
            let is_there = status.setpoint_nm.abs_diff(target_nm) <= ARRIVED_NM;
            Ok(is_there && !status.is_moving && !status.is_held)
        })
    }

    fn start_move(&mut self, target_nm: i64, feed_mm_per_min: f64) -> Result<(), Error> {
        let feed_um_per_min = feed(feed_mm_per_min)?;
        let feed_um_per_min = u32::try_from(feed_um_per_min)
            .map_err(|_| no_feed(feed_mm_per_min, "0 to 2 000 000 mm/min"))?;
        let asked = self.order(&Request::Move {
            target_nm,
            feed_um_per_min,
        });
        let target = target_nm as f64 / NM_PER_MM;
        self.explained(asked, || {
            format!("A move to {target} mm with {feed_mm_per_min} mm/min")
        })
    }

    /// Moves with a feed in mm/min, of either sign, until [`Self::stop`] or a soft limit. It moves on as long as the
    /// lease is kept: [`Self::wait`].
    ///
    /// # Errors
    /// [`Error::Refused`] with the limits, [`Error::NoNumber`].
    pub fn jog(&mut self, feed_mm_per_min: f64) -> Result<(), Error> {
        let feed_um_per_min = feed(feed_mm_per_min)?;
        let asked = self.order(&Request::Jog { feed_um_per_min });
        self.explained(asked, || format!("A jog with {feed_mm_per_min} mm/min"))
    }

    /// Selects what gives the setpoint while the axis stands.
    ///
    /// # Errors
    /// [`Error::Refused`] while it moves, a gear is engaged, or the source's parameters do not allow it.
    pub fn select(&mut self, source: Source) -> Result<(), Error> {
        self.order(&Request::Select {
            source: source as u8,
        })
    }

    /// Engages the gear while the master turns or stands, or disengages it.
    ///
    /// # Errors
    /// [`Error::Refused`] unless the axis is enabled and [`Source::Gearing`] selected, or while the master is lost.
    pub fn engage_gear(&mut self, engaged: bool) -> Result<(), Error> {
        self.order(&Request::Engage {
            engaged: engaged.into(),
        })
    }

    /// Stops whatever moves the axis, forgets the target, and waits until it stands. Needs no lease.
    ///
    /// # Errors
    /// [`Error::NotReached`] if it does not stand in time.
    pub fn stop(&mut self) -> Result<Status, Error> {
        self.order(&Request::Stop {})?;
        let advice = "Watch it; if it does not stop use the emergency stop";
        self.wait_for_end("not at rest", advice, Status::is_at_rest)
    }

    /// Feed hold: stops and remembers the target. Needs no lease. The stop is not waited for.
    ///
    /// # Errors
    /// [`Error::Refused`]
    pub fn hold(&mut self) -> Result<(), Error> {
        self.order(&Request::Hold {})
    }

    /// Ends a feed hold.
    ///
    /// # Errors
    /// [`Error::Refused`]
    pub fn resume(&mut self) -> Result<(), Error> {
        self.order(&Request::Resume {})
    }

    /// Sets the feed override, 0 to 200 %.
    ///
    /// # Errors
    /// [`Error::Refused`]
    pub fn set_override(&mut self, percent: u16) -> Result<(), Error> {
        self.order(&Request::Override { percent })
    }

    /// Waits until the axis stands: at the end of its motion, in a feed hold, disabled.
    ///
    /// # Errors
    /// [`Error::Faulted`]
    pub fn wait_for_rest(&mut self) -> Result<Status, Error> {
        self.wait_for("not at rest", WATCH, |status| Ok(status.is_at_rest()))
    }

    /// Lets time pass on the line's clock, keeping the lease.
    ///
    /// # Errors
    /// [`Error::LeaseLapsed`], [`Error::Interrupted`], those of a lost axis.
    pub fn wait(&mut self, time: Duration) -> Result<(), Error> {
        self.connection.wait(time)
    }

    /// Runs a long computation while the lease is kept.
    ///
    /// # Errors
    /// As of [`Self::wait`].
    pub fn keep_alive_while<R: Send>(
        &mut self,
        work: impl FnOnce() -> R + Send,
    ) -> Result<R, Error> {
        self.connection.keep_alive_while(work)
    }

    /// Adds to a refusal what was asked in numbers, and the limits that it ran into.
    pub(super) fn explained<T>(
        &mut self,
        outcome: Result<T, Error>,
        asked: impl FnOnce() -> String,
    ) -> Result<T, Error> {
        let Err(Error::Refused(mut refused)) = outcome else {
            return outcome;
        };
        refused.asked = asked();
        let limits: &[&str] = match refused.refusal() {
            Some(Refusal::FeedOutOfRange) => &["motion.max_feed_mm_per_min"],
            Some(Refusal::BeyondTravel) => &["motion.travel_low_mm", "motion.travel_high_mm"],
            _ => &[],
        };
        // Without them the refusal still says what to look for.
        let found = limits
            .iter()
            .filter_map(|name| self.parameter_at(name).ok());
        let told: Vec<_> = found
            .map(|limit| format!("{} is {}", limit.name, limit.value))
            .collect();
        if !told.is_empty() {
            refused.detail = format!("Here {}.", told.join(", "));
        }
        Err(Error::Refused(refused))
    }
}

/// Somebody else may take enable back.
pub(super) fn still_enabled(status: &Status, what: &'static str) -> Result<(), Error> {
    match status.state() {
        Some(State::Disabled | State::Stopping) => Err(Error::DisabledMeanwhile { what }),
        _ => Ok(()),
    }
}

pub(super) fn nm(mm: f64) -> Result<i64, Error> {
    let nm = (mm * NM_PER_MM).round();
    // The farthest target of the protocol is 1 km; the axis knows its own.
    if nm.abs() <= 1e15 {
        Ok(nm as i64)
    } else {
        Err(Error::NoNumber {
            what: "the target",
            value: mm,
            range: "-1 000 000 to 1 000 000 mm",
        })
    }
}

pub(super) fn feed(mm_per_min: f64) -> Result<i32, Error> {
    let um = (mm_per_min * UM_PER_MM).round();
    if um.abs() <= f64::from(i32::MAX) {
        Ok(um as i32)
    } else {
        Err(no_feed(mm_per_min, "-2 000 000 to 2 000 000 mm/min"))
    }
}

pub(super) const fn no_feed(value: f64, range: &'static str) -> Error {
    Error::NoNumber {
        what: "the feed",
        value,
        range,
    }
}
