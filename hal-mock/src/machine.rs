//! The machine "16K20F3 Z": drive, carriage and encoder together.

use leadscrew::hal::{self, Capture};
use leadscrew::parameter_table::ParameterTable;
use leadscrew::units::{AxisScale, Command, RangeError};

use crate::arc::{Arc, State};
use crate::carriage::{Carriage, CarriageParams};
use crate::drive::{Drive, DriveParams, Grip};
use crate::encoder::{Encoder, EncoderModel};
use crate::play::Play;
use crate::slip::Slip;
use crate::tachogenerator::Tachogenerator;

/// Where the shaft stands at first: in the middle of the discrete 0.
pub const START_D: f64 = 0.5;

leadscrew::parameter_table! {
    /// How the encoder is coupled.
    pub struct MountParams {
        /// Encoder resolution
        counts_per_mm: 1000.0, "d/mm", 0.001..=1e7;
        /// Play in the encoder's coupling
        coupling_play_mm: 0.0, "mm", 0.0..=1.0;
        /// 0: encoder on the screw; 1: linear scale on the carriage, which puts its backlash into the loop
        linear_scale: 0.0, "0 or 1", 0.0..=1.0;
        /// Share of its motion that the encoder loses in a slipping coupling; 1: broken
        coupling_slip: 0.0, "1", 0.0..=1.0;
        /// When the coupling begins to slip
        slip_from_s: 0.0, "s", 0.0..=1e6;
    }
}

/// Everything about a machine.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MachineParams {
    /// The drive.
    pub drive: DriveParams,
    /// The carriage.
    pub carriage: CarriageParams,
    /// The encoder's coupling.
    pub mount: MountParams,
    /// The encoder.
    pub encoder: EncoderModel,
}

impl MachineParams {
    /// The longitudinal axis of the 16K20F3 lathe with all its imperfections and the encoder "real".
    #[must_use]
    pub fn z_16k20f3() -> Self {
        Self::default()
    }

    /// The same axis for checking mathematics: no offset, delay, dead time, ripple, friction, compliance
    /// or play, and the encoder "ideal".
    #[must_use]
    pub fn bare(self) -> Self {
        Self {
            drive: self.drive.bare(),
            carriage: self.carriage.bare(),
            mount: MountParams {
                coupling_play_mm: 0.0,
                coupling_slip: 0.0,
                ..self.mount
            },
            encoder: EncoderModel::ideal(),
        }
    }
}

/// What the machine really does at the end of a tick, in d and ticks.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Truth {
    /// The encoder's shaft at the sampling instant.
    pub shaft: State,
    /// The carriage at the end of the tick.
    pub carriage: State,
}

/// The machine.
#[derive(Clone, Debug)]
pub struct Machine {
    drive: Drive,
    carriage: Carriage,
    coupling: Coupling,
    slip: Option<Slip>,
    encoder: Encoder,
    tachogenerator: Tachogenerator,
    /// Motion of the drive's shaft in the last tick, and the tachogenerator's error in it.
    turned: (Arc, f64),
    /// Motion of the encoder in the last tick.
    seen: Arc,
}

impl Machine {
    /// A machine at rest at [`START_D`], with the errors that `seed` draws, for a tick rate of `tick_hz`.
    ///
    /// # Errors
    /// A parameter out of range.
    pub fn new(params: &MachineParams, tick_hz: f64, seed: u64) -> Result<Self, RangeError> {
        params.mount.check()?;
        let scale = AxisScale::new(params.mount.counts_per_mm, tick_hz)?;
        Ok(Self {
            drive: Drive::new(&params.drive, scale, START_D)?,
            carriage: Carriage::new(&params.carriage, scale, START_D)?,
            coupling: Coupling::new(&params.mount, scale),
            slip: Slip::new(
                params.mount.coupling_slip,
                params.mount.slip_from_s * tick_hz,
            ),
            encoder: Encoder::new(&params.encoder, tick_hz, START_D, seed)?,
            tachogenerator: Tachogenerator::new(scale),
            turned: (Arc::default(), 0.0),
            seen: Arc::default(),
        })
    }

    /// Moves through one tick under the command that was put out before it.
    pub fn step(&mut self, command: Command, enable: bool) {
        self.step_gripped(command, enable, Grip::None);
    }

    /// The same with what grips the shaft besides the drive.
    pub fn step_gripped(&mut self, command: Command, enable: bool, grip: Grip) {
        let ripple = self.drive.ripple();
        let turned = self.drive.step_gripped(command, enable, grip);
        let shaft = self.drive.shaft();
        self.carriage.step(shaft);
        self.turned = (turned, ripple);
        self.seen = match &mut self.coupling {
            Coupling::Rigid => turned,
            Coupling::Play(play, end) => {
                let (position, driven) = play.follow(shaft.position);
                let velocity = if driven { shaft.velocity } else { 0.0 };
                let way = position - end.0;
                // The ends of the play are taken up by impact, within the tick.
                end.1 = without_overshoot(end.1, way);
                joined(end, (position, without_overshoot(velocity, way)))
            }
            Coupling::Scale(end) => {
                let carriage = self.carriage.state();
                joined(end, (carriage.position, carriage.velocity))
            }
        };
        if let Some(slip) = &mut self.slip {
            self.seen = slip.follow(&self.seen);
        }
        self.encoder.advance(&self.seen);
    }

    /// Lets the encoder's coupling lose the share `lost` of its motion from the next step on, 1 for all of it.
    pub fn set_slip(&mut self, lost: f64) {
        match &mut self.slip {
            Some(slip) => slip.set(lost),
            None => self.slip = Slip::new(lost, 0.0),
        }
    }

    /// The encoder, for where its edges really lie.
    #[must_use]
    pub const fn encoder(&self) -> &Encoder {
        &self.encoder
    }

    /// Motion of the encoder's shaft in the last tick.
    #[must_use]
    pub const fn seen(&self) -> &Arc {
        &self.seen
    }

    /// What really happened.
    #[must_use]
    pub fn truth(&self) -> Truth {
        let shaft = self.seen.at(1.0 - self.encoder.sampling_advance());
        Truth {
            shaft,
            carriage: self.carriage.state(),
        }
    }

    /// The screw at the sampling instant: where the encoder is, unless its coupling has play or slips.
    #[must_use]
    pub fn screw(&self) -> State {
        self.turned.0.at(1.0 - self.encoder.sampling_advance())
    }

    /// Mean reading of the tachogenerator over the last tick, d/tick. Call it once a tick, or never: the
    /// oscilloscope costs nothing while nobody looks.
    pub fn read_tachogenerator(&mut self) -> f64 {
        let (shaft, ripple) = self.turned;
        self.tachogenerator.step(&shaft, ripple);
        self.tachogenerator.velocity()
    }
}

impl hal::Encoder for Machine {
    fn capture(&self) -> Capture<'_> {
        self.encoder.capture()
    }
}

/// What turns the encoder.
#[derive(Clone, Debug)]
enum Coupling {
    Rigid,
    /// Through play; with the position and velocity reached last.
    Play(Play, (f64, f64)),
    /// It sits on the carriage.
    Scale((f64, f64)),
}

impl Coupling {
    fn new(params: &MountParams, scale: AxisScale) -> Self {
        let play = scale.counts_from_mm(params.coupling_play_mm);
        if params.linear_scale >= 0.5 {
            Self::Scale((START_D, 0.0))
        } else if play > 0.0 {
            Self::Play(Play::new(play, START_D), (START_D, 0.0))
        } else {
            Self::Rigid
        }
    }
}

/// A velocity at an end of an arc over `way`, bounded so that the arc does not turn back: a cubic with
/// end velocities between zero and three times its mean velocity is monotone.
fn without_overshoot(velocity: f64, way: f64) -> f64 {
    let (low, high) = if way < 0.0 {
        (3.0 * way, 0.0)
    } else {
        (0.0, 3.0 * way)
    };
    velocity.clamp(low, high)
}

/// The arc from where the last one ended to a new end.
fn joined(end: &mut (f64, f64), to: (f64, f64)) -> Arc {
    let arc = Arc::joining(*end, to);
    *end = to;
    arc
}
