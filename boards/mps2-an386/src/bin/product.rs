//! The product core alone, for its size: parameters in, moves planned, one axis ticking. No simulator,
//! no log, no executor; `cargo xtask bench` reports its sections. It is built, not run.
#![no_std]
#![no_main]

use core::cell::UnsafeCell;
use core::panic::PanicInfo;
use core::ptr::{read_volatile, write_volatile};
use core::sync::atomic::{AtomicBool, Ordering};

use cortex_m_rt::{entry, exception};
use leadscrew::axis::{Axis, Inputs};
use leadscrew::estimator::EstimatorConfig;
use leadscrew::hal::Capture;
use leadscrew::params::{AxisParams, MotionParams, OutputParams, ParamError};
use leadscrew::setpoint::profile::Profile;
use leadscrew::telemetry::Record;
use leadscrew::tuning::DriveModel;
use leadscrew::uncertainty::EdgeErrors;
use leadscrew::units::Position;

/// Anything outside, so that nothing is worked out beforehand.
const OUTSIDE: *mut u32 = 0x4002_8000 as *mut u32;

/// The runtime wants a vector table of the device; no interrupt of it is used here.
// SAFETY: the name and the section are those that cortex-m-rt's linker script asks for.
#[unsafe(no_mangle)]
// SAFETY: as above; nothing else is put there.
#[unsafe(link_section = ".vector_table.interrupts")]
pub static __INTERRUPTS: [usize; 1] = [0];

struct Shared(UnsafeCell<Option<Axis<'static>>>);

// SAFETY: the program fills it before `READY`, the tick uses it afterwards; the program then only
// touches it with interrupts off.
unsafe impl Sync for Shared {}

static AXIS: Shared = Shared(UnsafeCell::new(None));
static READY: AtomicBool = AtomicBool::new(false);

#[entry]
fn main() -> ! {
    if let Ok(axis) = configured() {
        // SAFETY: `READY` is not set yet, so the tick keeps off.
        unsafe { *AXIS.0.get() = Some(axis) };
        READY.store(true, Ordering::Release);
    }
    loop {
        cortex_m::interrupt::free(|_| {
            // SAFETY: with interrupts off the tick is not running.
            if let Some(axis) = unsafe { &mut *AXIS.0.get() } {
                let distance = Position::from_bits(i64::from(outside()));
                if let Ok(profile) = Profile::plan(distance, &axis.config().limits) {
                    let _ = axis.queue(&profile, outside());
                }
            }
        });
    }
}

/// An axis from parameters that come from outside.
fn configured() -> Result<Axis<'static>, ParamError> {
    let number = || f64::from(outside());
    let drive = DriveModel::second_order(number(), number());
    let estimator = match outside() % 5 {
        0 => EstimatorConfig::by_name("difference")?,
        1 => EstimatorConfig::by_name("exponential")?,
        2 => EstimatorConfig::by_name("simple")?,
        3 => EstimatorConfig::by_name("gaussian")?,
        _ => EstimatorConfig::by_name("polynomial")?,
    };
    let Some(estimator) = estimator else {
        return configured();
    };
    let params = AxisParams {
        tick_hz: number(),
        timer_hz: number(),
        encoder: EdgeErrors {
            edge_noise_d: number(),
            ..EdgeErrors::default()
        },
        motion: MotionParams {
            max_feed_mm_per_min: number(),
            ..MotionParams::default()
        },
        controller: drive.place_poles(number())?,
        output: OutputParams {
            limit: number(),
            slew_per_s: number(),
        },
        ..AxisParams::new(estimator)
    };
    params.validate().map(Axis::new)
}

#[exception]
fn SysTick() {
    if !READY.load(Ordering::Acquire) {
        return;
    }
    // SAFETY: `READY` is set, and the program touches the axis only with interrupts off.
    let Some(axis) = (unsafe { &mut *AXIS.0.get() }) else {
        return;
    };
    let capture = Capture {
        count: outside(),
        sampled_at: outside(),
        ..Capture::default()
    };
    let record = Record::new(axis.step(&Inputs::of(capture, outside() != 0)));
    for word in record.to_bytes() {
        // SAFETY: `OUTSIDE` is a device register of the board; the image is not run.
        unsafe { write_volatile(OUTSIDE, u32::from(word)) };
    }
}

fn outside() -> u32 {
    // SAFETY: `OUTSIDE` is a device register of the board; the image is not run.
    unsafe { read_volatile(OUTSIDE) }
}

#[panic_handler]
fn stop(_: &PanicInfo<'_>) -> ! {
    loop {}
}
