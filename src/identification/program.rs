//! What an experiment puts out, and the bounds it keeps: made outside the tick, run in it.

use crate::units::Command;

/// Most segments of a program.
pub const MAX_SEGMENTS: usize = 8;
/// Commands of a program are whole multiples of 2⁻¹⁵ of full command, so that a record holds them exactly.
const STEPS: f64 = 32_768.0;
const STEP_BITS: u32 = Command::FRAC_NBITS - 15;

/// The command of a segment over time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shape {
    /// Zero command: the drive stands by its own loop.
    #[default]
    Rest,
    /// A constant command.
    Level(Command),
    /// From zero, by so much more each tick.
    Ramp(Command),
    /// A wave of rising frequency about a level.
    Chirp(Chirp),
}

/// A wave of rising frequency; phases are parts of 2³² of a cycle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Chirp {
    /// Command about which it swings.
    pub centre: Command,
    /// How far it swings.
    pub amplitude: Command,
    /// Phase of the first tick's step.
    pub phase_step: u32,
    /// By how much the step grows each tick.
    pub phase_gain: u32,
}

/// A part of a program.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Segment {
    /// Its command.
    pub shape: Shape,
    /// It ends after so many ticks,
    pub ticks: u32,
    /// or once the axis is so many d from where the segment began, in the direction of its command (the other
    /// way too where `either_way`).
    pub travel_d: Option<u32>,
    /// Travel against the command counts as well: for an axis whose sign is not proved.
    pub either_way: bool,
}

impl Segment {
    /// `ticks` at zero command.
    #[must_use]
    pub const fn rest(ticks: u32) -> Self {
        Self::of(Shape::Rest, ticks)
    }

    /// A constant command, `level` of full command.
    #[must_use]
    pub fn level(level: f64, ticks: u32) -> Self {
        Self::of(Shape::Level(command(level)), ticks)
    }

    /// A command that reaches `level` in `ticks`.
    #[must_use]
    pub fn ramp(level: f64, ticks: u32) -> Self {
        let slope = Command::saturating_from_num(level / f64::from(ticks.max(1)));
        Self::of(Shape::Ramp(slope), ticks)
    }

    /// A wave about `centre` that goes from `from` to `to` cycles a tick in `ticks`.
    #[must_use]
    pub fn chirp(centre: f64, amplitude: f64, (from, to): (f64, f64), ticks: u32) -> Self {
        let turn = libm::ldexp(1.0, 32);
        let chirp = Chirp {
            centre: command(centre),
            amplitude: command(amplitude),
            phase_step: (from * turn) as u32,
            phase_gain: ((to - from) * turn / f64::from(ticks.max(1))) as u32,
        };
        Self::of(Shape::Chirp(chirp), ticks)
    }

    const fn of(shape: Shape, ticks: u32) -> Self {
        Self {
            shape,
            ticks,
            travel_d: None,
            either_way: false,
        }
    }

    /// The same, ended by that much travel.
    #[must_use]
    pub const fn until(self, travel_d: u32) -> Self {
        Self {
            travel_d: Some(travel_d),
            ..self
        }
    }

    /// The same, ended by travel in either direction.
    #[must_use]
    pub const fn until_either_way(self, travel_d: u32) -> Self {
        Self {
            travel_d: Some(travel_d),
            either_way: true,
            ..self
        }
    }
}

/// The nearest command that a record holds exactly.
#[must_use]
pub fn command(level: f64) -> Command {
    let steps = libm::round(level * STEPS).clamp(-(STEPS - 1.0), STEPS - 1.0);
    Command::from_bits((steps as i32).wrapping_shl(STEP_BITS))
}

/// What no experiment may pass; passing one ends it at zero command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bounds {
    /// Travel to either side of where the window was set, d.
    pub window_d: u32,
    /// Speed, d/tick.
    pub speed_d_per_tick: u32,
    /// Duration of the whole program, ticks.
    pub ticks: u32,
    /// Largest command, whatever a segment says.
    pub command: Command,
}

/// Whether the loop is open while a program runs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Loop {
    /// The program's command takes the place of the controller's.
    #[default]
    Open,
    /// The program's command is added to the controller's.
    Closed,
}

/// What an experiment does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Program {
    segments: [Segment; MAX_SEGMENTS],
    length: usize,
    /// What it must not pass.
    pub bounds: Bounds,
    /// Whether the loop is open.
    pub control: Loop,
    /// Where its window is centred, d; none: where it starts.
    pub centre: Option<i64>,
    /// Segments end only after whole multiples of so many ticks.
    pub aligned_to: u32,
}

impl Program {
    /// An open-loop program about where it starts; segments beyond [`MAX_SEGMENTS`] are left out.
    #[must_use]
    pub fn new(segments: &[Segment], bounds: Bounds) -> Self {
        let mut own = [Segment::default(); MAX_SEGMENTS];
        let length = segments.len().min(MAX_SEGMENTS);
        for (place, segment) in own.iter_mut().zip(segments) {
            *place = *segment;
        }
        Self {
            segments: own,
            length,
            bounds,
            control: Loop::Open,
            centre: None,
            aligned_to: 1,
        }
    }

    /// The same bounds with other segments; those beyond [`MAX_SEGMENTS`] are left out.
    #[must_use]
    pub fn with(&self, segments: &[Segment]) -> Self {
        let Self {
            segments, length, ..
        } = Self::new(segments, self.bounds);
        Self {
            segments,
            length,
            ..*self
        }
    }

    /// The same as an excitation of the closed loop.
    #[must_use]
    pub const fn closed(self) -> Self {
        Self {
            control: Loop::Closed,
            ..self
        }
    }

    /// The same with its window about `centre`.
    #[must_use]
    pub const fn about(self, centre: i64) -> Self {
        Self {
            centre: Some(centre),
            ..self
        }
    }

    /// The same with segments that end only after whole multiples of `ticks`, as records do.
    #[must_use]
    pub fn aligned(self, ticks: u32) -> Self {
        Self {
            aligned_to: ticks.max(1),
            ..self
        }
    }

    /// Segment number `index`; none past the end.
    #[must_use]
    pub fn segment(&self, index: usize) -> Option<&Segment> {
        self.segments.get(..self.length)?.get(index)
    }

    /// Longest that it can take, ticks.
    #[must_use]
    pub fn ticks(&self) -> u32 {
        let segments = self.segments.iter().take(self.length);
        segments.fold(0, |sum, segment| sum.saturating_add(segment.ticks))
    }
}

impl Shape {
    /// The command of tick `tick` of the segment.
    #[must_use]
    pub const fn command(&self, tick: u32) -> i32 {
        match self {
            Self::Rest => 0,
            Self::Level(level) => level.to_bits(),
            Self::Ramp(slope) => slope.to_bits().saturating_mul(tick.cast_signed()),
            Self::Chirp(chirp) => chirp.command(tick),
        }
    }

    /// Direction in which it drives.
    #[must_use]
    pub const fn direction(&self) -> i32 {
        match self {
            Self::Rest => 0,
            Self::Level(level) | Self::Ramp(level) => level.to_bits().signum(),
            Self::Chirp(chirp) => chirp.centre.to_bits().signum(),
        }
    }
}

impl Chirp {
    /// Two parabolas a cycle, which come close to a sine; what was put out is recorded, so it need not be one.
    const fn command(&self, tick: u32) -> i32 {
        // The steps grow evenly: n ticks add n·step + n(n−1)/2·gain, whole turns left out.
        let pairs = (tick as u64).wrapping_mul((tick as u64).wrapping_sub(1)) >> 1;
        let phase = self
            .phase_step
            .wrapping_mul(tick)
            .wrapping_add(self.phase_gain.wrapping_mul(pairs as u32));
        let p = phase.cast_signed() >> 16;
        let wave = p.wrapping_mul(32_768_i32.wrapping_sub(p.abs())) >> 13;
        let swing = (self.amplitude.to_bits() as i64).wrapping_mul(wave as i64) >> 15;
        self.centre.to_bits().saturating_add(swing as i32)
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use std::vec::Vec;

    #[test]
    fn commands_fit_a_record_exactly() {
        for level in [0.25, -0.1, 0.0123, 1.0, -1.0, 3.0] {
            let bits = command(level).to_bits();
            assert_eq!(bits % (1 << STEP_BITS), 0);
            assert!((f64::from(bits) / f64::from(1 << 30)).abs() < 1.0);
        }
    }

    #[test]
    fn a_chirp_swings_as_far_as_it_should_and_gets_faster() {
        let segment = Segment::chirp(0.2, 0.1, (0.005, 0.05), 1000);
        let full = f64::from(1 << 30);
        let wave: Vec<f64> = (0..1000)
            .map(|tick| f64::from(segment.shape.command(tick)) / full - 0.2)
            .collect();
        let (low, high) = wave
            .iter()
            .fold((0.0_f64, 0.0_f64), |(l, h), &w| (l.min(w), h.max(w)));
        assert!((high - 0.1).abs() < 1e-3 && (low + 0.1).abs() < 1e-3);
        let crossings = |part: &[f64]| part.windows(2).filter(|w| w[0] * w[1] < 0.0).count();
        assert!(crossings(&wave[500..]) > 2 * crossings(&wave[..500]));
    }
}
