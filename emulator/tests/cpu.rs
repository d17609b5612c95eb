//! The model of the core against QEMU's: the same image on both makes the same words.
//!
//! The image is `vectors` of the board in QEMU, which says what is in it. On the part it runs from the flash as it is seen at
//! zero after a reset, with more RAM than the part has.

use leadscrew_emulator::{AxisMachine, CLOCK_HZ, Elf, Emulator as _, MILLISECOND, Part};
use leadscrew_hal_mock::scenario::Base;
use leadscrew_qemu::{Run, build};

#[path = "../../boards/mps2-an386/src/bin/vectors/portable/mod.rs"]
mod portable;

/// Virtual time after which the program has to be through.
const LONGEST_MS: u64 = 4_000;
/// Between two looks at it.
const LOOK_MS: u64 = 20;
/// After that the first group is there.
const FIRST_GROUP_MS: u64 = 250;

/// What of the group `single` is known to differ: instruction, modes of FPSCR. The firmware computes nothing in singles, and
/// leaves FPSCR as it is out of reset.
const KNOWN: [(usize, &[usize]); 6] = [
    // VSUB negates a NaN that it hands on.
    (1, &[0, 1, 2, 3, 4]),
    // VCVT.S16.F32 with a fraction.
    (29, &[0, 1, 2, 3, 4, 5, 6]),
    // VCVT.F32.S32 and VCVT.F32.U32 with a fraction: rounded as FPSCR says, not to nearest.
    (30, &[1, 2, 3, 6]),
    (31, &[1, 2, 3, 6]),
    // VCVTB.F16.F32 and VCVTT.F16.F32 with denormals flushed, default NaNs and rounding up.
    (35, &[6]),
    (36, &[6]),
];
const MODES: usize = 7;

/// Words of a group.
type Group = (String, Vec<u32>);

/// The image as the part takes it, and QEMU's words of it.
fn image() -> (Elf, Vec<u8>, Vec<Group>) {
    let path = build("vectors", "firmware").unwrap();
    let elf = Elf::parse(&std::fs::read(&path).unwrap()).unwrap();
    let mut flash = Part::blank_flash();
    elf.program(&mut flash).unwrap();
    let output = Run::new(path).run().unwrap();
    assert_eq!(output.exit_code, 0, "{output}");
    let lines = output.log_lines.iter();
    let groups: Vec<Group> = lines.filter_map(|line| group(&line.message)).collect();
    assert!(groups.len() > portable::GROUPS.len(), "{output}");
    (elf, flash, groups)
}

/// A line of the log: `vectors <group>: [<word>, …]`.
fn group(line: &str) -> Option<Group> {
    let (name, words) = line.strip_prefix("vectors ")?.split_once(": ")?;
    let words = words.trim_matches(['[', ']']).split(", ");
    let words = words.map(|word| u32::from_str_radix(word.trim_start_matches("0x"), 16));
    Some((name.to_owned(), words.collect::<Result<_, _>>().ok()?))
}

/// The part with the image, just switched on and its RAM cleared.
fn started(flash: Vec<u8>) -> Part {
    let machine = AxisMachine::workshop(Base::Bare, 1).unwrap();
    let mut part = Part::with_more_ram(flash, machine).unwrap();
    part.run_until(MILLISECOND).unwrap();
    part
}

/// The first words.
fn read(part: &Part, elf: &Elf, words: u32) -> Vec<u32> {
    let (vectors, _) = elf.symbol("VECTORS").expect("the words");
    let word = |place| part.peek(vectors + 4 * place).expect("RAM");
    (0..words).map(word).collect()
}

/// The words that the part makes, and its virtual time until then, s.
fn on_the_part(elf: &Elf, flash: Vec<u8>) -> (Vec<u32>, f64) {
    let (finished, _) = elf.symbol("FINISHED").expect("the number of words");
    let mut part = started(flash);
    for look in 1..LONGEST_MS / LOOK_MS {
        let words = part.peek(finished).expect("RAM");
        if words > 0 {
            let seconds = part.now() as f64 / CLOCK_HZ as f64;
            return (read(&part, elf, words), seconds);
        }
        part.run_until(look * LOOK_MS * MILLISECOND).unwrap();
    }
    panic!("the program does not end: {}", part.describe());
}

/// Groups and places of the words that differ.
fn differences(expected: &[Group], words: &[u32]) -> Vec<(String, usize)> {
    let mut found = words.iter();
    let mut differ = Vec::new();
    for (name, expected) in expected {
        for (place, word) in expected.iter().enumerate() {
            if found.next() != Some(word) {
                differ.push((name.clone(), place));
            }
        }
    }
    if found.next().is_some() {
        differ.push(("more than there are in QEMU".to_owned(), 0));
    }
    differ
}

#[test]
#[ignore = "needs QEMU; run by cargo xtask test"]
fn the_core_s_model_makes_the_words_that_qemu_makes() {
    let (elf, flash, expected) = image();
    let (words, seconds) = on_the_part(&elf, flash);
    for (name, words) in &expected {
        println!("{name}: {} words", words.len());
    }
    println!("{seconds:.2} s of virtual time on the part");
    assert_eq!(differences(&expected, &words), known());
}

/// [`KNOWN`] as places of words, two of each digest.
fn known() -> Vec<(String, usize)> {
    let digests = KNOWN
        .iter()
        .flat_map(|(instruction, modes)| modes.iter().map(move |mode| instruction * MODES + mode));
    let places = digests.flat_map(|digest| [2 * digest, 2 * digest + 1]);
    places.map(|place| ("single".to_owned(), place)).collect()
}

/// Words that a host computes.
fn on_the_host(make: portable::Make) -> Vec<u32> {
    let mut memory = vec![0; 4096];
    let mut words = portable::Words::new(&mut memory);
    make(&mut words);
    let used = words.used();
    memory.truncate(used);
    memory
}

#[test]
#[ignore = "needs QEMU; run by cargo xtask test"]
fn a_host_makes_the_same_words_of_plain_rust() {
    let (.., expected) = image();
    for (name, make) in portable::GROUPS {
        let of_qemu = expected.iter().filter(|(group, _)| group == name);
        let of_qemu: Vec<_> = of_qemu.flat_map(|(_, words)| words).copied().collect();
        let host = on_the_host(*make);
        let differ = host.iter().zip(&of_qemu).position(|(a, b)| a != b);
        assert_eq!((differ, host.len()), (None, of_qemu.len()), "{name}");
    }
}

/// Takes one instruction of the image for another, as a wrong model of the core would.
fn take_for(flash: &mut [u8], halves: [u16; 2], mask: [u16; 2], wrong: u16) -> usize {
    let mut taken = 0;
    for place in (0..flash.len() - 4).step_by(2) {
        let half = |at: usize| u16::from_le_bytes([flash[at], flash[at + 1]]);
        if half(place) & mask[0] == halves[0] && half(place + 2) & mask[1] == halves[1] {
            let half = half(place + 2) ^ wrong;
            flash[place + 2..place + 4].copy_from_slice(&half.to_le_bytes());
            taken += 1;
        }
    }
    taken
}

#[test]
#[ignore = "needs QEMU; run by cargo xtask test"]
fn a_wrong_model_is_caught_and_told_where() {
    let (elf, mut flash, expected) = image();
    // QDADD does what QDSUB does: bit 5 of the second half.
    let taken = take_for(&mut flash, [0xfa80, 0xf090], [0xfff0, 0xf0f0], 0x20);
    assert!(taken > 0, "the image has such an instruction");
    let mut part = started(flash);
    part.run_until(FIRST_GROUP_MS * MILLISECOND).unwrap();
    let words = read(&part, &elf, expected[0].1.len() as u32);
    let found = differences(&expected[..1], &words);
    // The two words of one instruction's digest.
    assert_eq!(found.len(), 2, "{found:?}");
    assert_eq!(found[0].1 / 2, found[1].1 / 2, "{found:?}");
}

#[test]
#[ignore = "needs QEMU; run by cargo xtask test"]
fn a_single_bit_and_a_missing_word_are_differences() {
    let (.., expected) = image();
    let mut words: Vec<u32> = expected
        .iter()
        .flat_map(|(_, words)| words)
        .copied()
        .collect();
    assert_eq!(differences(&expected, &words), []);
    let last = words.len() - 1;
    words[last] ^= 1 << 31;
    let place = expected
        .last()
        .map(|(name, words)| (name.clone(), words.len() - 1));
    assert_eq!(differences(&expected, &words).last(), place.as_ref());
    words.pop();
    assert_eq!(differences(&expected, &words).last(), place.as_ref());
}
