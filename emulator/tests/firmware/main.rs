//! The image that is flashed, byte for byte, on an emulated part with the simulated machine at its pins.
//!
//! It has to be built before: `cargo build -p board-stm32f4 --target thumbv7em-none-eabihf --profile firmware`.

mod boot;
mod capture;
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
