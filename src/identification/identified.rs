//! What identification found.

use crate::tuning::model::DriveModel;
use crate::units::AxisScale;

/// A figure and its standard deviation.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Figure {
    /// The figure.
    pub value: f64,
    /// Its 1σ.
    pub sigma: f64,
}

/// What was seen of the limit of acceleration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LargestAcceleration {
    /// It was reached, d/tick².
    Reached(Figure),
    /// It was not: the drive gives at least this, d/tick².
    AtLeast(f64),
}

/// A drive that was identified; its sign is proved.
///
/// An offset of the command and friction that differs between the directions look the same in every motion: friction
/// is taken as equal both ways, and what differs is the offset. What a command loses in each direction is measured
/// without that assumption.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Identified {
    /// The units it was measured in.
    pub scale: AxisScale,
    /// Speed for each unit of command beyond friction and offset, d/tick.
    pub gain: Figure,
    /// Speed reached at full command in the slower direction, d/tick.
    pub full_speed: Figure,
    /// What the drive's input adds to the command, of full command.
    pub offset: Figure,
    /// Kinetic friction, d/tick of command.
    pub friction: Figure,
    /// What the speed falls short of gain·command by, forward and backward, d/tick: friction and offset together.
    pub loss: [Figure; 2],
    /// Static friction forward and backward, d/tick of command; none where the axis moves at zero command.
    pub breakaway: [Option<Figure>; 2],
    /// Speed at which half of the excess of static over kinetic friction is gone, d/tick; none without an excess.
    pub stribeck: Option<Figure>,
    /// Natural period of the velocity response, s.
    pub natural_period_s: Figure,
    /// Damping ratio.
    pub damping: Figure,
    /// Transport delay, s.
    pub delay_s: Figure,
    /// Standstill after a reversal of the command, s.
    pub dead_time_s: Figure,
    /// Limit of acceleration.
    pub largest_acceleration: LargestAcceleration,
    /// Rms of measured less modelled position, d.
    pub residual_d: f64,
    /// Command of the sign proof that moved the axis, of full command.
    pub proof_level: f64,
}

/// A drive moves by steps of its command too fine for these experiments; the finest common one is counted on.
const RESOLUTION: f64 = 1e-4;

impl Identified {
    /// The drive as the loop counts on it: figures that noise carried below what can be are at their least.
    #[must_use]
    pub fn model(&self) -> DriveModel {
        let feed = |speed: f64| self.scale.feed_from_velocity(speed).max(0.0);
        let [forward, backward] = self
            .breakaway
            .map(|aim| feed(aim.map_or(self.friction.value, |aim| aim.value)));
        let friction = feed(self.friction.value);
        let acceleration = match self.largest_acceleration {
            LargestAcceleration::Reached(figure) => figure.value,
            LargestAcceleration::AtLeast(least) => least,
        };
        let default = DriveModel::default();
        DriveModel {
            full_command_feed_mm_per_min: feed(self.gain.value),
            natural_period_s: self.natural_period_s.value,
            damping: self.damping.value,
            delay_s: self.delay_s.value.max(0.0),
            offset: self.offset.value,
            friction_forward_mm_per_min: friction,
            friction_backward_mm_per_min: friction,
            breakaway_forward_mm_per_min: forward.max(friction),
            breakaway_backward_mm_per_min: backward.max(friction),
            stribeck_mm_per_min: self
                .stribeck
                .map_or(default.stribeck_mm_per_min, |speed| feed(speed.value))
                .max(0.001),
            dead_time_s: self.dead_time_s.value.max(0.0),
            resolution: RESOLUTION,
            max_acceleration_m_s2: self.acceleration_m_s2(acceleration),
        }
    }

    /// An acceleration in m/s² of one in d/tick².
    #[must_use]
    pub fn acceleration_m_s2(&self, acceleration: f64) -> f64 {
        acceleration / self.scale.acceleration_from_m_s2(1.0)
    }
}
