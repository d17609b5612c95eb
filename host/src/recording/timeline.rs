//! Levels set at instants, gathered into a [`Recording`].

use super::error::{Located, Problem};
use super::{Change, Levels, Recording, Role};

/// A recording as it grows. Everything set between two calls of [`advance`](Self::advance) is one
/// instant.
pub(super) struct Timeline {
    /// The instant that is being gathered.
    now: u64,
    levels: Levels,
    known: [bool; 3],
    /// Where a level was lost that had been known.
    lost: Option<Loss>,
    initial: Levels,
    changes: Vec<Change>,
}

struct Loss {
    time: u64,
    role: Role,
    line: u64,
}

impl Timeline {
    /// Starts at the first timestamp.
    pub(super) fn new() -> Self {
        Timeline {
            now: 0,
            levels: Levels::default(),
            known: [false; 3],
            lost: None,
            initial: Levels::default(),
            changes: Vec::new(),
        }
    }

    /// Sets a level at the present instant; None where the file says that it is unknown.
    pub(super) fn set(
        &mut self,
        role: Role,
        level: Option<bool>,
        line: u64,
    ) -> Result<(), Located> {
        match level {
            Some(level) => self.set_known(role, level),
            None => {
                self.lose(role, line);
                Ok(())
            }
        }
    }

    fn set_known(&mut self, role: Role, level: bool) -> Result<(), Located> {
        if let Some(loss) = &self.lost {
            let goes_on = loss.role == role || *level_of(&mut self.levels, role) != level;
            if goes_on {
                return Err(Problem::Gap { role: loss.role }.at(loss.line));
            }
        }
        if !self.known[role as usize] {
            self.known[role as usize] = true;
            self.assume_from_start(role, level);
        }
        *level_of(&mut self.levels, role) = level;
        Ok(())
    }

    fn lose(&mut self, role: Role, line: u64) {
        if self.known[role as usize] && self.lost.is_none() {
            self.lost = Some(Loss {
                time: self.now,
                role,
                line,
            });
        }
    }

    /// A channel's first known level holds for what came before, which was noted as low.
    fn assume_from_start(&mut self, role: Role, level: bool) {
        *level_of(&mut self.initial, role) = level;
        for change in &mut self.changes {
            *level_of(&mut change.levels, role) = level;
        }
    }

    /// Goes to a later instant, or stays; the caller has checked that time does not run back.
    pub(super) fn advance(&mut self, time: u64) {
        if time > self.now {
            self.close_instant();
            self.now = time;
        }
    }

    fn close_instant(&mut self) {
        if self.now == 0 {
            self.initial = self.levels;
            return;
        }
        let before = self
            .changes
            .last()
            .map_or(self.initial, |change| change.levels);
        if self.levels != before {
            self.changes.push(Change {
                time: self.now,
                levels: self.levels,
            });
        }
    }

    /// The instant that is being gathered.
    pub(super) fn now(&self) -> u64 {
        self.now
    }

    /// Makes the clock `factor` times as fine.
    pub(super) fn refine(&mut self, factor: u64) -> Result<(), Problem> {
        self.now = self.now.checked_mul(factor).ok_or(Problem::TooLong)?;
        // No time is later than `now`, so that none of these overflows.
        for change in &mut self.changes {
            change.time *= factor;
        }
        if let Some(loss) = &mut self.lost {
            loss.time *= factor;
        }
        Ok(())
    }

    /// The recording, which lasts for `duration` ticks, or until a level was lost for good. Each of
    /// `wanted` must have had a level.
    pub(super) fn finish(
        mut self,
        clock_hz: u64,
        duration: u64,
        wanted: impl Iterator<Item = Role>,
    ) -> Result<Recording, Problem> {
        self.close_instant();
        for role in wanted {
            if !self.known[role as usize] {
                return Err(Problem::NeverKnown { role });
            }
        }
        Ok(Recording {
            clock_hz,
            duration: self.lost.map_or(duration, |loss| loss.time),
            initial: self.initial,
            changes: self.changes,
        })
    }
}

fn level_of(levels: &mut Levels, role: Role) -> &mut bool {
    match role {
        Role::A => &mut levels.a,
        Role::B => &mut levels.b,
        Role::Z => &mut levels.z,
    }
}
