//! Instructions on registers, each by itself: results, flags N Z C V Q and GE.

use core::arch::asm;

use crate::portable::{Digest, Operands, Words};

const ROUNDS: u32 = 200;

/// A word for every instruction: the digest of its results over random operands. `low` and `high` are read and written.
macro_rules! each {
    ($words:expr; $($instruction:literal)+) => {$({
        let (mut operands, mut digest) = (Operands::new(), Digest::new());
        for _ in 0..ROUNDS {
            let (first, second) = (operands.word(), operands.word());
            let (mut low, mut high) = (operands.word(), operands.word());
            let mut flags = operands.any() as u32 & 0xf80f_0000;
            // SAFETY: the instruction works on these registers and on the flags only.
            unsafe {
                asm!(
                    "msr apsr_nzcvqg, {flags}",
                    $instruction,
                    "mrs {flags}, apsr",
                    "@ {low} {high} {first} {second}",
                    flags = inout(reg) flags,
                    low = inout(reg) low,
                    high = inout(reg) high,
                    first = in(reg) first,
                    second = in(reg) second,
                    options(nomem, nostack),
                );
            }
            [low, high, flags].into_iter().for_each(|word| digest.take(word));
        }
        $words.push_digest(&digest);
    })+};
}

/// The group.
pub fn run(words: &mut Words<'_>) {
    sums(words);
    logic(words);
    shifts(words);
    products(words);
    halves(words);
    saturation(words);
    lanes(words);
    fields(words);
    conditions(words);
}

#[inline(never)]
fn sums(words: &mut Words<'_>) {
    each!(words;
        "adds {low}, {first}, {second}" "adcs {low}, {first}, {second}" "subs {low}, {first}, {second}"
        "sbcs {low}, {first}, {second}" "rsbs {low}, {first}, {second}" "rsbs {low}, {first}, #0"
        "adds {low}, {first}, #7" "adds {low}, #255" "subs {low}, {first}, #1" "addw {low}, {first}, #4095"
        "subw {low}, {first}, #4095" "adds {low}, {first}, #0xff00ff00" "adcs {low}, {first}, #0x10001"
        "sbcs {low}, {first}, #0" "adds {low}, {first}, {second}, lsl #3" "subs {low}, {first}, {second}, asr #31"
        "adcs {low}, {first}, {second}, lsr #32" "sbcs {low}, {first}, {second}, ror #9"
        "rsbs {low}, {first}, {second}, lsl #1" "adc {low}, {first}, {second}, rrx"
        "cmp {first}, {second}" "cmn {first}, {second}" "cmp {first}, #0x80000000" "cmn {first}, #1"
        "cmp {first}, {second}, asr #31"
    );
}

#[inline(never)]
fn logic(words: &mut Words<'_>) {
    each!(words;
        "ands {low}, {first}, {second}" "orrs {low}, {first}, {second}" "eors {low}, {first}, {second}"
        "bics {low}, {first}, {second}" "orns {low}, {first}, {second}" "mvns {low}, {first}"
        "ands {low}, {first}, #0xff000000" "orrs {low}, {first}, #0x00ff00ff" "eors {low}, {first}, #0x80000000"
        "bics {low}, {first}, #0xab00" "ands {low}, {first}, {second}, lsl #7" "orrs {low}, {first}, {second}, lsr #32"
        "eors {low}, {first}, {second}, ror #1" "orr {low}, {first}, {second}, asr #17" "tst {first}, {second}"
        "teq {first}, {second}" "tst {first}, #0x80000000" "teq {first}, {second}, rrx" "movs {low}, {first}"
        "movw {low}, #0xabcd" "movt {low}, #0x1234" "mvn {low}, #0xaa00aa00"
    );
}

#[inline(never)]
fn shifts(words: &mut Words<'_>) {
    each!(words;
        "lsls {low}, {first}, {second}" "lsrs {low}, {first}, {second}" "asrs {low}, {first}, {second}"
        "rors {low}, {first}, {second}" "lsls {low}, {first}, #1" "lsls {low}, {first}, #31" "lsrs {low}, {first}, #1"
        "lsrs {low}, {first}, #32" "asrs {low}, {first}, #13" "asrs {low}, {first}, #32" "rors {low}, {first}, #1"
        "rors {low}, {first}, #31" "rrxs {low}, {first}" "clz {low}, {first}" "rbit {low}, {first}" "rev {low}, {first}"
        "rev16 {low}, {first}" "revsh {low}, {first}"
    );
}

#[inline(never)]
fn products(words: &mut Words<'_>) {
    each!(words;
        "mul {low}, {first}, {second}" "mla {low}, {first}, {second}, {high}"
        "mls {low}, {first}, {second}, {high}" "smull {low}, {high}, {first}, {second}"
        "umull {low}, {high}, {first}, {second}" "smlal {low}, {high}, {first}, {second}"
        "umlal {low}, {high}, {first}, {second}" "umaal {low}, {high}, {first}, {second}"
        "smmul {low}, {first}, {second}" "smmulr {low}, {first}, {second}" "smmla {low}, {first}, {second}, {high}"
        "smmlar {low}, {first}, {second}, {high}" "smmls {low}, {first}, {second}, {high}"
        "smmlsr {low}, {first}, {second}, {high}" "sdiv {low}, {first}, {second}" "udiv {low}, {first}, {second}"
    );
}

#[inline(never)]
fn halves(words: &mut Words<'_>) {
    each!(words;
        "smulbb {low}, {first}, {second}" "smulbt {low}, {first}, {second}" "smultb {low}, {first}, {second}"
        "smultt {low}, {first}, {second}" "smulwb {low}, {first}, {second}" "smulwt {low}, {first}, {second}"
        "smlabb {low}, {first}, {second}, {high}" "smlabt {low}, {first}, {second}, {high}"
        "smlatb {low}, {first}, {second}, {high}" "smlatt {low}, {first}, {second}, {high}"
        "smlawb {low}, {first}, {second}, {high}" "smlawt {low}, {first}, {second}, {high}"
        "smlalbb {low}, {high}, {first}, {second}" "smlalbt {low}, {high}, {first}, {second}"
        "smlaltb {low}, {high}, {first}, {second}" "smlaltt {low}, {high}, {first}, {second}"
        "smuad {low}, {first}, {second}" "smuadx {low}, {first}, {second}" "smusd {low}, {first}, {second}"
        "smusdx {low}, {first}, {second}" "smlad {low}, {first}, {second}, {high}"
        "smladx {low}, {first}, {second}, {high}" "smlsd {low}, {first}, {second}, {high}"
        "smlsdx {low}, {first}, {second}, {high}" "smlald {low}, {high}, {first}, {second}"
        "smlaldx {low}, {high}, {first}, {second}" "smlsld {low}, {high}, {first}, {second}"
        "smlsldx {low}, {high}, {first}, {second}"
    );
}

#[inline(never)]
fn saturation(words: &mut Words<'_>) {
    each!(words;
        "qadd {low}, {first}, {second}" "qsub {low}, {first}, {second}" "qdadd {low}, {first}, {second}"
        "qdsub {low}, {first}, {second}" "ssat {low}, #1, {first}" "ssat {low}, #16, {first}" "ssat {low}, #32, {first}"
        "ssat {low}, #24, {first}, asr #8" "ssat {low}, #30, {first}, lsl #3" "usat {low}, #0, {first}"
        "usat {low}, #16, {first}" "usat {low}, #31, {first}, lsl #1" "usat {low}, #9, {first}, asr #31"
        "ssat16 {low}, #9, {first}" "usat16 {low}, #7, {first}" "qadd16 {low}, {first}, {second}"
        "qsub16 {low}, {first}, {second}" "qadd8 {low}, {first}, {second}" "qsub8 {low}, {first}, {second}"
        "qasx {low}, {first}, {second}" "qsax {low}, {first}, {second}" "uqadd16 {low}, {first}, {second}"
        "uqsub16 {low}, {first}, {second}" "uqadd8 {low}, {first}, {second}" "uqsub8 {low}, {first}, {second}"
        "uqasx {low}, {first}, {second}" "uqsax {low}, {first}, {second}"
    );
}

#[inline(never)]
fn lanes(words: &mut Words<'_>) {
    each!(words;
        "sadd16 {low}, {first}, {second}" "ssub16 {low}, {first}, {second}" "sadd8 {low}, {first}, {second}"
        "ssub8 {low}, {first}, {second}" "sasx {low}, {first}, {second}" "ssax {low}, {first}, {second}"
        "uadd16 {low}, {first}, {second}" "usub16 {low}, {first}, {second}" "uadd8 {low}, {first}, {second}"
        "usub8 {low}, {first}, {second}" "uasx {low}, {first}, {second}" "usax {low}, {first}, {second}"
        "shadd16 {low}, {first}, {second}" "shsub16 {low}, {first}, {second}" "shadd8 {low}, {first}, {second}"
        "shsub8 {low}, {first}, {second}" "uhadd16 {low}, {first}, {second}" "uhsub8 {low}, {first}, {second}"
        "uhadd8 {low}, {first}, {second}" "uhsub16 {low}, {first}, {second}" "sel {low}, {first}, {second}"
        "usad8 {low}, {first}, {second}" "usada8 {low}, {first}, {second}, {high}"
    );
}

#[inline(never)]
fn fields(words: &mut Words<'_>) {
    each!(words;
        "sxtb {low}, {first}" "sxth {low}, {first}" "uxtb {low}, {first}" "uxth {low}, {first}"
        "sxtb {low}, {first}, ror #16" "uxth {low}, {first}, ror #8" "sxtab {low}, {first}, {second}"
        "sxtah {low}, {first}, {second}, ror #24" "uxtab {low}, {first}, {second}, ror #8" "uxtah {low}, {first}, {second}"
        "sxtb16 {low}, {first}" "uxtb16 {low}, {first}, ror #8" "sxtab16 {low}, {first}, {second}"
        "uxtab16 {low}, {first}, {second}" "sbfx {low}, {first}, #5, #11" "ubfx {low}, {first}, #31, #1"
        "sbfx {low}, {first}, #0, #32" "bfi {low}, {first}, #3, #20" "bfc {low}, #9, #14"
        "pkhbt {low}, {first}, {second}" "pkhbt {low}, {first}, {second}, lsl #5"
        "pkhtb {low}, {first}, {second}, asr #16"
    );
}

/// Every condition, in blocks of one to four instructions.
#[inline(never)]
fn conditions(words: &mut Words<'_>) {
    each!(words;
        "it eq\naddeq {low}, {first}, {second}" "it ne\nmovne {low}, {first}" "ite cs\nmovcs {low}, {first}\nmovcc {high}, {second}"
        "ite mi\nmovmi {low}, {first}\nmovpl {high}, {second}" "ite vs\nmovvs {low}, {first}\nmovvc {high}, {second}"
        "ite hi\nmovhi {low}, {first}\nmovls {high}, {second}" "ite ge\nmovge {low}, {first}\nmovlt {high}, {second}"
        "ite gt\nmovgt {low}, {first}\nmovle {high}, {second}"
        "ittt lt\naddlt {low}, {low}, {first}\nsublt {high}, {high}, {second}\neorlt {low}, {low}, {high}"
        "itete ne\nmulne {low}, {first}, {second}\nlsleq {low}, {first}, #4\naddne {high}, {high}, {low}\nsubeq {high}, {high}, {low}"
        "cmp {first}, {second}\nitt hi\nsubhi {low}, {first}, {second}\ncmphi {low}, {high}"
        "itttt cc\nlsrcc {low}, {first}, #3\norrcc {high}, {high}, {low}\nmvncc {low}, {low}\nandcc {high}, {high}, {low}"
    );
}
