//! Running a script.

use std::time::Duration;

use leadscrew_client::{Axis, Error};
use serde::Serialize;

use super::{Action, Expected, Motion, Script, Step};
use crate::axis::jog;
use crate::axis::values::{self, Edit, named_request};
use crate::error::CommandError;

/// A step that was done.
#[derive(Clone, Debug, Serialize)]
pub struct Done {
    /// Time on the axis since the script began, s.
    pub time_s: f64,
    /// Its line.
    pub line: usize,
    /// The step as it stands there.
    pub step: String,
    /// What came of it.
    pub result: String,
}

/// What came of a script.
#[derive(Debug)]
pub struct Run {
    /// The steps that were done.
    pub done: Vec<Done>,
    /// Why it ended early.
    pub failure: Option<Box<Failure>>,
}

/// A step that failed.
#[derive(Debug)]
pub struct Failure {
    /// Its line.
    pub line: usize,
    /// The step as it stands there.
    pub step: String,
    /// What is wrong with it.
    pub error: CommandError,
}

/// Runs a script, after all of it that names parameters was looked at; tells of every step when it is done.
///
/// # Errors
/// A name or a value that cannot be, with file and line: nothing was done then. What goes wrong later is in the result.
pub fn run(
    axis: &mut Axis,
    script: &Script,
    told: &mut dyn FnMut(&Done),
) -> Result<Run, CommandError> {
    check(axis, script)?;
    let mut runner = Runner {
        clock: Clock::start(axis),
        axis,
        told,
        done: Vec::new(),
    };
    let failure = runner.steps(&script.steps).err();
    Ok(Run {
        done: runner.done,
        failure,
    })
}

/// Looks at every parameter that a script names.
///
/// # Errors
/// A name or a value that cannot be, with file and line.
pub fn check(axis: &mut Axis, script: &Script) -> Result<(), CommandError> {
    check_steps(axis, script, &script.steps)
}

fn check_steps(axis: &mut Axis, script: &Script, steps: &[Step]) -> Result<(), CommandError> {
    for step in steps {
        let checked = match &step.action {
            Action::Set(values) => edits(axis, values).map(drop),
            Action::Expect(Expected::Parameter(name, value)) => {
                values::edit(axis, name, value).map(drop)
            }
            Action::Repeat(_, steps) => check_steps(axis, script, steps),
            _ => continue,
        };
        let at = |error: CommandError| {
            if error.exit_code() == 3 || matches!(step.action, Action::Repeat(..)) {
                return error;
            }
            let file = script.file.display();
            CommandError::Usage(format!("{file}:{}: {error}", step.line))
        };
        checked.map_err(at)?;
    }
    Ok(())
}

fn edits(axis: &mut Axis, values: &[(String, String)]) -> Result<Vec<Edit>, CommandError> {
    let edit = |(name, value): &(String, String)| values::edit(axis, name, value);
    values.iter().map(edit).collect()
}

/// Time by the ticks of an axis that may start anew.
struct Clock {
    begin: u32,
    before_s: f64,
}

impl Clock {
    fn start(axis: &mut Axis) -> Self {
        Self {
            begin: axis.connection().seen(),
            before_s: 0.0,
        }
    }

    fn time_s(&self, axis: &mut Axis) -> f64 {
        let ticks = axis.connection().seen().wrapping_sub(self.begin);
        let tick_hz = axis.identity().tick_hz.max(1);
        self.before_s + f64::from(ticks) / f64::from(tick_hz)
    }
}

struct Runner<'a> {
    axis: &'a mut Axis,
    clock: Clock,
    told: &'a mut dyn FnMut(&Done),
    done: Vec<Done>,
}

impl Runner<'_> {
    fn steps(&mut self, steps: &[Step]) -> Result<(), Box<Failure>> {
        for step in steps {
            if let Action::Repeat(passes, inner) = &step.action {
                for pass in 1..=*passes {
                    self.note(step, format!("pass {pass} of {passes}"));
                    self.steps(inner)?;
                }
                continue;
            }
            let result = self.action(&step.action).map_err(|error| {
                Box::new(Failure {
                    line: step.line,
                    step: step.text.clone(),
                    error,
                })
            })?;
            self.note(step, result);
        }
        Ok(())
    }

    fn note(&mut self, step: &Step, result: String) {
        let done = Done {
            time_s: self.clock.time_s(self.axis),
            line: step.line,
            step: step.text.clone(),
            result,
        };
        (self.told)(&done);
        self.done.push(done);
    }

    fn action(&mut self, action: &Action) -> Result<String, CommandError> {
        let axis = &mut *self.axis;
        match action {
            Action::Enable => axis.enable().map(drop)?,
            Action::Disable => axis.disable().map(drop)?,
            Action::Home => axis.home().map(drop)?,
            Action::Hold => axis.hold()?,
            Action::Resume => axis.resume()?,
            Action::Stop => axis.stop().map(drop)?,
            Action::Clear => clear(axis)?,
            Action::Save => {
                let saved = axis.save_parameters();
                saved.map_err(|error| named_request(error, "Saving the parameters"))?;
                return Ok("saved".to_owned());
            }
            Action::Restart => {
                self.clock.before_s = self.clock.time_s(axis);
                axis.restart()
                    .map_err(|error| named_request(error, "The restart"))?;
                self.clock.begin = axis.connection().seen();
                return Ok("restarted".to_owned());
            }
            Action::Move(motion) => move_by(axis, *motion)?,
            Action::Jog {
                feed_mm_per_min,
                seconds: None,
            } => axis.jog(*feed_mm_per_min)?,
            Action::Jog {
                feed_mm_per_min,
                seconds: Some(seconds),
            } => {
                let time = Duration::from_secs_f64(*seconds);
                let (end, _) = jog::jog(axis, *feed_mm_per_min, Some(time), || {})?;
                if end == jog::JogEnd::Interrupted {
                    return Err(Error::Interrupted { stands: true }.into());
                }
            }
            Action::Override(percent) => axis.set_override(*percent)?,
            Action::Wait(seconds) => axis.wait(Duration::from_secs_f64(*seconds))?,
            Action::WaitRest => axis.wait_for_rest().map(drop)?,
            Action::Set(values) => {
                let edits = edits(axis, values)?;
                values::set(axis, &edits)?;
                return Ok("set".to_owned());
            }
            Action::Expect(expected) => {
                let seen = expected.check(axis)?;
                return seen
                    .map_err(|seen| CommandError::Data(format!("expected otherwise: {seen}")));
            }
            Action::Print(said) => return Ok(said.clone()),
            // Gone through by who calls this.
            Action::Repeat(..) => {}
        }
        let status = self.axis.status()?;
        let (state, position) = (status.state_text(), status.position_mm);
        Ok(format!("{state} at {position:.4} mm"))
    }
}

/// Clears the fault if there is one, and the warnings.
///
/// # Errors
/// [`Error::Refused`] with what is in the way.
pub fn clear(axis: &mut Axis) -> Result<(), Error> {
    if axis.status()?.fault_number != 0 {
        let cleared = axis.clear_fault();
        cleared.map_err(|error| named_request(error, "Clearing the fault"))?;
    }
    axis.clear_warnings()
        .map_err(|error| named_request(error, "Clearing the warnings"))
}

fn move_by(axis: &mut Axis, motion: Motion) -> Result<(), Error> {
    let base = if motion.is_by {
        axis.status()?.setpoint_mm
    } else {
        0.0
    };
    let target = base + motion.mm;
    if motion.is_awaited {
        axis.move_and_wait(target, motion.feed_mm_per_min).map(drop)
    } else {
        axis.move_to(target, motion.feed_mm_per_min)
    }
}
