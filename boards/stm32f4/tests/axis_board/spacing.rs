//! What captures of an encoder that turns evenly have to look like. Pure, so that the host tests it too.

/// Edges at a fixed distance, over any number of ticks.
#[derive(Debug)]
pub struct Spacing {
    clocks: u32,
    last: Option<u32>,
    /// Edges that came.
    pub edges: u32,
    /// How far a distance was from the expected one at most, clocks.
    pub worst: u32,
}

impl Spacing {
    /// Edges `clocks` apart.
    pub const fn new(clocks: u32) -> Self {
        Self {
            clocks,
            last: None,
            edges: 0,
            worst: 0,
        }
    }

    /// Takes the times of the edges of a tick, oldest first.
    pub fn take(&mut self, edges: [&[u32]; 2]) {
        for &time in edges.into_iter().flatten() {
            if let Some(last) = self.last {
                let distance = time.wrapping_sub(last);
                self.worst = self.worst.max(distance.abs_diff(self.clocks));
            }
            self.last = Some(time);
            self.edges = self.edges.wrapping_add(1);
        }
    }
}

/// Counts from tick to tick of an encoder that turns evenly forward, once turns round, and turns evenly back.
#[derive(Debug)]
pub struct Reversal {
    counts: i32,
    stage: Stage,
    /// Ticks that do not fit.
    pub faults: u32,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Stage {
    Forward,
    /// In one tick alone.
    Turning,
    Back,
}

impl Reversal {
    /// `counts` in a tick, or one more or less.
    pub const fn new(counts: i32) -> Self {
        Self {
            counts,
            stage: Stage::Forward,
            faults: 0,
        }
    }

    /// Takes the counts of a tick.
    pub fn take(&mut self, moved: i32) {
        let stage = if (moved - self.counts).abs() <= 1 {
            Stage::Forward
        } else if (moved + self.counts).abs() <= 1 {
            Stage::Back
        } else {
            Stage::Turning
        };
        let is_further = stage > self.stage || (stage == self.stage && stage != Stage::Turning);
        if !is_further || moved.abs() > self.counts + 1 {
            self.faults += 1;
        }
        self.stage = stage;
    }

    /// Whether it turned round, and nothing did not fit.
    pub fn is_right(&self) -> bool {
        self.faults == 0 && self.stage == Stage::Back
    }
}
