//! Discrete lines: what the levels of the pins mean.

use leadscrew::axis::Outputs;
use leadscrew::hal::Lines;

use crate::gpio;
use crate::pins;

/// Levels of all inputs now.
#[inline]
pub fn read() -> Lines {
    Lines {
        drive_ready: !gpio::is_high(pins::DRIVE_READY),
        drive_fault: gpio::is_high(pins::DRIVE_FAULT),
        encoder_lost: gpio::is_high(pins::ENCODER_LOST),
        emergency_stop: gpio::is_high(pins::EMERGENCY_STOP),
        limit_low: gpio::is_high(pins::LIMIT_LOW),
        limit_high: gpio::is_high(pins::LIMIT_HIGH),
        home: gpio::is_high(pins::HOME),
        master_lost: gpio::is_high(pins::MASTER_LOST),
    }
}

/// Level of the probe now: its edge is a latch's ([`latches`](crate::latches)).
#[inline]
pub fn is_probe_deflected() -> bool {
    gpio::is_high(pins::PROBE)
}

/// Enable and brake as a tick wants them; the light is on while the drive is enabled.
#[inline]
pub fn put_out(outputs: &Outputs) {
    gpio::set(pins::ENABLE, outputs.enabled);
    gpio::set(pins::BRAKE, outputs.brake_released);
    gpio::set(pins::LIGHT, !outputs.enabled);
}

/// Drive off and brake closed, whatever goes on.
pub fn release() {
    gpio::set(pins::ENABLE, false);
    gpio::set(pins::BRAKE, false);
    gpio::set(pins::LIGHT, true);
}

/// Whether the drive is off and the brake closed, as the pins are driven.
pub fn are_released() -> bool {
    !gpio::is_driven(pins::ENABLE) && !gpio::is_driven(pins::BRAKE)
}
