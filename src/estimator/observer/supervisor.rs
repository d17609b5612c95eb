//! Which model runs, and the line on which a command travels to the drive.

use super::Model;
use super::classes::Response;
use super::config::{MAX_DELAY, SIGMA_FRAC, Supervision};
use super::motion::{Motion, high};
use crate::units::Command;

/// Innovations beyond so many σ count as so many.
const MOST_SIGMAS: i32 = 128 << SIGMA_FRAC;
/// The mean square of the innovations is taken over 2ⁿ samples.
const MEAN_SHIFT: u32 = 4;
/// The shadow follows the acceleration with 2⁻³ of its error a tick and the disturbance with 2⁻⁸: critically
/// damped, 16 ticks.
const SHADOW_SHIFTS: [u32; 2] = [3, 8];
/// A model that was given up again and again has to prove itself for up to 2⁶ times as long.
const MOST_DOUBLINGS: u32 = 6;
/// Places of the line, a power of two.
const PLACES: usize = MAX_DELAY + 1;

/// Commands on their way.
#[derive(Clone, Debug)]
#[repr(C)]
pub struct Line {
    place: usize,
    /// Commands known without a gap.
    known: usize,
    commands: [i32; PLACES],
}

/// Full command.
const FULL: i32 = 1 << Command::FRAC_NBITS;

impl Line {
    pub const fn new() -> Self {
        Self {
            place: 0,
            known: 0,
            commands: [0; PLACES],
        }
    }

    /// Puts a command in and takes out that of `delay` ticks ago, if all since are known.
    #[inline]
    pub fn pass(&mut self, command: Option<Command>, delay: usize) -> Option<i32> {
        let Some(command) = command else {
            self.known = 0;
            return None;
        };
        let place = self.place.wrapping_add(1) % PLACES;
        self.place = place;
        if let Some(slot) = self.commands.get_mut(place) {
            // No more than full, by one instruction.
            *slot = command.to_bits().clamp(-FULL, FULL.wrapping_sub(1));
        }
        if self.known < delay {
            self.known = self.known.wrapping_add(1);
            return None;
        }
        self.commands
            .get(place.wrapping_sub(delay) % PLACES)
            .copied()
    }
}

/// Judges the drive's model.
#[derive(Clone, Debug)]
pub struct Supervisor {
    model: Model,
    /// Mean square of the normalised innovation, twice [`SIGMA_FRAC`] fractional bits.
    mean_square: i32,
    /// Ticks for which the model that does not run, or its opposite, has been the better one.
    persisted: u32,
    /// Acceleration by the drive's model while the other runs, as a state.
    acceleration: i64,
    fallbacks: u32,
}

impl Supervisor {
    pub const fn new() -> Self {
        Self {
            model: Model::Kinematic,
            mean_square: 0,
            persisted: 0,
            acceleration: 0,
            fallbacks: 0,
        }
    }

    pub const fn model(&self) -> Model {
        self.model
    }

    pub const fn fallbacks(&self) -> u32 {
        self.fallbacks
    }

    /// The state was lost: if it was by the drive's model, that may be why.
    pub const fn doubt(&mut self) {
        if matches!(self.model, Model::Drive) {
            self.fall_back();
        } else {
            self.restart();
        }
    }

    /// Begins anew with the kinematic model.
    const fn restart(&mut self) {
        let fallbacks = self.fallbacks;
        *self = Self::new();
        self.fallbacks = fallbacks;
    }

    /// Leaves the drive's model for want of a command.
    #[cold]
    pub const fn lose_command(&mut self) {
        self.restart();
    }

    /// Takes an innovation of the drive's model; true if the model is given up for it.
    #[inline]
    pub fn weigh(&mut self, innovation: i32, per_sigma: i32, supervision: &Supervision) -> bool {
        let sigmas = high((innovation as i64).wrapping_mul(per_sigma as i64));
        // These bounds are one instruction.
        let sigmas = sigmas.clamp(-MOST_SIGMAS, MOST_SIGMAS.wrapping_sub(1));
        let square = sigmas.wrapping_mul(sigmas);
        let change = square
            .wrapping_sub(self.mean_square)
            .wrapping_shr(MEAN_SHIFT);
        self.mean_square = self.mean_square.wrapping_add(change);
        if self.mean_square <= supervision.fallback_level {
            self.persisted = 0;
            false
        } else {
            self.persist(supervision.fallback_ticks)
        }
    }

    /// Another tick in which the drive's model was bad.
    #[cold]
    #[inline(never)]
    const fn persist(&mut self, ticks: u32) -> bool {
        self.persisted = self.persisted.wrapping_add(1);
        let given_up = self.persisted > ticks;
        if given_up {
            self.fall_back();
        }
        given_up
    }

    #[cold]
    const fn fall_back(&mut self) {
        self.restart();
        self.fallbacks = self.fallbacks.saturating_add(1);
    }

    /// Runs the drive's model beside the kinematic one, on its velocity, and goes over to it once it has
    /// predicted the acceleration well for long enough; at rest at once, unless it was given up before.
    pub fn shadow(
        &mut self,
        response: &Response,
        supervision: &Supervision,
        motion: &mut Motion,
        wanted: Option<i32>,
        resting: bool,
    ) {
        let Some(wanted) = wanted else {
            self.persisted = 0;
            self.acceleration = motion.acceleration;
            return;
        };
        if resting {
            motion.disturbance = response.jerk(wanted, 0, 0).wrapping_neg();
            self.acceleration = 0;
            self.prove(supervision, self.fallbacks == 0);
            return;
        }
        let jerk = response
            .jerk(wanted, motion.velocity, self.acceleration)
            .wrapping_add(motion.disturbance);
        let predicted = self.acceleration.wrapping_add(jerk);
        let error = motion.acceleration.wrapping_sub(predicted);
        let [fast, slow] = SHADOW_SHIFTS;
        self.acceleration = predicted.wrapping_add(error.wrapping_shr(fast));
        motion.disturbance = motion.disturbance.wrapping_add(error.wrapping_shr(slow));
        if error.unsigned_abs() > supervision.return_acceleration.unsigned_abs() {
            self.persisted = 0;
        } else {
            self.prove(supervision, false);
        }
    }

    /// Another tick in which the drive's model was good; it is taken up at last, or if it is `trusted`.
    const fn prove(&mut self, supervision: &Supervision, trusted: bool) {
        let doublings = if self.fallbacks < MOST_DOUBLINGS {
            self.fallbacks
        } else {
            MOST_DOUBLINGS
        };
        self.persisted = self.persisted.wrapping_add(1);
        if trusted || self.persisted > supervision.return_ticks.wrapping_shl(doublings) {
            self.take_up();
        }
    }

    const fn take_up(&mut self) {
        let fallbacks = self.fallbacks;
        *self = Self::new();
        self.fallbacks = fallbacks;
        self.model = Model::Drive;
    }
}
