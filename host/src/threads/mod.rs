//! Threads cut on the simulated lathe: phase and pitch of the passes, by the truth of shaft and spindle.
//!
//! The error of an instant is x − L·(θ − θ₀)/360°, with x the true shaft of the axis' encoder, θ the true angle of
//! the spindle and L the lead, up to whole leads; it is taken over the full-depth part. Its mean is the phase of the pass, its
//! mean of each revolution against that 100 mm on the pitch.

mod error;
mod lathe;
mod pass;

pub use error::ThreadError;
pub use lathe::Lathe;
pub use pass::Pass;

use leadscrew::setpoint::thread::{SpindleWay, ThreadOrder};
use leadscrew_hal_mock::encoder::EncoderModel;
use leadscrew_hal_mock::machine::MachineParams;
use leadscrew_hal_mock::spindle::SpindleParams;

/// Speeds of the table, rpm.
pub const SPEEDS_RPM: [f64; 3] = [100.0, 500.0, 1000.0];

/// A row of the table.
#[derive(Clone, Copy, Debug)]
pub struct ThreadRow {
    /// Speed of the spindle, rpm.
    pub rpm: f64,
    /// Number of the pass at this speed, from 1.
    pub pass: u32,
    /// Mean phase, °.
    pub phase_deg: f64,
    /// Largest deviation from it at any instant, d.
    pub instantaneous_d: f64,
    /// Largest following error, d.
    pub following_d: f64,
    /// Pitch error over 100 mm, d.
    pub pitch_error_d: f64,
}

/// Threads of one machine at several speeds.
#[derive(Clone, Debug)]
pub struct ThreadTable {
    /// Each pass.
    pub rows: Vec<ThreadRow>,
}

impl ThreadTable {
    /// Cuts the thread of 2 mm, `passes` times at each of [`SPEEDS_RPM`], by a loop with its poles at
    /// `bandwidth_rad_per_s` on the drive's nominal figures, and no map.
    ///
    /// # Errors
    /// A refusal, or a pass that did not come to its end.
    pub fn cut(
        machine: &MachineParams,
        spindle_encoder: EncoderModel,
        bandwidth_rad_per_s: f64,
        passes: u32,
        seed: u64,
    ) -> Result<Self, ThreadError> {
        Self::cut_by(machine.mount.counts_per_mm, passes, |spindle| {
            Lathe::new(machine, spindle, spindle_encoder, bandwidth_rad_per_s, seed)
        })
    }

    /// The same by a lathe of each spindle, on an axis with so many counts/mm.
    ///
    /// # Errors
    /// As [`Self::cut`].
    pub fn cut_by<'m>(
        counts_per_mm: f64,
        passes: u32,
        lathe: impl Fn(&SpindleParams) -> Result<Lathe<'m>, ThreadError>,
    ) -> Result<Self, ThreadError> {
        let mut rows = Vec::new();
        for rpm in SPEEDS_RPM {
            let mut lathe = lathe(&SpindleParams {
                rpm,
                ..SpindleParams::default()
            })?;
            lathe.run(1500);
            for pass in 1..=passes {
                let cut = lathe.cut(&standard_order(), counts_per_mm)?;
                rows.push(ThreadRow {
                    rpm,
                    pass,
                    phase_deg: cut.phase_deg(),
                    instantaneous_d: cut.instantaneous_d(),
                    following_d: cut.following.peak(),
                    pitch_error_d: cut.pitch_error_d().unwrap_or(f64::NAN),
                });
                // Each pass meets the spindle at another angle.
                lathe.run(137 * pass);
            }
        }
        Ok(Self { rows })
    }

    /// Largest difference of phase between any two passes, °.
    #[must_use]
    pub fn phase_spread_deg(&self) -> f64 {
        let phases = || self.rows.iter().map(|row| row.phase_deg);
        phases().fold(f64::MIN, f64::max) - phases().fold(f64::MAX, f64::min)
    }
}

/// A thread of 2 mm over 110 mm.
#[must_use]
pub fn standard_order() -> ThreadOrder {
    ThreadOrder {
        lead_mm: 2.0,
        start_mm: 2.0,
        from_mm: 10.0,
        to_mm: 120.0,
        angle_deg: 30.0,
        starts: 1,
        start: 0,
        spindle: SpindleWay::Forward,
        retract_deg: 90.0,
    }
}
