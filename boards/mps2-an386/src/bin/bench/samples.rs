//! Instruction counts of a stage.

use heapless::Vec;

/// Ticks of the standard move at 1 kHz, and some.
pub const MOST: usize = 6000;

/// Counts of one stage over many ticks.
pub struct Samples {
    name: &'static str,
    counts: Vec<u32, MOST>,
}

impl Samples {
    /// No counts yet.
    pub const fn of(name: &'static str) -> Self {
        Self {
            name,
            counts: Vec::new(),
        }
    }

    /// No counts yet, for each of `names`, of which there are `N`.
    pub const fn of_each<const N: usize>(names: &[&'static str]) -> [Self; N] {
        let mut all = [const { Self::of("") }; N];
        let mut index = 0;
        while index < N {
            all[index].name = names[index];
            index += 1;
        }
        all
    }

    /// Adds a count; those beyond [`MOST`] are left out.
    pub fn push(&mut self, count: u32) {
        let _ = self.counts.push(count);
    }

    /// Logs `bench <group>/<name> <median> <worst> <samples>`.
    pub fn log(&mut self, group: &str) {
        self.counts.sort_unstable();
        let samples = self.counts.len();
        let median = self.counts.get(samples / 2).copied().unwrap_or(0);
        let worst = self.counts.last().copied().unwrap_or(0);
        defmt::info!(
            "bench {=str}/{=str} {=u32} {=u32} {=usize}",
            group,
            self.name,
            median,
            worst,
            samples
        );
    }
}
