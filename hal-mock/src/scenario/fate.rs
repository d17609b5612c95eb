//! What a timeline does to the world, and the level of enable, where the axis is stepped elsewhere.

use leadscrew::axis::Inputs;
use leadscrew::telemetry::Record;

use super::action::{Action, Ask, Timed};
use super::definition::tick_at;
use super::error::ScenarioError;
use super::world::World;

/// The part of a timeline that is not asked of the axis.
#[derive(Clone, Debug)]
pub struct Fate<'s> {
    timeline: &'s [Timed],
    next: usize,
    tick_hz: f64,
    tick: u32,
    enable: bool,
}

impl<'s> Fate<'s> {
    /// Before the first tick.
    #[must_use]
    pub const fn new(timeline: &'s [Timed], tick_hz: f64) -> Self {
        Self {
            timeline,
            next: 0,
            tick_hz,
            tick: 0,
            enable: false,
        }
    }

    /// Steps `world` under what the last tick put out, with what begins in this one.
    ///
    /// # Errors
    /// A trouble that cannot be.
    pub fn step(&mut self, world: &mut World, applied: &Record) -> Result<(), ScenarioError> {
        while let Some(timed) = self.timeline.get(self.next)
            && tick_at(timed.at_s, self.tick_hz) <= self.tick
        {
            self.next += 1;
            match &timed.action {
                Action::Ask(Ask::Enable) => self.enable = true,
                Action::Ask(Ask::Disable) => self.enable = false,
                Action::Ask(_) => {}
                Action::Set(outer) => world.set(outer),
                Action::Trouble { trouble, for_s } => {
                    world.begin(trouble, tick_at(*for_s, self.tick_hz))?;
                }
            }
        }
        self.tick += 1;
        world.step(&applied.put_out());
        Ok(())
    }

    /// What the axis saw in the last step.
    #[must_use]
    pub fn inputs<'w>(&self, world: &'w World) -> Inputs<'w> {
        world.inputs(self.enable)
    }
}
