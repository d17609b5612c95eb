//! Terms whose K can be worked out by heart.

#[path = "polynomial.rs"]
mod polynomial;

use leadscrew_nc::coordinates::Axis;
use leadscrew_nc::terms::Terms;

use polynomial::Polynomial;

/// K constant in some axes.
pub fn constant(values: &[(Axis, f64)]) -> Terms {
    values.iter().fold(Terms::none(), |terms, (axis, k0)| {
        terms.with(Polynomial {
            corrects: *axis,
            over: *axis,
            k0: *k0,
            k1: 0.0,
            k2: 0.0,
        })
    })
}

/// K of one axis proportional to the place of another.
pub fn slope(corrects: Axis, over: Axis, k1: f64) -> Terms {
    Terms::none().with(Polynomial {
        corrects,
        over,
        k0: 0.0,
        k1,
        k2: 0.0,
    })
}

/// K of one axis with the square of the place of another.
pub fn square(corrects: Axis, over: Axis, k2: f64) -> Terms {
    Terms::none().with(Polynomial {
        corrects,
        over,
        k0: 0.0,
        k1: 0.0,
        k2,
    })
}
