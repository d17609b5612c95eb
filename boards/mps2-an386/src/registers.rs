//! Registers of a peripheral.

use core::ptr;

/// One block of 32-bit registers at a fixed address.
pub(crate) struct Registers(usize);

impl Registers {
    /// The block at `address`, which has to be that of a peripheral of the board that has no access to memory itself:
    /// only this crate makes one.
    pub(crate) const fn new(address: usize) -> Self {
        Self(address)
    }

    pub(crate) fn read(&self, offset: usize) -> u32 {
        let address = ptr::with_exposed_provenance::<u32>(self.0 + offset);
        // SAFETY: `self.0` is the address of a timer or a UART (the statics of those modules) and the offsets are its
        // registers, aligned words. Reading touches the peripheral alone.
        unsafe { address.read_volatile() }
    }

    pub(crate) fn write(&self, offset: usize, value: u32) {
        let address = ptr::with_exposed_provenance_mut::<u32>(self.0 + offset);
        // SAFETY: as for `read`; the registers only steer the peripheral, they give it no access to memory.
        unsafe { address.write_volatile(value) }
    }
}
