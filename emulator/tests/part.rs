//! The part's devices at their registers, against the reference manual, without a program.

mod support;

use leadscrew_emulator::{
    AxisMachine, Emulator as _, MachineHandle, Part, Pin, Serial, Surroundings as _,
};
use support::*;

/// Edges that the ring holds.
const EDGES: u32 = 8192;

/// TIM2 counts, TIM5 stamps both edges of A xor B into a ring, TIM8 latches both every millisecond.
fn start_capture(part: &mut Part) {
    for (address, value) in [
        (TIM2 + ARR, u32::MAX),
        (TIM2 + CCMR1, 0x0101),
        (TIM2 + CCMR2, 0x0301),
        (TIM2 + SMCR, 0x10),
        (TIM2 + SMCR, 0x13),
        (TIM2 + CCER, 0x1100),
        (TIM2 + CR1, 1),
        (TIM5 + ARR, u32::MAX),
        (TIM5 + CR2, 0x80),
        (TIM5 + CCMR1, 0x0001),
        (TIM5 + CCMR2, 0x0103),
        (TIM5 + SMCR, 0x30),
        (TIM5 + CCER, 0x110b),
        (TIM5 + DIER, 1 << 9),
        (DMA1 + 0x48, TIM5 + CCR1),
        (DMA1 + 0x4c, RING),
        (DMA1 + 0x44, EDGES),
        (
            DMA1 + 0x40,
            6 << 25 | 2 << 13 | 2 << 11 | 1 << 10 | 1 << 8 | 1,
        ),
        (TIM5 + CR1, 1),
        (TIM8 + PSC, 3),
        (TIM8 + ARR, 41_999),
        (TIM8 + CR2, 0x20),
        (TIM8 + EGR, 1),
        (TIM8 + CR1, 1),
    ] {
        part.poke(address, value);
    }
}

/// How many times are in the ring.
fn captured(part: &Part) -> u32 {
    EDGES - word(part, DMA1 + 0x44)
}

fn force(machine: &MachineHandle, edges_per_s: f64) {
    machine.lock().expect("a machine").force(edges_per_s);
}

/// Every edge at this rate is in the ring, at its time.
fn all_edges_at(edges_per_s: f64, microseconds: u64) {
    let (mut part, machine) = idle_part();
    start_capture(&mut part);
    force(&machine, edges_per_s);
    run_us(&mut part, microseconds);
    let edges = machine.lock().expect("a machine").edges() as u32;
    let seen = captured(&part);
    // The last ones of the machine's step are still to come.
    let expected = microseconds as f64 * edges_per_s / 1e6;
    assert!(
        f64::from(seen) > expected * 0.9 && seen <= edges,
        "{seen} of {edges}"
    );
    let times: Vec<u32> = (0..seen).map(|edge| word(&part, RING + 4 * edge)).collect();
    let period = 84e6 / edges_per_s;
    for (edge, pair) in times.windows(2).enumerate() {
        let apart = f64::from(pair[1].wrapping_sub(pair[0]));
        assert!(
            (apart - period).abs() <= 1.0,
            "edge {edge}: {apart}, not {period}"
        );
    }
    let count = word(&part, TIM2 + CNT);
    assert!(count.abs_diff(seen) <= 1, "count {count} for {seen} edges");
}

#[test]
fn every_edge_is_stamped_at_150_a_millisecond() {
    all_edges_at(150e3, 20_000);
}

#[test]
fn every_edge_is_stamped_at_1200_a_millisecond() {
    all_edges_at(1.2e6, 5_000);
}

#[test]
fn the_tick_latches_count_and_time_at_one_instant() {
    let (mut part, machine) = idle_part();
    start_capture(&mut part);
    force(&machine, -150e3);
    let mut before = None;
    for _ in 0..5 {
        run_us(&mut part, 1000);
        let (count, time) = (word(&part, TIM2 + CCR4), word(&part, TIM5 + CCR3));
        if let Some((count_before, time_before)) = before {
            assert_eq!(time.wrapping_sub(time_before), 84_000);
            let counts: u32 = count.wrapping_sub(count_before);
            assert!((-151..=-149).contains(&counts.cast_signed()), "{counts}");
        }
        before = Some((count, time));
    }
}

#[test]
fn the_index_latches_count_and_time_of_its_front() {
    let (mut part, machine) = idle_part();
    start_capture(&mut part);
    let (start, edges) = {
        let machine = machine.lock().expect("a machine");
        let edges = machine.world().board.machine.encoder().edges();
        (machine.count(), edges)
    };
    force(&machine, 600e3);
    run_us(&mut part, edges as u64 * 10 / 6 + 200);
    let shaft = start + word(&part, TIM2 + CCR3).cast_signed();
    assert_eq!(shaft, edges as i32, "a turn from where the index is");
    // The edge of B that passes the boundary comes with the same clock.
    let time = word(&part, TIM5 + CCR4);
    let apart = (0..EDGES).map(|edge| word(&part, RING + 4 * edge).abs_diff(time));
    assert!(apart.min() <= Some(1), "no edge at {time}");
}

#[test]
fn steps_count_up_and_down_by_their_direction() {
    let (mut part, machine) = idle_part();
    for (address, value) in [
        (TIM4 + ARR, 0xffff),
        (TIM4 + CCMR1, 0x0001),
        (TIM4 + SMCR, 0x57),
        (TIM4 + CR1, 1),
    ] {
        part.poke(address, value);
    }
    machine.lock().expect("a machine").step_at(50e3);
    run_us(&mut part, 2_000);
    let steps = machine.lock().expect("a machine").steps();
    assert!(steps > 90);
    let counted = i64::from(word(&part, TIM4 + CNT));
    assert!((counted - steps).abs() <= 3, "{counted} of {steps}");
    part.poke(TIM4 + CR1, 0x11);
    let (before, steps) = (counted, machine.lock().expect("a machine").steps());
    run_us(&mut part, 1_000);
    let counted = i64::from(word(&part, TIM4 + CNT));
    let given = machine.lock().expect("a machine").steps() - steps;
    assert!((before - counted - given).abs() <= 3, "{counted}");
}

#[test]
fn a_probe_is_stamped_by_the_16_bit_timer() {
    let (mut part, machine) = idle_part();
    start_capture(&mut part);
    for (address, value) in [
        (TIM1 + PSC, 1),
        (TIM1 + ARR, 0xffff),
        (TIM1 + CCMR1, 0x0001),
        (TIM1 + CCER, 0x0001),
        (TIM1 + EGR, 1),
        (TIM1 + CR1, 1),
    ] {
        part.poke(address, value);
    }
    // Without an access the two timers stand still against each other.
    let offset = word(&part, TIM5 + CNT).wrapping_sub(word(&part, TIM1 + CNT)) as u16;
    let start = machine.lock().expect("a machine").count();
    machine
        .lock()
        .expect("a machine")
        .put_probe(Some(start + 100));
    force(&machine, 150e3);
    run_us(&mut part, 2_000);
    assert_ne!(word(&part, TIM1 + SR) & 2, 0, "nothing captured");
    let stamp = (word(&part, TIM1 + CCR1) as u16).wrapping_add(offset);
    let edge = word(&part, RING + 4 * 99) as u16;
    assert!(
        stamp.wrapping_sub(edge).cast_signed().abs() <= 2,
        "{stamp} for {edge}"
    );
}

#[test]
fn the_watchdog_resets_all_but_the_ram() {
    let (mut part, _machine) = idle_part();
    part.poke(0x2000_0100, 0xcafe_f00d);
    // PB9 drives.
    part.poke(0x4002_0400, 0x280 | 1 << 18);
    for (offset, value) in [(0, 0xcccc), (0, 0x5555)] {
        part.poke(0x4000_3000 + offset, value);
    }
    run_us(&mut part, 1_000);
    part.poke(0x4000_3008, 50);
    part.poke(0x4000_3000, 0xaaaa);
    run_us(&mut part, 5_000);
    assert_eq!(part.resets(), 0);
    run_us(&mut part, 5_000);
    assert_eq!(part.resets(), 1);
    assert_eq!(word(&part, 0x2000_0100), 0xcafe_f00d);
    assert_eq!(
        word(&part, 0x4002_0400),
        0x280,
        "port B is as after a reset"
    );
    assert_ne!(word(&part, RCC + 0x74) & 1 << 29, 0, "the watchdog is told");
    assert_eq!(word(&part, RCC + 0x44), 0, "no clock is on");
}

#[test]
fn the_usart_sends_and_receives_at_its_rate() {
    let (mut part, _machine) = idle_part();
    let usart = 0x4001_1000;
    part.poke(usart + 0x08, 84_000_000 / 115_200);
    part.poke(usart + 0x0c, 1 << 13 | 3 << 2);
    part.poke(usart + 0x04, 0x55);
    run_us(&mut part, 80);
    assert!(part.receive(Serial::Link).is_empty());
    run_us(&mut part, 20);
    assert_eq!(part.receive(Serial::Link), [0x55]);
    part.send(Serial::Link, &[0x66]);
    run_us(&mut part, 100);
    assert_eq!(word(&part, usart) & 1 << 5, 1 << 5);
    assert_eq!(word(&part, usart + 4), 0x66);
}

#[test]
fn the_converter_takes_whole_frames_and_gives_them_back() {
    let (mut part, machine) = idle_part();
    let spi = 0x4001_3000;
    // PA4, PC4 and PC5 drive; /LDAC stays low, /RESET rises.
    part.poke(0x4002_0018, 1 << 4);
    part.poke(0x4002_0818, 1 << 5);
    part.poke(0x4002_0000, 0xa800_0000 | 1 << 8);
    part.poke(0x4002_0800, 5 << 8);
    part.poke(spi, 1 << 9 | 1 << 8 | 1 << 6 | 2 << 3 | 1 << 2 | 1);
    let mut frame = |word_out: u32| {
        part.poke(0x4002_0018, 1 << 20);
        let mut back = 0;
        for shift in [16, 8, 0] {
            part.poke(spi + 0x0c, word_out >> shift & 0xff);
            run_us(&mut part, 20);
            assert_eq!(word(&part, spi + 8) & 0x81, 1, "received, not busy");
            back = back << 8 | word(&part, spi + 0x0c);
            // A debugger's look takes nothing: fetch it as a program does.
            part.fetch(spi + 0x0c);
        }
        part.poke(0x4002_0018, 1 << 4);
        back
    };
    // ±10 V, two's complement, mid scale at power-up.
    frame(0x04_0088);
    frame(0x03_4000);
    let volts = machine.lock().expect("a machine").converter().volts();
    assert!((volts - 5.0).abs() < 1e-9, "{volts}");
    frame(0x0b_0000);
    assert_eq!(frame(0x00_0000), 0x0b_4000);
    let machine = machine.lock().expect("a machine");
    assert_eq!(machine.converter().frames(), (4, 0));
}

#[test]
fn the_machine_at_rest_tells_its_levels() {
    let machine = AxisMachine::workshop(leadscrew_hal_mock::scenario::Base::Bare, 1);
    let machine = machine.expect("the workshop's machine");
    let mut changes = Vec::new();
    machine.lock().expect("a machine").advance(0, &mut changes);
    let level = |pin| {
        changes
            .iter()
            .find(|(at, _)| *at == pin)
            .map(|(_, level)| *level)
    };
    assert_eq!(level(Pin::b(12)), Some(false), "the drive is ready");
    assert_eq!(level(Pin::c(1)), Some(false), "no emergency stop");
    assert_eq!(level(Pin::b(14)), Some(false), "the encoder is there");
}

#[test]
fn the_core_stands_while_a_sector_is_erased_and_the_watchdog_does_not() {
    const FLASH: u32 = 0x4002_3c00;
    const WORD: u32 = 0x0800_4000;
    let (mut part, _machine) = idle_part();
    part.poke(FLASH + 0x04, 0x4567_0123);
    part.poke(FLASH + 0x04, 0xcdef_89ab);
    part.poke(FLASH + 0x10, 2 << 8 | 1);
    part.poke(WORD, 0x1234_5678);
    run_us(&mut part, 100);
    assert_eq!(word(&part, WORD), 0x1234_5678);
    part.poke(FLASH + 0x10, 1 << 16 | 2 << 8 | 1 << 3 | 1 << 1);
    let before = part.cycles();
    run_us(&mut part, 200_000);
    assert!(part.cycles() - before < 4_000, "the core ran on");
    run_us(&mut part, 100_000);
    assert!(
        part.cycles() - before > 1_000_000,
        "the core stands for ever"
    );
    assert_eq!(word(&part, WORD), u32::MAX);
    // 50 ms of the watchdog end an erasure of 250: what the board lengthens its period for.
    part.poke(0x4000_3000, 0xcccc);
    part.poke(0x4000_3000, 0x5555);
    part.poke(0x4000_3008, 400);
    part.poke(0x4000_3000, 0xaaaa);
    part.poke(FLASH + 0x10, 1 << 16 | 2 << 8 | 2 << 3 | 1 << 1);
    run_us(&mut part, 60_000);
    assert_eq!(part.resets(), 1);
}
