//! Why data do not suffice, and what to do.

use core::fmt;

/// Data from which no map can be learned. The text says what to do. It goes over the link: variants are only appended.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[non_exhaustive]
pub enum Refusal {
    /// Edges per revolution that cannot be mapped.
    EdgesPerRevolution {
        /// What was asked for.
        edges: u32,
        /// Fewest.
        min: u32,
        /// Most.
        max: u32,
    },
    /// Less work memory than an entry for each edge.
    WorkMemory {
        /// Entries given.
        given: usize,
        /// Entries needed.
        needed: u32,
    },
    /// No run was begun.
    NoRun,
    /// More runs than are kept for comparison.
    TooManyRuns {
        /// Most runs.
        limit: usize,
    },
    /// Fewer revolutions than the average needs.
    TooFewRevolutions {
        /// Whole revolutions seen or asked for.
        found: u32,
        /// Revolutions needed.
        needed: u32,
    },
    /// Edge times are missing, false or not captured at all.
    MissedEdges {
        /// Revolution of the run, from the index on.
        revolution: u32,
    },
    /// The shaft turned back.
    Reversed {
        /// Revolution of the run, from the index on.
        revolution: u32,
    },
    /// A revolution takes longer than the timer can tell.
    TooSlow {
        /// Longest revolution, s.
        longest_s: f64,
    },
    /// The speed does not keep to what the first revolutions gave.
    SpeedChanging {
        /// Revolution of the run, from the index on.
        revolution: u32,
        /// Change as a part of the speed.
        change: f64,
        /// Largest change allowed.
        limit: f64,
    },
    /// No index in a revolution.
    IndexMissing {
        /// Revolution of the run, from the index on.
        revolution: u32,
    },
    /// An index where none belongs.
    IndexInconsistent {
        /// Revolution of the run, from the index on.
        revolution: u32,
        /// Counts by which it is off its place, modulo a revolution.
        off_by: i32,
    },
    /// The pattern of the lines lies elsewhere than the index says.
    PatternShifted {
        /// Number of the run, from 0.
        run: usize,
        /// Counts by which the pattern is off.
        off_by: i32,
    },
    /// The lines of two runs have nothing in common.
    PatternDiffers {
        /// Number of the run, from 0.
        run: usize,
    },
    /// A placement error beyond what a map can hold.
    ErrorTooLarge {
        /// The error, d.
        error_d: f64,
        /// Largest error held, d.
        limit_d: f64,
    },
    /// All runs were at about one speed.
    OneSpeed {
        /// Slowest run, d/s.
        slowest_d_s: f64,
        /// Fastest run, d/s.
        fastest_d_s: f64,
        /// Ratio needed.
        ratio: f64,
    },
    /// All runs were in one direction.
    OneDirection,
    /// Runs differ in a harmonic of the revolution.
    RunsDisagree {
        /// Cycles a revolution.
        order: u32,
        /// Amplitude by which the worst run differs from the mean, d.
        difference_d: f64,
        /// Largest difference allowed, d.
        limit_d: f64,
        /// Number of that run, from 0.
        run: usize,
    },
    /// A run differs from those before in short waves.
    LinesDisagree {
        /// Number of the run, from 0.
        run: usize,
        /// Difference in waves shorter than the 32nd part of a revolution, d rms.
        difference_d: f64,
        /// Largest difference allowed, d.
        limit_d: f64,
    },
    /// Edges do not repeat well enough.
    ResidualTooLarge {
        /// Estimated error of an edge of the map, d rms.
        residual_d: f64,
        /// Largest allowed, d.
        limit_d: f64,
    },
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::EdgesPerRevolution { edges, min, max } => write!(
                f,
                "{edges} edges per revolution: expected a multiple of 4 from {min} to {max} (4 times the lines)"
            ),
            Self::WorkMemory { given, needed } => write!(
                f,
                "work memory for {given} edges, {needed} are needed: give larger slices"
            ),
            Self::NoRun => f.write_str("no run: begin one, feed it to its end, then end it"),
            Self::TooManyRuns { limit } => {
                write!(f, "more than {limit} runs: finish with those there are")
            }
            Self::TooFewRevolutions { found, needed } => write!(
                f,
                "{found} revolutions, {needed} are needed: record a longer run"
            ),
            Self::MissedEdges { revolution } => write!(
                f,
                "edge times missed or false in revolution {revolution}: capture every edge, without overrun; \
                 run slower or look at the wiring"
            ),
            Self::Reversed { revolution } => write!(
                f,
                "the shaft turned back in revolution {revolution}: a run goes one way only"
            ),
            Self::TooSlow { longest_s } => write!(
                f,
                "a revolution takes longer than {longest_s:.1} s: run faster"
            ),
            Self::SpeedChanging {
                revolution,
                change,
                limit,
            } => write!(
                f,
                "the speed changed by {:.2} % by revolution {revolution}, allowed are {:.2} %: begin when it is \
                 steady, hold the feed",
                100.0 * change,
                100.0 * limit
            ),
            Self::IndexMissing { revolution } => {
                write!(f, "no index in revolution {revolution}: look at channel Z")
            }
            Self::IndexInconsistent { revolution, off_by } => write!(
                f,
                "the index in revolution {revolution} is {off_by} counts off: the count slipped, Z is disturbed, or \
                 the edges per revolution are others"
            ),
            Self::PatternShifted { run, off_by } => write!(
                f,
                "the lines of run {run} lie {off_by} counts from those before: the count slipped, or does not begin \
                 with the state of A and B"
            ),
            Self::PatternDiffers { run } => write!(
                f,
                "the lines of run {run} are not those of the runs before: another encoder, or the index moved"
            ),
            Self::ErrorTooLarge { error_d, limit_d } => write!(
                f,
                "an edge is off by {error_d:.2} d, a map holds {limit_d:.2} d: mount the encoder better, or run more \
                 steadily"
            ),
            Self::OneSpeed {
                slowest_d_s,
                fastest_d_s,
                ratio,
            } => write!(
                f,
                "runs at {slowest_d_s:.0} to {fastest_d_s:.0} d/s only: add a run at {ratio} times the speed or more, \
                 or accept one speed"
            ),
            Self::OneDirection => f.write_str(
                "runs in one direction only: add one the other way, or accept one direction",
            ),
            Self::RunsDisagree {
                order,
                difference_d,
                limit_d,
                run,
            } => write!(
                f,
                "run {run} differs by {difference_d:.3} d at {order} cycles a revolution, allowed are {limit_d:.3} d: \
                 the motion trembles there; learn anew at another speed (some 20 % off) or over more revolutions"
            ),
            Self::LinesDisagree {
                run,
                difference_d,
                limit_d,
            } => write!(
                f,
                "run {run} differs by {difference_d:.3} d in short waves, allowed are {limit_d:.3} d: the motion hums, or \
                 the lines change with speed; learn anew at another speed (a few % off)"
            ),
            Self::ResidualTooLarge {
                residual_d,
                limit_d,
            } => write!(
                f,
                "the map's edges are uncertain by {residual_d:.4} d, allowed are {limit_d:.4} d: use more revolutions \
                 or a slower feed"
            ),
        }
    }
}

impl core::error::Error for Refusal {}
