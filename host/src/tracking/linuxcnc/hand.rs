//! The law tuned as well as it can be: what a patient hand would find, found by a search.
//!
//! From a coarse grid of P, I and D the best few are refined gain by gain with ever smaller steps; what counts is the
//! largest following error of the move on the machines that it is tuned for, with any of the five encoders. Gains by
//! which the output oscillates at rest are no tuning. All gains have three digits, so that the search gives the
//! constants below exactly: `leadscrew tracking --tune-linuxcnc` runs it.

use super::PidParams;
use super::bench::Bench;
use super::margins::Margins;
use crate::parallel;
use crate::tracking::error::TrackingError;
use crate::tracking::scene::Scene;
use crate::tracking::trace::MoveFigures;
use crate::tracking::{SEEDS, setpoints};

/// Tuned for the full nominal machine, [`Manner::WithMargins`].
pub const WITH_MARGINS: PidParams = PidParams {
    p: 36.1,
    i: 655.0,
    d: 1.5,
    ff1: 0.985,
    ff2: 0.0143,
    bias: 3130.0,
    ..NONE
};

/// Tuned for the full nominal machine, [`Manner::ToTheEdge`].
pub const TO_THE_EDGE: PidParams = PidParams {
    p: 101.0,
    i: 1810.0,
    d: 3.0,
    ff1: 1.0,
    ff2: 0.0143,
    bias: 1110.0,
    ..NONE
};

/// Tuned for the worst of the full nominal machine and both off nominal, [`Manner::EveryGain`]: by one who knows
/// them all.
pub const FOR_ALL: PidParams = PidParams {
    p: 90.0,
    i: 1960.0,
    d: 1.43,
    ff1: 1.0,
    ff2: 0.0184,
    ff3: 0.000_197,
    bias: 2930.0,
    ..NONE
};

/// All gains zero.
pub const NONE: PidParams = PidParams {
    p: 0.0,
    i: 0.0,
    d: 0.0,
    ff0: 0.0,
    ff1: 0.0,
    ff2: 0.0,
    ff3: 0.0,
    bias: 0.0,
    deadband: 0.0,
    max_error: 0.0,
    max_error_i: 0.0,
    max_error_d: 0.0,
    max_command_d: 0.0,
    max_command_dd: 0.0,
    max_command_ddd: 0.0,
    max_output: 0.0,
};

/// A machine to tune for, with the course on it.
#[derive(Clone, Debug)]
pub struct Lesson {
    /// The machine.
    pub scene: Scene,
    /// Setpoints, d.
    pub setpoints: Vec<f64>,
    /// The encoder.
    pub seed: u64,
}

/// What gains come to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tuned {
    /// The gains.
    pub params: PidParams,
    /// Largest following error of all lessons, d; infinite where the output oscillates.
    pub cost: f64,
}

/// How one tunes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Manner {
    /// P, I, D, FF1, FF2, bias, deadband, with 6 dB and 30° in hand on the nominal drive: as our own tuning must have.
    WithMargins,
    /// The same gains to the very edge, nothing in hand.
    ToTheEdge,
    /// FF3 as well, nothing in hand, for the worst of the full nominal machine and both off nominal.
    EveryGain,
}

impl Manner {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::WithMargins, Self::ToTheEdge, Self::EveryGain];

    /// What the search of it found.
    #[must_use]
    pub const fn found(self) -> PidParams {
        match self {
            Self::WithMargins => WITH_MARGINS,
            Self::ToTheEdge => TO_THE_EDGE,
            Self::EveryGain => FOR_ALL,
        }
    }
}

/// What is tuned for in a `manner`.
///
/// # Errors
/// Never with the scenes built in, which a test shows.
pub fn lessons(manner: Manner) -> Result<Vec<Lesson>, TrackingError> {
    let [_, full, _, low, high] = Scene::of_moves();
    let scenes = match manner {
        Manner::WithMargins | Manner::ToTheEdge => vec![full],
        Manner::EveryGain => vec![full, low, high],
    };
    let mut lessons = Vec::new();
    for scene in scenes {
        let mut setpoints = setpoints(&scene)?;
        setpoints.truncate(setpoints.len().saturating_sub(LEFT_OUT_TICKS));
        for seed in SEEDS {
            lessons.push(Lesson {
                scene,
                setpoints: setpoints.clone(),
                seed,
            });
        }
    }
    Ok(lessons)
}

/// Of the rest at the end of the course, which takes time and teaches nothing, ticks.
const LEFT_OUT_TICKS: usize = 8500;
/// Best of the grid that are refined.
const REFINED: usize = 4;
/// Relative steps of the refinement, coarse to fine.
const STEPS: [f64; 6] = [0.5, 0.25, 0.12, 0.06, 0.03, 0.015];
/// Most rounds through all gains with one step.
const ROUNDS: usize = 6;

impl Lesson {
    /// Largest following error with `params`, infinite where the output oscillates.
    fn cost(&self, params: &PidParams) -> Result<f64, TrackingError> {
        let machine = self.scene.machine();
        let bench = Bench::new(&self.scene.nominal, &machine, self.seed)?;
        let figures = MoveFigures::of(&bench.follow(params, &self.setpoints));
        Ok(if figures.oscillates() {
            f64::INFINITY
        } else {
            figures.peak
        })
    }
}

/// What `params` come to in all lessons; no better than `enough` where the rest of them does not matter.
///
/// # Errors
/// A parameter out of range.
pub fn judge(
    lessons: &[Lesson],
    params: &PidParams,
    manner: Manner,
    enough: f64,
) -> Result<Tuned, TrackingError> {
    let mut cost = 0.0_f64;
    for lesson in lessons {
        let drive = &lesson.scene.nominal.drive;
        if manner == Manner::WithMargins && !Margins::of(params, drive).suffice() {
            cost = f64::INFINITY;
            break;
        }
        cost = cost.max(lesson.cost(params)?);
        if cost >= enough {
            break;
        }
    }
    Ok(Tuned {
        params: *params,
        cost,
    })
}

/// Searches the best gains for `lessons`.
///
/// # Errors
/// A parameter out of range.
pub fn search(lessons: &[Lesson], manner: Manner) -> Result<Tuned, TrackingError> {
    let mut found = judged(lessons, &grid(), manner)?;
    found.sort_by(|one, other| one.cost.total_cmp(&other.cost));
    found.truncate(REFINED);
    let refined = parallel::map(&found, |start| refine(lessons, *start, manner));
    let refined = refined.into_iter().collect::<Result<Vec<_>, _>>()?;
    let best = refined
        .into_iter()
        .min_by(|one, other| one.cost.total_cmp(&other.cost));
    best.map_or_else(|| judge(lessons, &NONE, manner, f64::INFINITY), Ok)
}

fn judged(
    lessons: &[Lesson],
    all: &[PidParams],
    manner: Manner,
) -> Result<Vec<Tuned>, TrackingError> {
    let judged = parallel::map(all, |params| judge(lessons, params, manner, f64::INFINITY));
    judged.into_iter().collect()
}

/// Coarse gains; the feedforwards are those of the drive's data sheet.
fn grid() -> Vec<PidParams> {
    let mut all = Vec::new();
    for p in [5.0, 10.0, 20.0, 40.0] {
        for integral_rate in [0.5, 2.0, 8.0] {
            for d in [0.0, 0.3, 1.0, 3.0] {
                for deadband in [0.0, 0.6] {
                    all.push(PidParams {
                        p,
                        i: p * integral_rate,
                        d,
                        ff1: 1.0,
                        ff2: 0.0143,
                        deadband,
                        ..NONE
                    });
                }
            }
        }
    }
    all
}

/// A gain, and the least step that is made of it where it is small.
type Knob = (fn(&mut PidParams) -> &mut f64, f64);

const KNOBS: [Knob; 7] = [
    (|params| &mut params.p, 1.0),
    (|params| &mut params.i, 1.0),
    (|params| &mut params.d, 0.1),
    (|params| &mut params.ff1, 0.1),
    (|params| &mut params.ff2, 0.002),
    (|params| &mut params.bias, 500.0),
    (|params| &mut params.ff3, 1e-4),
];

fn refine(lessons: &[Lesson], start: Tuned, manner: Manner) -> Result<Tuned, TrackingError> {
    let knobs = match manner {
        Manner::WithMargins | Manner::ToTheEdge => &KNOBS[..6],
        Manner::EveryGain => &KNOBS[..],
    };
    let mut best = start;
    for step in STEPS {
        for _ in 0..ROUNDS {
            let before = best.cost;
            for (gain, least) in knobs {
                for direction in [1.0, -1.0] {
                    let mut params = best.params;
                    let value = gain(&mut params);
                    let by = step * value.abs().max(*least);
                    *value = three_digits(*value + direction * by);
                    // The manual warns of negative gains; an offset has either sign.
                    if *value < 0.0 && *least < 500.0 {
                        continue;
                    }
                    let tried = judge(lessons, &params, manner, best.cost)?;
                    if tried.cost < best.cost {
                        best = tried;
                        break;
                    }
                }
            }
            if best.cost > 0.995 * before {
                break;
            }
        }
    }
    Ok(best)
}

/// `value` as a person would type it.
fn three_digits(value: f64) -> f64 {
    format!("{value:.2e}").parse().unwrap_or(value)
}
