//! What keeps the drive off when the firmware cannot, and what is known of it afterwards.
//!
//! ```text
//! reset, panic, hard fault, watchdog ─► pins float: enable relay and brake open by their pull-downs, converter in reset at 0 V
//!
//! tick that ended in time ──► feed ─────────► watchdog (≤ 10 ms) ──► reset
//! tick that did not ──┬─────► starve
//!                     └─────► counted as missed: LateTick of the supervisor, a controlled stop, long before
//! panic, hard fault, starving ticks ─► record in RAM that no start-up code clears ─► told after the reset
//! ```
//!
//! [`feeding`] says which tick feeds the watchdog, [`period`] when its period may be long, [`reason`] and [`record`] keep why a
//! reset came. All is plain logic over traits and words; the board has the registers and the memory.

pub mod feeding;
pub mod period;
pub mod reason;
pub mod record;
