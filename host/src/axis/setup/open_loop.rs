//! Steps before any loop closes: bounded open-loop motion.

use leadscrew::identification::IdentifyParams;
use leadscrew::identification::program::{Bounds, Program, Segment, command};

use super::{ProcedureError, Session};
use crate::axis::calm::{made_ready, switched_off};
use crate::axis::identify::{run_from_rest, scale_of};
use crate::axis::prove_sign;

/// Way that shows the direction, mm.
const SHOWN_MM: f64 = 2.0;
/// Longest that a crawl may take, s.
const LONGEST_S: f64 = 60.0;
/// A crawl is told so much more than what moved the axis at first.
const MORE: f64 = 2.0;
/// Revolutions in which there are two indexes, and something more.
const REVOLUTIONS: f64 = 2.3;
/// Largest command of a crawl, of full command.
const MOST: f64 = 0.25;

impl Session<'_> {
    fn identify_params(&self) -> IdentifyParams {
        let motion = &self.settings.axis.motion;
        let asked = self.answers.known("window_mm", &self.settings);
        IdentifyParams {
            window_mm: asked.min(self.room.length_mm()).max(0.1),
            max_feed_mm_per_min: motion.full_command_feed_mm_per_min.min(6000.0),
            ..IdentifyParams::default()
        }
    }

    pub(super) fn experiments(&self) -> IdentifyParams {
        self.identify_params()
    }

    /// Proves the sign.
    pub(super) fn polarity(&mut self) -> Result<(), ProcedureError> {
        let params = self.identify_params();
        self.agreed(&format!(
            "polarity: pulses of {:.1} to {:.0} % of full command, loop open, move the axis by {} mm or so each way, {} mm at most.",
            0.5,
            100.0 * params.proof_level,
            params.proof_distance_mm,
            10.0 * params.proof_distance_mm
        ))?;
        let Self {
            axis,
            guide,
            settings,
            ..
        } = self;
        let level = prove_sign(axis, settings, &params, &mut |text| guide.progress(text))?;
        self.proof_level = Some(level);
        self.outcome.proof_level = Some(level);
        self.guide.tell(&format!(
            "polarity: right, {:.1} % of full command moves the axis the way that it counts",
            100.0 * level
        ));
        Ok(())
    }

    /// Moves a little and asks which way is plus.
    pub(super) fn direction(&mut self) -> Result<(), ProcedureError> {
        self.agreed(&format!(
            "direction: the axis crawls {SHOWN_MM} mm to where it counts up, loop open: watch it."
        ))?;
        self.crawl(SHOWN_MM, "the crawl that shows the direction")?;
        let known = self.answers.known("plus_is_right", &self.settings);
        let is_right = if known < 0.0 {
            let question = "Did it move to the plus side of the machine?";
            self.guide.agree(question, true)?
        } else {
            known > 0.0
        };
        if !is_right {
            return Err(ProcedureError::OtherWay);
        }
        self.guide.tell("direction: plus is plus");
        Ok(())
    }

    /// Counts from index to index.
    pub(super) fn index(&mut self) -> Result<(), ProcedureError> {
        let expected = self.expected_counts;
        if expected == 0.0 {
            self.guide.tell("index: none, so the answer");
            return self.set([("motion.counts_per_revolution".to_owned(), 0.0)]);
        }
        let turn_mm = expected / self.settings.axis.motion.counts_per_mm;
        let way_mm = REVOLUTIONS * turn_mm;
        self.agreed(&format!(
            "index: the axis crawls {way_mm:.1} mm to the plus side, loop open, over two indexes."
        ))?;
        let before = self.axis.tick_counters()?.indexes;
        self.crawl(way_mm, "the crawl over two indexes")?;
        let counters = self.axis.tick_counters()?;
        if counters.indexes.wrapping_sub(before) < 2 {
            return Err(ProcedureError::NoIndex {
                travel_mm: way_mm,
                revolutions: REVOLUTIONS,
            });
        }
        let found = counters.index_distance.abs();
        let off = found as f64 - expected;
        if off.abs() > self.settings.axis.supervisor.index_tolerance_d {
            return Err(ProcedureError::OtherRevolution { found, expected });
        }
        self.set([("motion.counts_per_revolution".to_owned(), expected)])?;
        self.save()?;
        self.outcome.counts_per_revolution = Some(expected);
        self.guide
            .tell(&format!("index: every {found} d, as it should be"));
        Ok(())
    }

    /// Crawls to the plus side, open-loop, by a command that grows until the axis gets there.
    fn crawl(&mut self, way_mm: f64, what: &'static str) -> Result<(), ProcedureError> {
        let at_mm = self.axis.status()?.position_mm;
        let advice = "Move the axis away from its end by hand, or state the room that there is (room_plus_mm)";
        let mut room = self.room;
        room.low_mm = at_mm;
        room.place(at_mm, way_mm, what, advice)?;
        made_ready(self.axis)?;
        let outcome = self.crawl_ready(way_mm);
        switched_off(self.axis, outcome)
    }

    fn crawl_ready(&mut self, way_mm: f64) -> Result<(), ProcedureError> {
        let scale = scale_of(&self.settings)?;
        let tick_hz = self.settings.axis.tick_hz;
        let way_d = scale.counts_from_mm(way_mm);
        let full = self.settings.axis.motion.full_command_feed_mm_per_min;
        let mut level = MORE * self.proof_level.unwrap_or(0.01);
        let from = self.axis.experiment()?.count;
        loop {
            level = level.min(MOST);
            let fastest = scale.velocity_from_feed((3.0 * level * full).max(1.0))?;
            let bounds = Bounds {
                window_d: (1.2 * way_d + 100.0) as u32,
                speed_d_per_tick: fastest.ceil().clamp(2.0, 2047.0) as u32,
                ticks: (LONGEST_S * tick_hz) as u32,
                command: command(level),
            };
            let gone = (self.axis.experiment()?.count - from) as f64;
            let left = (way_d - gone).max(1.0) as u32;
            let ticks = if level < MOST {
                4.0 * tick_hz * way_mm.max(1.0)
            } else {
                LONGEST_S * tick_hz
            };
            let crawl =
                Segment::level(level, ticks.min(0.5 * LONGEST_S * tick_hz) as u32).until(left);
            let rest = Segment::rest((0.3 * tick_hz) as u32);
            let program = Program::new(&[crawl, rest], bounds);
            self.guide
                .progress(&format!("{:.1} % of full command", 100.0 * level));
            let record_ticks = (LONGEST_S * tick_hz / 5000.0) as u32;
            let ended = run_from_rest(self.axis, &program, record_ticks)?;
            let gone = (ended.count - from) as f64;
            if gone >= 0.9 * way_d {
                return Ok(());
            }
            if level >= MOST || ended.phase != leadscrew_client::ExperimentPhase::Complete {
                return Err(ProcedureError::Stuck {
                    moved_mm: scale.mm_from_counts(gone),
                    wanted_mm: way_mm,
                });
            }
            level *= 2.0;
        }
    }
}
