//! Sets of faults.

use super::fault::Fault;

/// A set of faults.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FaultSet(u32);

impl FaultSet {
    /// With `fault` in it.
    #[must_use]
    pub const fn with(self, fault: Fault) -> Self {
        Self(self.0 | 1_u32.wrapping_shl(fault as u32))
    }

    /// Of both.
    #[must_use]
    pub const fn union(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// True if `fault` is in it.
    #[must_use]
    pub const fn contains(self, fault: Fault) -> bool {
        self.0 & 1_u32.wrapping_shl(fault as u32) != 0
    }

    /// True if nothing is in it.
    #[must_use]
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// How many are in it.
    #[must_use]
    pub const fn len(self) -> u32 {
        self.0.count_ones()
    }

    /// Bit n is the fault of number n.
    #[must_use]
    pub const fn bits(self) -> u32 {
        self.0
    }
}
