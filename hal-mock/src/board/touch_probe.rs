//! A touch probe and the surface before it.
//!
//! ```text
//!  position ──► contact ──► + pre-travel + scatter ──► contact opens ──► + delay + jitter ──► edge at the input ─► Latch, level
//! ```
//!
//! Scatter and jitter are bell-shaped, bounded by ±3.45σ (`random.rs`), and drawn anew for every touch.

use leadscrew::hal::{Capture, Latch};
use leadscrew::parameter_table::ParameterTable;
use leadscrew::units::RangeError;

use super::switches::latch_at;
use crate::machine::Machine;
use crate::random::Noise;

leadscrew::parameter_table! {
    /// A touch probe before a surface; the machine starts at 0 mm. By default there is none.
    pub struct TouchProbeParams {
        /// Where the surface is; beyond ±1e5 mm there is none
        surface_mm: 1e6, "mm", -1e6..=1e6;
        /// 1: it is touched going up; -1: going down
        direction: 1.0, "1 or -1", -1.0..=1.0;
        /// 1: the surface is at a place of the encoder's shaft; 0: of the carriage
        at_shaft: 0.0, "0 or 1", 0.0..=1.0;
        /// From the contact to the trigger going up
        pretravel_up_mm: 0.0, "mm", 0.0..=1.0;
        /// The same going down
        pretravel_down_mm: 0.0, "mm", 0.0..=1.0;
        /// Scatter of the pre-travel, two standard deviations
        repeatability_2s_mm: 0.001, "mm", 0.0..=0.1;
        /// How far it has to be withdrawn to be released
        release_mm: 0.005, "mm", 0.0..=1.0;
        /// From the trigger to the edge at the input
        delay_s: 0.0, "s", 0.0..=0.01;
        /// Standard deviation of that
        jitter_s: 1e-5, "s", 0.0..=0.001;
        /// How long the contact bounces after its first edge
        bounce_s: 0.0, "s", 0.0..=0.1;
    }
}

/// No surface lies farther.
const FAR_MM: f64 = 1e5;
/// Halvings of a tick that find a crossing to the clock of any timer.
const HALVINGS: u32 = 40;

/// A probe and its surface.
#[derive(Clone, Debug)]
pub struct TouchProbe {
    params: TouchProbeParams,
    counts_per_mm: f64,
    tick_hz: f64,
    /// Where it triggers next, d, and where it is released.
    trigger: f64,
    release: f64,
    /// It is deflected beyond its trigger.
    deflected: bool,
    position: f64,
    noise: Noise,
    coin: Noise,
    /// When its edge reaches the input.
    due: Option<u32>,
    level: bool,
    /// Ticks that it still bounces.
    bouncing: u32,
    /// A pulse by interference is to come.
    glitch: bool,
    latch: Option<Latch>,
}

impl TouchProbe {
    /// A probe on a machine at `machine`'s place; none without a surface.
    ///
    /// # Errors
    /// A parameter out of range.
    pub fn new(
        params: &TouchProbeParams,
        machine: &Machine,
        counts_per_mm: f64,
        tick_hz: f64,
        seed: u64,
    ) -> Result<Option<Self>, RangeError> {
        params.check()?;
        if params.surface_mm.max(-params.surface_mm) >= FAR_MM {
            return Ok(None);
        }
        let mut probe = Self {
            params: *params,
            counts_per_mm,
            tick_hz,
            trigger: 0.0,
            release: 0.0,
            deflected: false,
            position: 0.0,
            noise: Noise::new(seed, 41),
            coin: Noise::new(seed, 42),
            due: None,
            level: false,
            bouncing: 0,
            glitch: false,
            latch: None,
        };
        probe.position = probe.place_of(machine);
        probe.arm();
        probe.deflected = probe.side() * (probe.position - probe.trigger) >= 0.0;
        probe.level = probe.deflected;
        Ok(Some(probe))
    }

    /// Puts the surface elsewhere, mm, touched going up or down.
    pub fn set_surface(&mut self, surface_mm: f64, upwards: bool) {
        self.params.surface_mm = surface_mm;
        self.params.direction = if upwards { 1.0 } else { -1.0 };
        self.arm();
        let beyond = self.side() * (self.position - self.trigger);
        self.deflected = beyond >= 0.0;
        self.level = self.deflected;
        self.due = None;
    }

    /// Where the shaft or the carriage is when the probe triggers next, d: contact, pre-travel and its scatter.
    #[must_use]
    pub const fn trigger_d(&self) -> f64 {
        self.trigger
    }

    /// A pulse of interference in the next tick, shorter than a tick.
    pub const fn disturb(&mut self) {
        self.glitch = true;
    }

    /// Levels and latch of the tick.
    pub(super) const fn input(&self) -> (bool, Option<Latch>) {
        (self.level, self.latch)
    }

    const fn side(&self) -> f64 {
        if self.params.direction < 0.0 {
            -1.0
        } else {
            1.0
        }
    }

    fn place_of(&self, machine: &Machine) -> f64 {
        if self.params.at_shaft >= 0.5 {
            machine.seen().end().position
        } else {
            machine.truth().carriage.position
        }
    }

    /// Draws the next trigger.
    fn arm(&mut self) {
        let params = &self.params;
        let pretravel = if params.direction < 0.0 {
            params.pretravel_down_mm
        } else {
            params.pretravel_up_mm
        };
        let scatter = 0.5 * params.repeatability_2s_mm * self.noise.normal();
        let side = self.side();
        let trigger_mm = params.surface_mm + side * (pretravel + scatter);
        self.trigger = trigger_mm * self.counts_per_mm;
        self.release = self.trigger - side * params.release_mm * self.counts_per_mm;
    }

    /// Follows the machine through a tick.
    pub(super) fn step(&mut self, machine: &Machine) {
        let before = self.position;
        self.position = self.place_of(machine);
        let side = self.side();
        if self.deflected {
            if side * (self.position - self.release) < 0.0 {
                self.deflected = false;
                self.level = false;
                self.due = None;
                self.bouncing = 0;
                self.arm();
            }
        } else if side * (self.position - self.trigger) >= 0.0 {
            self.deflected = true;
            let share = self.crossing(before, machine);
            let delay_s = self.params.delay_s + self.params.jitter_s * self.noise.normal();
            let at = share + delay_s.max(0.0) * self.tick_hz;
            self.due = Some(machine.encoder().time_at(at));
            self.bouncing = (self.params.bounce_s * self.tick_hz) as u32;
        }
    }

    /// The share of the tick at which it came to its trigger.
    fn crossing(&self, before: f64, machine: &Machine) -> f64 {
        if self.params.at_shaft < 0.5 {
            // The carriage moves evenly within a tick, to the millionth that its acceleration makes.
            let way = self.position - before;
            return if way == 0.0 {
                1.0
            } else {
                ((self.trigger - before) / way).clamp(0.0, 1.0)
            };
        }
        let (arc, side) = (machine.seen(), self.side());
        let (mut from, mut to) = (0.0, 1.0);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (from + to);
            if side * (arc.at(middle).position - self.trigger) < 0.0 {
                from = middle;
            } else {
                to = middle;
            }
        }
        to
    }

    /// What the input sees at the sampling instant of `capture`; the one before was at `before`.
    pub(super) fn sample(&mut self, before: (u32, u32), capture: &Capture<'_>) {
        self.latch = None;
        if core::mem::take(&mut self.glitch) {
            let half = capture.sampled_at.wrapping_sub(before.1) / 2;
            let time = before.1.wrapping_add(half);
            self.latch = Some(latch_at(before, capture, time));
        }
        let is_due = |time: &mut u32| capture.sampled_at.wrapping_sub(*time).cast_signed() >= 0;
        if let Some(time) = self.due.take_if(is_due) {
            self.latch = Some(latch_at(before, capture, time));
            self.level = true;
        } else if self.bouncing != 0 && self.deflected && self.due.is_none() {
            self.bouncing -= 1;
            let was = self.level;
            self.level = self.bouncing == 0 || self.coin.uniform() > 0.0;
            if self.level && !was {
                self.latch = Some(latch_at(before, capture, capture.sampled_at));
            }
        }
    }
}
