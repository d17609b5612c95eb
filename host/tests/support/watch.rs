//! A watcher of every tick: what the axis is told to do by its own setpoint, and how it stops.

use leadscrew::supervisor::State;
use leadscrew::telemetry::Record;

/// Beyond the way between where it stands and its target, mm: rounding, and what a stop adds.
const BESIDE_MM: f64 = 0.02;
const MS_PER_TICK: u32 = 1;

/// What was seen.
#[derive(Clone, Copy, Debug, Default)]
pub struct Watch {
    counts_per_mm: f64,
    /// Where it was sent, mm.
    pub target_mm: f64,
    /// Where it stood last, mm.
    stood_mm: f64,
    /// Ticks in which it was told to be elsewhere than on its way.
    pub wrong: u32,
    /// Stops out of a motion that nobody asked for.
    pub stops: u32,
    /// The longest and the farthest of them.
    pub longest_ms: u32,
    pub farthest_mm: f64,
    /// The longest time from the last byte that the axis heard to its rest, of those.
    pub deaf_ms: u32,
    heard: u32,
    stopping: Option<Stop>,
    was_moving: bool,
}

/// A stop under way.
#[derive(Clone, Copy, Debug)]
struct Stop {
    tick: u32,
    heard: u32,
    from_mm: f64,
}

impl Watch {
    /// Nothing seen yet.
    pub fn new(counts_per_mm: f64) -> Self {
        Self {
            counts_per_mm,
            ..Self::default()
        }
    }

    /// A tick, and the bytes that came in it. A zero alone is what the line has left of a frame.
    pub fn tick(&mut self, record: &Record, bytes: &[u8]) {
        if bytes.iter().any(|byte| *byte != 0) {
            self.heard = record.tick;
        }
        let is = |state: State| record.state() == state as u8;
        let mm = |bits: i64| bits as f64 / 65_536.0 / self.counts_per_mm;
        let at_mm = mm(record.setpoint_position);
        if is(State::Moving) || is(State::Stopping) {
            let (low, high) = (
                self.stood_mm.min(self.target_mm),
                self.stood_mm.max(self.target_mm),
            );
            let is_on_its_way = (low - BESIDE_MM..=high + BESIDE_MM).contains(&at_mm);
            self.wrong += u32::from(!is_on_its_way);
        } else {
            // Off it is where it is.
            self.stood_mm = if is(State::Ready) {
                at_mm
            } else {
                mm(record.position)
            };
        }
        if is(State::Stopping) && self.was_moving {
            self.stopping = Some(Stop {
                tick: record.tick,
                heard: self.heard,
                from_mm: at_mm,
            });
        }
        if record.setpoint_velocity == 0
            && let Some(stop) = self.stopping.take()
        {
            self.stops += 1;
            let ms = |since: u32| record.tick.wrapping_sub(since) * MS_PER_TICK;
            self.longest_ms = self.longest_ms.max(ms(stop.tick));
            self.deaf_ms = self.deaf_ms.max(ms(stop.heard));
            self.farthest_mm = self.farthest_mm.max((at_mm - stop.from_mm).abs());
        }
        self.was_moving = is(State::Moving);
    }
}
