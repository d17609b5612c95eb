//! A stack that grows down over paint.

/// Words from its far end on that were never used, of a stack of `words`; `is_painted` tells of one, counted from that end.
/// A frame may leave words of its own as they were, so what counts is the first that is not painted.
pub fn untouched(words: usize, is_painted: impl Fn(usize) -> bool) -> usize {
    (0..words)
        .find(|index| !is_painted(*index))
        .unwrap_or(words)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_used_farthest_counts_whatever_is_painted_behind_it() {
        let untouched = |used: &[usize]| untouched(100, |index| !used.contains(&index));
        assert_eq!(untouched(&[]), 100);
        assert_eq!(untouched(&[99, 98, 97]), 97);
        assert_eq!(
            untouched(&[99, 60, 59, 98]),
            59,
            "a frame with a hole in it"
        );
        assert_eq!(untouched(&[0, 99]), 0);
    }
}
