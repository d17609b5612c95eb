//! The digital filter of an STM32 timer's inputs, chosen from the fastest edges that have to pass.
//!
//! An edge passes when the input kept its new level for N samples in a row, taken every `divider` clocks of the timer
//! (ICxF in `TIMx_CCMR`, with CKD = 00: the sampling clock f_DTS is the timer's). So no two edges behind the filter are nearer
//! than N·`divider` clocks, whatever interference does: [`InputFilter::passed_hz`] bounds what a ring of edge times has to hold.
//!
//! The longest filter is the best against interference that still passes every edge. A ⊕ B has an edge every
//! 1/(4·f_I), f_I being the frequency of one channel (paper P1, formula 5); unequal lines and phases that are off by 45°, what
//! makers of encoders allow, bring two edges as near as half of that. So the filter takes at most half the nominal distance.
//!
//! Both timers that see A and B are given the same code: they then differ by one sampling period, as each has a sampling
//! clock of its own, and by a clock or two of synchronisation ([`InputFilter::skew_clocks`]). (That bound is from the
//! reference manual's block diagram; measure it on a board.)

mod error;
mod inputs;

pub use error::{Bottleneck, FilterError};
pub use inputs::{InputError, Inputs, InputsInForce};

use leadscrew::units::{TIMER_HZ, checked};

/// (N, divider) of the codes 0 to 15 of ICxF; 0 does not filter.
const CODES: [(u16, u16); 16] = [
    (1, 1),
    (2, 1),
    (4, 1),
    (8, 1),
    (6, 2),
    (8, 2),
    (6, 4),
    (8, 4),
    (6, 8),
    (8, 8),
    (5, 16),
    (6, 16),
    (8, 16),
    (5, 32),
    (6, 32),
    (8, 32),
];
/// Shortest filter: below it two timers could not be told to have seen the same edge.
const FIRST_CODE: u8 = 3;
/// Clocks by which two timers differ besides their sampling: synchronisers, and the counter behind its edge.
const SYNC_CLOCKS: u16 = 2;
/// Edges of A and B in a period of one channel.
const EDGES_PER_LINE: f64 = 4.0;
/// Share of the nominal distance of edges that the filter may take.
const SHARE: f64 = 0.5;
const LINE_HZ: (f64, f64) = (1.0, 1e8);

/// A code of the filter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct InputFilter {
    code: u8,
    samples: u16,
    divider: u16,
}

/// What limits the frequency of an encoder's channel, Hz.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineLimits {
    /// The encoder's own (f_I of its data sheet).
    pub encoder_hz: f64,
    /// The line receiver's, with the resistors and capacitors at its inputs.
    pub receiver_hz: f64,
}

impl InputFilter {
    /// The longest filter that passes the edges of a channel of `line_hz`, in a timer of `timer_hz`; `None` if there is none.
    #[must_use]
    pub fn longest(line_hz: f64, timer_hz: f64) -> Option<Self> {
        let clocks = SHARE * timer_hz / (EDGES_PER_LINE * line_hz);
        let codes = CODES.into_iter().zip(0..).skip(FIRST_CODE.into());
        codes
            .map(|((samples, divider), code)| Self {
                code,
                samples,
                divider,
            })
            .filter(|filter| f64::from(filter.clocks()) <= clocks)
            .max_by_key(|filter| filter.clocks())
    }

    /// The shortest that is used, for what is faster than any should be.
    #[must_use]
    pub const fn shortest() -> Self {
        let (samples, divider) = CODES[FIRST_CODE as usize];
        Self {
            code: FIRST_CODE,
            samples,
            divider,
        }
    }

    /// The filter for an axis of `counts_per_mm` that may be as fast as `feed_mm_per_min`. That is the feed at full command:
    /// a drive out of control is to be counted well, too.
    ///
    /// # Errors
    /// [`FilterError`] naming the part that passes least, if the feed is too fast for one; or a value out of range.
    pub fn for_feed(
        feed_mm_per_min: f64,
        counts_per_mm: f64,
        timer_hz: f64,
        limits: &LineLimits,
    ) -> Result<Self, FilterError> {
        let range = |name, value| checked(name, value, LINE_HZ.0, LINE_HZ.1);
        let timer_hz = checked("timer_hz", timer_hz, TIMER_HZ.0, TIMER_HZ.1)?;
        let parts = [
            (Bottleneck::Encoder, range("encoder_hz", limits.encoder_hz)?),
            (
                Bottleneck::Receiver,
                range("receiver_hz", limits.receiver_hz)?,
            ),
            (Bottleneck::Filter, Self::fastest_line_hz(timer_hz)),
        ];
        let line_hz = line_hz(feed_mm_per_min, counts_per_mm);
        let line_hz = checked("line_hz", line_hz, 0.0, LINE_HZ.1)?;
        let least = parts.into_iter().min_by(|a, b| a.1.total_cmp(&b.1));
        match (least, Self::longest(line_hz, timer_hz)) {
            (Some((_, limit_hz)), Some(filter)) if line_hz <= limit_hz => Ok(filter),
            (least, _) => {
                let (part, limit_hz) = least.unwrap_or((Bottleneck::Filter, 0.0));
                Err(FilterError::TooFast {
                    part,
                    line_hz,
                    limit_hz,
                    feed_mm_per_min,
                })
            }
        }
    }

    /// Highest frequency of a channel that a timer of `timer_hz` can filter, Hz.
    fn fastest_line_hz(timer_hz: f64) -> f64 {
        let (samples, divider) = CODES[usize::from(FIRST_CODE)];
        SHARE * timer_hz / (EDGES_PER_LINE * f64::from(samples * divider))
    }

    /// Bits of ICxF.
    #[must_use]
    pub const fn code(self) -> u8 {
        self.code
    }

    /// Clocks of the timer for which a level has to last.
    #[must_use]
    pub const fn clocks(self) -> u16 {
        self.samples * self.divider
    }

    /// Most edges of A and B together that pass in a second, whatever comes in, Hz.
    #[must_use]
    pub fn passed_hz(self, timer_hz: f64) -> f64 {
        timer_hz / f64::from(self.clocks())
    }

    /// Clocks by which an edge behind this filter is later than one behind a filter of `clocks`: each passes when its level has
    /// lasted, so times behind unlike filters are of unlike moments.
    #[must_use]
    pub const fn later_than(self, clocks: u16) -> i32 {
        self.clocks() as i32 - clocks as i32
    }

    /// Clocks by which two timers with this filter may see an edge apart, for [`EdgeRing::new`](crate::edge_ring::EdgeRing::new).
    #[must_use]
    pub const fn skew_clocks(self) -> u16 {
        self.divider - 1 + SYNC_CLOCKS
    }
}

/// Frequency of one channel at a feed, Hz: F·K/(4·60), which is n·Z/60 (P1, formula 5) with 4·Z counts a revolution.
#[must_use]
pub fn line_hz(feed_mm_per_min: f64, counts_per_mm: f64) -> f64 {
    feed_mm_per_min * counts_per_mm / (EDGES_PER_LINE * 60.0)
}

#[cfg(test)]
mod tests {
    extern crate std;

    use std::string::ToString;

    use leadscrew::units::line_frequency_hz;

    use super::*;

    const LIMITS: LineLimits = LineLimits {
        encoder_hz: 300e3,
        receiver_hz: 1e6,
    };

    #[test]
    fn the_frequency_is_that_of_the_paper() {
        // 9 000 mm/min of a screw of 10 mm: 900 rpm, 2 500 lines, 1 000 d/mm.
        let paper = line_frequency_hz(900.0, 2500.0);
        assert_eq!(paper, Ok(line_hz(9000.0, 1000.0)));
    }

    #[test]
    fn filters_of_the_16k20f3_and_of_the_fastest_encoder() {
        let lathe = InputFilter::for_feed(9600.0, 1000.0, 84e6, &LIMITS);
        // 40 kHz: edges 525 clocks apart, 256 are the longest filter of all.
        assert_eq!(
            lathe.map(|filter| (filter.code(), filter.clocks())),
            Ok((15, 256))
        );
        // 300 kHz, 1.2 M edges a second: 70 clocks apart.
        let fastest = InputFilter::for_feed(72_000.0, 1000.0, 84e6, &LIMITS);
        assert_eq!(
            fastest.map(|filter| (filter.code(), filter.clocks())),
            Ok((7, 32))
        );
        assert_eq!(fastest.map(|filter| filter.passed_hz(84e6)), Ok(2.625e6));
    }

    #[test]
    fn the_longest_that_passes_is_taken_and_no_longer_one() {
        let mut seen = 0_u32;
        for clocks in 8..600_u16 {
            let line_hz = 84e6 / (8.0 * f64::from(clocks));
            let Some(filter) = InputFilter::longest(line_hz, 84e6) else {
                continue;
            };
            seen |= 1 << filter.code();
            assert!(filter.clocks() <= clocks);
            let longer = CODES.iter().map(|(samples, divider)| samples * divider);
            assert!(
                !longer
                    .into_iter()
                    .any(|other| other > filter.clocks() && other <= clocks)
            );
        }
        // All but the short ones, and one of the pairs that are equally long: 8·8 and none else.
        assert_eq!(seen, 0xfff8);
    }

    #[test]
    fn an_edge_is_later_by_as_much_as_its_filter_is_longer() {
        let lathe = InputFilter::longest(40e3, 84e6).unwrap();
        assert_eq!(lathe.later_than(32), 224);
        assert_eq!(InputFilter::shortest().later_than(32), -24);
    }

    #[test]
    fn behind_a_filter_one_edge_at_most_is_in_doubt_at_a_sample() {
        for code in FIRST_CODE..16 {
            let (samples, divider) = CODES[usize::from(code)];
            let filter = InputFilter {
                code,
                samples,
                divider,
            };
            assert!(filter.clocks() > 2 * filter.skew_clocks(), "{code}");
        }
    }

    #[test]
    fn a_feed_that_is_too_fast_is_refused_by_the_part_that_passes_least() {
        let refused = |feed, limits: &LineLimits| InputFilter::for_feed(feed, 1000.0, 84e6, limits);
        let message = |result: Result<_, FilterError>| {
            result.map_or_else(|error| error.to_string(), |_| "".into())
        };
        assert_eq!(
            message(refused(72_001.0, &LIMITS)),
            "72001 mm/min are 300004 Hz on each channel of the encoder, the encoder gives 300000 Hz: allowed are \
             72000.0 mm/min at full command"
        );
        let slow = LineLimits {
            receiver_hz: 10e3,
            ..LIMITS
        };
        assert!(
            message(refused(9600.0, &slow))
                .contains("the line receiver passes 10000 Hz: allowed are 2400.0 mm/min")
        );
        let fast = LineLimits {
            encoder_hz: 5e6,
            receiver_hz: 5e6,
        };
        assert!(message(refused(400_000.0, &fast)).contains("the input filter passes 1312500 Hz"));
        assert!(refused(315_000.0, &fast).is_ok());
        assert!(matches!(
            refused(f64::NAN, &LIMITS),
            Err(FilterError::Range(_))
        ));
        let none = LineLimits {
            encoder_hz: 0.0,
            ..LIMITS
        };
        assert!(matches!(refused(1.0, &none), Err(FilterError::Range(_))));
    }
}
