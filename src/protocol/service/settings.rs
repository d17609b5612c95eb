//! What is set over the link: one parameter after the other, or many at once by an edit.

use super::{Inner, Passed, Port, Seen};
use crate::protocol::parameters::{NewValue, Which, write};
use crate::protocol::refusal::Refusal;
use crate::settings::Settings;
use crate::supervisor::State;

impl Inner {
    /// Passes what only an axis that is off may do.
    pub(super) fn check_off(seen: &Seen) -> Result<(), Refusal> {
        if seen.enabled || !matches!(seen.state, State::Disabled | State::Fault) {
            return Err(Refusal::AxisOn);
        }
        Ok(())
    }

    /// Sets a parameter: in the edit, if there is one.
    pub(super) fn set(
        &mut self,
        name: &str,
        value: NewValue<'_>,
        seen: &Seen,
        port: &mut dyn Port,
    ) -> Result<Passed, Refusal> {
        Self::check_off(seen)?;
        let which = Which::Named(name);
        if let Some(edit) = &mut self.edit {
            write(edit, which, value)?;
            return Ok(Passed::Taken);
        }
        let mut settings = self.settings;
        write(&mut settings, which, value)?;
        self.put(settings, port)
    }

    /// Puts all settings into force, or none.
    pub(super) fn set_all(
        &mut self,
        settings: Settings,
        seen: &Seen,
        port: &mut dyn Port,
    ) -> Result<Passed, Refusal> {
        Self::check_off(seen)?;
        self.put(settings, port)
    }

    pub(super) fn open_edit(&mut self, seen: &Seen) -> Result<Passed, Refusal> {
        Self::check_off(seen)?;
        self.edit = Some(self.settings);
        Ok(Passed::Taken)
    }

    pub(super) fn drop_edit(&mut self) -> Result<Passed, Refusal> {
        let dropped = self.edit.take().map(|_| Passed::Taken);
        dropped.ok_or(Refusal::NoEdit)
    }

    /// Takes the edit, or leaves it open.
    pub(super) fn take_edit(
        &mut self,
        seen: &Seen,
        port: &mut dyn Port,
    ) -> Result<Passed, Refusal> {
        Self::check_off(seen)?;
        let edit = self.edit.ok_or(Refusal::NoEdit)?;
        let passed = self.put(edit, port)?;
        self.edit = None;
        Ok(passed)
    }

    /// True if the axis runs at other rates than are set.
    pub(super) fn needs_restart(&self) -> bool {
        self.rates != Self::rates_of(&self.settings)
    }

    const fn rates_of(settings: &Settings) -> [f64; 2] {
        [settings.axis.tick_hz, settings.axis.timer_hz]
    }

    /// Puts settings into force; other rates wait for a restart.
    fn put(&mut self, mut settings: Settings, port: &mut dyn Port) -> Result<Passed, Refusal> {
        let config = settings.validate().map_err(|_| Refusal::Inconsistent)?;
        match port.check(&settings) {
            Ok(()) | Err(Refusal::RestartNeeded) => {}
            Err(refusal) => return Err(refusal),
        }
        let mut passed = Passed::Taken;
        if Self::rates_of(&settings) == self.rates {
            passed = port.reconfigure(&config)?;
            let feed = settings.axis.motion.max_feed_mm_per_min;
            self.mover.reconfigure(&config, feed);
        }
        self.is_unsaved |= settings != self.settings;
        self.settings = settings;
        Ok(passed)
    }
}
