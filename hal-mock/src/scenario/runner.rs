//! A run of a scenario, tick by tick.

use leadscrew::axis::{Axis, Outputs, Request};
use leadscrew::telemetry::Record;

use super::action::{Action, Ask, Timed};
use super::definition::{Scenario, tick_at};
use super::error::ScenarioError;
use super::operator::{Operator, Order, Seen};
use super::world::World;
use crate::invariants::{Invariants, Violation};
use crate::trace::TraceDigest;

/// What became of an action.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Happening {
    /// Its place in the timeline.
    pub index: usize,
    /// The tick that first saw it.
    pub tick: u32,
    /// Why it was refused, if it was.
    pub refused: Option<ScenarioError>,
}

/// A run: the machine, the axis on it and the timeline.
#[derive(Clone)]
pub struct Runner<'s> {
    /// The machine with its troubles.
    pub world: World,
    /// The axis.
    pub axis: Axis<'s>,
    operator: Operator,
    enable: bool,
    timeline: &'s [Timed],
    next: usize,
    tick_hz: f64,
    tick: u32,
    ticks: u32,
    outputs: Outputs,
    digest: TraceDigest,
    invariants: Invariants,
    violation: Option<Violation>,
}

impl<'s> Runner<'s> {
    /// The run of `scenario`, before its first tick; a map of the encoder is for the caller to set.
    ///
    /// # Errors
    /// A parameter out of range.
    pub fn new(scenario: &Scenario<'s>) -> Result<Self, ScenarioError> {
        let plant = scenario.plant();
        let params = scenario.axis_params(&plant.machine)?;
        let config = params.validate()?;
        Ok(Self {
            world: World::new(&plant, scenario)?,
            axis: Axis::new(config),
            operator: Operator::new(&params, &config)?,
            enable: false,
            timeline: scenario.timeline,
            next: 0,
            tick_hz: scenario.tick_hz,
            tick: 0,
            ticks: scenario.ticks()?,
            outputs: Outputs::default(),
            digest: TraceDigest::new(),
            invariants: Invariants::new(params.output.limit),
            violation: None,
        })
    }

    /// One tick: what is due begins, the machine moves under the last command, the axis sees what came of it. `tell` is
    /// told of every action. `None` when the run is through.
    pub fn step(&mut self, mut tell: impl FnMut(Happening)) -> Option<&Outputs> {
        if self.tick == self.ticks {
            return None;
        }
        while let Some(timed) = self.timeline.get(self.next)
            && tick_at(timed.at_s, self.tick_hz) <= self.tick
        {
            tell(Happening {
                index: self.next,
                tick: self.tick,
                refused: self.begin(&timed.action).err(),
            });
            self.next += 1;
        }
        self.world.step(&self.outputs);
        self.axis
            .supervisor_mut()
            .set_store_corrupt(self.world.store_corrupt());
        let inputs = self.world.inputs(self.enable);
        self.outputs = *self.axis.step(&inputs);
        self.digest.update(&inputs, &Record::new(&self.outputs));
        let checked = self.invariants.check(&self.axis);
        self.violation = self.violation.or(checked.err());
        self.operator.look(&Seen::of(&self.axis));
        self.tick += 1;
        Some(&self.outputs)
    }

    fn begin(&mut self, action: &Action) -> Result<(), ScenarioError> {
        match action {
            Action::Ask(ask) => self.ask(ask),
            Action::Set(outer) => {
                self.world.set(outer);
                Ok(())
            }
            Action::Trouble { trouble, for_s } => {
                let ticks = tick_at(*for_s, self.tick_hz);
                Ok(self.world.begin(trouble, ticks)?)
            }
        }
    }

    fn ask(&mut self, ask: &Ask) -> Result<(), ScenarioError> {
        let order = self.operator.order(ask, self.tick, &Seen::of(&self.axis))?;
        match &order {
            Order::Enable(enable) => self.enable = *enable,
            Order::Axis(request) => {
                if let Err(refused) = self.axis.take(request) {
                    self.operator.withdraw(&order);
                    return Err(ScenarioError::Refused(refused));
                }
                if matches!(request, Request::ClearFault) {
                    self.invariants.note_cleared();
                }
            }
            Order::Nothing => {}
        }
        Ok(())
    }

    /// Ticks of the whole run.
    #[must_use]
    pub const fn ticks(&self) -> u32 {
        self.ticks
    }

    /// The first rule that holds in every run and did not in this one.
    #[must_use]
    pub const fn violation(&self) -> Option<Violation> {
        self.violation
    }

    /// Digest of the run so far.
    #[must_use]
    pub const fn digest(&self) -> u64 {
        self.digest.value()
    }
}
