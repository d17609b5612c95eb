//! Between setpoint and loop: what the screw does wrong, put right.
//!
//! The setpoint says where the carriage shall be. The encoder has to be elsewhere: by the error of the screw there,
//! and by half the backlash ahead in the direction of motion. [`table`] holds the errors, [`config`] how fast the
//! compensation may change.
//!
//! ```text
//! commanded ─► place ahead ─► table(direction) ─┐ wanted          ┌─────────┐   ┌─────────┐
//!     │      x + v·lag − origin                 +──► rate limit ─►│ 1st lag │──►│ 2nd lag │──► compensation
//!     └─────► direction ─────► ± backlash/2 ────┘    ± feed share └─────────┘   └─────────┘       │
//!     └───────────────────────────────────────────────────────────────────────────────────────────+─► loop
//! ```
//!
//! Signs: the error of a point is carriage less place, so that the compensation is its negative; positive backlash
//! is lost motion, and the compensation is + half of it while moving towards larger positions, − half of it towards
//! smaller ones. The place is counted from the origin that homing found; without an origin nothing is compensated.
//! A compensation that comes into force, or ceases to be, does so by the same path.
//!
//! # It keeps the limits of the axis
//!
//! With R the rate and T ≥ 4 the time constant of either lag, y += (x − y)/T, a lag's step in a tick is a mean of
//! its input's steps with weights that add up to one, so both lags step by at most R: the compensation's velocity.
//! The step of the second changes by (step of the first − its own)/T, by at most 2R/T: its acceleration. These two
//! are taken off the limits that setpoints are planned with ([`Config::setpoint_limits`]), so that their sum stays
//! within the axis's limits whatever table, reversal or change of origin comes, without the compensation having to
//! know where the setpoint will go.
//!
//! The lags cost 2(T − 1) ticks at constant speed. The table is asked for the place so much ahead, so at constant
//! speed over constant slope the compensation is on time; at rest it is exact.

pub mod config;
pub mod table;

pub use config::{CompensationParams, Config, TableRefused};
pub use table::{ScrewError, ScrewPoint, ScrewTable, Stretch, TableError};

use config::LEAD_FRAC;
use table::Here;

use crate::setpoint::Setpoint;
use crate::units::{Acceleration, Position, Velocity};

/// Which way the setpoint went last.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Heading {
    /// Towards larger positions.
    #[default]
    Forward,
    /// Towards smaller positions.
    Backward,
}

impl Heading {
    /// The one of a pair forward, backward.
    #[inline]
    const fn of_pair<T>(self, pair: &[T; 2]) -> &T {
        let [forward, backward] = pair;
        match self {
            Self::Forward => forward,
            Self::Backward => backward,
        }
    }
}

/// The compensation of an axis; `'m` is how long its table lives.
#[derive(Clone, Debug)]
pub struct Compensation<'m> {
    config: Config,
    table: Option<ScrewTable<'m>>,
    /// The stretch of the table used last.
    stretch: usize,
    /// The same with the backlash, as table, origin and heading have it; see [`Self::look_anew`].
    here: Option<Here>,
    /// Half the backlash by the heading, Q12.20 d; 0 without an origin.
    take_up: i32,
    /// Raw position of the zero of machine coordinates, Q48.16 d, once known.
    origin: Option<i64>,
    /// The same, or 0.
    zero: i64,
    heading: Heading,
    /// Farthest that the setpoint went in its direction, low word of Q48.16 d.
    farthest: i32,
    /// What the limiter lets through, Q12.20 d.
    limited: i32,
    /// The lags, Q12.52 d.
    first: i64,
    second: i64,
    /// Last step of the second lag, Q4.28 d/tick.
    velocity: i32,
}

/// Fractional bits of the lags below those of an error.
const LAG_SHIFT: u32 = 32;
const VELOCITY_FRAC: u32 = 28;

impl<'m> Compensation<'m> {
    /// None so far: no origin is known.
    #[must_use]
    pub const fn new(config: Config) -> Self {
        Self {
            config,
            table: None,
            stretch: 0,
            here: None,
            take_up: 0,
            origin: None,
            zero: 0,
            heading: Heading::Forward,
            farthest: 0,
            limited: 0,
            first: 0,
            second: 0,
            velocity: 0,
        }
    }

    /// Takes another configuration; what changes comes into force by the slew. A table that it leaves no room for, or
    /// cannot follow, is let go.
    pub fn reconfigure(&mut self, config: Config) {
        self.config = config;
        self.table = self.table.filter(|table| config.check(table).is_ok());
        self.look_anew();
    }

    /// The table in use.
    #[must_use]
    pub const fn table(&self) -> Option<&ScrewTable<'m>> {
        self.table.as_ref()
    }

    /// Takes a table, or does without; it comes into force by the slew. Outside the tick.
    ///
    /// # Errors
    /// [`TableRefused`] if the compensation cannot follow it at the largest feed; the one before stays.
    pub fn set_table(&mut self, table: Option<ScrewTable<'m>>) -> Result<(), TableRefused> {
        if let Some(table) = &table {
            self.config.check(table)?;
        }
        self.table = table;
        self.look_anew();
        Ok(())
    }

    /// The raw position of the zero of machine coordinates becomes known, or is lost. Neither moves the setpoint by a
    /// step.
    pub fn set_origin(&mut self, origin: Option<Position>) {
        self.origin = origin.map(Position::to_bits);
        self.zero = self.origin.unwrap_or(0);
        self.look_anew();
    }

    /// The raw position of the zero of machine coordinates, d.
    #[must_use]
    pub const fn origin(&self) -> Option<Position> {
        match self.origin {
            Some(origin) => Some(Position::from_bits(origin)),
            None => None,
        }
    }

    /// What is added to the setpoint now, d.
    #[must_use]
    pub const fn amount(&self) -> ScrewError {
        ScrewError::from_bits(self.second.wrapping_shr(LAG_SHIFT) as i32)
    }

    /// Which way the setpoint went last.
    #[must_use]
    pub const fn heading(&self) -> Heading {
        self.heading
    }

    /// Where the carriage is with the encoder at `position`: compensation taken out, from the origin where it is
    /// known.
    #[must_use]
    #[inline]
    pub fn reported(&self, position: Position) -> Position {
        Position::from_bits(
            position
                .to_bits()
                .wrapping_sub(self.amount_as_position())
                .wrapping_sub(self.zero),
        )
    }

    /// For an axis that is not under control at `position` of the encoder: stands still there, and says which
    /// setpoint that is.
    pub fn rest_at(&mut self, position: Position) -> Position {
        let commanded = position.to_bits().wrapping_sub(self.amount_as_position());
        if let (Some(_), Some(table)) = (self.origin, &self.table) {
            // Not on time: an axis turned by hand may pass many stretches in a tick.
            self.stretch = table.find(commanded.wrapping_sub(self.zero));
            self.look_anew();
        }
        self.limited = self.wanted(commanded);
        self.first = i64::from(self.limited).wrapping_shl(LAG_SHIFT);
        self.second = self.first;
        self.velocity = 0;
        let commanded = position.to_bits().wrapping_sub(self.amount_as_position());
        // An axis turned by hand has not reversed: which way its play lies is not known.
        self.farthest = commanded as i32;
        Position::from_bits(commanded)
    }

    /// The setpoint of the encoder that brings the carriage to `commanded`.
    #[inline]
    pub fn step(&mut self, commanded: &Setpoint) -> Setpoint {
        // Not used, and what was once in force is out of it: the axis pays nothing.
        if !self.config.is_used && (self.first | self.second | i64::from(self.velocity)) == 0 {
            return *commanded;
        }
        let position = commanded.position.to_bits();
        self.follow_heading(position as i32);
        // The saturated product of a velocity within ±2¹¹ d/tick and at most 2¹³ ticks.
        let ahead = i64::from(commanded.velocity.to_bits())
            .wrapping_mul(i64::from(self.config.lead))
            .wrapping_shr(Velocity::FRAC_NBITS + LEAD_FRAC - Position::FRAC_NBITS);
        let wanted = self.wanted(position.wrapping_add(ahead));
        let acceleration = self.move_towards(wanted);
        Setpoint {
            position: Position::from_bits(position.wrapping_add(self.amount_as_position())),
            velocity: Velocity::from_bits(commanded.velocity.to_bits().saturating_add(rounded::<
                { VELOCITY_FRAC - Velocity::FRAC_NBITS },
            >(
                self.velocity,
            ))),
            acceleration: Acceleration::from_bits(commanded.acceleration.to_bits().saturating_add(
                rounded::<{ VELOCITY_FRAC - Acceleration::FRAC_NBITS }>(acceleration),
            )),
            jerk: commanded.jerk,
            turn: commanded.turn,
        }
    }

    /// A motion backward by more than the reversal turns the direction.
    #[inline]
    fn follow_heading(&mut self, position: i32) {
        let moved = position.wrapping_sub(self.farthest);
        let onward = match self.heading {
            Heading::Forward => moved,
            Heading::Backward => moved.wrapping_neg(),
        };
        if onward >= 0 {
            self.farthest = position;
        } else if onward < self.config.reversal.wrapping_neg() {
            self.farthest = position;
            self.heading = match self.heading {
                Heading::Forward => Heading::Backward,
                Heading::Backward => Heading::Forward,
            };
            self.look_anew();
        }
    }

    /// Puts together what the place is looked up in: after any change of table, stretch, origin, heading or backlash.
    #[cold]
    #[inline(never)]
    fn look_anew(&mut self) {
        let half = self.config.half_backlash;
        self.take_up = match (self.origin, self.heading) {
            (None, _) => 0,
            (Some(_), Heading::Forward) => half,
            (Some(_), Heading::Backward) => half.wrapping_neg(),
        };
        self.here = None;
        if let (Some(origin), Some(table)) = (self.origin, &self.table) {
            self.stretch = self.stretch.min(table.points().saturating_sub(2));
            self.here = table.here(self.stretch, self.heading, origin, self.take_up);
        }
    }

    /// What the compensation should be for a carriage at raw position `place`, Q12.20 d.
    #[inline]
    fn wanted(&mut self, place: i64) -> i32 {
        let Some(here) = &self.here else {
            return self.take_up;
        };
        match here.value_within(place) {
            Some(value) => value,
            None => self.move_on(place),
        }
    }

    /// Goes on by a stretch: the compensation is that of its nearer end until it has come to the place.
    #[cold]
    #[inline(never)]
    fn move_on(&mut self, place: i64) -> i32 {
        if let (Some(here), Some(table)) = (&self.here, &self.table) {
            self.stretch = table.neighbour(self.stretch, here.is_below(place));
            self.look_anew();
        }
        (self.here).map_or(self.take_up, |here| here.value_at_nearest(place))
    }

    /// One tick towards `wanted`; gives the change of velocity, Q4.28 d/tick². Errors stay within ±1 500 d, and so
    /// do the limiter and the lags behind it.
    #[inline]
    fn move_towards(&mut self, wanted: i32) -> i32 {
        let rate = self.config.rate;
        let gap = wanted.wrapping_sub(self.limited);
        self.limited = self
            .limited
            .wrapping_add(gap.max(rate.wrapping_neg()).min(rate));
        self.first = self
            .first
            .wrapping_add(self.step_of(self.limited, self.first));
        let first = self.first.wrapping_shr(LAG_SHIFT) as i32;
        let step = self.step_of(first, self.second);
        self.second = self.second.wrapping_add(step);
        let velocity = step.wrapping_shr(LAG_SHIFT + ScrewError::FRAC_NBITS - VELOCITY_FRAC) as i32;
        let acceleration = velocity.wrapping_sub(self.velocity);
        self.velocity = velocity;
        acceleration
    }

    /// A lag's step towards `input`, Q12.52 d: zero as soon as its whole units are those of the input.
    #[inline]
    fn step_of(&self, input: i32, lag: i64) -> i64 {
        let behind = input.wrapping_sub(lag.wrapping_shr(LAG_SHIFT) as i32);
        i64::from(behind).wrapping_mul(i64::from(self.config.weight))
    }

    /// The compensation, Q48.16 d.
    #[inline]
    fn amount_as_position(&self) -> i64 {
        const BITS: u32 = ScrewError::FRAC_NBITS - Position::FRAC_NBITS;
        i64::from(rounded::<BITS>(self.amount().to_bits()))
    }
}

/// `value` / 2^`BITS` to nearest; the value is far from the end of its format.
#[inline]
const fn rounded<const BITS: u32>(value: i32) -> i32 {
    value
        .wrapping_add(1 << (BITS.wrapping_sub(1)))
        .wrapping_shr(BITS)
}
