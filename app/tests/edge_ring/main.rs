//! Edge times and counts of a model of timers, DMA and handler, interleaved in every way.

mod fast;
mod interleavings;
mod losses;
mod model;
mod stamps;
