//! A store that is written all the time.

use core::fmt::Write as _;

use board_mps2_an386::exit_failure;
use board_mps2_an386::flash::{self, CAPACITY, Flash};
use heapless::String;
use leadscrew::axis::Outputs;
use leadscrew::compensation::{ScrewError, ScrewPoint};
use leadscrew::units::Position;
use leadscrew_app::store::{Interlock, Store};

/// Points of a table: it takes several chunks of the store.
const POINTS: usize = 100;
const WORK: usize = 16 * POINTS;

/// The store and the number that it has.
pub struct Saving<'i> {
    store: Store<Flash>,
    interlock: &'i Interlock,
    number: i32,
    work: [u8; WORK],
}

impl<'i> Saving<'i> {
    /// The store in the flash image at `path`; logs the number that it has, and ends the program if there is none to be had.
    pub fn open(path: Option<&str>, interlock: &'i Interlock) -> Self {
        let Ok(flash) = flash::open(path).inspect_err(|error| defmt::error!("flash: {}", error))
        else {
            exit_failure()
        };
        let Ok(permission) = interlock.permit(&Outputs::default()) else {
            defmt::panic!("nothing enables the axis");
        };
        let Ok(store) = Store::mount(flash, 0..CAPACITY as u32, &permission) else {
            defmt::error!("store: cannot be mounted");
            exit_failure()
        };
        drop(permission);
        let mut saving = Self {
            store,
            interlock,
            number: 0,
            work: [0; WORK],
        };
        saving.load();
        saving
    }

    fn load(&mut self) {
        let mut memory = [ScrewPoint::default(); POINTS];
        let Ok(found) = self.store.load_screw(&mut memory, &mut self.work) else {
            defmt::error!("store: the table cannot be read");
            exit_failure()
        };
        if let Some(points) = found {
            self.number = points[0].error[0].to_bits();
            if points != table(self.number) {
                defmt::error!("store: the table is a mixture");
                exit_failure();
            }
        }
        defmt::info!("store: number {=i32}", self.number);
    }

    /// Saves the next table; the line that tells its number.
    pub fn save_next(&mut self) -> String<16> {
        self.number += 1;
        let Ok(permission) = self.interlock.permit(&Outputs::default()) else {
            defmt::panic!("nothing enables the axis");
        };
        if self
            .store
            .save_screw(&table(self.number), &permission)
            .is_err()
        {
            defmt::error!("store: cannot save");
            exit_failure();
        }
        let mut line = String::new();
        let _ = writeln!(line, "{}", self.number);
        line
    }
}

/// A table that has `number` everywhere.
fn table(number: i32) -> [ScrewPoint; POINTS] {
    core::array::from_fn(|at| ScrewPoint {
        position: Position::from_bits(at as i64),
        error: [ScrewError::from_bits(number); 2],
    })
}
