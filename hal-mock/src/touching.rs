//! A simulated axis that touches: a surface at a known place, one touch after the other.

use leadscrew::axis::{Axis, Inputs, Outputs};
use leadscrew::encoder_map::EncoderMap;
use leadscrew::hal::Reference;
use leadscrew::params::{AxisParams, ParamError};
use leadscrew::probe::{ProbeOrder, ProbeRefused, Report};
use leadscrew::setpoint::planner::Planner;
use leadscrew::units::{AxisScale, Position, RangeError, Velocity};

use crate::board::{Board, BoardParams, TouchProbeParams};
use crate::machine::MachineParams;
use crate::scenario::Plant;

/// Longest that a touch or a move may take, ticks.
const MOST_TICKS: u32 = 2_000_000;
/// Ticks from enable to an axis that is ready.
const READY_TICKS: u32 = 300;
/// Where a surface is out of the way, mm.
const AWAY_MM: f64 = 9e4;
/// Ticks in which a probe that was touching is seen to be free.
const RELEASE_TICKS: u32 = 20;
/// Ticks ahead that a move is planned.
const LEAD: u32 = 50;

/// What came of a touch.
#[derive(Clone, Copy, Debug)]
pub struct Touched {
    /// What the axis says.
    pub report: Report,
    /// Where the shaft or the carriage, whichever carries the surface, was when the probe triggered, d.
    pub trigger_d: f64,
    /// Farthest that the shaft went beyond where it was at the contact, d.
    pub overtravel_d: f64,
    /// What the axis stated as the largest before it moved, d.
    pub bound_d: f64,
}

/// Why a touch could not be run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TouchingError {
    /// A parameter out of range.
    Range(RangeError),
    /// Parameters that do not make an axis.
    Params(ParamError),
    /// The axis refuses to probe so.
    Refused(ProbeRefused),
    /// The board has no probe: its surface is out of reach.
    NoProbe,
    /// The axis is not ready, or does not come to an end.
    NotReady,
}

impl core::fmt::Display for TouchingError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Range(error) => error.fmt(f),
            Self::Params(error) => error.fmt(f),
            Self::Refused(error) => error.fmt(f),
            Self::NoProbe => {
                f.write_str("there is no probe: set touch_probe.surface_mm to where the surface is")
            }
            Self::NotReady => f.write_str(
                "the simulated axis did not come to rest in time: look at its fault and its feeds",
            ),
        }
    }
}

impl core::error::Error for TouchingError {}

impl From<RangeError> for TouchingError {
    fn from(error: RangeError) -> Self {
        Self::Range(error)
    }
}

impl From<ParamError> for TouchingError {
    fn from(error: ParamError) -> Self {
        Self::Params(error)
    }
}

/// A machine with a probe, and the axis on it.
#[derive(Clone, Debug)]
pub struct TouchBench<'m> {
    /// The board with machine and probe.
    pub board: Board,
    /// The axis.
    pub axis: Axis<'m>,
    outputs: Outputs,
    scale: AxisScale,
    planner: Planner,
}

impl<'m> TouchBench<'m> {
    /// An axis by `params` under control, at rest at 0 mm, with its map if there is one. The map waits for an index.
    ///
    /// # Errors
    /// A parameter out of range, or an axis that does not become ready.
    pub fn new(
        plant: &Plant,
        params: &AxisParams,
        map: Option<EncoderMap<'m>>,
        seed: u64,
    ) -> Result<Self, TouchingError> {
        let Plant { machine, board, .. } = plant;
        let config = params.validate()?;
        let mut axis = Axis::new(config);
        axis.set_map(map);
        let mut bench = Self {
            board: Board::new(board, machine, params.tick_hz, seed)?,
            axis,
            outputs: Outputs::default(),
            scale: config.scale,
            planner: Planner::new(config.limits, Position::ZERO, 0),
        };
        bench.run(READY_TICKS);
        if bench.outputs.enabled {
            Ok(bench)
        } else {
            Err(TouchingError::NotReady)
        }
    }

    /// One tick.
    pub fn step(&mut self) -> &Outputs {
        self.board.step(&self.outputs);
        let inputs: Inputs<'_> = self.board.inputs(true, Reference::default());
        self.outputs = *self.axis.step(&inputs);
        &self.outputs
    }

    /// So many ticks.
    pub fn run(&mut self, ticks: u32) {
        for _ in 0..ticks {
            self.step();
        }
    }

    /// Takes the surface away, moves to `position_mm`, raw from where the encoder counts, and lets the loop settle.
    ///
    /// # Errors
    /// A feed that the axis has not, or an axis that does not come to rest.
    pub fn go_to(&mut self, position_mm: f64, feed_mm_per_min: f64) -> Result<(), TouchingError> {
        let target = Position::saturating_from_num(self.scale.counts_from_mm(position_mm));
        let feed = self.feed(feed_mm_per_min)?;
        if let Some(probe) = &mut self.board.probe {
            probe.set_surface(AWAY_MM, true);
        }
        let tick = self.outputs.tick;
        self.planner.begin(self.axis.commanded().position, tick);
        let planned = self.planner.move_to(target, feed, tick.wrapping_add(LEAD));
        if let Ok(Some(timed)) = planned {
            let queued = self.axis.queue(&timed.plan, timed.start);
            queued.map_err(|_| TouchingError::NotReady)?;
            self.run(LEAD + 2);
            self.finish(|_| {})?;
        }
        self.run(READY_TICKS);
        Ok(())
    }

    /// Puts the surface to `surface_mm`, probes towards `towards_mm` and goes back by `retract_mm`.
    ///
    /// # Errors
    /// [`TouchingError`]; a touch that does not come is none, but what the report says.
    pub fn touch(
        &mut self,
        surface_mm: f64,
        towards_mm: f64,
        feed_mm_per_min: f64,
        retract_mm: f64,
    ) -> Result<Touched, TouchingError> {
        let from_mm = self
            .scale
            .mm_from_counts(self.axis.commanded().position.to_num());
        let probe = self.board.probe.as_mut().ok_or(TouchingError::NoProbe)?;
        probe.set_surface(surface_mm, towards_mm > from_mm);
        let trigger_d = probe.trigger_d();
        self.run(RELEASE_TICKS);
        let up = if towards_mm > from_mm { 1.0 } else { -1.0 };
        let place = |mm| Position::saturating_from_num(self.scale.counts_from_mm(mm));
        let order = ProbeOrder {
            target: place(towards_mm),
            feed: self.feed(feed_mm_per_min)?,
            retract: place(retract_mm),
        };
        let bound = self.axis.probe_towards(&order);
        let bound_d = bound.map_err(TouchingError::Refused)?.to_num();
        let ends = self.axis.probe().report().ends;
        let mut overtravel_d: f64 = 0.0;
        self.finish(|bench| {
            let shaft = bench.board.machine.truth().shaft.position;
            overtravel_d = overtravel_d.max(up * (shaft - trigger_d));
        })?;
        self.run(READY_TICKS);
        let report = *self.axis.probe().report();
        if report.ends == ends {
            return Err(TouchingError::NotReady);
        }
        Ok(Touched {
            report,
            trigger_d,
            overtravel_d,
            bound_d,
        })
    }

    /// Steps until nothing moves.
    fn finish(&mut self, mut look: impl FnMut(&Self)) -> Result<(), TouchingError> {
        for _ in 0..MOST_TICKS {
            let moving = self.step().moving;
            look(self);
            if !moving {
                return Ok(());
            }
        }
        Err(TouchingError::NotReady)
    }

    fn feed(&self, feed_mm_per_min: f64) -> Result<Velocity, TouchingError> {
        let velocity = self.scale.velocity_from_feed(feed_mm_per_min)?;
        Ok(Velocity::saturating_from_num(velocity))
    }
}

/// A machine with a probe: `params` of it, its surface within reach.
#[must_use]
pub fn plant_with_probe(machine: MachineParams, probe: TouchProbeParams) -> Plant {
    Plant {
        board: BoardParams {
            probe: TouchProbeParams {
                surface_mm: probe.surface_mm.clamp(-9e4, 9e4),
                ..probe
            },
            ..BoardParams::default()
        },
        ..machine.into()
    }
}
