//! The memory of edge times, which a DMA writes for ever.

use core::cell::UnsafeCell;

use leadscrew_app::edge_ring::Span;

use crate::encoder::RING;

/// The ring; there is one.
pub struct Ring(UnsafeCell<[u32; RING]>);

// SAFETY: the program only reads it, in the tick alone; what writes is the DMA, beside which the reads are volatile or of
// words that it does not write meanwhile (see `slices`).
unsafe impl Sync for Ring {}

/// In SRAM: the DMA does not reach the CCM.
pub static EDGES: Ring = Ring(UnsafeCell::new([0; RING]));

impl Ring {
    /// For the DMA.
    pub const fn address(&self) -> *mut [u32; RING] {
        self.0.get()
    }

    /// One word, as it is now.
    #[inline(always)]
    pub fn word(&self, index: usize) -> u32 {
        let words = self.0.get().cast::<u32>();
        // SAFETY: the index is within the ring by the mask, and the pointer is aligned; volatile, as the DMA writes.
        unsafe { words.add(index % RING).read_volatile() }
    }

    /// The words of a span, to be used up before the tick ends.
    #[inline(always)]
    pub fn slices(&self, span: &Span<RING>) -> [&[u32]; 2] {
        span.runs().map(|run| {
            let words = self.0.get().cast::<u32>();
            let (start, len) = (run.start.min(RING), run.len().min(RING - run.start.min(RING)));
            // SAFETY: within the ring by the two lines above. The DMA is past these words and comes back to them only after
            // half a ring of further edges, which the tick does not last: the argument is in `leadscrew_app::edge_ring`,
            // and `hold`, on which it rests, was asked at boot (`crate::tick`): without it no span is taken.
            unsafe { core::slice::from_raw_parts(words.add(start), len) }
        })
    }
}
