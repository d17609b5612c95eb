//! Instructions of the floating-point unit, each by itself, in every mode of rounding, with denormals flushed, with default NaNs.

use core::arch::asm;

use crate::portable::{Digest, Operands, Words};

const ROUNDS: u32 = 200;
/// Round to nearest, up, down, to zero; flush to zero; default NaN; the last two together.
const MODES: [u32; 7] = [
    0,
    1 << 22,
    2 << 22,
    3 << 22,
    1 << 24,
    1 << 25,
    3 << 24 | 1 << 22,
];
/// N Z C V of FPSCR.
const COMPARISON: u32 = 0xf000_0000;

/// Values at which a single turns: zeros, denormals, the ends of the normal ones, infinities, NaNs quiet and signalling.
const TURNS: [u32; 14] = [
    0,
    1,
    0x0000_ffff,
    0x007f_ffff,
    0x0080_0000,
    0x0080_0001,
    0x3f80_0000,
    0x3f00_0000,
    0x4eff_ffff,
    0x4f00_0000,
    0x7f7f_ffff,
    0x7f80_0000,
    0x7fc0_1234,
    0x7f80_0001,
];

/// Any single, one at a turn, or one near one.
fn single(operands: &mut Operands) -> u32 {
    let (any, choice) = (operands.any(), operands.any() as u32);
    let sign = choice & 0x8000_0000;
    match choice & 3 {
        0 => any as u32,
        1 => TURNS[(choice >> 8) as usize % TURNS.len()] | sign,
        // Of the size of an axis' quantities.
        2 => (0x3a80_0000 + (any as u32 & 0x0dff_ffff)) | sign,
        _ => (0x3f80_0000 + (any as u32 & 0x00ff_ffff)) | sign,
    }
}

macro_rules! each {
    ($words:expr; $($instruction:literal)+) => {$({
        for mode in MODES {
            let (mut operands, mut digest) = (Operands::new(), Digest::new());
            for _ in 0..ROUNDS {
                let (first, second) = (single(&mut operands), single(&mut operands));
                let mut result = single(&mut operands);
                let flags: u32;
                // SAFETY: the instruction works on registers and on FPSCR that are put back; the compiler knows of no
                // floating-point registers here, so it cannot be asked for them.
                unsafe {
                    asm!(
                        "vpush {{d6, d7}}",
                        "vmov s12, {result}",
                        "vmov s13, {first}",
                        "vmov s14, {second}",
                        "vmrs {before}, fpscr",
                        "vmsr fpscr, {mode}",
                        $instruction,
                        "vmrs {flags}, fpscr",
                        "vmsr fpscr, {before}",
                        "vmov {result}, s12",
                        "vpop {{d6, d7}}",
                        before = out(reg) _,
                        mode = in(reg) mode,
                        flags = out(reg) flags,
                        result = inout(reg) result,
                        first = in(reg) first,
                        second = in(reg) second,
                    );
                }
                digest.take(result);
                digest.take(flags & COMPARISON);
            }
            $words.push_digest(&digest);
        }
    })+};
}

/// The group.
pub fn run(words: &mut Words<'_>) {
    arithmetic(words);
    fused(words);
    comparisons(words);
    conversions(words);
}

#[inline(never)]
fn arithmetic(words: &mut Words<'_>) {
    each!(words;
        "vadd.f32 s12, s13, s14" "vsub.f32 s12, s13, s14" "vmul.f32 s12, s13, s14"
        "vnmul.f32 s12, s13, s14" "vdiv.f32 s12, s13, s14" "vsqrt.f32 s12, s13"
        "vabs.f32 s12, s13" "vneg.f32 s12, s13" "vmov.f32 s12, #0.5"
    );
}

#[inline(never)]
fn fused(words: &mut Words<'_>) {
    each!(words;
        "vmla.f32 s12, s13, s14" "vmls.f32 s12, s13, s14" "vnmla.f32 s12, s13, s14"
        "vnmls.f32 s12, s13, s14" "vfma.f32 s12, s13, s14" "vfms.f32 s12, s13, s14"
        "vfnma.f32 s12, s13, s14" "vfnms.f32 s12, s13, s14"
    );
}

#[inline(never)]
fn comparisons(words: &mut Words<'_>) {
    each!(words;
        "vcmp.f32 s13, s14" "vcmpe.f32 s13, s14" "vcmp.f32 s13, #0" "vcmpe.f32 s13, #0"
    );
}

#[inline(never)]
fn conversions(words: &mut Words<'_>) {
    each!(words;
        "vcvt.s32.f32 s12, s13" "vcvt.u32.f32 s12, s13" "vcvtr.s32.f32 s12, s13"
        "vcvtr.u32.f32 s12, s13" "vcvt.f32.s32 s12, s13" "vcvt.f32.u32 s12, s13"
        "vcvt.s32.f32 s12, s12, #16" "vcvt.u32.f32 s12, s12, #20" "vcvt.s16.f32 s12, s12, #4"
        "vcvt.f32.s32 s12, s12, #16" "vcvt.f32.u32 s12, s12, #31" "vcvt.f32.u16 s12, s12, #8"
        "vcvtb.f32.f16 s12, s13" "vcvtt.f32.f16 s12, s13" "vcvtb.f16.f32 s12, s13"
        "vcvtt.f16.f32 s12, s13"
    );
}
