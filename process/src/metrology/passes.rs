//! The size of the blank to the number of passes.

use super::error::MetrologyError;

/// Most passes: more are a mistake in the numbers.
const MOST_PASSES: f64 = 10_000.0;

/// What is to be cut, all mm, sizes across the surface that is cut (a turned part: radii).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cut {
    /// Size of the blank as measured; its largest if it is not even.
    pub blank_mm: f64,
    /// Size that is wanted.
    pub finished_mm: f64,
    /// Largest depth of a roughing pass.
    pub max_depth_mm: f64,
    /// What the last pass is to take; 0 for none.
    pub finishing_mm: f64,
}

/// One pass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pass {
    /// Depth of cut, mm.
    pub depth_mm: f64,
    /// Size after it, mm.
    pub size_mm: f64,
}

/// Passes from blank to finished size: roughing passes of equal depth, as few as the largest depth allows, then the finishing pass.
/// Where the stock is less than the finishing allowance it is all taken by the finishing pass. Inside surfaces grow: their blank is
/// smaller than their finished size, which is seen from the two.
///
/// # Errors
/// Numbers outside their ranges.
pub fn passes(cut: &Cut) -> Result<Vec<Pass>, MetrologyError> {
    let positive = |name, value: f64| check(name, value, value > 0.0, "more than 0");
    positive("max_depth_mm", cut.max_depth_mm)?;
    check("blank_mm", cut.blank_mm, cut.blank_mm >= 0.0, "0 or more")?;
    check(
        "finished_mm",
        cut.finished_mm,
        cut.finished_mm >= 0.0,
        "0 or more",
    )?;
    let (finishing, depth) = (cut.finishing_mm, cut.max_depth_mm);
    let allowed = (0.0..=depth).contains(&finishing);
    check(
        "finishing_mm",
        finishing,
        allowed,
        &format!("0 to max_depth_mm, {depth}"),
    )?;
    let stock = (cut.blank_mm - cut.finished_mm).abs();
    let inward = if cut.blank_mm >= cut.finished_mm {
        -1.0
    } else {
        1.0
    };
    let rough = (stock - finishing).max(0.0);
    // A stock that is a whole number of passes but for the last bit is that number.
    let count = (rough / depth - 1e-9).ceil().max(0.0);
    let at_most = format!("no more than {MOST_PASSES} passes: a larger max_depth_mm");
    check("blank_mm", cut.blank_mm, count <= MOST_PASSES, &at_most)?;
    let mut passes = Vec::new();
    for pass in 1..=count as u32 {
        let taken = rough * f64::from(pass) / count;
        passes.push(Pass {
            depth_mm: rough / count,
            size_mm: cut.blank_mm + inward * taken,
        });
    }
    let rest = stock - rough;
    if rest > 0.0 {
        passes.push(Pass {
            depth_mm: rest,
            size_mm: cut.finished_mm,
        });
    }
    Ok(passes)
}

fn check(
    name: &'static str,
    value: f64,
    is_allowed: bool,
    allowed: &str,
) -> Result<(), MetrologyError> {
    if value.is_finite() && is_allowed {
        return Ok(());
    }
    Err(MetrologyError::Range {
        name,
        value,
        unit: "mm",
        allowed: allowed.to_owned(),
    })
}
