//! Simulated scenes to tune on.

use clap::ValueEnum;
use leadscrew::edges::EdgeConfig;
use leadscrew::uncertainty::EdgeErrors;
use leadscrew::units::RangeError;
use leadscrew_hal_mock::encoder::{EncoderModel, EncoderParams};
use leadscrew_hal_mock::scene::{Motion, Scene};

use super::judge::{Judge, warm_up};
use super::sweep::Candidate;
use crate::listening::Listening;
use crate::progress::Progress;
use crate::truth::TruthTrack;

/// Sampling jitter with which plain differences at 130 d/tick and 1 kHz have the σ_a of P2's Table 1, 1.695.
const TABLE_1_JITTER_S: f64 = 4.82e-6;
/// Whole revolutions of 10 000 d at any whole velocity.
const STEADY_TICKS: u32 = 10_000;
/// The flywheel stands after 3 333 ticks.
const COASTING_TICKS: u32 = 2_500;

/// Names of the scenes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum SceneName {
    #[value(name = "table-1")]
    /// P2's Table 1: 130 d/tick, ideal encoder, sampling jitter of 4.82 µs
    Table1,
    /// 150 d/tick, encoder with the errors of a real disc, no map
    Real,
    /// 5 d/tick, the same encoder
    RealSlow,
    /// P1's flywheel: coasts from 20 d/tick at −0.006 d/tick², ideal encoder
    Flywheel,
}

impl SceneName {
    /// What it is, in words.
    pub(super) const fn description(self) -> &'static str {
        match self {
            Self::Table1 => {
                "scene table-1: ideal encoder at 130 d/tick, sampled with a jitter of 4.82 µs"
            }
            Self::Real => "scene real: encoder with the errors of a real disc, no map, 150 d/tick",
            Self::RealSlow => {
                "scene real-slow: encoder with the errors of a real disc, no map, 5 d/tick"
            }
            Self::Flywheel => {
                "scene flywheel: ideal encoder, coasting from 20 d/tick at -0.006 d/tick²"
            }
        }
    }

    fn motion(self) -> (Motion, u32) {
        let steady = |velocity| (Motion::Steady { velocity }, STEADY_TICKS);
        match self {
            Self::Table1 => steady(130.0),
            Self::Real => steady(150.0),
            Self::RealSlow => steady(5.0),
            Self::Flywheel => (Motion::FLYWHEEL, COASTING_TICKS),
        }
    }

    fn encoder(self) -> EncoderModel {
        let ideal = EncoderModel::ideal();
        match self {
            Self::Table1 => EncoderModel {
                encoder: EncoderParams {
                    sampling_jitter_s: TABLE_1_JITTER_S,
                    ..ideal.encoder
                },
                ..ideal
            },
            Self::Real | Self::RealSlow => EncoderModel::default(),
            Self::Flywheel => ideal,
        }
    }

    /// Errors of all candidates against the truth at the instant of each estimate.
    ///
    /// # Errors
    /// A control rate out of range.
    pub(super) fn judge(
        self,
        candidates: &[Candidate],
        tick_hz: f64,
        seed: u64,
    ) -> Result<Vec<Judge>, RangeError> {
        let (motion, ticks) = self.motion();
        let encoder = self.encoder();
        let mut scene = Scene::new(motion, &encoder, tick_hz, 0.0, seed)?;
        let timer_hz = encoder.encoder.timer_hz;
        let edges = EdgeConfig::new(tick_hz, timer_hz, &EdgeErrors::default())?;
        let configs: Vec<_> = candidates
            .iter()
            .map(|candidate| candidate.config)
            .collect();
        let mut listening = Listening::new(&configs, edges);
        let mut truth = TruthTrack::default();
        let mut judges = vec![Judge::default(); candidates.len()];
        let first = warm_up(candidates);
        let mut progress = Progress::new("simulating", first + u64::from(ticks));
        for tick in 0..first as usize + ticks as usize {
            scene.step();
            truth.push(scene.truth());
            listening.hear(&scene.capture(), None, |index, estimate| {
                if tick >= first as usize {
                    let at = |lag| Some(truth.before(tick, lag)?.acceleration);
                    judges[index].push(&estimate, at);
                }
            });
            progress.step();
        }
        Ok(judges)
    }
}
