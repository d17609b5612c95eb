//! P4's formulas with as few touches as they take, as they stand in the paper with its slips put right: written here anew, so that
//! nothing of the library is in them.

/// P4 (1): offset at the origin, ∂z/∂x, ∂z/∂y.
pub fn plane(places: [[f64; 2]; 3], dz: [f64; 3]) -> [f64; 3] {
    let [[x1, y1], [x2, y2], [x3, y3]] = places;
    let brackets = [x2 * y3 - y2 * x3, y1 * x3 - x1 * y3, x1 * y2 - y1 * x2];
    let c: f64 = brackets.iter().sum();
    let offset = brackets[0] * dz[0] + brackets[1] * dz[1] + brackets[2] * dz[2];
    let by_x = (y2 - y3) * dz[0] + (y3 - y1) * dz[1] + (y1 - y2) * dz[2];
    let by_y = (x3 - x2) * dz[0] + (x1 - x3) * dz[1] + (x2 - x1) * dz[2];
    [offset / c, by_x / c, by_y / c]
}

/// Δ_B and γ from points 4 and 5.
pub fn shoulder(x: [f64; 2], dy: [f64; 2]) -> [f64; 2] {
    let length = x[1] - x[0];
    [
        (x[1] * dy[0] - x[0] * dy[1]) / length,
        (dy[1] - dy[0]) / length,
    ]
}

/// P4 (2): centre, and diameter error, from point 1 on the + wall and 2 on the − wall.
pub fn hole(d1: f64, d2: f64) -> [f64; 2] {
    [(d1 + d2) / 2.0, d1 - d2]
}

/// An axis from means of opposite points in two sections: offset at y = 0 and slope.
pub fn axis(y: [f64; 2], m: [f64; 2]) -> [f64; 2] {
    let length = y[1] - y[0];
    [(y[1] * m[0] - y[0] * m[1]) / length, (m[1] - m[0]) / length]
}
