//! Programs of experiments, told segment by segment: [`requests`] on the tool's side, [`Draft`] on the axis's.

use crate::identification::program::{Bounds, Chirp, Loop, MAX_SEGMENTS, Program, Segment, Shape};
use crate::protocol::refusal::Refusal;
use crate::protocol::request::Request;
use crate::units::Command;

/// Full command, 2⁻³⁰.
const FULL: i32 = 1 << Command::FRAC_NBITS;

/// A program as far as it was told.
#[derive(Clone, Copy, Debug, Default)]
pub struct Draft {
    frame: Option<Program>,
    segments: [Segment; MAX_SEGMENTS],
    length: usize,
}

impl Draft {
    /// Takes the bounds, or a segment.
    ///
    /// # Errors
    /// [`Refusal::WrongProgram`]; what was told before stays.
    pub fn add(&mut self, request: &Request<'_>) -> Result<(), Refusal> {
        match *request {
            Request::Program {
                window_d,
                speed_d_per_tick,
                ticks,
                command,
                is_closed,
                centre,
                aligned_to,
            } => {
                let command = command_of(command)?;
                let bounds = Bounds {
                    window_d,
                    speed_d_per_tick,
                    ticks,
                    command,
                };
                let mut frame = Program::new(&[], bounds).aligned(aligned_to);
                frame.centre = centre;
                if is_closed {
                    frame.control = Loop::Closed;
                }
                *self = Self {
                    frame: Some(frame),
                    ..Self::default()
                };
                Ok(())
            }
            Request::Segment { .. } => {
                let segment = segment_of(request)?;
                let place = self.segments.get_mut(self.length);
                let place = place.filter(|_| self.frame.is_some());
                *place.ok_or(Refusal::WrongProgram)? = segment;
                self.length = self.length.wrapping_add(1);
                Ok(())
            }
            _ => Err(Refusal::NotUnderstood),
        }
    }

    /// The whole program.
    ///
    /// # Errors
    /// [`Refusal::WrongProgram`] without bounds or segments.
    pub fn program(&self) -> Result<Program, Refusal> {
        let segments = self.segments.get(..self.length).unwrap_or_default();
        match &self.frame {
            Some(frame) if !segments.is_empty() => Ok(frame.with(segments)),
            _ => Err(Refusal::WrongProgram),
        }
    }
}

fn command_of(bits: i32) -> Result<Command, Refusal> {
    if bits.unsigned_abs() > FULL.unsigned_abs() {
        return Err(Refusal::WrongProgram);
    }
    Ok(Command::from_bits(bits))
}

fn segment_of(request: &Request<'_>) -> Result<Segment, Refusal> {
    let Request::Segment {
        shape,
        level,
        amplitude,
        phase_step,
        phase_gain,
        ticks,
        travel_d,
        either_way,
    } = *request
    else {
        return Err(Refusal::NotUnderstood);
    };
    let level = command_of(level)?;
    let shape = match shape {
        0 => Shape::Rest,
        1 => Shape::Level(level),
        2 => Shape::Ramp(level),
        3 => Shape::Chirp(Chirp {
            centre: level,
            amplitude: command_of(amplitude)?,
            phase_step,
            phase_gain,
        }),
        _ => return Err(Refusal::WrongProgram),
    };
    Ok(Segment {
        shape,
        ticks,
        travel_d,
        either_way,
    })
}

/// The requests that tell a program: the first is [`Request::Program`], a [`Request::Segment`] each follow.
pub fn requests(program: &Program) -> impl Iterator<Item = Request<'static>> + use<'_> {
    let Program {
        bounds,
        control,
        centre,
        aligned_to,
        ..
    } = *program;
    let first = Request::Program {
        window_d: bounds.window_d,
        speed_d_per_tick: bounds.speed_d_per_tick,
        ticks: bounds.ticks,
        command: bounds.command.to_bits(),
        is_closed: control == Loop::Closed,
        centre,
        aligned_to,
    };
    let segments = (0..MAX_SEGMENTS).map_while(|index| program.segment(index));
    core::iter::once(first).chain(segments.map(request_of))
}

fn request_of(segment: &Segment) -> Request<'static> {
    let chirp = match segment.shape {
        Shape::Chirp(chirp) => chirp,
        _ => Chirp::default(),
    };
    let (shape, level) = match segment.shape {
        Shape::Rest => (0, Command::ZERO),
        Shape::Level(level) => (1, level),
        Shape::Ramp(slope) => (2, slope),
        Shape::Chirp(chirp) => (3, chirp.centre),
    };
    Request::Segment {
        shape,
        level: level.to_bits(),
        amplitude: chirp.amplitude.to_bits(),
        phase_step: chirp.phase_step,
        phase_gain: chirp.phase_gain,
        ticks: segment.ticks,
        travel_d: segment.travel_d,
        either_way: segment.either_way,
    }
}
