//! Probing: an order in mm and mm/min, and what came of it.

use std::time::Duration;

use leadscrew::probe::ProbeEnd;
use leadscrew::protocol::reply::Reply;
use leadscrew::protocol::request::Request;

use super::Axis;
use super::motion::{WATCH, feed, nm, no_feed, still_enabled};
use crate::error::Error;
use crate::status::{NM_PER_MM, UM_PER_MM};

const PM_PER_MM: f64 = 1e9;
/// 2⁻¹⁶ d.
const RAW_PER_D: f64 = 65_536.0;
/// How often it is asked for an end that the link has yet to hear of, and how long between.
const ASKED: (u32, Duration) = (100, Duration::from_millis(5));

/// A touch that was measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touch {
    /// Where the axis was at the contact, mm from the origin.
    pub position_mm: f64,
    /// 1σ of it by the encoder's edges and the trigger's jitter, mm; the scatter of the probe itself comes on top.
    pub sigma_mm: f64,
    /// The place of the encoder's shaft, d as it counts.
    pub raw_d: f64,
    /// Velocity at the contact, mm/min.
    pub velocity_mm_per_min: f64,
    /// Tick that took the probe's edge in.
    pub tick: u32,
    /// The edge by the timer, clocks.
    pub time: i64,
    /// How far beyond the contact the axis went, mm.
    pub overtravel_mm: f64,
    /// Edges that the place was found from; 0: by the count alone.
    pub edges: u32,
}

/// What the probe came to since the axis was switched on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProbeStatus {
    /// Ends of probing, and touches that nobody sought; wraps.
    pub ends: u16,
    /// Touches; wraps.
    pub touches: u16,
    /// Edges of the probe that were none of a touch; wraps.
    pub glitches: u16,
    /// How the last probing ended; none before the first, and for an end of a later version.
    pub end: Option<ProbeEnd>,
    /// Its touch.
    pub touch: Option<Touch>,
}

impl ProbeStatus {
    fn of(reply: &Reply<'_>) -> Option<Self> {
        let Reply::Touch {
            ends,
            touches,
            glitches,
            end,
            has_touch,
            position_nm,
            sigma_pm,
            raw,
            velocity_um_per_min,
            touch_tick,
            time,
            overtravel_nm,
            edges,
            ..
        } = *reply
        else {
            return None;
        };
        let touch = Touch {
            position_mm: position_nm as f64 / NM_PER_MM,
            sigma_mm: f64::from(sigma_pm) / PM_PER_MM,
            raw_d: raw as f64 / RAW_PER_D,
            velocity_mm_per_min: f64::from(velocity_um_per_min) / UM_PER_MM,
            tick: touch_tick,
            time,
            overtravel_mm: overtravel_nm as f64 / NM_PER_MM,
            edges,
        };
        Some(Self {
            ends,
            touches,
            glitches,
            end: ProbeEnd::of_number(end),
            touch: has_touch.then_some(touch),
        })
    }
}

impl Axis {
    /// Goes towards a place, mm from the origin, until the probe touches, then back by `retract_mm`, and waits for the end
    /// of it. How it ended is part of the answer: no touch is no error.
    ///
    /// # Errors
    /// [`Error::Refused`] with the limits, [`Error::NoNumber`], [`Error::Faulted`].
    pub fn probe(
        &mut self,
        towards_mm: f64,
        feed_mm_per_min: f64,
        retract_mm: f64,
    ) -> Result<ProbeStatus, Error> {
        let before = self.probe_status()?;
        let feed = u32::try_from(feed(feed_mm_per_min)?)
            .map_err(|_| no_feed(feed_mm_per_min, "0 to 2 000 000 mm/min"))?;
        let retract_nm = nm(retract_mm)?;
        let retract_nm = u32::try_from(retract_nm).map_err(|_| Error::NoNumber {
            what: "the way back after a touch",
            value: retract_mm,
            range: "0 to 4 290 mm",
        })?;
        let asked = self.order(&Request::Probe {
            target_nm: nm(towards_mm)?,
            feed_um_per_min: feed,
            retract_nm,
        });
        self.explained(asked, || {
            format!("Probing towards {towards_mm} mm with {feed_mm_per_min} mm/min")
        })?;
        self.wait_for("still probing", WATCH, |status| {
            still_enabled(status, "it probed")?;
            Ok(status.is_planned && !status.is_moving)
        })?;
        // The end of it may be on its way.
        for _ in 0..ASKED.0 {
            let status = self.probe_status()?;
            if status.ends != before.ends {
                return Ok(status);
            }
            self.wait(ASKED.1)?;
        }
        self.probe_status()
    }

    /// What the probe came to since the axis was switched on.
    ///
    /// # Errors
    /// [`Error::Refused`] by an axis without a probe.
    pub fn probe_status(&mut self) -> Result<ProbeStatus, Error> {
        self.query(&Request::Touch {}, ProbeStatus::of)
    }
}
