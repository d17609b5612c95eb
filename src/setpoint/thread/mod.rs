//! Thread cutting: a line fixed by the spindle's angle, reached and left over angles.
//!
//! ```text
//! x ┤                    ┌── rest
//!   │                 .'    run-out over an angle
//!   │               /    ← retraction is requested
//!   │             /  line x = L·(θ − θ₀)/360°
//!   │         .·'    run-in over an angle: a weight of the spindle's motion
//!   ├─ start ┘       waits here, always come to from the same side
//!   └────────┴──────────────────── θ
//! ```
//!
//! Run-in and run-out are functions of the spindle's angle alone, not of time, so the phase of the thread does not depend
//! on the speed, nor on how it changes; where the run-in begins is planned outside the tick from the index. Velocity
//! and acceleration are those of the spindle's estimate by the chain rule. A spindle that gives no signal, turns back,
//! leaves the speeds planned for or loses counts ends the pass: [`SpindleTrouble`].

mod order;
mod plan;
mod reach;

pub use order::{SpindleWay, ThreadFigures, ThreadOrder, ThreadParams, ThreadRefusal};
pub use plan::{Config, Plan};
pub use reach::{Standing, ThreadPlace};

use super::Setpoint;
use super::master::Master;
use super::run_up::{self, Followed, RATE_FRAC, Weight};
use super::trajectory::Trajectory;
use crate::estimator::saturate;
use crate::units::{Acceleration, Position, Velocity};
use plan::PER_RAMP_FRAC;

/// How far a pass has come.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ThreadPhase {
    /// None is under way.
    #[default]
    Idle,
    /// On the way to the start, or settling there.
    Approaching,
    /// Waiting for the spindle's angle.
    Armed,
    /// On the way to the line.
    RunIn,
    /// On the line.
    Cutting,
    /// On the way to rest.
    RunOut,
}

/// What was wrong with the spindle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpindleTrouble {
    /// No capture, or no valid signal on its lines.
    NoSignal,
    /// An index came elsewhere than counted, or did not come.
    IndexSlipped,
    /// It turned slower than the plan allows for, or back.
    TooSlow,
    /// It turned faster than the plan allows for.
    TooFast,
    /// Its count moved by far less or more in a tick than its speed says.
    Jumped,
}

/// A pass of a thread.
// The plan is large, and so comes last.
#[derive(Clone, Debug, Default)]
#[repr(C)]
pub struct Thread {
    phase: ThreadPhase,
    /// The second leg of the approach has been queued.
    is_last_leg: bool,
    settle: u32,
    /// Speed of the spindle at the last tick, along its way, 2⁻²⁰ d/tick.
    speed: i32,
    retract: bool,
    trouble: Option<SpindleTrouble>,
    plan: Plan,
}

impl Thread {
    /// No pass.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Takes a pass; the first leg of its approach has been queued.
    pub fn arm(&mut self, plan: &Plan) {
        *self = Self {
            plan: *plan,
            phase: ThreadPhase::Approaching,
            settle: plan.settle,
            ..Self::default()
        };
    }

    /// Ends the pass; what was wrong with the spindle is kept.
    pub const fn end(&mut self) {
        self.phase = ThreadPhase::Idle;
        self.retract = false;
    }

    /// How far the pass has come.
    #[must_use]
    pub const fn phase(&self) -> ThreadPhase {
        self.phase
    }

    /// The tool is to be retracted now, by another axis; until the pass ends.
    #[must_use]
    pub const fn retract(&self) -> bool {
        self.retract
    }

    /// What was wrong with the spindle in the last pass.
    #[must_use]
    pub const fn trouble(&self) -> Option<SpindleTrouble> {
        self.trouble
    }

    /// The setpoint of tick `tick`; `None` if the spindle cannot be followed.
    pub fn step(
        &mut self,
        tick: u32,
        master: &Master,
        trajectory: &mut Trajectory,
    ) -> Option<Setpoint> {
        if self.phase == ThreadPhase::Approaching {
            return Some(self.approach(tick, master, trajectory));
        }
        let velocity = master.estimate().velocity.to_bits();
        let speed = if self.plan.way < 0 {
            velocity.saturating_neg()
        } else {
            velocity
        };
        self.trouble = self.judge(master, speed);
        self.speed = speed;
        if self.trouble.is_some() {
            return None;
        }
        let angle = self.angle(master);
        Some(self.at(angle, speed, master))
    }

    /// Where the spindle is from where the run-in begins, along its way.
    #[inline]
    fn angle(&self, master: &Master) -> i64 {
        let place = master.estimate().position.to_bits();
        place
            .wrapping_sub(self.plan.begin)
            .wrapping_mul(self.plan.way)
    }

    /// Goes to the start from one side; meanwhile the begin keeps ahead of the spindle.
    #[cold]
    #[inline(never)]
    fn approach(&mut self, tick: u32, master: &Master, trajectory: &mut Trajectory) -> Setpoint {
        let setpoint = trajectory.step(tick);
        // Two ticks before the begin the next revolution is waited for.
        let margin = i64::from(self.plan.speeds.1)
            .wrapping_shr(Velocity::FRAC_NBITS - Position::FRAC_NBITS - 1);
        if self.angle(master) > margin.wrapping_neg() {
            let turn = self.plan.turn.wrapping_mul(self.plan.way);
            self.plan.begin = self.plan.begin.wrapping_add(turn);
        }
        let velocity = i64::from(master.estimate().velocity.to_bits());
        self.speed = saturate(velocity.wrapping_mul(self.plan.way));
        if !trajectory.is_moving() {
            if !self.is_last_leg {
                self.is_last_leg = true;
                let [_, last] = &self.plan.approach;
                // The first leg is over, and nothing else can have been queued.
                let _ = trajectory.queue(last, tick.wrapping_add(1), tick);
            } else if self.settle > 0 {
                self.settle = self.settle.wrapping_sub(1);
            } else {
                self.phase = ThreadPhase::Armed;
            }
        }
        setpoint
    }

    /// What is wrong with the spindle, which turned at [`Self::speed`] a tick ago and at `speed` now.
    #[inline]
    fn judge(&self, master: &Master, speed: i32) -> Option<SpindleTrouble> {
        let (slowest, fastest) = self.plan.speeds;
        let delta = i64::from(master.delta()).wrapping_mul(self.plan.way);
        let gap = delta
            .wrapping_shl(Velocity::FRAC_NBITS)
            .wrapping_sub(i64::from(self.speed));
        let largest_gap = i64::from(fastest)
            .wrapping_shr(2)
            .wrapping_add(JUMP_COUNTS << Velocity::FRAC_NBITS);
        if !master.is_present() {
            Some(SpindleTrouble::NoSignal)
        } else if master.is_slipped() {
            Some(SpindleTrouble::IndexSlipped)
        } else if gap.unsigned_abs() > largest_gap.unsigned_abs() {
            Some(SpindleTrouble::Jumped)
        } else if speed < slowest {
            Some(SpindleTrouble::TooSlow)
        } else if speed > fastest {
            Some(SpindleTrouble::TooFast)
        } else {
            None
        }
    }

    /// The setpoint at an angle.
    #[inline]
    fn at(&mut self, angle: i64, speed: i32, master: &Master) -> Setpoint {
        let plan = &self.plan;
        self.retract = angle >= plan.retract && angle >= plan.ramp;
        let followed = Followed {
            velocity: saturate(plan.factor.of(master.estimate().velocity.to_bits())),
            acceleration: saturate(plan.factor.of(master.estimate().acceleration.to_bits())),
        };
        if angle >= plan.ramp && angle < plan.end {
            self.phase = ThreadPhase::Cutting;
            return Setpoint {
                position: plan.line(angle),
                velocity: Velocity::from_bits(followed.velocity),
                acceleration: Acceleration::from_bits(followed.acceleration),
                ..Setpoint::default()
            };
        }
        self.ramp(angle, speed, &followed)
    }

    /// The setpoint off the line: at rest, in the run-in or in the run-out.
    #[inline(never)]
    fn ramp(&mut self, angle: i64, speed: i32, followed: &Followed) -> Setpoint {
        let plan = &self.plan;
        let resting = |position| Setpoint {
            position,
            ..Setpoint::default()
        };
        if angle < 0 {
            // The angle of a spindle under way is not below zero but by the noise of its estimate.
            return resting(plan.start);
        }
        let rate = i128::from(plan.per_ramp)
            .wrapping_mul(i128::from(speed))
            .wrapping_shr(Velocity::FRAC_NBITS + PER_RAMP_FRAC - Position::FRAC_NBITS - RATE_FRAC);
        let rate = saturate(rate as i64);
        if angle < plan.ramp {
            self.phase = ThreadPhase::RunIn;
            let u = plan.share(angle);
            return Setpoint {
                position: plan.start.wrapping_add(plan.way_at(u)),
                ..Weight::at(u, rate).of(followed)
            };
        }
        let left = plan.end.wrapping_add(plan.ramp).wrapping_sub(angle);
        if left <= 0 {
            self.end();
            return resting(self.plan.rest);
        }
        self.phase = ThreadPhase::RunOut;
        let u = plan.share(left);
        Setpoint {
            position: plan.rest.wrapping_sub(plan.way_at(u)),
            ..Weight::at(u, rate.wrapping_neg()).of(followed)
        }
    }
}

/// Counts that a tick may differ from the spindle's speed besides a quarter of it: displaced edges, noise.
const JUMP_COUNTS: i64 = 2;

impl Plan {
    /// u of an angle within a ramp, Q.30.
    fn share(&self, angle: i64) -> i32 {
        let share = i128::from(angle)
            .wrapping_mul(i128::from(self.per_ramp))
            .wrapping_shr(PER_RAMP_FRAC - run_up::FRAC);
        (share as i64).clamp(0, i64::from(run_up::ONE)) as i32
    }

    /// The way from rest at `u` of a ramp.
    fn way_at(&self, u: i32) -> Position {
        let way = i128::from(self.ramp_way)
            .wrapping_mul(i128::from(run_up::integral(u)))
            .wrapping_shr(run_up::FRAC);
        Position::from_bits(way as i64)
    }
}
