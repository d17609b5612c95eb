//! Where in a recording the shaft turns steadily.
//!
//! The time is taken every quarter of a revolution on a way in one direction, so that speeds are means over whole
//! revolutions: eccentricity and a wobble do not show in them.

use crate::recording::Recording;
use crate::sampler::Sampler;

/// How the shaft moves in the runs that are looked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// At a constant feed.
    Steady,
    /// A free flywheel that slows down.
    Coast,
}

/// Speeds of revolutions in a steady stretch differ by this part at most: a learner allows 1 % from the first ones.
const STEADY: f64 = 0.0095;
/// A flywheel's stretch ends where it has lost this part of its speed.
const COASTED: f64 = 0.6;
/// Marks a revolution.
const MARKS: usize = 4;
/// Counts back that are no turn: an edge that dithers.
const DITHER: i64 = 8;
/// Shorter stretches are not worth telling, revolutions.
const SHORTEST: usize = 1;

/// A way at one speed, as far as it can be told from counts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stretch {
    /// First tick.
    pub from: u64,
    /// Tick after the last.
    pub to: u64,
    /// The shaft went backward.
    pub backward: bool,
    /// Length, revolutions.
    pub revolutions: f64,
    /// Mean speed, revolutions a tick.
    pub speed: f64,
}

/// A mark: when the shaft passed it, in ticks.
type Mark = f64;

/// Marks of a way in one direction.
#[derive(Clone, Debug)]
struct Way {
    backward: bool,
    marks: Vec<Mark>,
}

/// Stretches of `recording` sampled at `tick_hz`, an encoder of `edges` a revolution, in the order of time.
pub fn find(recording: &Recording, tick_hz: f64, edges: u32, motion: Motion) -> Vec<Stretch> {
    let mut stretches = Vec::new();
    for way in ways(recording, tick_hz, i64::from(edges)) {
        match motion {
            Motion::Steady => way.steady(0, way.marks.len(), &mut stretches),
            Motion::Coast => way.coast(&mut stretches),
        }
    }
    stretches
}

/// The ways between turns, marked.
fn ways(recording: &Recording, tick_hz: f64, edges: i64) -> Vec<Way> {
    let mut sampler = Sampler::new(recording, tick_hz);
    let mut ways = Vec::new();
    let mut under_way: Option<Marking> = None;
    let (mut tick, mut before) = (0.0, None);
    while let Some(capture) = sampler.next_capture() {
        let count = i64::from(capture.count.cast_signed());
        let old = *before.get_or_insert(count);
        let marking = under_way.get_or_insert_with(|| Marking::new(count, edges));
        if let Some(way) = marking.go_on(tick, old, count) {
            ways.push(way);
        }
        before = Some(count);
        tick += 1.0;
    }
    ways.extend(under_way.map(|marking| marking.way));
    ways
}

/// A way under way.
struct Marking {
    edges: i64,
    way: Way,
    start: i64,
    /// The furthest count.
    furthest: i64,
}

impl Marking {
    const fn new(start: i64, edges: i64) -> Self {
        Self {
            edges,
            way: Way {
                backward: false,
                marks: Vec::new(),
            },
            start,
            furthest: start,
        }
    }

    /// Takes the count of a tick and that before; gives the way that ended with a turn.
    fn go_on(&mut self, tick: f64, old: i64, count: i64) -> Option<Way> {
        let sign = if self.way.backward { -1 } else { 1 };
        let back = (self.furthest - count) * sign;
        if back > DITHER {
            let mut next = Self::new(self.furthest, self.edges);
            next.way.backward = !self.way.backward;
            let ended = std::mem::replace(self, next);
            self.mark(tick, old, count);
            return Some(ended.way);
        }
        self.mark(tick, old, count);
        None
    }

    /// Marks each quarter of a revolution that was passed from `old` to `count`.
    fn mark(&mut self, tick: f64, old: i64, count: i64) {
        let sign = if self.way.backward { -1 } else { 1 };
        let (from, to) = ((old - self.start) * sign, (count - self.start) * sign);
        if (count - self.furthest) * sign > 0 {
            self.furthest = count;
        }
        loop {
            let mark = self.way.marks.len() as i64 * self.edges / MARKS as i64;
            if mark > to || to <= from {
                return;
            }
            let part = (to - mark) as f64 / (to - from) as f64;
            self.way.marks.push(tick - part.min(1.0));
        }
    }
}

impl Way {
    /// Speed over the revolution that begins at a mark, revolutions a tick.
    fn speed(&self, mark: usize) -> Option<f64> {
        let duration = self.marks.get(mark + MARKS)? - self.marks.get(mark)?;
        (duration > 0.0).then(|| duration.recip())
    }

    /// Adds the longest steady stretch between two marks, and those beside it.
    fn steady(&self, from: usize, to: usize, stretches: &mut Vec<Stretch>) {
        let (begin, end) = self.longest_steady(from, to);
        if end < begin + SHORTEST * MARKS {
            return;
        }
        self.steady(from, begin, stretches);
        stretches.push(self.stretch(begin, end));
        self.steady(end, to, stretches);
    }

    /// First and last mark of the longest stretch in which all revolutions are of one speed.
    fn longest_steady(&self, from: usize, to: usize) -> (usize, usize) {
        let (mut best, mut begin) = ((from, from), from);
        while begin + MARKS < to && best.1 - best.0 < to - begin {
            let (mut low, mut high) = (f64::INFINITY, 0.0_f64);
            let mut end = begin;
            for mark in begin..to.saturating_sub(MARKS) {
                let Some(speed) = self.speed(mark) else { break };
                (low, high) = (low.min(speed), high.max(speed));
                if high > low * (1.0 + STEADY) {
                    break;
                }
                end = mark + MARKS;
            }
            if end - begin > best.1 - best.0 {
                best = (begin, end);
            }
            begin += 1;
        }
        best
    }

    /// Adds the stretch from the highest speed on until too much of it is lost.
    fn coast(&self, stretches: &mut Vec<Stretch>) {
        let speeds: Vec<f64> = (0..).map_while(|mark| self.speed(mark)).collect();
        let Some(begin) = (0..speeds.len()).max_by(|&a, &b| speeds[a].total_cmp(&speeds[b])) else {
            return;
        };
        let lost = |&mark: &usize| speeds[mark] < speeds[begin] * (1.0 - COASTED);
        let end = (begin..speeds.len()).find(lost).unwrap_or(speeds.len());
        // A mark on, since it slows down within a revolution.
        let end = end - 1 + MARKS;
        if end > begin + SHORTEST * MARKS {
            stretches.push(self.stretch(begin, end));
        }
    }

    fn stretch(&self, begin: usize, end: usize) -> Stretch {
        let (start, stop) = (self.marks[begin], self.marks[end]);
        let revolutions = (end - begin) as f64 / MARKS as f64;
        Stretch {
            from: start.ceil() as u64,
            to: stop.floor() as u64,
            backward: self.backward,
            revolutions,
            speed: revolutions / (stop - start),
        }
    }
}
