//! A revolution in segments of whole lines, so that each segment holds all four phases alike.

/// Segments of a revolution.
pub const SEGMENTS: usize = 128;

/// First edge of a segment in a revolution of `edges` (a multiple of 4); `edges` for the segment after the last.
pub fn segment_start(edges: u32, segment: u32) -> u32 {
    const PARTS: u64 = SEGMENTS as u64;
    let lines = u64::from(edges / 4).wrapping_mul(u64::from(segment)) / PARTS;
    (lines as u32).wrapping_mul(4)
}

/// A number of edges modulo a revolution of `edges`, from 0 on.
pub fn within_revolution(number: i64, edges: u32) -> u32 {
    number.checked_rem_euclid(i64::from(edges)).unwrap_or(0) as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn segments_cover_a_revolution_in_whole_lines() {
        for edges in [512, 2000, 10_000, 16_384, 65_536] {
            assert_eq!(segment_start(edges, 0), 0);
            assert_eq!(segment_start(edges, SEGMENTS as u32), edges);
            for segment in 0..SEGMENTS as u32 {
                let (from, to) = (
                    segment_start(edges, segment),
                    segment_start(edges, segment + 1),
                );
                assert!(from < to && from % 4 == 0, "{edges}: {from} {to}");
            }
        }
    }
}
