//! The part as rsemu reads it: memory map, clocks, interrupts, requests, triggers, pins.
//!
//! RM0090: table 1 (memory map), table 42 and 43 (DMA requests), table 62 (interrupts), table 86 and 93 (triggers of timers).

use std::fmt::Write as _;

/// What no loop writes.
const FIXED: &str = r#"
  param flash = 1M
  osc hse = 8000000 Hz
  osc lsi = 32000 Hz
  osc dma1clk = 42000000 Hz
  osc dma2clk = 42000000 Hz
  space mem    { width = 32 }
  space dmabus { width = 32 }

  object dma1 "st.dma" { clock = dma1clk, space = dmabus, variant = "stream" }
  object dma2 "st.dma" { clock = dma2clk, space = dmabus, variant = "stream" }
  object cpu "axis.core" { clock = hse * 21, space = mem, part = "cortex-m4f", priority-bits = 4 }
  object pins "axis.pins" { clock = hse * 21 / 2 }
  object reset "axis.reset" { }
  object eflash "st.flash" {
    clock = hse
    variant = "f4"
    size = flash
    image = "flash"
    program-time = 128
    erase-time = 2000000
  }
  object sram "ram" { size = 128K }
  object ccm  "ram" { size = 64K }
  object rcc "st.rcc" { clock = hse, variant = "f4", hse = 8000000 }
  object pwr "st.pwr" { clock = hse, variant = "f4" }
  object syscfg "st.syscfg" {
    variant = "f4"
    ports = 8
    space = mem
    boot-size = flash
    boot-sources = [ 0x08000000, 0, 0, 0x20000000 ]
  }
  object exti "st.exti" { lines = 23 }
  object iwdg "st.iwdg" { clock = lsi, window = false }
  object dbgmcu "st.dbgmcu" { dev-id = 0x413, rev-id = 0x1000 }
  object gpioa "st.gpio" { moder-reset = 0xa8000000, pupdr-reset = 0x64000000 }
  object gpiob "st.gpio" { moder-reset = 0x00000280, ospeedr-reset = 0x000000c0, pupdr-reset = 0x00000100 }
  object gpioc "st.gpio" { }
  object gpiod "st.gpio" { }
  object gpioe "st.gpio" { }
  object gpioh "st.gpio" { }
  object usart1 "axis.link"   { clock = hse * 21 / 2 }
  object usart6 "axis.modbus" { clock = hse * 21 / 2 }
  object spi1   "axis.spi"    { clock = hse * 21 / 2 }
  object adc1   "axis.adc"    { clock = hse * 21 / 2 }

  map mem 0x00000000 size flash = syscfg.boot
  map mem 0x08000000 size flash = eflash.array
  map mem 0x10000000 size 64K   = ccm
  map mem 0x20000000 size 128K  = sram
  map mem 0x40003000 size 0x14  = iwdg
  map mem 0x40007000 size 0x08  = pwr
  map mem 0x40013800 size 0x24  = syscfg
  map mem 0x40013c00 size 0x18  = exti
  map mem 0x40011000 size 0x50  = usart1
  map mem 0x40011400 size 0x50  = usart6
  map mem 0x40012000 size 0x400 = adc1
  map mem 0x40013000 size 0x50  = spi1
  map mem 0x40023800 size 0x90  = rcc
  map mem 0x40023c00 size 0x1c  = eflash
  map mem 0x40026000 size 0xd0  = dma1
  map mem 0x40026400 size 0xd0  = dma2
  map mem 0xe0042000 size 0x10  = dbgmcu
  map dmabus 0x20000000 size 128K = sram

  wire iwdg.reset -> rcc.iwdgrst
  wire iwdg.reset -> reset.in
  wire cpu.asked  -> rcc.sftrst
  wire eflash.irq -> cpu.irq4
  wire usart1.irq -> cpu.irq37
  wire usart6.irq -> cpu.irq71
  wire adc1.dma   -> dma2.req0c0
  wire pins.pb7   -> syscfg.pb7
"#;

/// A timer of the part.
struct TimerPlace {
    number: u8,
    base: u32,
    /// Its clock, in halves of the core's.
    halves: u32,
    kind: &'static str,
    channels: u8,
    width: u8,
    /// Bank and bit of its clock gate.
    gate: (&'static str, u8),
}

const fn timer(number: u8, base: u32, width: u8, gate: (&'static str, u8)) -> TimerPlace {
    TimerPlace {
        number,
        base,
        halves: 1,
        kind: "general",
        channels: 4,
        width,
        gate,
    }
}

/// A timer with all features, on the fast bus.
const fn advanced(number: u8, base: u32, gate: u8) -> TimerPlace {
    TimerPlace {
        halves: 2,
        kind: "advanced",
        ..timer(number, base, 16, ("apb2", gate))
    }
}

const TIMERS: &[TimerPlace] = &[
    advanced(1, 0x4001_0000, 0),
    timer(2, 0x4000_0000, 32, ("apb1", 0)),
    timer(3, 0x4000_0400, 16, ("apb1", 1)),
    timer(4, 0x4000_0800, 16, ("apb1", 2)),
    timer(5, 0x4000_0c00, 32, ("apb1", 3)),
    advanced(8, 0x4001_0400, 1),
    TimerPlace {
        channels: 2,
        ..timer(12, 0x4000_1800, 16, ("apb1", 6))
    },
];

/// Interrupts: output, and number.
const INTERRUPTS: &[(&str, u8)] = &[
    ("exti.irq0", 6),
    ("exti.irq1", 7),
    ("exti.irq2", 8),
    ("exti.irq3", 9),
    ("exti.irq4", 10),
    ("exti.irq5", 23),
    ("exti.irq6", 23),
    ("exti.irq7", 23),
    ("exti.irq8", 23),
    ("exti.irq9", 23),
    ("dma1.irq2", 13),
    ("dma2.irq0", 56),
    ("tim1.irq-up", 25),
    ("tim1.irq-trg", 26),
    ("tim1.irq-cc", 27),
    ("tim2.irq", 28),
    ("tim3.irq", 29),
    ("tim4.irq", 30),
    ("tim12.irq", 43),
    ("tim8.irq-up", 44),
    ("tim8.irq-trg", 45),
    ("tim8.irq-cc", 46),
    ("tim5.irq", 50),
];

/// Triggers from timer to timer.
const TRIGGERS: &[(&str, &str)] = &[
    ("tim1", "tim2.itr0"),
    ("tim1", "tim3.itr0"),
    ("tim1", "tim4.itr0"),
    ("tim1", "tim8.itr0"),
    ("tim2", "tim1.itr1"),
    ("tim2", "tim3.itr1"),
    ("tim2", "tim4.itr1"),
    ("tim2", "tim5.itr0"),
    ("tim2", "tim8.itr1"),
    ("tim3", "tim1.itr2"),
    ("tim3", "tim2.itr2"),
    ("tim3", "tim4.itr2"),
    ("tim3", "tim5.itr1"),
    ("tim4", "tim1.itr3"),
    ("tim4", "tim2.itr3"),
    ("tim4", "tim3.itr3"),
    ("tim4", "tim5.itr2"),
    ("tim4", "tim8.itr2"),
    ("tim5", "tim1.itr0"),
    ("tim5", "tim3.itr2"),
    ("tim5", "tim8.itr3"),
    ("tim8", "tim2.itr1"),
    ("tim8", "tim4.itr3"),
    ("tim8", "tim5.itr3"),
];

/// Requests of timers to the DMA.
const REQUESTS: &[(&str, &str)] = &[
    ("tim5.dma-ch3", "dma1.req0c6"),
    ("tim5.dma-ch4", "dma1.req1c6"),
    ("tim5.dma-ch1", "dma1.req2c6"),
    ("tim5.dma-ch2", "dma1.req4c6"),
    ("tim2.dma-ch3", "dma1.req1c3"),
    ("tim2.dma-ch1", "dma1.req5c3"),
];

/// Pins that the surroundings drive, and the timer inputs at them.
const INPUTS: &[(&str, Option<&str>)] = &[
    ("pa0", Some("tim5.ti1")),
    ("pa1", Some("tim5.ti2")),
    ("pa3", Some("tim5.ti4")),
    ("pa8", Some("tim1.ti1")),
    ("pa11", Some("tim1.ti4")),
    ("pa15", Some("tim2.ti1")),
    ("pb0", Some("tim3.ti3")),
    ("pb1", None),
    ("pb3", Some("tim2.ti2")),
    ("pb4", Some("tim3.ti1")),
    ("pb5", Some("tim3.ti2")),
    ("pb6", Some("tim4.ti1")),
    ("pb7", None),
    ("pb10", Some("tim2.ti3")),
    ("pb12", None),
    ("pb13", None),
    ("pb14", None),
    ("pb15", None),
    ("pc1", None),
    ("pc2", None),
    ("pc3", None),
];

/// Pins that the part drives, and where the board pulls them while it does not.
const OUTPUTS: &[(&str, &str)] = &[
    ("pa4", "up"),
    ("pb8", "down"),
    ("pb9", "down"),
    ("pc4", "down"),
    ("pc5", "down"),
    ("pc8", "down"),
    ("pc13", "up"),
];

/// RAM behind the part's own, which no part has.
pub const MORE_RAM: (u32, u32) = (0x2002_0000, 0x003e_0000);

/// The whole description; `more_ram` for programs of a board that has more.
pub fn description(more_ram: bool) -> String {
    let mut text = format!("machine \"stm32f407\" {{{FIXED}");
    if more_ram {
        let (base, size) = MORE_RAM;
        line(
            &mut text,
            format_args!("object more \"ram\" {{ size = {size} }}"),
        );
        line(
            &mut text,
            format_args!("map mem {base:#x} size {size} = more"),
        );
    }
    timers(&mut text);
    ports(&mut text);
    for (output, number) in INTERRUPTS {
        line(&mut text, format_args!("wire {output} -> cpu.irq{number}"));
    }
    for (timer, input) in TRIGGERS {
        line(&mut text, format_args!("wire {timer}.trgo -> {input}"));
    }
    for (output, input) in REQUESTS {
        line(&mut text, format_args!("wire {output} -> {input}"));
    }
    for number in 0..16 {
        line(
            &mut text,
            format_args!("wire syscfg.exti{number} -> exti.line{number}"),
        );
    }
    text.push('}');
    text
}

fn line(text: &mut String, line: std::fmt::Arguments<'_>) {
    // A string takes all that is written.
    let _ = writeln!(text, "  {line}");
}

fn timers(text: &mut String) {
    for place in TIMERS {
        let TimerPlace {
            number,
            base,
            kind,
            channels,
            width,
            gate: (bank, bit),
            ..
        } = place;
        let (ratio, top) = (21 * place.halves, (1_u64 << width) - 1);
        line(
            text,
            format_args!(
                "object tim{number} \"axis.timer\" {{ clock = hse * {ratio} / 2, variant = \"{kind}\", \
                 channels = {channels}, width = {width}, arr-reset = {top} }}"
            ),
        );
        for space in ["mem", "dmabus"] {
            line(
                text,
                format_args!("map {space} {base:#x} size 0x64 = tim{number}"),
            );
        }
        for (signal, input) in [("en", "enable"), ("rst", "reset")] {
            line(
                text,
                format_args!("wire rcc.{bank}{signal}{bit} -> tim{number}.{input}"),
            );
        }
    }
    line(text, format_args!("map dmabus 0x40012000 size 0x50 = adc1"));
}

fn ports(text: &mut String) {
    for (number, letter) in [(0, 'a'), (1, 'b'), (2, 'c'), (3, 'd'), (4, 'e'), (7, 'h')] {
        let base = 0x4002_0000 + 0x400 * number;
        line(
            text,
            format_args!("map mem {base:#x} size 0x28 = gpio{letter}"),
        );
    }
    for (name, timer_input) in INPUTS {
        let (port, number) = split(name);
        line(
            text,
            format_args!("wire pins.{name} -> gpio{port}.in{number}"),
        );
        if let Some(input) = timer_input {
            line(text, format_args!("wire pins.{name} -> {input}"));
        }
    }
    for (name, pull) in OUTPUTS {
        let (port, number) = split(name);
        line(
            text,
            format_args!("wire gpio{port}.p{number} -> pins.{name}-out {{ pull = \"{pull}\" }}"),
        );
    }
}

/// Letter of the port, and number of the pin.
fn split(name: &str) -> (&str, &str) {
    (&name[1..2], &name[2..])
}
