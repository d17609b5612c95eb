//! What the tick takes, in cycles of the core, and when it starts.

use board_stm32f4::clocks::CORE_HZ;
use board_stm32f4::converter::{self, Output};
use board_stm32f4::encoder;
use board_stm32f4::machine::Machine;
use board_stm32f4::references::References;
use board_stm32f4::tick::{self, COUNTERS};
use board_stm32f4::{lines, priorities};
use cortex_m::peripheral::DWT;
use leadscrew::units::Command;
use leadscrew_app::input_filter::InputFilter;

use crate::spread::Spread;
use crate::timed_tick::{START, TOTAL, install};

/// Runs of a stage by itself.
const RUNS: u32 = 1_000;
/// The tick starts within 5 µs of the timer: latches before it, and critical sections.
const LATEST_START: u32 = CORE_HZ / 200_000;
/// Half a step of the converter, of full scale 1.
const HALF_STEP: i32 = 1 << (Command::FRAC_NBITS - 16);

/// The converter holds each command, to half a step of its 16 bits.
pub fn converter() {
    let mut output = started();
    for sixteenth in -15..=15 {
        let command = Command::from_bits(sixteenth << (Command::FRAC_NBITS - 4));
        let readback = output.put(command, true);
        let error = (readback.to_bits() - command.to_bits()).abs();
        defmt::assert!(
            error <= HALF_STEP,
            "{=i32}/16 of full scale came back as {=i32}",
            sixteenth,
            readback.to_bits()
        );
    }
    output.put(Command::ZERO, true);
    converter::release();
}

/// The converter, which has to be there.
fn started() -> Output {
    let (output, trouble) = Output::start();
    defmt::assert!(trouble.is_none(), "converter: {}", trouble);
    output
}

/// The firmware's tick on a standing axis, disabled, with thread mode idle: start, end, and the cycles of its stages.
pub fn ticks() {
    let mut core = defmt::unwrap!(cortex_m::Peripherals::take());
    core.DCB.enable_trace();
    core.DWT.enable_cycle_counter();
    // It holds the ticks' reports, which nobody takes here: they are counted as lost.
    let (_server, period) = defmt::unwrap!(crate::boot::boot());
    let sample = time_sample();
    let put_out = time_put_out();

    install(&mut core.SCB, period.divider);
    priorities::unmask(&mut core.NVIC);
    tick::start(period);
    // Two seconds.
    cortex_m::asm::delay(2 * CORE_HZ);
    tick::stop();

    let counts = COUNTERS.read();
    let stages = [
        ("start", &START),
        ("sample", &sample),
        ("put out", &put_out),
    ];
    for (name, spread) in stages.into_iter().chain([("total", &TOTAL)]) {
        let (least, most) = spread.range();
        let mean = spread.mean();
        defmt::info!(
            "{=str}: {=u32} to {=u32} cycles, {=u32} in the mean",
            name,
            least,
            most,
            mean
        );
    }
    let rest = sample.mean() + put_out.mean();
    defmt::info!(
        "step: {=u32} cycles in the mean, what is left",
        TOTAL.mean().saturating_sub(rest)
    );
    defmt::info!("{}", counts);
    defmt::assert_eq!(counts.ticks, TOTAL.count());
    defmt::assert!(counts.ticks > 0, "no tick came");
    defmt::assert_eq!((counts.late, counts.overlong), (0, 0));
    let (_, latest) = START.range();
    defmt::assert!(
        latest <= LATEST_START,
        "a tick started {=u32} cycles late",
        latest
    );
}

/// What the tick sees, by a machine of its own on the same inputs.
fn time_sample() -> Spread {
    let spread = Spread::new();
    let mut machine = Machine::new(InputFilter::shortest(), true, References::start());
    for _ in 0..RUNS {
        let begun = DWT::cycle_count();
        let (sample, progress) = encoder::sample();
        machine.sample(sample, progress, 0);
        spread.note(DWT::cycle_count().wrapping_sub(begun));
    }
    spread
}

/// What the tick puts out: lines, and three words to the converter.
fn time_put_out() -> Spread {
    let spread = Spread::new();
    let mut output = started();
    for _ in 0..RUNS {
        let begun = DWT::cycle_count();
        lines::release();
        output.put(Command::ZERO, true);
        spread.note(DWT::cycle_count().wrapping_sub(begun));
    }
    spread
}
