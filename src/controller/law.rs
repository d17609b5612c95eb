//! The law of a tick: the terms in their order, each with what it costs only where it is on.

use super::rest::Verdict;
use super::{Config, Controller, filter, rest};
use crate::estimator::{Estimate, saturate};
use crate::narrowing::within_or_high;
use crate::output::ActiveLimits;
use crate::setpoint::Setpoint;

/// What a tick's law is made of.
#[derive(Clone, Copy)]
pub(super) struct Tick<'a> {
    pub(super) setpoint: &'a Setpoint,
    pub(super) estimate: &'a Estimate,
    pub(super) active: ActiveLimits,
    /// Following error less the deadband, and its change.
    pub(super) error: i32,
    pub(super) change: i32,
}

impl Controller {
    // Taken apart: what is handed on as it came has to be in memory in every tick.
    #[inline(never)]
    pub(super) fn law_at_rest(
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
    pub(super) fn law(&mut self, tick: Tick<'_>, at_rest: Option<Verdict>) -> i32 {
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
    pub(super) fn at_rest(&mut self, setpoint: &Setpoint, error: i32) -> Option<Verdict> {
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
