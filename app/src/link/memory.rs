//! Memory that the link works with, lent to one thing at a time.

use leadscrew::calibration::{Learner, Work};
use leadscrew::identification::recorder::Recorder;
use leadscrew::scope::Scope;

use crate::store::SET_BYTES;

/// Words of the work memory, and its halves, where there is room for all; as many edges of an encoder can be learned.
pub const WORDS: usize = 10_000;
/// Bytes of the longest image of an encoder map.
pub const MAP_BYTES: usize = 10_752;
/// Maps between two restarts: the one that was stored, and one that is learned.
pub const MAPS: usize = 2;

/// A place for it, to be a static; all zeros is one.
pub struct WorkMemory<const WORDS: usize, const HALVES: usize> {
    words: [i32; WORDS],
    halves: [i16; HALVES],
}

impl<const WORDS: usize, const HALVES: usize> Default for WorkMemory<WORDS, HALVES> {
    fn default() -> Self {
        Self::new()
    }
}

impl<const WORDS: usize, const HALVES: usize> WorkMemory<WORDS, HALVES> {
    /// Bytes that the store works with come from the halves.
    const HOLDS_A_SET: () = assert!(
        2 * HALVES >= SET_BYTES,
        "the halves are to hold a set of parameters"
    );

    /// All zero.
    #[must_use]
    pub const fn new() -> Self {
        let () = Self::HOLDS_A_SET;
        Self {
            words: [0; WORDS],
            halves: [0; HALVES],
        }
    }

    /// What [`Boot`](super::Boot) takes.
    pub const fn lend(&'static mut self) -> Work<'static> {
        Work {
            sums: &mut self.words,
            mean: &mut self.halves,
        }
    }
}

/// Places for encoder maps, to be a static: what the axis goes by, so not lent to anything else.
pub struct Maps<const PLACES: usize = MAPS>([[u8; MAP_BYTES]; PLACES]);

impl<const PLACES: usize> Default for Maps<PLACES> {
    fn default() -> Self {
        Self::new()
    }
}

impl<const PLACES: usize> Maps<PLACES> {
    /// All zero.
    #[must_use]
    pub const fn new() -> Self {
        Self([[0; MAP_BYTES]; PLACES])
    }

    /// What [`Boot`](super::Boot) takes.
    pub fn places(&'static mut self) -> MapPlaces {
        let mut places = MapPlaces::new();
        for place in &mut self.0 {
            // As many as there are.
            let _ = places.push(place);
        }
        places
    }
}

/// Places for maps that are not in use.
pub type MapPlaces = heapless::Vec<&'static mut [u8; MAP_BYTES], MAPS>;

/// Who has the work memory.
#[expect(
    clippy::large_enum_variant,
    reason = "there is one, in the link, and no heap"
)]
pub(super) enum Lent {
    /// Nobody. What was recorded last may be in it.
    Free(Work<'static>),
    /// An experiment, or what is left of one.
    Recorder(Recorder<'static>, &'static mut [i16]),
    /// The scope, in the tick.
    ScopeInTick(&'static mut [i16]),
    /// The scope that is over.
    Scope(Scope<'static>, &'static mut [i16]),
    /// The learner.
    Learner(Learner<'static>),
    /// Moments in between.
    Nobody,
}

impl Lent {
    /// The memory, if whoever has it can give it up at once: a record or a scope that is over can.
    pub fn reclaim(&mut self) -> Option<Work<'static>> {
        match core::mem::replace(self, Self::Nobody) {
            Self::Free(work) => Some(work),
            Self::Recorder(recorder, mean) => Some(Work {
                sums: recorder.into_memory(),
                mean,
            }),
            Self::Scope(scope, mean) => Some(Work {
                sums: scope.into_memory(),
                mean,
            }),
            other => {
                *self = other;
                None
            }
        }
    }

    /// The bytes that the store works with; the learner has them while it learns.
    pub fn bytes(&mut self) -> Option<&mut [u8]> {
        let halves: &mut [i16] = match self {
            Self::Free(Work { mean, .. })
            | Self::Recorder(_, mean)
            | Self::ScopeInTick(mean)
            | Self::Scope(_, mean) => mean,
            Self::Learner(_) | Self::Nobody => return None,
        };
        Some(bytemuck::cast_slice_mut(halves))
    }

    /// The words that are there to be read.
    pub fn words(&self) -> Option<&[i32]> {
        match self {
            Self::Free(work) => Some(work.sums),
            Self::Recorder(recorder, _) => Some(recorder.words()),
            _ => None,
        }
    }
}
