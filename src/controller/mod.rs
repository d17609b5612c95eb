//! From setpoint and estimate to a demand on the drive: PID with feedforward and corrective links.
//!
//! ```text
//! u = filtered( kp·e + ki·Σe + kd·Δe                PID on position, e = x_set − x
//!             + kv·(v_ref − v̂) + ka·(a_ref − â) )   the papers' corrective links (P2)
//!   + ff_v·v⁺ + ff_a·a⁺ + ff_j·j                    feedforward
//!   + learned shares of these three terms
//!   + friction(v⁺), at rest a push + bias
//!   + transfer                                      decays to zero, see below
//! ```
//!
//! The feedforward is for the instant at which the command arrives: v⁺ = v + τ·a + τ²·j/2 and a⁺ = a + τ·j, the setpoint
//! τ ahead ([`config::Gains::feedforward_lead`]), folded into the weights; [`turning`] adds what a change of the jerk within τ makes of it, and
//! [`learning`] what the drive shows it to be short of. [`filter`] holds what the feedback part passes through, [`friction`] the
//! feedforward against friction, [`rest`] what is done about a standing error; all cost next to nothing where they are off.
//!
//! An estimate holds for an instant `lag` ticks ago, so the links compare it with the setpoint of that
//! instant: v_ref = v − lag_v·a + ⟨lag_v²⟩·j/2, a_ref = a − lag_a·j, where ⟨lag_v²⟩ is the mean square age of
//! what the velocity is made of ([`Delay`](crate::estimator::Delay)). Since an estimator's lags are known
//! beforehand, [`Config`] folds them into the weights of a and j.
//!
//! At enable and at a change of parameters the law would jump; the jump is taken up by `transfer`,
//! which then decays geometrically, so the output stays continuous. Integration stops while the output
//! is limited in the direction in which the error would drive it further, and at rest where static friction holds the axis
//! ([`rest`]); the [`integral`] itself stays within ±1.

pub mod biquad;
pub mod config;
pub mod dead_time;
pub mod filter;
pub mod friction;
pub mod integral;
pub mod learning;
pub mod params;
pub mod rest;
pub mod turning;
mod weights;

pub use config::Config;

use crate::estimator::Estimate;
use crate::narrowing::within_or_high;
use crate::output::ActiveLimits;
use crate::setpoint::Setpoint;
use crate::units::{Command, Position};

use crate::estimator::saturate;
use rest::Verdict;

/// Following error x_set − x in Q15.16 d; saturates at ±32 768 d.
pub type FollowingError = fixed::types::I16F16;

/// Controller state.
#[derive(Clone, Debug)]
pub struct Controller {
    config: Config,
    /// ki·Σe.
    integral: integral::State,
    /// Error of the previous tick, less the deadband.
    previous_error: i32,
    previous_following_error: i32,
    /// There was no previous tick.
    fresh: bool,
    /// Ticks for which the setpoint has been slow; counts no further than it matters.
    slow_ticks: u32,
    was_calm: bool,
    filter: filter::State,
    friction: friction::State,
    rest: rest::State,
    /// What of the last demand goes against friction or into the dead time, and what was learned, Q.30.
    withheld: i32,
    dead_time: dead_time::State,
    /// There is a jump to be taken up: `start_from` is set, or something is left in `transfer`.
    jumps: bool,
    /// What is left of the last jump of the law, Q.30; a jump across the range of a command needs 33 bits.
    transfer: i64,
    /// The next demand is to start from this output.
    start_from: Option<Command>,
    learning: learning::State,
}

/// What a tick's law is made of.
#[derive(Clone, Copy)]
struct Tick<'a> {
    setpoint: &'a Setpoint,
    estimate: &'a Estimate,
    active: ActiveLimits,
    /// Following error less the deadband, and its change.
    error: i32,
    change: i32,
}

/// What the controller asks for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Demand {
    /// Demand in fractions of full command, before the limits of the output.
    pub command: Command,
    /// Setpoint less measured position, d.
    pub following_error: FollowingError,
}

impl Controller {
    /// A controller that starts with its output at zero.
    #[must_use]
    pub const fn new(config: Config) -> Self {
        Self {
            config,
            integral: integral::State::new(),
            slow_ticks: u32::MAX,
            was_calm: true,
            filter: filter::State::new(),
            friction: friction::State::new(),
            rest: rest::State::new(),
            withheld: 0,
            dead_time: dead_time::State::new(),
            previous_error: 0,
            previous_following_error: 0,
            fresh: true,
            jumps: true,
            transfer: 0,
            start_from: Some(Command::ZERO),
            learning: learning::State::new(),
        }
    }

    /// Forgets everything but what it learned of the drive; the next demand starts from zero.
    pub fn reset(&mut self) {
        let learning = self.learning.clone();
        *self = Self::new(self.config);
        self.learning = learning;
    }

    /// Takes new parameters; the demand goes on from `output` without a step.
    pub fn reconfigure(&mut self, config: Config, output: Command) {
        if config.learning != self.config.learning {
            self.learning = learning::State::new();
        }
        self.config = config;
        // A new deadband must not look like a change of the error.
        self.previous_error = config.apply_deadband(self.previous_following_error);
        self.start_from = Some(output);
        self.jumps = true;
    }

    /// Takes what a tick shows beside what [`step`](Self::step) acts on: by how much the count changed, and what an observer is
    /// told of the command of the tick just past, with what came of it.
    #[inline]
    pub fn note(&mut self, delta: i32, command: Option<Command>, estimate: &Estimate) {
        self.rest.note(delta);
        if self.config.learning.is_on() {
            self.learning.note(&self.config.learning, command, estimate);
        }
    }

    /// By which shares the drive asks for more of the feedforward's terms of v, a and j than they give.
    #[must_use]
    pub fn learned(&self) -> [f64; 3] {
        self.learning.shares()
    }

    /// One tick: `position` is the measured position, `estimate` gives velocity and acceleration, and
    /// `active` are the limits that held the output of the previous tick.
    pub fn step(
        &mut self,
        setpoint: &Setpoint,
        position: Position,
        estimate: &Estimate,
        active: ActiveLimits,
    ) -> Demand {
        let behind = setpoint.position.to_bits().wrapping_sub(position.to_bits());
        let following_error = FollowingError::from_bits(saturate(behind));
        let error = self.config.apply_deadband(following_error.to_bits());
        if self.fresh {
            self.fresh = false;
            self.previous_error = error;
        }
        let change = error.saturating_sub(self.previous_error);
        self.previous_error = error;
        self.previous_following_error = following_error.to_bits();
        let tick = Tick {
            setpoint,
            estimate,
            active,
            error,
            change,
        };
        let command = match self.at_rest(setpoint, error) {
            None => self.law(tick, None),
            Some(verdict) => self.law_at_rest(setpoint, estimate, active, [error, change], verdict),
        };
        Demand {
            command: Command::from_bits(command),
            following_error,
        }
    }

    // Taken apart: what is handed on as it came has to be in memory in every tick.
    #[inline(never)]
    fn law_at_rest(
        &mut self,
        setpoint: &Setpoint,
        estimate: &Estimate,
        active: ActiveLimits,
        [error, change]: [i32; 2],
        verdict: Verdict,
    ) -> i32 {
        let tick = Tick {
            setpoint,
            estimate,
            active,
            error,
            change,
        };
        self.law(tick, Some(verdict))
    }

    /// The law, Q.30. Inlined once for motion, where nothing has to be asked about rest, and once for that.
    #[inline(always)]
    fn law(&mut self, tick: Tick<'_>, at_rest: Option<Verdict>) -> i32 {
        let Tick {
            setpoint,
            estimate,
            active,
            error,
            change,
        } = tick;
        let signals = [
            error,
            change,
            estimate.velocity.to_bits(),
            estimate.acceleration.to_bits(),
            setpoint.velocity.to_bits(),
            setpoint.acceleration.to_bits(),
            setpoint.jerk.to_bits(),
        ];
        // The jerk may change within the feedforward's lead.
        let turns = setpoint.turn.ticks <= self.config.horizon;
        let calm = self.is_calm(error, setpoint);
        if calm != self.was_calm {
            self.was_calm = calm;
            if at_rest == Some(Verdict::Within) {
                self.keep_push(calm, error);
            }
        }
        let set = if calm {
            &self.config.calm
        } else {
            &self.config.moving
        };
        if self.integrates(at_rest) {
            let increment = i64::from(error).wrapping_mul(i64::from(set.integral_gain));
            // Not further into a limit of the output.
            if !(active.is_limited()
                && (increment > 0 && active.high || increment < 0 && active.low))
            {
                self.integral.add(increment);
            }
        }
        let mut law = set.weigh(&signals, self.integral.value());
        if self.config.filter.is_on() {
            law = self.filtered(law, setpoint);
        }
        if turns {
            law = law.saturating_add(self.config.turning.command(setpoint));
        }
        let mut withheld = 0;
        if self.config.friction.is_on() {
            (law, withheld) = self.against_friction(law, tick, turns, at_rest);
        }
        let mut lost = 0;
        if self.config.dead_time.is_on() {
            let config = &self.config.dead_time;
            (law, lost) = self
                .dead_time
                .step(config, law, withheld, at_rest.is_some());
        }
        if self.config.learning.is_on() {
            let config = &self.config.learning;
            if self.learning.is_due(config, setpoint) {
                let changed = self.learning.learn(config, setpoint);
                self.integral.give_way(changed);
            }
            let added = self.learning.add(setpoint, turns);
            law = law.saturating_add(added);
            withheld = withheld.saturating_add(added);
        }
        self.withheld = withheld.saturating_add(lost);
        if self.jumps {
            self.without_jump(law)
        } else {
            law
        }
    }

    /// What of the last demand an observer of the nominal drive is not told: what goes against friction or falls into the
    /// drive's dead time, and moves nothing, and what the drive was found to need beyond the nominal feedforward.
    #[inline]
    #[must_use]
    pub const fn withheld(&self) -> Command {
        Command::from_bits(self.withheld)
    }

    /// Other gains on an `error` that stays as it is: the integral takes over what they give less. What they make of the
    /// estimates is not kept: held on an axis that still moves it would throw it.
    #[cold]
    fn keep_push(&mut self, calm: bool, error: i32) {
        let Config {
            moving, calm: slow, ..
        } = &self.config;
        let (before, after) = if calm { (moving, slow) } else { (slow, moving) };
        let signals = [error, 0, 0, 0, 0, 0, 0];
        let less = before
            .weigh(&signals, 0)
            .saturating_sub(after.weigh(&signals, 0));
        self.integral.take(less);
    }

    /// What is to become of an `error` at rest; `None` in motion, or if one is about to start.
    #[inline]
    fn at_rest(&mut self, setpoint: &Setpoint, error: i32) -> Option<Verdict> {
        if is_at_rest(setpoint) && !self.config.friction.is_due(setpoint) {
            if self.rest.enter() && self.config.learning.is_on() {
                self.integral.rest();
            }
            return Some(self.rest.judge(&self.config.rest, error));
        }
        if self.rest.leave() {
            self.integral.start(self.config.held);
        }
        None
    }

    /// The error is integrated.
    #[inline]
    const fn integrates(&self, at_rest: Option<Verdict>) -> bool {
        match at_rest {
            None | Some(Verdict::Far) => true,
            Some(Verdict::Near) => !self.config.rest.pushes(),
            Some(Verdict::Within) => false,
        }
    }

    /// `law` with what goes against friction, and that itself: in motion a level that goes with the setpoint; at rest, where an
    /// error stands, a push in place of the law, of which static friction takes up what it can.
    #[inline(always)]
    fn against_friction(
        &mut self,
        law: i32,
        tick: Tick<'_>,
        turns: bool,
        at_rest: Option<Verdict>,
    ) -> (i32, i32) {
        match at_rest {
            Some(verdict @ (Verdict::Within | Verdict::Near)) if self.config.rest.pushes() => {
                self.pushed(law, tick.error, verdict, tick.estimate.velocity.to_bits())
            }
            _ => {
                let config = &self.config.friction;
                let level = self
                    .friction
                    .step_where(config, tick.setpoint, turns, &self.learning);
                (law.saturating_add(level), level)
            }
        }
    }

    #[inline(never)]
    fn pushed(&mut self, law: i32, error: i32, verdict: Verdict, velocity: i32) -> (i32, i32) {
        self.friction.let_go();
        let bias = self.config.bias;
        let held = self.learning.scaled(self.config.rest.held());
        let standing = rest::Standing {
            error,
            verdict,
            law: law.saturating_sub(bias),
            held,
            velocity,
        };
        let law = law.saturating_add(self.rest.push(&self.config.rest, &standing));
        let withheld = law.saturating_sub(bias);
        (law, within_or_high(withheld, held.wrapping_neg(), held))
    }

    /// The feedback part through the filters, and what passes by them.
    #[inline(never)]
    fn filtered(&mut self, feedback: i32, setpoint: &Setpoint) -> i32 {
        let config = &self.config;
        if self.jumps && self.start_from.is_some() {
            self.filter = filter::State::steady(&config.filter, feedback);
        }
        let filtered = self.filter.step(&config.filter, feedback);
        let setpoints = [
            setpoint.velocity.to_bits(),
            setpoint.acceleration.to_bits(),
            setpoint.jerk.to_bits(),
        ];
        config.ahead(&setpoints).saturating_add(filtered)
    }

    /// Whether the gains for slow motion count.
    #[inline]
    fn is_calm(&mut self, error: i32, setpoint: &Setpoint) -> bool {
        let speed = setpoint.velocity.to_bits().saturating_abs();
        if speed > self.config.calm_speed {
            self.slow_ticks = 0;
            return false;
        }
        let was_calm = self.slow_ticks >= self.config.calm_ticks;
        // Eight times as much to leave as to come: the other gains, at rest, may be what makes the error.
        let bound = if was_calm {
            self.config.calm_error.saturating_mul(8)
        } else {
            self.config.calm_error
        };
        self.slow_ticks = if error.saturating_abs() <= bound {
            self.slow_ticks.saturating_add(1)
        } else {
            0
        };
        self.slow_ticks >= self.config.calm_ticks
    }

    /// Adds the transfer term, which starts as whatever keeps the output where it was.
    #[cold]
    fn without_jump(&mut self, law: i32) -> i32 {
        self.transfer = match self.start_from.take() {
            Some(output) => i64::from(output.to_bits()).wrapping_sub(i64::from(law)),
            None => decayed(self.transfer, self.config.transfer_decay),
        };
        self.jumps = self.transfer != 0;
        saturate(i64::from(law).wrapping_add(self.transfer))
    }
}

/// The setpoint stands.
#[inline]
const fn is_at_rest(setpoint: &Setpoint) -> bool {
    setpoint.velocity.to_bits() | setpoint.acceleration.to_bits() | setpoint.jerk.to_bits() == 0
}

/// `value`·`factor`/2³¹ rounded towards zero, so that it ends at zero; |value| < 2³².
fn decayed(value: i64, factor: u32) -> i64 {
    let magnitude = value.unsigned_abs() as u32;
    let left = u64::from(magnitude)
        .wrapping_mul(u64::from(factor))
        .wrapping_shr(31)
        .cast_signed();
    if value < 0 { left.wrapping_neg() } else { left }
}
