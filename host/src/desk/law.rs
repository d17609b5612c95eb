//! The control law on recorded signals.

use leadscrew::controller::Controller;
use leadscrew::estimator::Estimate;
use leadscrew::output::{ActiveLimits, Output};
use leadscrew::scope::Signal;
use leadscrew::setpoint::{Setpoint, Turn};
use leadscrew::units::{Acceleration, Command, Jerk, Position, Velocity};

use super::{Desk, ENABLED, HIGH, LOW, Lacking, SLEW, is_in_loop};
use crate::statistics::Spread;

/// What the law says again.
#[derive(Clone, Debug)]
pub struct Law {
    /// What it puts out in each tick, bits; 0 where the loop is open.
    pub commands: Vec<i64>,
    /// That less what was put out, over the ticks in the loop, bits.
    pub difference: Spread,
    /// The loop was closed before the recording begins: what it had added up is not known, and stays as a difference.
    pub begins_in_loop: bool,
}

/// The recorded signals of the law.
struct Signals<'a> {
    error: &'a [i64],
    velocity: &'a [i64],
    acceleration: &'a [i64],
    setpoint_velocity: &'a [i64],
    setpoint_acceleration: &'a [i64],
    command: &'a [i64],
    flags: &'a [i64],
    counts: Option<&'a [i64]>,
}

/// Runs the law of the recorded settings on what it saw.
///
/// # Errors
/// What the recording lacks.
pub fn law(desk: &Desk<'_>) -> Result<Law, Lacking> {
    let [
        error,
        velocity,
        acceleration,
        setpoint_velocity,
        setpoint_acceleration,
        command,
        flags,
    ] = desk.need([
        Signal::FollowingError,
        Signal::Velocity,
        Signal::Acceleration,
        Signal::SetpointVelocity,
        Signal::SetpointAcceleration,
        Signal::Command,
        Signal::Flags,
    ])?;
    let signals = Signals {
        error,
        velocity,
        acceleration,
        setpoint_velocity,
        setpoint_acceleration,
        command,
        flags,
        counts: desk.recorded.recording.bits(Signal::Count),
    };
    let mut controller = Controller::new(desk.config.controller);
    let mut output = Output::new(desk.config.output);
    let begins_in_loop = Desk::begins_in_loop(flags);
    if begins_in_loop {
        let begin = Command::from_bits(command[0] as i32);
        controller.reconfigure(desk.config.controller, begin);
        output.step(begin);
    }
    let mut law = Law {
        commands: Vec::with_capacity(flags.len()),
        difference: Spread::default(),
        begins_in_loop,
    };
    for (tick, (&flags, &recorded)) in flags.iter().zip(command).enumerate() {
        if !is_in_loop(flags) {
            controller.reset();
            output.off();
            law.commands.push(0);
            continue;
        }
        let said = signals.step(tick, &mut controller, &mut output);
        law.commands.push(said);
        law.difference.push((said - recorded) as f64);
    }
    Ok(law)
}

impl Signals<'_> {
    fn step(&self, tick: usize, controller: &mut Controller, output: &mut Output) -> i64 {
        let estimate = Estimate {
            velocity: Velocity::from_bits(self.velocity[tick] as i32),
            acceleration: Acceleration::from_bits(self.acceleration[tick] as i32),
            ..Estimate::default()
        };
        let before = tick.checked_sub(1);
        let delta = |counts: &[i64]| before.map_or(0, |before| counts[tick] - counts[before]);
        let flags = before.map_or(0, |before| self.flags[before]);
        let told = before.filter(|_| flags & ENABLED != 0);
        let told = told.map(|before| Command::from_bits(self.command[before] as i32));
        let told = told.map(|told| told.saturating_sub(controller.withheld()));
        controller.note(self.counts.map_or(0, delta) as i32, told, &estimate);
        let active = ActiveLimits {
            high: flags & HIGH != 0,
            low: flags & LOW != 0,
            slew: flags & SLEW != 0,
        };
        // The law sees positions by their difference alone.
        let setpoint = self.setpoint(tick);
        let demand = controller.step(&setpoint, Position::ZERO, &estimate, active);
        i64::from(output.step(demand.command).to_bits())
    }

    fn setpoint(&self, tick: usize) -> Setpoint {
        let jerk = self.jerk(tick);
        let ahead = (1..=Turn::HORIZON).find(|ahead| {
            let next = tick + *ahead as usize;
            next < self.flags.len() && self.jerk(next) != jerk
        });
        let turn = ahead.map_or(Turn::NONE, |ticks| Turn {
            ticks,
            jerk: self.jerk(tick + ticks as usize),
        });
        Setpoint {
            position: Position::from_bits(self.error[tick]),
            velocity: Velocity::from_bits(self.setpoint_velocity[tick] as i32),
            acceleration: Acceleration::from_bits(self.setpoint_acceleration[tick] as i32),
            jerk,
            turn,
        }
    }

    /// The jerk from a tick to the next: what the acceleration makes of it.
    fn jerk(&self, tick: usize) -> Jerk {
        let next = (tick + 1).min(self.setpoint_acceleration.len() - 1);
        let step = self.setpoint_acceleration[next] - self.setpoint_acceleration[tick];
        let bits = step << (Jerk::FRAC_NBITS - Acceleration::FRAC_NBITS);
        Jerk::from_bits(bits.clamp(i32::MIN.into(), i32::MAX.into()) as i32)
    }
}
