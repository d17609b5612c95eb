//! Integers of 32, 64 and 128 bits, and the fixed-point formats of the axis.

use core::hint::black_box;

use leadscrew::units::{Acceleration, Command, Jerk, Position, Variance, Velocity};

use super::{Digest, Operands, Words};

const ROUNDS: u32 = 400;

/// Digest of what `work` makes of random operands.
fn over(words: &mut Words<'_>, work: impl Fn(&mut Operands, &mut Digest)) {
    let (mut operands, mut digest) = (Operands::new(), Digest::new());
    for _ in 0..ROUNDS {
        work(&mut operands, &mut digest);
    }
    words.push_digest(&digest);
}

/// The group.
pub fn run(words: &mut Words<'_>) {
    integers(words);
    formats(words);
    floats_to_fixed(words);
}

fn integers(words: &mut Words<'_>) {
    over(words, |operands, digest| {
        let (a, b) = (operands.word().cast_signed(), operands.word().cast_signed());
        let (a, b) = (black_box(a), black_box(b));
        digest.take(a.checked_div(b).unwrap_or(7).cast_unsigned());
        digest.take(a.checked_rem(b).unwrap_or(7).cast_unsigned());
        digest.take(a.saturating_add(b).cast_unsigned());
        digest.take(a.saturating_mul(b).cast_unsigned());
        digest.take(a.abs_diff(b) ^ a.leading_zeros() ^ b.trailing_zeros());
        digest.take(a.rotate_left(b.cast_unsigned() & 31).cast_unsigned());
    });
    over(words, |operands, digest| {
        let (a, b) = (operands.long().cast_signed(), operands.long().cast_signed());
        let (a, b) = (black_box(a), black_box(b));
        digest.take_long(a.checked_div(b).unwrap_or(7).cast_unsigned());
        digest.take_long(a.checked_rem(b).unwrap_or(7).cast_unsigned());
        digest.take_long(a.saturating_sub(b).cast_unsigned());
        digest.take_long(a.saturating_mul(b).cast_unsigned());
        digest.take_long((a >> (b & 63)).cast_unsigned());
        digest.take_long(a.cast_unsigned() << (b & 63));
        digest.take(a.leading_zeros() ^ b.trailing_zeros() ^ a.count_ones());
        digest.take(a.isqrt_or_zero());
    });
    over(words, |operands, digest| {
        let (a, b) = (black_box(operands.long()), black_box(operands.long()));
        let product = u128::from(a) * u128::from(b);
        digest.take_long((product >> 64) as u64);
        digest.take_long((product >> 37) as u64);
        let divided = (product ^ u128::from(b)) / u128::from(a | 1);
        digest.take_long(divided as u64);
    });
}

trait Root {
    fn isqrt_or_zero(self) -> u32;
}

impl Root for i64 {
    fn isqrt_or_zero(self) -> u32 {
        self.checked_isqrt().unwrap_or_default() as u32
    }
}

fn formats(words: &mut Words<'_>) {
    over(words, |operands, digest| {
        let velocity = Velocity::from_bits(operands.word().cast_signed());
        let other = Velocity::from_bits(operands.word().cast_signed());
        let (velocity, other) = (black_box(velocity), black_box(other));
        digest.take(velocity.saturating_mul(other).to_bits().cast_unsigned());
        digest.take(velocity.saturating_add(other).to_bits().cast_unsigned());
        digest.take_long(velocity.wide_mul(other).to_bits().cast_unsigned());
        let divided = velocity.checked_div(other).unwrap_or_default();
        digest.take(divided.to_bits().cast_unsigned());
    });
    over(words, |operands, digest| {
        let position = Position::from_bits(black_box(operands.long().cast_signed()));
        let velocity = position.saturating_to_num::<Velocity>();
        digest.take(velocity.to_bits().cast_unsigned());
        let acceleration = position.saturating_to_num::<Acceleration>();
        digest.take(acceleration.to_bits().cast_unsigned());
        digest.take(position.saturating_to_num::<Jerk>().to_bits() as u32);
        digest.take(position.saturating_to_num::<Command>().to_bits() as u32);
        digest.take_long(position.saturating_mul(position).to_bits().cast_unsigned());
        let variance = Variance::from_bits(operands.long());
        digest.take_long(variance.saturating_mul(variance).to_bits());
        digest.take_long(variance.sqrt().to_bits());
    });
}

fn floats_to_fixed(words: &mut Words<'_>) {
    over(words, |operands, digest| {
        let single = f32::from_bits(black_box(operands.word()));
        let double = f64::from_bits(black_box(operands.any()));
        let (single, double) = (zero_if_nan(single.into()), zero_if_nan(double));
        let velocity = Velocity::saturating_from_num(single);
        digest.take(velocity.to_bits().cast_unsigned());
        digest.take_long(velocity.to_num::<f64>().to_bits());
        digest.take(velocity.to_num::<f32>().to_bits());
        let position = Position::saturating_from_num(double);
        digest.take_long(position.to_bits().cast_unsigned());
        digest.take_long(position.to_num::<f64>().to_bits());
    });
}

/// A format has no such number.
fn zero_if_nan(value: f64) -> f64 {
    if value.is_nan() { 0.0 } else { value }
}
