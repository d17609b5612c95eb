//! The store and the drive exclude each other: while one is at it, the other waits outside.

use core::fmt;
use core::sync::atomic::{AtomicU8, Ordering};

use leadscrew::axis::Outputs;

const IDLE: u8 = 0;
const WRITING: u8 = 1;
const ENABLED: u8 = 2;

/// Shared by the tick, which enables the axis, and whoever writes to the store. Flash that is erased may stall the
/// processor for longer than a tick, so that no axis may be under control meanwhile.
#[derive(Debug, Default)]
pub struct Interlock {
    holder: AtomicU8,
}

impl Interlock {
    /// Nobody holds it.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            holder: AtomicU8::new(IDLE),
        }
    }

    /// To be asked by the tick before it passes a demand to enable on; false while the store is written. Takes no
    /// longer than a few instructions and may be asked again while it is enabled.
    pub fn try_enable(&self) -> bool {
        self.take(ENABLED) || self.holder.load(Ordering::Acquire) == ENABLED
    }

    /// To be told by the tick once the drive is off and the brake closed.
    pub fn disabled(&self) {
        self.release(ENABLED);
    }

    /// The right to write, for as long as it is kept.
    ///
    /// # Errors
    /// The axis is enabled, by `outputs` or by [`Self::try_enable`], or another permission is out.
    pub fn permit(&self, outputs: &Outputs) -> Result<Permission<'_>, NotPermitted> {
        if outputs.enabled || outputs.brake_released {
            return Err(NotPermitted::Enabled);
        }
        if self.take(WRITING) {
            return Ok(Permission { interlock: self });
        }
        Err(match self.holder.load(Ordering::Acquire) {
            ENABLED => NotPermitted::Enabled,
            _ => NotPermitted::Busy,
        })
    }

    fn take(&self, holder: u8) -> bool {
        self.exchange(IDLE, holder)
    }

    fn release(&self, holder: u8) {
        // Another holder keeps it.
        let _ = self.exchange(holder, IDLE);
    }

    fn exchange(&self, from: u8, to: u8) -> bool {
        self.holder
            .compare_exchange(from, to, Ordering::AcqRel, Ordering::Acquire)
            .is_ok()
    }
}

/// The axis is disabled, and stays so while this is kept.
#[derive(Debug)]
pub struct Permission<'i> {
    interlock: &'i Interlock,
}

impl Drop for Permission<'_> {
    fn drop(&mut self) {
        self.interlock.release(WRITING);
    }
}

/// Why nothing may be written now.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NotPermitted {
    /// The drive is enabled, or about to be.
    Enabled,
    /// Something else is being written.
    Busy,
}

impl fmt::Display for NotPermitted {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Enabled => {
                "the axis is enabled: disable it, then save (writing may stall the processor for longer than a tick)"
            }
            Self::Busy => "the store is being written: wait until that is done",
        })
    }
}

impl core::error::Error for NotPermitted {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn writing_and_enabling_exclude_each_other() {
        let interlock = Interlock::new();
        let off = Outputs::default();
        let permission = interlock.permit(&off);
        assert!(permission.is_ok() && !interlock.try_enable());
        assert_eq!(interlock.permit(&off).err(), Some(NotPermitted::Busy));
        drop(permission);
        assert!(interlock.try_enable() && interlock.try_enable());
        assert_eq!(interlock.permit(&off).err(), Some(NotPermitted::Enabled));
        interlock.disabled();
        for on in [
            Outputs {
                enabled: true,
                ..off
            },
            Outputs {
                brake_released: true,
                ..off
            },
        ] {
            assert_eq!(interlock.permit(&on).err(), Some(NotPermitted::Enabled));
        }
        assert!(interlock.permit(&off).is_ok());
    }
}
