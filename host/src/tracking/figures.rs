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

/// All tables.
#[derive(Clone, Debug, Serialize)]
pub struct Figures {
    /// Our moves.
    pub moves: Vec<MoveRow>,
    /// Gains of the law of LinuxCNC's `pid`.
    pub peer_gains: Vec<PeerGains>,
    /// The same moves by it.
    pub peer: Vec<PeerRow>,
    /// Backlash in its three places.
    pub backlash: Vec<MoveRow>,
    /// Slow feeds.
    pub creep: Vec<CreepRow>,
}
