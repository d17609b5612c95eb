//! Words of the command line.
//!
//! - `lockstep=FOLDER`: the link is in lockstep by the FIFOs in that folder, not on UART 0;
//! - `flash=PATH`: image of the flash, made if it is not there; without it the store forgets;
//! - `machine=16k20f3` or `16k20f3-bare`, the one without imperfections;
//! - `seed=N`: of the encoder's errors and all noise;
//! - `modbus=N`: address of the unit on UART 1, 1 to 247; 1 without it;
//! - `ticks=N`: end after so many ticks; else it runs until it is told;
//! - `tick-hz=N`, `estimator=NAME`: see [`leadscrew_app::options`]; what the store has comes before.

use board_mps2_an386::carrier::Path;
use board_mps2_an386::{arguments, exit_failure};
use leadscrew_app::options::Options;
use leadscrew_hal_mock::scenario::Base;

/// What to run, and on what.
pub struct Words {
    pub options: Options,
    pub machine: Base,
    pub seed: u64,
    pub modbus_unit: u8,
    pub flash: Option<Path>,
    pub lockstep: Option<Path>,
}

impl Words {
    /// The words that this program was started with; ends it if one is wrong.
    pub fn of_command_line() -> Self {
        let mut words = Self {
            options: Options::default(),
            machine: Base::default(),
            seed: 1,
            modbus_unit: 1,
            flash: None,
            lockstep: None,
        };
        if arguments(|word| words.take(word)).is_err() {
            exit_failure();
        }
        words
    }

    /// The path of the flash image, for a person to read.
    pub fn flash_path(&self) -> &str {
        self.flash.as_deref().unwrap_or_default()
    }

    fn take(&mut self, word: &str) -> Result<(), ()> {
        match word.split_once('=') {
            Some(("lockstep", folder)) => self.lockstep = Some(path(folder)?),
            Some(("flash", file)) => self.flash = Some(path(file)?),
            Some(("machine", name)) => {
                let known = Base::ALL.into_iter().find(|base| base.name() == name);
                self.machine = known.ok_or_else(|| {
                    defmt::error!(
                        "argument {=str}: the machines are 16k20f3 and 16k20f3-bare",
                        word
                    );
                })?;
            }
            Some(("seed", number)) => {
                self.seed = number.parse().map_err(|_| {
                    defmt::error!("argument {=str}: a seed is a whole number below 2^64", word);
                })?;
            }
            Some(("modbus", unit)) => {
                self.modbus_unit = unit.parse().map_err(|_| {
                    defmt::error!("argument {=str}: a unit is a number from 1 to 247", word);
                })?;
            }
            _ => self
                .options
                .apply(word)
                .map_err(|error| defmt::error!("argument {=str}: {}", word, error))?,
        }
        Ok(())
    }
}

fn path(text: &str) -> Result<Path, ()> {
    Path::try_from(text).map_err(|_| {
        defmt::error!("{=str}: the path is too long, use a shorter one", text);
    })
}
