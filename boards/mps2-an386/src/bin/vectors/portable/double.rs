//! `f64`, which the core has no instructions for: the compiler's routines, and the functions of libm.

use core::hint::black_box;

use super::{Digest, Operands, Words};

const ROUNDS: u32 = 300;

/// The group.
pub fn run(words: &mut Words<'_>) {
    let pairs: [fn(f64, f64) -> f64; 11] = [
        |a, b| a + b,
        |a, b| a - b,
        |a, b| a * b,
        |a, b| a / b,
        |a, b| a % b,
        libm::hypot,
        libm::atan2,
        libm::copysign,
        libm::fmin,
        libm::fmax,
        // Over the range of the configuration's own powers.
        |a, b| libm::pow(libm::fabs(small(a)), small(b)),
    ];
    for function in pairs {
        let (mut operands, mut digest) = (Operands::new(), Digest::new());
        for _ in 0..ROUNDS {
            let (a, b) = (number(&mut operands), number(&mut operands));
            take(&mut digest, function(black_box(a), black_box(b)));
        }
        words.push_digest(&digest);
    }
    for function in singles() {
        let (mut operands, mut digest) = (Operands::new(), Digest::new());
        for _ in 0..ROUNDS {
            take(&mut digest, function(black_box(number(&mut operands))));
        }
        words.push_digest(&digest);
    }
    conversions(words);
}

/// Functions of one number.
fn singles() -> [fn(f64) -> f64; 13] {
    [
        libm::sqrt,
        libm::floor,
        libm::ceil,
        libm::round,
        libm::fabs,
        |x| libm::exp(small(x)),
        |x| libm::log(libm::fabs(x)),
        |x| libm::log2(libm::fabs(x)),
        |x| libm::log10(libm::fabs(x)),
        |x| libm::sin(small(x)),
        |x| libm::cos(small(x)),
        |x| libm::frexp(x).0,
        |x| libm::ldexp(small(x), 5),
    ]
}

fn conversions(words: &mut Words<'_>) {
    let (mut operands, mut digest) = (Operands::new(), Digest::new());
    for _ in 0..ROUNDS {
        let x = black_box(number(&mut operands));
        digest.take((x as i32).cast_unsigned());
        digest.take(x as u32);
        digest.take_long((x as i64).cast_unsigned());
        digest.take_long(x as u64);
        take(&mut digest, f64::from(x as f32));
        let long = black_box(operands.long());
        take(&mut digest, long as f64);
        take(&mut digest, long.cast_signed() as f64);
        take(&mut digest, f64::from(long as f32));
        let order = x.partial_cmp(&f64::from_bits(long));
        digest.take(order.map_or(9, |order| order as u32));
    }
    words.push_digest(&digest);
}

/// A number of any size, or one of a configuration's size.
fn number(operands: &mut Operands) -> f64 {
    let any = operands.any();
    if any >> 33 & 1 == 0 {
        f64::from_bits(operands.long())
    } else {
        f64::from((any as u32).cast_signed()) / 65_536.0
    }
}

/// Within ±64, where nothing overflows.
fn small(x: f64) -> f64 {
    if x.abs() < 64.0 { x } else { 64.0 / x }
}

/// All that are no number are the same: which one comes out is up to the machine.
fn take(digest: &mut Digest, value: f64) {
    let bits = if value.is_nan() { 1 } else { value.to_bits() };
    digest.take_long(bits);
}
