//! What a learned map is worth.

use super::bands::Bands;
use super::refusal::Refusal;

/// Runs that are kept for comparison.
pub const MAX_RUNS: usize = 8;
/// Ratio of speeds from which on two runs are at different speeds.
pub const SPEED_RATIO: f64 = 1.2;

/// What a finished map must satisfy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Requirements {
    /// Runs at two speeds, a factor of 1.2 apart: without them nothing shows that the motion trembles in step
    /// with the shaft at the speed of the run.
    pub two_speeds: bool,
    /// Runs in both directions: without them the hysteresis is unknown.
    pub both_directions: bool,
    /// Most that a run may differ from the mean of all in one harmonic up to 32, and from the runs before in
    /// shorter waves, rms, d.
    pub max_disagreement_d: f64,
    /// Largest error of an edge of the map by what does not repeat, d rms.
    pub max_edge_residual_d: f64,
}

impl Requirements {
    /// Takes what there is; [`Report::check`] then tells what it does not satisfy.
    pub const NONE: Self = Self {
        two_speeds: false,
        both_directions: false,
        max_disagreement_d: f64::INFINITY,
        max_edge_residual_d: f64::INFINITY,
    };
}

impl Default for Requirements {
    /// Two speeds, both directions, 0.01 d in a harmonic, 0.01 d an edge.
    fn default() -> Self {
        Self {
            two_speeds: true,
            both_directions: true,
            max_disagreement_d: 0.01,
            max_edge_residual_d: 0.01,
        }
    }
}

/// One run.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct RunSummary {
    /// The shaft went backward.
    pub backward: bool,
    /// Revolutions in the average.
    pub revolutions: u32,
    /// Speed, d/s.
    pub speed_d_s: f64,
    /// Noise of one pass of an edge at this speed: its place and its time, d rms.
    pub pass_sigma_d: f64,
    /// Errors that the run shows, d rms.
    pub errors: Bands,
    /// The same less the mean of the runs before: what a map learned from those leaves on this run, d rms. None
    /// for the first run.
    pub less_earlier_runs: Option<Bands>,
    /// Second half of the run less its first half, harmonics only, d rms. A half averages over half the
    /// revolutions: this is more than the error of the whole.
    pub halves: Bands,
}

/// The harmonic in which a run differs most from the mean of all.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Disagreement {
    /// Cycles a revolution.
    pub order: u32,
    /// Amplitude of the difference, d.
    pub difference_d: f64,
    /// Number of the run, from 0.
    pub run: usize,
}

/// What no report can show, to be told with every map.
pub const NOT_SEPARATED: &str = "motion in step with the shaft at every speed (a bent screw, an unbalanced or \
    toothed drive) cannot be told from the encoder's errors by the encoder itself: it is in the map";

/// Estimated errors of the map; see [`NOT_SEPARATED`] for what they do not show.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Residual {
    /// White error of each edge, d rms.
    pub edge_sigma_d: f64,
    /// Error of the harmonics up to 32, d rms.
    pub long_wave_d: f64,
    /// Their slope, d/d rms: times v it is an error of velocity.
    pub slope: f64,
    /// Their curvature, 1/d rms: times v² it is an error of acceleration.
    pub curvature_per_d: f64,
    /// Slope of those that stand out of the white error, d/d rms: what is to be stated besides it.
    pub standing_slope: f64,
    /// Curvature of the same, 1/d rms.
    pub standing_curvature_per_d: f64,
}

/// Noise of edges told apart by the speed of the runs: variance σ_d² + (σ_s·v)².
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Noise {
    /// Noise of an edge's place, d rms.
    pub place_d: f64,
    /// Noise of an edge's time, the step of the timer included, s rms.
    pub time_s: f64,
}

/// What a learned map is worth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Report {
    runs: [RunSummary; MAX_RUNS],
    run_count: usize,
    /// The errors learned: what stays without a map, the four phases apart, d rms.
    pub errors: Bands,
    /// Where the runs disagree most; order 0 for a single run.
    pub disagreement: Disagreement,
    /// Estimated errors of the map.
    pub residual: Residual,
    /// Noise by place and by time; none with one speed.
    pub noise: Option<Noise>,
    /// Hysteresis of A less that of B, d; none with one direction. What both have in common moves the whole
    /// scale with the direction and cannot be seen from steady feeds.
    pub hysteresis_a_less_b_d: Option<f64>,
    /// All runs were at about one speed.
    pub one_speed: bool,
}

impl Report {
    pub(super) const fn new(runs: [RunSummary; MAX_RUNS], run_count: usize) -> Self {
        const NONE: Bands = Bands {
            first: 0.0,
            second: 0.0,
            third_to_tenth: 0.0,
            eleventh_to_32nd: 0.0,
            lines: 0.0,
            edges: 0.0,
        };
        Self {
            runs,
            run_count,
            errors: NONE,
            disagreement: Disagreement {
                order: 0,
                difference_d: 0.0,
                run: 0,
            },
            residual: Residual {
                edge_sigma_d: 0.0,
                long_wave_d: 0.0,
                slope: 0.0,
                curvature_per_d: 0.0,
                standing_slope: 0.0,
                standing_curvature_per_d: 0.0,
            },
            noise: None,
            hysteresis_a_less_b_d: None,
            one_speed: false,
        }
    }

    /// The runs in their order.
    #[must_use]
    pub fn runs(&self) -> &[RunSummary] {
        self.runs.get(..self.run_count).unwrap_or(&[])
    }

    /// Refuses what does not satisfy the requirements.
    ///
    /// # Errors
    /// [`Refusal`] of the first requirement that is not met.
    pub fn check(&self, requirements: &Requirements) -> Result<(), Refusal> {
        let one_direction = self.hysteresis_a_less_b_d.is_none();
        if requirements.both_directions && one_direction {
            return Err(Refusal::OneDirection);
        }
        if requirements.two_speeds && self.one_speed {
            let (slowest_d_s, fastest_d_s) = self.speeds();
            return Err(Refusal::OneSpeed {
                slowest_d_s,
                fastest_d_s,
                ratio: SPEED_RATIO,
            });
        }
        let Disagreement {
            order,
            difference_d,
            run,
        } = self.disagreement;
        let limit_d = requirements.max_disagreement_d;
        if difference_d > limit_d {
            return Err(Refusal::RunsDisagree {
                order,
                difference_d,
                limit_d,
                run,
            });
        }
        self.check_lines(limit_d)?;
        let residual_d = self.residual.edge_sigma_d;
        let limit_d = requirements.max_edge_residual_d;
        if residual_d > limit_d {
            return Err(Refusal::ResidualTooLarge {
                residual_d,
                limit_d,
            });
        }
        Ok(())
    }

    /// Refuses runs that differ in short waves from those before.
    fn check_lines(&self, limit_d: f64) -> Result<(), Refusal> {
        for (run, summary) in self.runs().iter().enumerate() {
            let off = summary.less_earlier_runs.unwrap_or_default();
            let difference_d = off.lines.max(off.edges);
            if difference_d > limit_d {
                return Err(Refusal::LinesDisagree {
                    run,
                    difference_d,
                    limit_d,
                });
            }
        }
        Ok(())
    }

    /// Slowest and fastest run, d/s.
    pub(super) fn speeds(&self) -> (f64, f64) {
        let speeds = self.runs().iter().map(|run| run.speed_d_s);
        speeds.fold((f64::INFINITY, 0.0), |(slowest, fastest), speed| {
            (speed.min(slowest), speed.max(fastest))
        })
    }
}
