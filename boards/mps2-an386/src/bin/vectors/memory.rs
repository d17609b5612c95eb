//! Loads and stores: every width, sign, way of addressing and alignment, several at once, exclusive ones, jumps by tables.

use core::arch::asm;

use crate::portable::{Digest, Operands, Words};

const ROUNDS: u32 = 60;
/// Words of the memory that they work on, and which of them they begin with.
const LENGTH: usize = 24;
const MIDDLE: usize = 8;
/// Which offsets from a word an instruction takes.
const ANY: u32 = 3;
const ALIGNED: u32 = 0;

#[repr(align(8))]
struct Memory([u32; LENGTH]);

macro_rules! each {
    ($words:expr, $offsets:expr; $($instruction:literal)+) => {$({
        let (mut operands, mut digest) = (Operands::new(), Digest::new());
        for round in 0..ROUNDS {
            let mut memory = Memory([0; LENGTH]);
            memory.0.fill_with(|| operands.any() as u32);
            let start = memory.0.as_ptr().addr();
            let (mut low, mut high) = (operands.any() as u32, operands.any() as u32);
            let index = operands.any() as u32 & 7;
            // SAFETY: the instruction touches at most 24 bytes before and 31 after the middle of the memory.
            unsafe {
                let offset = (round & $offsets) as usize;
                let mut at = memory.0.as_mut_ptr().add(MIDDLE).byte_add(offset);
                asm!(
                    "vpush {{d6, d7}}",
                    $instruction,
                    "vpop {{d6, d7}}",
                    "@ {at} {low} {high} {index}",
                    at = inout(reg) at,
                    low = inout(reg) low,
                    high = inout(reg) high,
                    index = in(reg) index,
                    // Those that take several registers want them in order. The compiler knows of no floating-point
                    // registers here: those are put back.
                    out("r8") _, out("r9") _,
                );
                digest.take((at.addr() - start) as u32);
            }
            memory.0.iter().for_each(|&word| digest.take(word));
            [low, high].into_iter().for_each(|word| digest.take(word));
        }
        $words.push_digest(&digest);
    })+};
}

/// The group.
pub fn run(words: &mut Words<'_>) {
    loads(words);
    stores(words);
    several(words);
    exclusive(words);
    tables(words);
}

#[inline(never)]
fn loads(words: &mut Words<'_>) {
    each!(words, ANY;
        "ldr {low}, [{at}]" "ldrh {low}, [{at}]" "ldrb {low}, [{at}]" "ldrsh {low}, [{at}]" "ldrsb {low}, [{at}]"
        "ldr {low}, [{at}, #-17]" "ldrsh {low}, [{at}, #13]" "ldrsb {low}, [{at}], #3" "ldrh {low}, [{at}, #-6]!"
        "ldr {low}, [{at}], #-4" "ldr {low}, [{at}, {index}]" "ldr {low}, [{at}, {index}, lsl #1]"
        "ldrb {low}, [{at}, {index}, lsl #2]" "ldrsh {low}, [{at}, {index}, lsl #1]" "ldrh {low}, [{at}, {index}]"
    );
}

#[inline(never)]
fn stores(words: &mut Words<'_>) {
    each!(words, ANY;
        "str {low}, [{at}]" "strh {low}, [{at}]" "strb {low}, [{at}]" "str {low}, [{at}, #-11]"
        "strh {low}, [{at}, #5]!" "strb {low}, [{at}], #-1" "str {low}, [{at}, {index}, lsl #1]"
        "strh {low}, [{at}, {index}, lsl #1]" "strb {low}, [{at}, {index}]"
    );
}

#[inline(never)]
fn several(words: &mut Words<'_>) {
    each!(words, ALIGNED;
        "ldrd {low}, {high}, [{at}, #8]" "ldrd {low}, {high}, [{at}], #-8" "strd {low}, {high}, [{at}, #-12]!"
        "strd {low}, {high}, [{at}]" "ldm {at}, {{r8, r9}}\nadd {low}, r8, r9" "ldmdb {at}!, {{r8, r9}}\neor {low}, r8, r9, ror #3"
        "mov r8, {low}\nmov r9, {high}\nstm {at}!, {{r8, r9}}" "mov r8, {low}\nmov r9, {high}\nstmdb {at}!, {{r8, r9}}"
        "push {{r8, r9}}\nmov r8, {low}\nmov r9, {high}\npush {{r8, r9}}\npop {{r9}}\npop {{r8}}\nsub {low}, r8, r9, lsl #1\npop {{r8, r9}}"
        "vldr s14, [{at}, #4]\nvmov {low}, s14" "vldr d7, [{at}, #-16]\nvmov {low}, {high}, d7"
        "vmov d7, {low}, {high}\nvstr d7, [{at}]" "vmov s15, {high}\nvstr s15, [{at}, #12]"
        "vldmia {at}!, {{s14, s15}}\nvmov {low}, {high}, s14, s15" "vmov s14, s15, {low}, {high}\nvstmdb {at}!, {{s14, s15}}"
        "vmov s14, {low}\nvpush {{s14}}\nvpop {{s15}}\nvmov {high}, s15"
    );
}

#[inline(never)]
fn exclusive(words: &mut Words<'_>) {
    each!(words, ALIGNED;
        "ldrex {low}, [{at}]\nadd {low}, #5\nstrex {high}, {low}, [{at}]" "clrex\nstrex {high}, {low}, [{at}]"
        "ldrexb {low}, [{at}]\nstrexb {high}, {index}, [{at}]" "ldrexh {low}, [{at}]\nstrexh {high}, {index}, [{at}]"
        "ldrex {low}, [{at}]\nclrex\nstrex {high}, {low}, [{at}]"
    );
}

/// What depends on where the program lies is not taken in: `lr` and `pc` stay out of the results.
#[inline(never)]
fn tables(words: &mut Words<'_>) {
    each!(words, ALIGNED;
        "and {high}, {index}, #3\ntbb [pc, {high}]\n20:\n.byte (21f-20b)/2\n.byte (22f-20b)/2\n.byte (23f-20b)/2\n.byte (24f-20b)/2\n\
         21:\nadd {low}, #1\n22:\nadd {low}, #16\n23:\nadd {low}, #256\n24:\nadd {low}, #4096"
        "and {high}, {index}, #3\ntbh [pc, {high}, lsl #1]\n20:\n.hword (21f-20b)/2\n.hword (22f-20b)/2\n.hword (23f-20b)/2\n\
         .hword (24f-20b)/2\n21:\nadd {low}, #1\n22:\nadd {low}, #16\n23:\nadd {low}, #256\n24:\nadd {low}, #4096"
    );
}
