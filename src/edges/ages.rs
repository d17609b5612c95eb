//! How long the edges of a tick lie before its sample, added up.

use crate::capture::Observation;

/// Ages below [`MAX_SPAN_TICKS`](super::MAX_SPAN_TICKS) of so many edges add up in 32 bits at every clock and rate.
const CHUNK: usize = 128;

/// How long the `edges` edges at `times` lie before the sample, added up, clocks.
pub(super) fn sum(observation: &Observation<'_>, times: [&[u32]; 2], edges: u32) -> u64 {
    let now = observation.sampled_at as u32;
    // None is older than the tick.
    if observation.elapsed.checked_mul(edges).is_some() {
        let [older, newer] = times.map(wrapping_sum);
        let sum = older.wrapping_add(newer);
        return u64::from(now.wrapping_mul(edges).wrapping_sub(sum));
    }
    chunked_sum(now, times)
}

/// The same where it needs more than 32 bits.
#[cold]
fn chunked_sum(now: u32, times: [&[u32]; 2]) -> u64 {
    let chunks = times.into_iter().flat_map(|times| times.chunks(CHUNK));
    chunks.fold(0, |total, times| {
        let ages = now
            .wrapping_mul(times.len() as u32)
            .wrapping_sub(wrapping_sum(times));
        total.wrapping_add(u64::from(ages))
    })
}

/// The sum of all, modulo 2³². A function of its own, four at a time, in pairs: with its registers to itself an edge
/// costs little more than its addition, and eights were so unrolled that they did not fit in them.
#[inline(never)]
fn wrapping_sum(times: &[u32]) -> u32 {
    let (fours, rest) = times.as_chunks::<4>();
    let mut sum = 0_u32;
    for &[a, b, c, d] in fours {
        let (one, other) = (a.wrapping_add(b), c.wrapping_add(d));
        sum = sum.wrapping_add(one.wrapping_add(other));
    }
    rest.iter().copied().fold(sum, u32::wrapping_add)
}
