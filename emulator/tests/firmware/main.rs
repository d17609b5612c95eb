//! The image that is flashed, byte for byte, on an emulated part with the simulated machine at its pins.
//!
//! It has to be built before, so all of them are marked `#[ignore]`: `cargo build -p board-stm32f4 --target
//! thumbv7em-none-eabihf --profile firmware`. `LEADSCREW_LONG` lets those run that take minutes.

mod boot;
mod capture;
mod commissioning;
mod inputs;
mod instructions;
mod motion;
mod references;
mod safety;
mod session;
mod stack;
mod store;
#[path = "../../../host/tests/support/tuned.rs"]
mod tuned;
