//! The count at an event of which hardware stamped the time alone.

use super::Taken;

/// The count at `time`, a stamp of the timer of the edges between the last sample and this one; `edges` are those of
/// [`Taken::span`].
///
/// Each edge that came after the stamp moved the count by one, in a tick without reversal all of them one way: the count then
/// is that of the sample less those edges. Binary search: time grows with the logarithm of the edges.
///
/// `None` where the edges do not tell: the stamp is later than the sample (it belongs to the next tick), times were lost, or
/// the axis reversed within the tick and edges came on both sides of the stamp. The count that the event's own handler read
/// stands in then. A stamp within the skew of the sample, or of an edge, is right to one count.
#[must_use]
pub fn count_at<const WORDS: usize>(
    taken: &Taken<WORDS>,
    edges: [&[u32]; 2],
    time: u32,
) -> Option<u32> {
    let age = taken.sampled_at.wrapping_sub(time);
    if taken.overrun || age.cast_signed() < 0 {
        return None;
    }
    let total = edges[0].len().wrapping_add(edges[1].len());
    let before = edges
        .iter()
        .map(|part| part.partition_point(|edge| taken.sampled_at.wrapping_sub(*edge) >= age))
        .fold(0, usize::wrapping_add);
    let after = total.wrapping_sub(before) as u32;
    let moved = taken.moved;
    if after == 0 {
        Some(taken.count)
    } else if before == 0 {
        Some(taken.count.wrapping_sub(moved.cast_unsigned()))
    } else if total == moved.unsigned_abs() as usize {
        let back = if moved < 0 {
            after.wrapping_neg()
        } else {
            after
        };
        Some(taken.count.wrapping_sub(back))
    } else {
        None
    }
}
