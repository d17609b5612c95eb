//! How large and how long experiments may be.

use super::drive::{Vector, place};
use super::matrix::part;
use super::program::{Bounds, Program, Segment, command};
use super::refusal::Refusal;
use crate::parameter_table;
use crate::parameter_table::ParameterTable;
use crate::units::AxisScale;

parameter_table! {
    /// Bounds of identification.
    pub struct IdentifyParams {
        /// Travel within which all of it stays, half to either side of where it begins
        window_mm: 20.0, "mm", 0.1..=1000.0;
        /// Travel of a pulse that proves the sign
        proof_distance_mm: 0.3, "mm", 0.001..=10.0;
        /// Largest command of a pulse that proves the sign
        proof_level: 0.16, "of full command", 0.005..=0.5;
        /// Largest command of all others
        max_level: 0.4, "of full command", 0.01..=1.0;
        /// Largest feed
        max_feed_mm_per_min: 6000.0, "mm/min", 0.1..=1e6;
    }
}

/// Fewest counts that prove a sign.
const PROOF_D: f64 = 16.0;
/// First command of the proof.
const FIRST_LEVEL: f64 = 0.005;
/// Share of the window that programs mean to use; the rest is for overshoot.
const USED: f64 = 0.7;

/// The bounds in d and ticks.
#[derive(Clone, Copy, Debug)]
pub struct Plan {
    /// Control rate, Hz.
    pub tick_hz: f64,
    /// Half the window, d.
    pub half_window_d: f64,
    /// Travel of a pulse of the proof, d.
    pub proof_d: f64,
    pub proof_level: f64,
    pub max_level: f64,
    /// Largest speed, d/tick.
    pub max_speed: f64,
    /// Speed at full command as it is thought to be, d/tick.
    pub nominal_gain: f64,
}

impl Plan {
    pub fn new(
        params: &IdentifyParams,
        scale: AxisScale,
        nominal_gain: f64,
    ) -> Result<Self, Refusal> {
        params.check()?;
        let plan = Self {
            tick_hz: scale.tick_hz(),
            half_window_d: 0.5 * scale.counts_from_mm(params.window_mm),
            proof_d: scale.counts_from_mm(params.proof_distance_mm),
            proof_level: params.proof_level,
            max_level: params.max_level,
            max_speed: scale.velocity_from_feed(params.max_feed_mm_per_min)?,
            nominal_gain,
        };
        let needed_d = 2.0 * PROOF_D;
        if plan.proof_d < needed_d {
            return Err(Refusal::TooCoarse {
                proof_d: plan.proof_d,
                needed_d,
            });
        }
        Ok(plan)
    }

    fn ticks(&self, time_s: f64) -> u32 {
        libm::round(time_s * self.tick_hz).max(1.0) as u32
    }

    /// Ticks of a record before the drive's period is known.
    pub fn first_decimation(&self) -> u32 {
        libm::ceil(self.tick_hz / 1250.0) as u32
    }

    fn bounded(&self, segments: &[Segment], window_d: f64, level: f64) -> Program {
        let bounds = Bounds {
            window_d: libm::ceil(window_d) as u32,
            speed_d_per_tick: libm::ceil(self.max_speed + 1.0).min(2047.0) as u32,
            ticks: u32::MAX,
            command: command(level),
        };
        let mut program = Program::new(segments, bounds);
        // Segments may end late by what they are aligned to.
        program.bounds.ticks = program.ticks().saturating_add(2000);
        program
    }

    /// The command of the proof after `level`; none past the largest.
    pub fn next_level(&self, level: Option<f64>) -> Option<f64> {
        match level {
            None => Some(FIRST_LEVEL.min(self.proof_level)),
            Some(level) if level < self.proof_level => Some((2.0 * level).min(self.proof_level)),
            Some(_) => None,
        }
    }

    /// A pulse each way, from rest to rest.
    pub fn proof(&self, level: f64) -> Program {
        let pulse =
            |level| Segment::level(level, self.ticks(0.06)).until_either_way(self.proof_d as u32);
        let rest = Segment::rest(self.ticks(0.2));
        let segments = [rest, pulse(level), rest, pulse(-level), rest];
        let window = (10.0 * self.proof_d).min(self.half_window_d);
        self.bounded(&segments, window, level)
    }

    /// Counts that prove a sign.
    pub fn proof_threshold(&self) -> f64 {
        PROOF_D.max(0.05 * self.proof_d)
    }

    /// Slow ramps each way, to what breaks the axis away.
    pub fn ramps(&self, level: f64) -> Program {
        let ramp = |level| {
            Segment::ramp(level, self.ramp_ticks()).until_either_way((0.5 * PROOF_D) as u32)
        };
        let rest = Segment::rest(self.ticks(0.25));
        let segments = [rest, ramp(level), rest, ramp(-level), rest];
        self.bounded(&segments, self.half_window_d, level)
    }

    /// Length of a ramp.
    pub fn ramp_ticks(&self) -> u32 {
        self.ticks(0.8)
    }

    /// Steps at two levels each way; `moving` is a command that surely moves the axis.
    pub fn probe(&self, moving: f64, offset_d: f64) -> (Program, [f64; 2]) {
        let go = self.ticks(0.7);
        let comfortable = USED * self.half_window_d / (self.nominal_gain * f64::from(go));
        let large = comfortable.max(3.0 * moving).min(self.max_level);
        let small = (0.55 * large).max((1.5 * moving).min(0.8 * large));
        let levels = [large, small];
        let [large, small] = levels;
        let far = 0.8 * USED * self.half_window_d;
        let goals = [
            (large, 0.6 * far),
            (-large, -0.6 * far),
            (small, 0.4 * far),
            (-small, 0.0),
        ];
        let segments = shuttle(&goals, offset_d, 0.0, go, self.ticks(0.5));
        (self.bounded(&segments, self.half_window_d, large), levels)
    }

    /// What the model of the probe, in ticks, allows in the window.
    pub fn main(&self, probe: &Vector, held: f64, capacity: usize) -> Result<Main, Refusal> {
        let omega = libm::exp(part(probe, place::LN_OMEGA));
        let damping = libm::exp(part(probe, place::LN_DAMPING));
        let gain = part(probe, place::GAIN);
        let delay = part(probe, place::DELAY).max(0.0);
        let settle = 4.0 / (omega * damping.clamp(0.2, 1.0)) + delay;
        // Overdamped drives settle by their slower pole.
        let settle = settle * damping.max(1.0) * damping.max(1.0);
        let brake = 2.0 * damping / omega + delay;
        let window = 2.0 * self.half_window_d;
        let speed = (USED * window / (2.0 * settle))
            .min(0.08 * window / brake)
            .min(0.65 * self.max_speed);
        let large = (speed / gain).min(self.max_level);
        let least = 1.5 * held / gain;
        let needed = 2.0 * least;
        if large < needed || large < 2e-3 {
            return Err(Refusal::WindowTooSmall {
                level: large,
                needed: needed.max(2e-3),
            });
        }
        let main = Main {
            levels: [(0.3 * large).max(least), (0.58 * large).max(least), large],
            go: 2.0 * settle,
            rest: settle,
            brake_d_per_level: gain * brake,
            period: core::f64::consts::TAU / omega,
            cruise: USED * window / (0.5 * large * gain),
            decimation: 1,
        };
        let longest =
            (0..Main::PROGRAMS).map(|number| self.main_program(&main, number, 0.0).ticks());
        let ticks: u32 = longest.fold(0, u32::saturating_add);
        let by_room = f64::from(ticks) / (0.97 * capacity as f64);
        let by_period = main.period / 300.0;
        Ok(Main {
            decimation: libm::ceil(by_room.max(by_period).max(1.0)) as u32,
            ..main
        })
    }

    /// Program `number` of the main experiments, for an axis `offset_d` from the middle of the window.
    pub fn main_program(&self, main: &Main, number: usize, offset_d: f64) -> Program {
        let [small, middle, large] = main.levels;
        // Levels differ a little, so that steps of the command that the drive answers to average out.
        let about = |level: f64, part: f64| level * (1.0 - 0.037 * part);
        let far = USED * self.half_window_d;
        let goals = |level: f64| {
            [
                (about(level, 0.0), far),
                (-about(level, 1.0), -far),
                (about(level, 2.0), far),
                (-about(level, 3.0), 0.0),
            ]
        };
        let (go, rest) = (main.whole(main.go), main.whole(main.rest));
        let stop = main.brake_d_per_level;
        let segments = match number {
            // The fastest first: it passes the index, from which on an encoder map helps the slow ones, which need it more.
            0 => shuttle(&goals(large), offset_d, stop, go, rest),
            1 => shuttle(&goals(middle), offset_d, stop, go, rest),
            2 => shuttle(&goals(small), offset_d, stop, go, rest),
            3 => {
                // No rest between: the reversals are the largest changes of speed.
                let travel = |to: f64, from: f64| libm::fabs(to - from).max(1.0) as u32;
                [
                    Segment::level(large, go).until(travel(0.5 * far, offset_d)),
                    Segment::level(-large, go).until(travel(-0.3 * far, 0.5 * far)),
                    Segment::level(large, go).until(travel(0.3 * far, -0.3 * far)),
                    Segment::rest(rest),
                    Segment::level(-large, go).until(travel(-0.5 * far, 0.3 * far)),
                    Segment::level(large, go).until(travel(0.3 * far, -0.5 * far)),
                    Segment::level(-large, go).until(travel(0.0, 0.3 * far)),
                    Segment::rest(rest),
                ]
            }
            _ => {
                let band = (0.4 / main.period, (5.0 / main.period).min(0.2));
                let chirp = |sign: f64, travel: f64| {
                    let centre = sign * 0.55 * large;
                    Segment::chirp(centre, 0.35 * large, band, main.whole(main.cruise))
                        .until(travel.max(1.0) as u32)
                };
                let mut segments = [Segment::default(); 8];
                let there = [
                    chirp(1.0, far - offset_d),
                    Segment::rest(rest),
                    chirp(-1.0, 2.0 * far),
                    Segment::rest(rest),
                ];
                for (place, segment) in segments.iter_mut().zip(there) {
                    *place = segment;
                }
                segments
            }
        };
        self.bounded(&segments, self.half_window_d, self.max_level)
    }
}

/// Sizes of the main experiments, ticks.
#[derive(Clone, Copy, Debug)]
pub struct Main {
    levels: [f64; 3],
    go: f64,
    rest: f64,
    /// Way of braking for a full command, d.
    brake_d_per_level: f64,
    period: f64,
    cruise: f64,
    /// Ticks of a record.
    pub decimation: u32,
}

impl Main {
    /// Number of programs.
    pub const PROGRAMS: usize = 5;

    /// Whole records, in ticks.
    fn whole(&self, ticks: f64) -> u32 {
        let n = f64::from(self.decimation);
        (libm::ceil(ticks / n) * n) as u32
    }
}

/// Steps to places of the window and rests between them; goals are levels and places, d from the middle, and
/// `stop` is the way of braking for a full command.
fn shuttle(goals: &[(f64, f64); 4], from: f64, stop: f64, go: u32, rest: u32) -> [Segment; 8] {
    let mut segments = [Segment::rest(rest); 8];
    let mut position = from;
    for (pair, &(level, place)) in segments.chunks_exact_mut(2).zip(goals) {
        let travel = (place - position) * libm::copysign(1.0, level) - stop * libm::fabs(level);
        if let Some(first) = pair.first_mut() {
            *first = Segment::level(level, go).until(travel.max(1.0) as u32);
        }
        position = place;
    }
    segments
}
