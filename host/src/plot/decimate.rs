//! Fewer points, the same picture.

use super::axis::is_drawable;

type Point = (f64, f64);

/// What a pixel column shows of the samples that fall in it.
struct Column {
    index: usize,
    first: Point,
    last: Point,
    low: Point,
    high: Point,
    /// Whether `low` came before `high`.
    low_first: bool,
}

impl Column {
    fn new(index: usize, point: Point) -> Self {
        Self {
            index,
            first: point,
            last: point,
            low: point,
            high: point,
            low_first: true,
        }
    }

    fn add(&mut self, point: Point) {
        self.last = point;
        if point.1 < self.low.1 {
            self.low = point;
            self.low_first = false;
        }
        if point.1 > self.high.1 {
            self.high = point;
            self.low_first = true;
        }
    }

    /// First, lowest, highest and last sample in the order they came, each once.
    fn emit(&self, run: &mut Vec<Point>) {
        let (earlier, later) = if self.low_first {
            (self.low, self.high)
        } else {
            (self.high, self.low)
        };
        let start = run.len();
        for point in [self.first, earlier, later, self.last] {
            if run.len() == start || run.last() != Some(&point) {
                run.push(point);
            }
        }
    }
}

/// Thins a series for drawing `columns` pixels wide, by keeping of every pixel column
/// the first, the lowest, the highest and the last sample: the drawn line covers the
/// same pixels as the whole series, so noise keeps its envelope.
///
/// Returns runs of points to join; between runs is a gap, left by samples that are not
/// finite (or beyond ±1e150, out of reach of an axis). A gap narrower than a column
/// closes. All runs together hold at most 4 · `columns` points (zero counts as one
/// column), among them the first, the last, the lowest and the highest of the series.
/// A series that short comes back whole. Samples out of order are sorted by x.
#[must_use]
pub fn decimate(points: &[Point], columns: usize) -> Vec<Vec<Point>> {
    let columns = columns.max(1);
    // A sample without a finite time marks a gap where it stands; only sorting drops it.
    let timed = |point: &&Point| point.0.is_finite();
    if points.iter().filter(timed).is_sorted_by(|a, b| a.0 <= b.0) {
        return thin(points, columns);
    }
    let mut sorted: Vec<Point> = points.iter().filter(timed).copied().collect();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
    thin(&sorted, columns)
}

fn thin(points: &[Point], columns: usize) -> Vec<Vec<Point>> {
    let drawn = || points.iter().copied().filter(|&point| drawable(point));
    let (Some(first), Some(last)) = (drawn().next(), drawn().next_back()) else {
        return Vec::new();
    };
    if drawn().count() <= columns.saturating_mul(4) {
        return points
            .split(|&point| !drawable(point))
            .filter(|run| !run.is_empty())
            .map(<[Point]>::to_vec)
            .collect();
    }
    let scale = columns as f64 / (last.0 - first.0);
    let column_of = |x: f64| (((x - first.0) * scale) as usize).min(columns - 1);

    let mut runs = vec![Vec::new()];
    let mut current: Option<Column> = None;
    let mut gap = false;
    for &point in points {
        if !drawable(point) {
            gap = true;
            continue;
        }
        let index = column_of(point.0);
        match &mut current {
            Some(column) if column.index == index => column.add(point),
            _ => {
                flush(current.take(), &mut runs);
                if gap {
                    runs.push(Vec::new());
                }
                current = Some(Column::new(index, point));
            }
        }
        gap = false;
    }
    flush(current, &mut runs);
    runs.retain(|run| !run.is_empty());
    runs
}

fn flush(column: Option<Column>, runs: &mut [Vec<Point>]) {
    if let (Some(column), Some(run)) = (column, runs.last_mut()) {
        column.emit(run);
    }
}

fn drawable(point: Point) -> bool {
    is_drawable(point.0) && is_drawable(point.1)
}
