//! The way out of Fault.

use core::fmt;

use super::Supervisor;
use super::fault::Fault;
use super::sequence::Phase;
use crate::hal::Lines;

/// Why a fault is not cleared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ClearError {
    /// Enable is still asked for.
    EnableRequested,
    /// The reaction is not over: the drive is still enabled.
    Stopping,
    /// The axis still moves.
    Moving,
    /// What brought this fault about is still there.
    CausePersists(Fault),
}

impl fmt::Display for ClearError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::EnableRequested => f.write_str("enable is still asked for: take it back first"),
            Self::Stopping => f.write_str("the stop is not over: wait until the drive is off"),
            Self::Moving => f.write_str("the axis still moves: wait until it stands"),
            Self::CausePersists(fault) => write!(
                f,
                "the cause of {} is still there: {}",
                fault.name(),
                fault.description().remedy
            ),
        }
    }
}

impl core::error::Error for ClearError {}

impl Supervisor {
    /// Leaves Fault for Disabled.
    ///
    /// # Errors
    /// [`ClearError`]: enable is still asked for, the stop is not over, the axis moves, or the cause persists.
    pub fn clear(&mut self) -> Result<(), ClearError> {
        if !self.latch.is_set() {
            return Ok(());
        }
        if self.enable {
            return Err(ClearError::EnableRequested);
        }
        if !matches!(self.sequence.phase(), Phase::Faulted | Phase::Disabled) {
            return Err(ClearError::Stopping);
        }
        if self.velocity.saturating_abs() > self.config.still {
            return Err(ClearError::Moving);
        }
        if let Some(fault) = self.persisting() {
            return Err(ClearError::CausePersists(fault));
        }
        self.has_news = true;
        self.sequence.clear();
        self.latch.clear();
        self.watch.forget();
        Ok(())
    }

    /// A fault whose cause is there whatever the axis does.
    fn persisting(&self) -> Option<Fault> {
        let Lines {
            emergency_stop,
            drive_fault,
            encoder_lost,
            ..
        } = self.lines;
        [
            (emergency_stop, Fault::EmergencyStop),
            (drive_fault, Fault::DriveFault),
            (encoder_lost, Fault::SignalLoss),
            (self.store_corrupt, Fault::StoreCorrupt),
        ]
        .into_iter()
        .find_map(|(is_there, fault)| is_there.then_some(fault))
    }
}
