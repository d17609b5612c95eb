//! What a run is made of, as a file or a constant states it.

use leadscrew::estimator::EstimatorConfig;
use leadscrew::estimator::paths::{Choice, Paths};
use leadscrew::parameter_table::ParameterTable;
use leadscrew::params::{AxisParams, MAX_FEED_SHARE};
use leadscrew::units::{RangeError, checked};

use super::action::Timed;
use super::error::ScenarioError;
use super::plant::Plant;
use super::sections::{Set, visit_axis, visit_plant};
use super::tuning::{BANDWIDTH_RAD_PER_S, autotuned_axis, tuned_axis, tuned_estimator};
use crate::machine::MachineParams;

/// Longest run, s.
pub const MAX_DURATION_S: f64 = 1e5;

/// A machine that is built in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Base {
    /// The longitudinal axis of the 16K20F3 with all its imperfections.
    #[default]
    Full,
    /// The same without them.
    Bare,
}

impl Base {
    /// Every one.
    pub const ALL: [Self; 2] = [Self::Full, Self::Bare];

    /// Its name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Full => "16k20f3",
            Self::Bare => "16k20f3-bare",
        }
    }

    /// Its parameters.
    #[must_use]
    pub fn params(self) -> MachineParams {
        match self {
            Self::Full => MachineParams::z_16k20f3(),
            Self::Bare => MachineParams::z_16k20f3().bare(),
        }
    }
}

/// A parameter that is set otherwise than by default.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setting {
    /// Its section.
    pub section: &'static str,
    /// Its name there.
    pub key: &'static str,
    /// Its value.
    pub value: f64,
}

/// How the loop is tuned.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Tuning {
    /// The poles are placed on the drive's nominal period and damping; offset, friction and delay are not known to it.
    PlacePoles {
        /// Where, rad/s.
        bandwidth_rad_per_s: f64,
    },
    /// By the product's own tuning, which knows the drive as a perfect identification would find it.
    Autotune,
}

/// What a laser showed at a place of the screw.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScrewReading {
    /// The place, from the origin, mm.
    pub position_mm: f64,
    /// Carriage less place, having come there towards larger positions, mm.
    pub forward_mm: f64,
    /// The same towards smaller ones, mm.
    pub backward_mm: f64,
}

/// A run: a machine, an axis, and what happens.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scenario<'s> {
    /// The machine to begin with.
    pub base: Base,
    /// What differs from it, and from a board at which all is well.
    pub machine: &'s [Setting],
    /// What differs from an axis that is tuned on the machine.
    pub axis: &'s [Setting],
    /// Control rate, Hz.
    pub tick_hz: f64,
    /// Name of the estimator in the loop.
    pub estimator: &'static str,
    /// Name of a second estimator, whose estimates are shown; `None` if that of the loop is.
    pub display: Option<&'static str>,
    /// How the loop is tuned.
    pub tuning: Tuning,
    /// Table of the screw, for the host to set; empty for none.
    pub screw: &'s [ScrewReading],
    /// A learned map of the encoder is in use; the estimator counts on it.
    pub mapped: bool,
    /// Seed of everything random.
    pub seed: u64,
    /// Length of the run, s.
    pub duration_s: f64,
    /// What happens, by ascending time.
    pub timeline: &'s [Timed],
}

impl Scenario<'_> {
    /// Nothing happens for a second on the full machine.
    pub const QUIET: Self = Self {
        base: Base::Full,
        machine: &[],
        axis: &[],
        tick_hz: 1000.0,
        estimator: "exponential",
        display: None,
        tuning: Tuning::PlacePoles {
            bandwidth_rad_per_s: BANDWIDTH_RAD_PER_S,
        },
        screw: &[],
        mapped: false,
        seed: 1,
        duration_s: 1.0,
        timeline: &[],
    };

    /// The machine and its board.
    #[must_use]
    pub fn plant(&self) -> Plant {
        let mut plant = Plant::from(self.base.params());
        for setting in self.machine {
            visit_plant(&mut plant, setting.section, Set(setting));
        }
        plant
    }

    /// The axis, tuned on `machine` but for its settings.
    ///
    /// # Errors
    /// A parameter out of range.
    pub fn axis_params(&self, machine: &MachineParams) -> Result<AxisParams, ScenarioError> {
        let estimator = self.estimator_on(machine, self.estimator)?;
        let fastest = MAX_FEED_SHARE * machine.drive.full_command_feed_mm_per_min;
        let feed = REFERENCE_FEED.min(fastest);
        let mut axis = match self.tuning {
            Tuning::PlacePoles {
                bandwidth_rad_per_s,
            } => tuned_axis(machine, self.tick_hz, feed, bandwidth_rad_per_s, estimator)?,
            Tuning::Autotune => autotuned_axis(machine, self.tick_hz, feed, estimator, self.mapped)
                .map_err(ScenarioError::Autotune)?,
        };
        if let Some(display) = self.display {
            axis.second_estimator = Some(self.estimator_on(machine, display)?);
            axis.paths = Paths {
                display: Choice::Second,
                ..axis.paths
            };
        }
        if !self.screw.is_empty() {
            axis.compensation.screw_table = 1.0;
        }
        for setting in self.axis {
            visit_axis(&mut axis, setting.section, Set(setting));
        }
        Ok(axis)
    }

    /// The estimator of that name for `machine`.
    fn estimator_on(
        &self,
        machine: &MachineParams,
        name: &str,
    ) -> Result<EstimatorConfig, ScenarioError> {
        let named = EstimatorConfig::by_name(name)?;
        let estimator = named.ok_or(ScenarioError::NoSuchEstimator)?;
        Ok(tuned_estimator(
            machine,
            self.tick_hz,
            estimator,
            self.mapped,
        )?)
    }

    /// Ticks of the whole run.
    ///
    /// # Errors
    /// A length out of range.
    pub fn ticks(&self) -> Result<u32, RangeError> {
        let length = checked("duration_s", self.duration_s, 0.0, MAX_DURATION_S)?;
        Ok(tick_at(length, self.tick_hz))
    }
}

/// The fastest move of the reference machine, mm/min.
const REFERENCE_FEED: f64 = 9000.0;

/// The tick nearest to a time.
#[must_use]
pub fn tick_at(time_s: f64, tick_hz: f64) -> u32 {
    // Conversions saturate.
    (time_s * tick_hz + 0.5) as u32
}

/// Sets a parameter; false for one that the table does not have.
pub fn set<T: ParameterTable>(table: &mut T, key: &str, value: f64) -> bool {
    let found = T::FIELDS.iter().find(|field| field.name == key);
    if let Some(field) = found {
        (field.set)(table, value);
    }
    found.is_some()
}
