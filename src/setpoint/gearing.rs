//! Electronic gearing: the axis follows the master by an exact ratio.
//!
//! x = x₀ + N/D·m. Whole counts of the master go through an exact [`Ratio`], so that the phase never drifts; where the
//! master stands between two counts comes from its estimate, as do velocity and acceleration, so that the axis is told
//! where it has to be now, not where it had to be.
//!
//! **Phase.** The gear locks at the phase that comes of the moment of engaging: x₀ is not chosen. From then on it is kept
//! exactly, but engaged anew the gear locks at another one. A phase that is given beforehand would need a run-up whose
//! end does not depend on what the master's speed does in it, that is one over the master's angle; then a master that
//! stands could not be engaged. Where the phase counts, as against an index, [a thread](super::thread) has such a run-up.
//!
//! The gear is engaged while the master turns: over N ticks, planned from the master's speed and the limits of the axis,
//! a [weight](super::run_up) of the master's motion goes from 0 to 1, and x₀ is what comes of it. Disengaging is the same
//! from 1 to 0. A master that asks for more than the largest velocity, or for more than 1¼ of the largest acceleration, is not
//! followed: the source is lost, and with it the phase.

use super::Setpoint;
use super::master::Master;
use super::profile::Limits;
use super::ratio::{Carried, MAX_STEP, Ratio};
use super::run_up::{self, Followed, RATE_FRAC, Weight};
use crate::estimator::saturate;
use crate::parameter_table;
use crate::parameter_table::ParameterTable;
use crate::units::{Acceleration, Jerk, Position, RangeError, Velocity};

parameter_table! {
    /// Electronic gearing: so many d of the axis for so many of the master, exactly.
    pub struct GearingParams {
        /// Ratio of the gear, numerator; negative turns the direction round
        gear_axis_counts: 1.0, "d", -1048576.0..=1048576.0;
        /// Ratio of the gear, denominator
        gear_master_counts: 1.0, "d of the master", 1.0..=1048576.0;
    }
}

/// Quantised parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Config {
    ratio: Ratio,
}

impl GearingParams {
    /// Validates and quantises.
    ///
    /// # Errors
    /// [`RangeError`] naming the parameter that is out of range.
    pub fn quantise(&self) -> Result<Config, RangeError> {
        self.check()?;
        Ok(Config {
            ratio: Ratio::new(
                ("gear_axis_counts", self.gear_axis_counts),
                ("gear_master_counts", self.gear_master_counts),
            )?,
        })
    }
}

/// How far the gear is engaged.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Gear {
    /// The axis stands.
    #[default]
    Open,
    /// On its way to the master's speed.
    Engaging,
    /// Locked to the master's phase.
    Locked,
    /// On its way to rest.
    Disengaging,
}

/// The setpoint by the master.
#[derive(Clone, Debug)]
pub struct Gearing {
    config: Config,
    gear: Gear,
    run_up: RunUp,
    carried: Carried,
    /// Where whole counts led, and where the setpoint is, 2⁻¹⁶ d.
    geared: i64,
    /// The same with the part of a count, at the last tick.
    last: i64,
    /// Setpoint less [`Self::last`], 2⁻⁴⁶ d.
    offset: i128,
    velocity: i32,
    /// Largest velocity and acceleration that are followed.
    largest: (i64, i64),
    /// Largest way of a tick, 2⁻¹⁶ d: a count more or less than the velocity says is no jump.
    largest_way: u64,
    is_lost: bool,
}

/// A run-up over time.
#[derive(Clone, Copy, Debug, Default)]
struct RunUp {
    tick: u32,
    ticks: u32,
    /// 2³⁰/ticks, rounded down.
    step: u32,
}

impl RunUp {
    fn new(velocity: Velocity, limits: &Limits) -> Self {
        let ticks = libm::ceil(run_up::ticks(
            velocity.to_num::<f64>().abs(),
            limits.acceleration().to_num(),
            limits.jerk().to_num(),
        ));
        let ticks = ticks.min(MAX_RUN_UP_TICKS);
        Self {
            tick: 0,
            ticks: ticks as u32,
            step: (f64::from(run_up::ONE) / ticks) as u32,
        }
    }

    /// u, Q.30, half a tick ago if `is_middle`, and its rate, Q.33.
    fn at(&self, is_middle: bool) -> (i32, i32) {
        let doubled = self.tick.wrapping_mul(2).wrapping_sub(u32::from(is_middle));
        let u = u64::from(doubled).wrapping_mul(u64::from(self.step));
        (
            u.wrapping_shr(1).min(run_up::ONE as u64) as i32,
            self.step
                .wrapping_shl(RATE_FRAC - run_up::FRAC)
                .cast_signed(),
        )
    }
}

/// Longest run-up, ticks.
const MAX_RUN_UP_TICKS: f64 = 16_777_216.0;

impl Gearing {
    /// Open, at 0 d, within `limits`.
    #[must_use]
    pub fn new(config: Config, limits: &Limits) -> Self {
        let acceleration = i64::from(limits.acceleration().to_bits());
        Self {
            config,
            gear: Gear::Open,
            run_up: RunUp::default(),
            carried: Carried::ZERO,
            geared: 0,
            last: 0,
            offset: 0,
            velocity: 0,
            largest: (
                i64::from(limits.velocity().to_bits()),
                acceleration.wrapping_add(acceleration.wrapping_shr(2)),
            ),
            largest_way: i64::from(limits.velocity().to_bits())
                .wrapping_shr(Velocity::FRAC_NBITS - Position::FRAC_NBITS)
                .wrapping_add(config.ratio.of(2 << Position::FRAC_NBITS).wrapping_abs())
                .unsigned_abs(),
            is_lost: false,
        }
    }

    /// Opens the gear at once and stands at `position`.
    pub fn start(&mut self, position: Position) {
        self.gear = Gear::Open;
        self.is_lost = false;
        self.velocity = 0;
        self.carried = Carried::ZERO;
        (self.geared, self.last) = (0, 0);
        self.offset = i128::from(position.to_bits()).wrapping_shl(run_up::FRAC);
    }

    /// Engages an open gear, or disengages a locked one, planned by the master's speed and `limits`. Outside the tick.
    /// False if the gear is in neither state.
    pub fn engage(&mut self, engaged: bool, master: &Master, limits: &Limits) -> bool {
        let next = match (self.gear, engaged) {
            (Gear::Open, true) => Gear::Engaging,
            (Gear::Locked, false) => Gear::Disengaging,
            _ => return false,
        };
        let velocity = self.config.ratio.of(master.estimate().velocity.to_bits());
        self.run_up = RunUp::new(Velocity::from_bits(saturate(velocity)), limits);
        self.gear = next;
        true
    }

    /// How far the gear is engaged.
    #[must_use]
    pub const fn gear(&self) -> Gear {
        self.gear
    }

    /// True while the gear goes in or out, and while a master that moves is followed.
    #[must_use]
    pub const fn is_moving(&self) -> bool {
        match self.gear {
            Gear::Open => false,
            Gear::Engaging | Gear::Disengaging => true,
            Gear::Locked => self.velocity != 0,
        }
    }

    /// True from the first tick in which the master was gone or asked for more than the axis can do.
    #[must_use]
    pub const fn is_lost(&self) -> bool {
        self.is_lost
    }

    /// The setpoint of this tick.
    pub fn step(&mut self, master: &Master) -> Setpoint {
        let ratio = &self.config.ratio;
        let delta = master.delta();
        let fits = delta.unsigned_abs() < MAX_STEP.unsigned_abs();
        let step = if fits { delta } else { 0 };
        let counted = ratio.step(&mut self.carried, step);
        self.geared = self.geared.wrapping_add(counted);
        let place = self.geared.wrapping_add(ratio.of(master.part()));
        let estimate = master.estimate();
        let velocity = ratio.of(estimate.velocity.to_bits());
        let acceleration = ratio.of(estimate.acceleration.to_bits());
        let is_followable = fits
            && master.is_present()
            && counted.unsigned_abs() <= self.largest_way
            && velocity.unsigned_abs() <= self.largest.0.unsigned_abs()
            && acceleration.unsigned_abs() <= self.largest.1.unsigned_abs();
        let followed = Followed {
            velocity: saturate(velocity),
            acceleration: saturate(acceleration),
        };
        if self.gear != Gear::Open && !is_followable {
            self.is_lost = true;
        }
        let way = place.wrapping_sub(self.last);
        self.last = place;
        let mut setpoint = match self.gear {
            Gear::Locked => Setpoint {
                velocity: Velocity::from_bits(followed.velocity),
                acceleration: Acceleration::from_bits(followed.acceleration),
                jerk: Jerk::ZERO,
                ..Setpoint::default()
            },
            _ => self.slip(way, &followed),
        };
        self.velocity = setpoint.velocity.to_bits();
        let offset = self.offset.wrapping_shr(run_up::FRAC) as i64;
        setpoint.position = Position::from_bits(place.wrapping_add(offset));
        setpoint
    }

    /// Follows a share of the master's `way`, 2⁻¹⁶ d.
    #[inline(never)]
    fn slip(&mut self, way: i64, followed: &Followed) -> Setpoint {
        let is_engaging = self.gear == Gear::Engaging;
        if self.gear == Gear::Open {
            self.offset = self
                .offset
                .wrapping_sub(i128::from(way).wrapping_shl(run_up::FRAC));
            return Setpoint::default();
        }
        self.run_up.tick = self.run_up.tick.wrapping_add(1);
        let weight = |(u, rate): (i32, i32)| {
            if is_engaging {
                Weight::at(u, rate)
            } else {
                Weight::at(run_up::ONE.wrapping_sub(u), rate.wrapping_neg())
            }
        };
        let middle = weight(self.run_up.at(true)).value;
        let not_followed = run_up::ONE.wrapping_sub(middle);
        self.offset = self
            .offset
            .wrapping_sub(i128::from(way).wrapping_mul(i128::from(not_followed)));
        if self.run_up.tick >= self.run_up.ticks {
            self.gear = if is_engaging {
                Gear::Locked
            } else {
                Gear::Open
            };
            // A whole LSB of the position, so that nothing of it is left to round from now on.
            self.offset = self
                .offset
                .wrapping_shr(run_up::FRAC)
                .wrapping_shl(run_up::FRAC);
        }
        weight(self.run_up.at(false)).of(followed)
    }
}
