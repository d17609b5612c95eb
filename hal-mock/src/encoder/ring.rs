//! Where the capture hardware keeps edge times until they are taken.

/// Edge times kept for one capture: the fastest motion the core takes, and the next tick's beginning.
const SIZE: usize = 4096;

/// Direction of an edge: +1 or −1 counts.
pub type Direction = i8;

/// Edges in order of their times; the newest that a sampling instant leaves out stay for the next one.
#[derive(Clone, Debug)]
pub struct Ring {
    times: [u32; SIZE],
    directions: [Direction; SIZE],
    /// Ring positions: start of the last capture, its end, and the end of what is written.
    start: u32,
    taken: u32,
    written: u32,
    overrun: bool,
}

impl Ring {
    pub const fn new() -> Self {
        Self {
            times: [0; SIZE],
            directions: [0; SIZE],
            start: 0,
            taken: 0,
            written: 0,
            overrun: false,
        }
    }

    /// Gives up the edges of the last capture.
    pub const fn release(&mut self) {
        self.start = self.taken;
        self.overrun = false;
    }

    /// Takes in an edge, unless the ring is full.
    pub const fn push(&mut self, time: u32, direction: Direction) {
        if self.written.wrapping_sub(self.start) >= SIZE as u32 {
            self.overrun = true;
            return;
        }
        let slot = self.written as usize % SIZE;
        self.times[slot] = time;
        self.directions[slot] = direction;
        self.written = self.written.wrapping_add(1);
    }

    /// Captures all edges up to a time; gives the counts made by those after it.
    pub fn take(&mut self, until: u32) -> i32 {
        let (mut last, mut waiting) = (self.written, 0);
        while last != self.taken {
            let slot = last.wrapping_sub(1) as usize % SIZE;
            if until.wrapping_sub(self.times[slot]).cast_signed() >= 0 {
                break;
            }
            waiting += i32::from(self.directions[slot]);
            last = last.wrapping_sub(1);
        }
        self.taken = last;
        waiting
    }

    /// The edges captured, in two parts.
    pub fn captured(&self) -> [&[u32]; 2] {
        let first = self.start as usize % SIZE;
        let end = first + self.taken.wrapping_sub(self.start) as usize;
        if end <= SIZE {
            [&self.times[first..end], &[]]
        } else {
            [&self.times[first..], &self.times[..end - SIZE]]
        }
    }

    /// The edges captured with their directions, in order.
    pub fn passed(&self) -> impl Iterator<Item = (u32, Direction)> + '_ {
        let count = self.taken.wrapping_sub(self.start);
        (0..count).map(|index| {
            let slot = self.start.wrapping_add(index) as usize % SIZE;
            (self.times[slot], self.directions[slot])
        })
    }

    /// Edges were lost since the capture before.
    pub const fn overrun(&self) -> bool {
        self.overrun
    }
}
