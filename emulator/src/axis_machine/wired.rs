//! Pins of the board as the machine is wired to them.

use crate::emulator::Pin;

pub const CONVERTER_SYNC: Pin = Pin::a(4);
pub const CONVERTER_LOAD: Pin = Pin::c(4);
pub const CONVERTER_RESET: Pin = Pin::c(5);
pub const CONVERTER_ALERT: Pin = Pin::b(1);
pub const ENABLE: Pin = Pin::b(9);
pub const BRAKE: Pin = Pin::b(8);
pub const PROBE: Pin = Pin::a(8);
pub const HOME: Pin = Pin::a(11);
pub const STEP: Pin = Pin::b(6);
pub const DIRECTION: Pin = Pin::b(7);
/// Low is ready.
pub const DRIVE_READY: Pin = Pin::b(12);
pub const DRIVE_FAULT: Pin = Pin::b(13);
pub const ENCODER_LOST: Pin = Pin::b(14);
pub const MASTER_LOST: Pin = Pin::b(15);
pub const EMERGENCY_STOP: Pin = Pin::c(1);
pub const LIMIT_LOW: Pin = Pin::c(2);
pub const LIMIT_HIGH: Pin = Pin::c(3);
