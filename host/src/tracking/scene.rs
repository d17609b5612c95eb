//! Machines and moves of the tables.

use leadscrew_hal_mock::encoder::EncoderModel;
use leadscrew_hal_mock::machine::{MachineParams, MountParams};

/// Control rate of all tables, Hz.
pub const TICK_HZ: f64 = 1000.0;
/// Way of the moves, mm.
pub const MOVE_MM: f64 = 300.0;

/// A machine, and how it differs from the one that an axis is tuned on.
#[derive(Clone, Copy, Debug)]
pub struct Scene {
    /// What it is called in a table.
    pub name: &'static str,
    /// The machine that the axis is tuned on.
    pub nominal: MachineParams,
    /// Gain and natural period of the actual drive over the nominal ones.
    pub actual: (f64, f64),
    /// Feed of the move, mm/min.
    pub feed_mm_per_min: f64,
}

impl Scene {
    /// The full machine with the encoder "real".
    pub const fn full(nominal: MachineParams) -> Self {
        Self {
            name: "full",
            nominal,
            actual: (1.0, 1.0),
            feed_mm_per_min: 9000.0,
        }
    }

    /// The bare machine with the encoder "real".
    #[must_use]
    pub fn bare() -> Self {
        let bare = MachineParams {
            encoder: EncoderModel::real(),
            ..MachineParams::z_16k20f3().bare()
        };
        Self {
            name: "bare",
            ..Self::full(bare)
        }
    }

    /// The scenes of the moves: bare and full, then the full machine off nominal at 6 000 mm/min.
    #[must_use]
    pub fn of_moves() -> [Self; 5] {
        let full = Self::full(MachineParams::z_16k20f3());
        let slower = Self {
            feed_mm_per_min: 6000.0,
            ..full
        };
        let [low, high] = Self::corners();
        [Self::bare(), full, slower, low, high]
    }

    /// The full machine at 6 000 mm/min with the drive's gain and natural period off nominal.
    #[must_use]
    pub fn corners() -> [Self; 2] {
        let full = Self::full(MachineParams::z_16k20f3());
        [
            ("full, -20 %/+30 %", (0.8, 1.3)),
            ("full, +20 %/-25 %", (1.2, 0.75)),
        ]
        .map(|(name, actual)| Self {
            name,
            actual,
            feed_mm_per_min: 6000.0,
            ..full
        })
    }

    /// The full machine off nominal, commissioned as it is.
    #[must_use]
    pub fn commissioned_off_nominal() -> [Self; 2] {
        let names = ["-20 %/+30 %, tuned there", "+20 %/-25 %, tuned there"];
        let [low, high] = Self::corners();
        [(names[0], low), (names[1], high)].map(|(name, corner)| Self {
            name,
            nominal: corner.machine(),
            actual: (1.0, 1.0),
            ..corner
        })
    }

    /// The full machine with backlash: between screw and carriage, in the encoder's coupling, in the loop of a
    /// linear scale.
    #[must_use]
    pub fn with_backlash() -> [Self; 3] {
        let full = MachineParams::z_16k20f3();
        let outside = {
            let mut machine = full;
            machine.carriage.backlash_mm = 0.003;
            machine
        };
        let coupling = MachineParams {
            mount: MountParams {
                coupling_play_mm: 0.0005,
                ..full.mount
            },
            ..full
        };
        let scale = MachineParams {
            mount: MountParams {
                linear_scale: 1.0,
                ..outside.mount
            },
            ..outside
        };
        let of = |name, nominal| Self {
            name,
            ..Self::full(nominal)
        };
        [
            of("(a) 3 d outside the loop", outside),
            of("(b) 0.5 d in the coupling", coupling),
            of("(c) 3 d inside the loop", scale),
        ]
    }

    /// The machine as it is.
    #[must_use]
    pub fn machine(&self) -> MachineParams {
        let mut machine = self.nominal;
        machine.drive.full_command_feed_mm_per_min *= self.actual.0;
        machine.drive.natural_period_s *= self.actual.1;
        machine
    }
}
