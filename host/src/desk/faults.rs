//! The monitors of the supervisor on recorded signals.

use leadscrew::capture::{Observation, Unwrapper};
use leadscrew::estimator::Estimate;
use leadscrew::hal::{Capture, Lines};
use leadscrew::output::ActiveLimits;
use leadscrew::scope::Signal;
use leadscrew::setpoint::Setpoint;
use leadscrew::supervisor::{Fault, Permit, Review, Situation, State, Supervisor};
use leadscrew::units::{Command, Velocity};

use super::{Desk, HIGH, LOW, Lacking, MOVING, SLEW, fault_of, state_of};

/// Longest way of a supervisor to an enabled axis, ticks.
const MOST_ENABLING: u32 = 1_000_000;

/// A fault that was found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Derived {
    /// Which.
    pub fault: Fault,
    /// In which tick.
    pub tick: u32,
    /// What was seen, and what is allowed; none where the recording does not tell.
    pub figures: Option<(f64, f64)>,
}

/// Faults of a recording.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Faults {
    /// The first one that the axis latched.
    pub recorded: Option<Derived>,
    /// The first one that the monitors find again.
    pub derived: Option<Derived>,
}

impl Faults {
    /// True where recorded signals tell of such a fault; others come from lines, edges, the index or a source.
    #[must_use]
    pub const fn can_be_derived(fault: Fault) -> bool {
        matches!(
            fault,
            Fault::FollowingError
                | Fault::MotionAgainstCommand
                | Fault::MotionAtStandstill
                | Fault::EncoderLoss
                | Fault::Overspeed
                | Fault::OutputSaturated
        )
    }

    /// True if both are the same fault in the same tick, with the same figures where they are told.
    #[must_use]
    pub fn agree(&self) -> bool {
        match (self.recorded, self.derived) {
            (None, None) => true,
            (Some(recorded), Some(derived)) => {
                recorded.fault == derived.fault
                    && recorded.tick == derived.tick
                    && recorded
                        .figures
                        .is_none_or(|figures| Some(figures) == derived.figures)
            }
            _ => false,
        }
    }
}

/// The recorded signals of the monitors.
struct Signals<'a> {
    count: &'a [i64],
    error: &'a [i64],
    velocity: &'a [i64],
    setpoint_velocity: &'a [i64],
    command: &'a [i64],
    flags: &'a [i64],
}

/// Looks for faults anew, as the axis is set.
///
/// # Errors
/// What the recording lacks.
pub fn faults(desk: &Desk<'_>) -> Result<Faults, Lacking> {
    let [count, error, velocity, setpoint_velocity, command, flags] = desk.need([
        Signal::Count,
        Signal::FollowingError,
        Signal::Velocity,
        Signal::SetpointVelocity,
        Signal::Command,
        Signal::Flags,
    ])?;
    let signals = Signals {
        count,
        error,
        velocity,
        setpoint_velocity,
        command,
        flags,
    };
    let ticks = &desk.recorded.recording.ticks;
    let mut supervisor = Supervisor::new(desk.monitors);
    let mut unwrapper = Unwrapper::new();
    if matches!(state_of(flags[0]), 2 | 3) {
        enable(&mut supervisor, (ticks[0] as u32).wrapping_sub(1));
    }
    for (place, &tick) in ticks.iter().enumerate() {
        signals.step(place, tick as u32, &mut supervisor, &mut unwrapper);
        if supervisor.first_fault().is_some() {
            break;
        }
    }
    let derived = supervisor.first_fault().map(|found| Derived {
        fault: found.trip.fault,
        tick: found.tick,
        figures: Some((found.trip.value.to_num(), found.trip.limit.to_num())),
    });
    Ok(Faults {
        recorded: recorded(desk, flags),
        derived,
    })
}

/// The first fault that was latched within the recording.
fn recorded(desk: &Desk<'_>, flags: &[i64]) -> Option<Derived> {
    let place = flags.iter().position(|flags| fault_of(*flags) != 0)?;
    let tick = *desk.recorded.recording.ticks.get(place)? as u32;
    let fault = Fault::from_number(fault_of(flags[place]))?;
    let page = desk.recorded.header.fault;
    let page = page.filter(|page| page.number == fault as u8 && page.tick == tick);
    Some(Derived {
        fault,
        tick,
        figures: page.map(|page| (page.value, page.limit)),
    })
}

const WELL: Lines = Lines {
    drive_ready: true,
    drive_fault: false,
    encoder_lost: false,
    emergency_stop: false,
    limit_low: false,
    limit_high: false,
    home: false,
    master_lost: false,
};

fn situation(tick: u32, enable: bool, told: Command) -> Situation<'static> {
    Situation {
        tick,
        enable,
        lines: &WELL,
        illegal: 0,
        missed_ticks: 0,
        readback: None,
        told,
    }
}

/// Brings a supervisor to where the recording begins: under control.
fn enable(supervisor: &mut Supervisor, tick: u32) {
    let capture = Capture::default();
    let observation = Unwrapper::new().unwrap(&capture);
    for _ in 0..MOST_ENABLING {
        let permit = supervisor.permit(&situation(tick, true, Command::ZERO));
        supervisor.review(&Review {
            permit,
            tick,
            moving: false,
            trouble: None,
            lines: &WELL,
            observation: &observation,
            estimate: &Estimate::default(),
            setpoint: &Setpoint::default(),
            following_error: 0,
            told: Command::ZERO,
            active: ActiveLimits::default(),
            open_loop: false,
        });
        if permit == Permit::Follow {
            return;
        }
    }
}

impl Signals<'_> {
    fn step(
        &self,
        place: usize,
        tick: u32,
        supervisor: &mut Supervisor,
        unwrapper: &mut Unwrapper,
    ) {
        let before = place.checked_sub(1);
        let told = before.map_or(0, |before| self.command[before]);
        let told = Command::from_bits(told as i32);
        let capture = Capture {
            count: self.count[place] as u32,
            sampled_at: tick,
            ..Capture::default()
        };
        let observation: Observation<'_> = unwrapper.unwrap(&capture);
        let flags = self.flags[place];
        let state = state_of(flags);
        let is_stopped = state == State::Disabled as u8
            || state == State::Stopping as u8 && fault_of(flags) == 0;
        let permit = supervisor.permit(&situation(tick, !is_stopped, told));
        let active = before.map_or(0, |before| self.flags[before]);
        let setpoint = Setpoint {
            velocity: Velocity::from_bits(self.setpoint_velocity[place] as i32),
            ..Setpoint::default()
        };
        let estimate = Estimate {
            velocity: Velocity::from_bits(self.velocity[place] as i32),
            ..Estimate::default()
        };
        supervisor.review(&Review {
            permit,
            tick,
            // A tick that ends in a fault does not say any more that it moved.
            moving: flags & MOVING != 0 || self.setpoint_velocity[place] != 0,
            trouble: None,
            lines: &WELL,
            observation: &observation,
            estimate: &estimate,
            setpoint: &setpoint,
            following_error: self.error[place] as i32,
            told,
            active: ActiveLimits {
                high: active & HIGH != 0,
                low: active & LOW != 0,
                slew: active & SLEW != 0,
            },
            open_loop: false,
        });
    }
}
