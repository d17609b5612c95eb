//! What the tables hold.

use serde::Serialize;

use super::linuxcnc::PidParams;
use super::trace::MoveFigures;

/// A figure beside what is to be reached.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Judged {
    /// The figure.
    pub value: f64,
    /// What it may be at most.
    pub limit: f64,
    /// It is no more.
    pub reached: bool,
}

impl Judged {
    /// `value` against `limit`.
    #[must_use]
    pub fn new(value: f64, limit: f64) -> Self {
        Self {
            value,
            limit,
            reached: value <= limit,
        }
    }
}

/// A move of our axis.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct MoveRow {
    /// The machine.
    pub machine: &'static str,
    /// Feed, mm/min.
    pub feed_mm_per_min: f64,
    /// The worst of all encoders.
    pub figures: MoveFigures,
    /// Peak of the following error, d; none in rows that are only shown.
    pub peak: Option<Judged>,
    /// Neither a limit cycle at rest nor a sustained oscillation, where that is asked for.
    pub quiet: Option<bool>,
    /// Largest standing error, d.
    pub standing: Option<Judged>,
    /// What the peak is to come to if all goes well, d.
    pub moonshot: Option<Judged>,
}

/// A move by the law of LinuxCNC's `pid`.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct PeerRow {
    /// How it is tuned.
    pub tuning: &'static str,
    /// The machine.
    pub machine: &'static str,
    /// Feed, mm/min.
    pub feed_mm_per_min: f64,
    /// The worst of all encoders.
    pub figures: MoveFigures,
    /// Our peak over its.
    pub ratio: f64,
    /// The most that the ratio may be, in the rows that are judged.
    pub judged: Option<Judged>,
}

/// Gains of the law and what they leave in hand.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct PeerGains {
    /// How it is tuned.
    pub tuning: &'static str,
    /// Pgain, 1/s.
    pub p: f64,
    /// Igain, 1/s².
    pub i: f64,
    /// Dgain.
    pub d: f64,
    /// FF1.
    pub ff1: f64,
    /// FF2, s.
    pub ff2: f64,
    /// FF3, s².
    pub ff3: f64,
    /// bias, d/s.
    pub bias: f64,
    /// deadband, d.
    pub deadband: f64,
    /// Gain margin on the nominal drive, dB.
    pub gain_margin_db: f64,
    /// Phase margin, degrees; negative in a loop that is not stable.
    pub phase_margin_deg: f64,
}

impl PeerGains {
    pub(super) fn new(
        tuning: &'static str,
        params: &PidParams,
        margins: &super::linuxcnc::margins::Margins,
    ) -> Self {
        Self {
            tuning,
            p: params.p,
            i: params.i,
            d: params.d,
            ff1: params.ff1,
            ff2: params.ff2,
            ff3: params.ff3,
            bias: params.bias,
            deadband: params.deadband,
            gain_margin_db: 20.0 * margins.gain.log10(),
            phase_margin_deg: margins.phase.to_degrees(),
        }
    }
}

/// A slow feed.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct CreepRow {
    /// The machine.
    pub machine: &'static str,
    /// Feed, mm/min; negative backward.
    pub feed_mm_per_min: f64,
    /// Largest error in the first second, d: breaking away.
    pub start_peak: f64,
    /// Largest error after it, d.
    pub peak: Judged,
    /// Its rms, d.
    pub rms: f64,
}

/// The carriage by a laser: largest errors, d; where no table came about they are infinite.
#[derive(Clone, Debug, Serialize)]
pub struct CarriageRow {
    /// The machine.
    pub machine: &'static str,
    /// Carriage less place before compensation.
    pub positioning_before: f64,
    /// The same with the screw's table.
    pub positioning: Judged,
    /// Difference of a target reached from below and from above, before compensation.
    pub reversal_before: f64,
    /// The same with the table, which holds both directions.
    pub reversal: Judged,
    /// Its mean over all targets with the machine's backlash as a parameter, and no table.
    pub mean_reversal_of_backlash: f64,
    /// Largest setpoint less encoder at rest with the table.
    pub standing: f64,
    /// Why no table came about, or the axis did not take it.
    pub refused: Option<String>,
}

/// A pass of a thread.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct ThreadPass {
    /// Speed of the spindle, rpm.
    pub rpm: f64,
    /// Number of the pass at this speed, from 1.
    pub pass: u32,
    /// Mean phase, °.
    pub phase_deg: f64,
    /// Largest deviation from it, d.
    pub instantaneous_d: f64,
    /// Largest following error, d.
    pub following_d: f64,
    /// Pitch error over 100 mm, d.
    pub pitch_error: Judged,
}

/// Threads on a machine.
#[derive(Clone, Debug, Serialize)]
pub struct Threads {
    /// The machine.
    pub machine: &'static str,
    /// All passes at all speeds.
    pub passes: Vec<ThreadPass>,
    /// Largest difference of phase between any two of them, °.
    pub phase_spread_deg: Judged,
}

/// What identification found of a machine.
#[derive(Clone, Debug, Serialize)]
pub struct IdentifiedRow {
    /// The machine.
    pub machine: &'static str,
    /// Its figures.
    pub figures: Vec<IdentifiedFigure>,
}

/// A figure as it was identified with all encoders, beside the machine's.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct IdentifiedFigure {
    /// What it is.
    pub figure: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// What the machine has.
    pub truth: f64,
    /// Mean of what was found; null where nothing was.
    pub mean: Option<f64>,
    /// Largest difference from the machine's; null where nothing was found.
    pub worst: Option<f64>,
}

/// All tables.
#[derive(Clone, Debug, Serialize)]
pub struct Figures {
    /// Our moves.
    pub moves: Vec<MoveRow>,
    /// The same scenes by an axis that was tuned on its drive's true figures: what identification costs.
    pub known: Vec<MoveRow>,
    /// The off nominal machines by axes commissioned on them.
    pub there: Vec<MoveRow>,
    /// What identification found, of each machine that an axis was commissioned on.
    pub identified: Vec<IdentifiedRow>,
    /// Gains of the law of LinuxCNC's `pid`.
    pub peer_gains: Vec<PeerGains>,
    /// The same moves by it.
    pub peer: Vec<PeerRow>,
    /// Backlash in its three places.
    pub backlash: Vec<MoveRow>,
    /// Slow feeds.
    pub creep: Vec<CreepRow>,
    /// The carriage before and after compensation, with 3 d of backlash outside the loop.
    pub carriage: Vec<CarriageRow>,
    /// Threads of 2 mm.
    pub threads: Vec<Threads>,
}
