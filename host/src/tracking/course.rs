//! What a course comes to: figures of the encoder's true shaft against the setpoint.

use leadscrew_hal_mock::scenario::ScenarioError;

use super::rig::Rig;
use crate::statistics::Spread;

/// What the axis is told to do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Course {
    /// A move there, a rest of 11 s, and back.
    Move {
        /// Distance, mm.
        distance_mm: f64,
        /// Feed, mm/min.
        feed_mm_per_min: f64,
    },
    /// Slow feed for 10 s.
    Creep {
        /// Feed, mm/min; negative backward.
        feed_mm_per_min: f64,
    },
}

/// What came of it.
#[derive(Clone, Copy, Debug, Default)]
pub struct TrackingFigures {
    /// Setpoint less shaft while a move runs, d.
    pub following: Spread,
    /// Setpoint less shaft from 100 ms after the end of a move on, until 1 s after it, d.
    pub standing: Spread,
    /// Peak to peak of the shaft over the 10 s after that, the larger of both ends of the way, d.
    pub rest_swing_d: f64,
    /// Setpoint less shaft over the creep, d; its start, half a d of way, is in `following`.
    pub creep: Spread,
    /// Peak to peak of the creep's error, d.
    pub creep_swing_d: f64,
    /// Peak to peak of the output over the last second of rest, of full command.
    pub output_swing: f64,
}

/// Smallest and largest.
#[derive(Clone, Copy, Debug)]
struct Extent(f64, f64);

impl Extent {
    const NONE: Self = Self(f64::INFINITY, f64::NEG_INFINITY);

    const fn push(&mut self, value: f64) {
        self.0 = self.0.min(value);
        self.1 = self.1.max(value);
    }

    fn size(self) -> f64 {
        (self.1 - self.0).max(0.0)
    }
}

impl Rig<'_> {
    /// Over the index and back, then `course`.
    ///
    /// # Errors
    /// A move that cannot be planned or queued.
    pub fn run(&mut self, course: &Course) -> Result<TrackingFigures, ScenarioError> {
        self.approach()?;
        let mut figures = TrackingFigures::default();
        match *course {
            Course::Move {
                distance_mm,
                feed_mm_per_min,
            } => {
                for way in [distance_mm, -distance_mm] {
                    self.travel(way, feed_mm_per_min, |_, error| {
                        figures.following.push(error);
                    })?;
                    self.stand(&mut figures);
                }
            }
            Course::Creep { feed_mm_per_min } => self.creep(feed_mm_per_min, &mut figures)?,
        }
        Ok(figures)
    }

    /// The error over the middle fifth of a move, where the feed is steady, d.
    ///
    /// # Errors
    /// A move that cannot be planned or queued.
    pub fn cruise(
        &mut self,
        distance_mm: f64,
        feed_mm_per_min: f64,
    ) -> Result<Spread, ScenarioError> {
        self.rest(0.2, |_, _| ());
        let mut errors = Vec::new();
        self.travel(distance_mm, feed_mm_per_min, |_, error| errors.push(error))?;
        let fifth = errors.len() / 5;
        Ok(errors[2 * fifth..3 * fifth].iter().copied().collect())
    }

    /// Eleven seconds at rest after a move.
    fn stand(&mut self, figures: &mut TrackingFigures) {
        let (mut place, mut output) = (Extent::NONE, Extent::NONE);
        let settled = self.ticks(0.1);
        let second = self.ticks(1.0);
        let all = self.ticks(11.0);
        for tick in 0..all {
            let (error, shaft) = self.tick();
            if tick < settled {
                figures.following.push(error);
            } else if tick < second {
                figures.standing.push(error);
            } else {
                place.push(shaft);
            }
            if tick >= all - second {
                output.push(self.outputs().command.to_num());
            }
        }
        figures.rest_swing_d = figures.rest_swing_d.max(place.size());
        figures.output_swing = figures.output_swing.max(output.size());
    }

    fn creep(
        &mut self,
        feed_mm_per_min: f64,
        figures: &mut TrackingFigures,
    ) -> Result<(), ScenarioError> {
        let velocity = self.scale().velocity_from_feed(feed_mm_per_min)?;
        let start = (START_D / velocity.abs()) as u32;
        let way = feed_mm_per_min / 60.0 * CREEP_S;
        let (mut tick, mut swing) = (0, Extent::NONE);
        self.travel(way, feed_mm_per_min.abs(), |_, error| {
            tick += 1;
            if tick < start {
                figures.following.push(error);
            } else {
                figures.creep.push(error);
                swing.push(error);
            }
        })?;
        figures.creep_swing_d = swing.size();
        Ok(())
    }
}

/// Way of a creep that counts as its start, d.
const START_D: f64 = 0.5;
/// Time of a creep, s.
const CREEP_S: f64 = 10.0;
