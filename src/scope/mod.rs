//! The scope: records signals of the axis in the tick, around the moment that matters.
//!
//! ```text
//!           ◄──────────────── samples ────────────────►
//!           ◄─── pre ───►
//!  …  ring  ░░░░░░░░░░░░░█░░░░░░░░░░░░░░░░░░░░░░░░░░░░░
//!                        ▲                             ▲
//!  Waiting ──────────────┴─ Triggered ─────────────────┴─ Complete      (stop: Stopped, with what there is)
//! ```
//!
//! A board calls [`Scope::take`] right behind [`Axis::step`], in every tick. The scope writes every n-th tick's [`Signal`]s
//! into the memory that it was lent, 32 bits each; while it waits, the memory is a ring. The [`Trigger`] is looked for in
//! every tick; the sample of the trigger is the first one of that tick or behind it. When it is complete it is handed to
//! thread mode as it is, which reads the [`Recording`], oldest sample first, and gives the memory back by
//! [`Scope::into_memory`].
//!
//! Nothing is lost without being told. A position is recorded by its low word, and the recording has its value at the
//! first sample, from which [`Unwrap`] makes the others. Where ticks were missed, or a value moved farther than a low word
//! tells (the origin was set), there is an [`Interruption`].
//!
//! [`Stream`] is the same for a live view: it gives each sample away instead of keeping it.

mod error;
mod interruptions;
mod readers;
mod recording;
mod setup;
mod signal;
mod signals;
mod stream;
mod trigger;
mod unwrap;

pub use error::ScopeError;
pub use interruptions::{Interruption, MOST_INTERRUPTIONS};
pub use recording::{Interrupted, Recording};
pub use setup::Setup;
pub use signal::{Description, Kind, Signal, Unit};
pub use signals::{MOST_SIGNALS, Signals};
pub use stream::{Sample, Stream};
pub use trigger::{Side, Slope, Trigger};
pub use unwrap::Unwrap;

use interruptions::Interruptions;
use readers::{Wide, WordReaders};
use trigger::Watch;

use crate::axis::Axis;

/// How far a scope has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum State {
    /// It records into its ring and looks for the trigger.
    Waiting = 0,
    /// The trigger came; it records what comes behind it.
    Triggered = 1,
    /// It has all samples, and takes no more.
    Complete = 2,
    /// It was stopped before, and has what there was.
    Stopped = 3,
}

/// Records signals in memory that it was lent for `'m`.
#[derive(Debug)]
pub struct Scope<'m> {
    setup: Setup,
    state: State,
    is_forced: bool,
    /// Ticks until the next sample.
    rest: u16,
    watch: Watch,
    /// The tick that comes next, once there was one.
    next_tick: Option<u32>,
    /// Ticks missed since the newest sample.
    missed: u32,
    /// Word of the memory that comes next, and the end of those that the samples take.
    next: usize,
    end: usize,
    /// Samples still to come, once triggered.
    left: u32,
    /// Samples before that of the trigger, once triggered.
    before: u32,
    /// Tick of the trigger, once triggered.
    trigger_tick: u32,
    /// Samples since arming.
    taken: u64,
    /// Tick of the newest sample.
    newest_tick: u32,
    words: WordReaders,
    wide: Wide,
    interruptions: Interruptions,
    memory: &'m mut [i32],
}

/// A setup that was refused, with the memory that was meant for it.
#[derive(Debug)]
pub struct Refused<'m> {
    /// Why.
    pub error: ScopeError,
    /// The memory.
    pub memory: &'m mut [i32],
}

impl<'m> Scope<'m> {
    /// A scope that waits for its trigger from the next tick on.
    ///
    /// # Errors
    /// [`Refused`] with the memory and what [`Setup::check`] says.
    pub fn new(memory: &'m mut [i32], setup: &Setup) -> Result<Self, Refused<'m>> {
        if let Err(error) = setup.check(memory.len()) {
            return Err(Refused { error, memory });
        }
        Ok(Self {
            setup: *setup,
            state: State::Waiting,
            is_forced: false,
            rest: 0,
            watch: Watch::new(setup.trigger),
            next_tick: None,
            missed: 0,
            next: 0,
            // It fits the memory.
            end: (setup.samples as usize).wrapping_mul(setup.signals.len()),
            left: 0,
            before: 0,
            trigger_tick: 0,
            taken: 0,
            newest_tick: 0,
            words: WordReaders::of(&setup.signals),
            wide: Wide::of(&setup.signals),
            interruptions: Interruptions::new(),
            memory,
        })
    }

    /// What it was set up to.
    #[must_use]
    pub const fn setup(&self) -> &Setup {
        &self.setup
    }

    /// How far it has come.
    #[must_use]
    #[inline]
    pub const fn state(&self) -> State {
        self.state
    }

    /// True when there is no more to come: it can be read.
    #[must_use]
    #[inline]
    pub const fn is_over(&self) -> bool {
        matches!(self.state, State::Complete | State::Stopped)
    }

    /// Triggers with the next tick, whatever the trigger is; nothing if it was triggered.
    pub const fn trigger(&mut self) {
        self.is_forced = true;
    }

    /// Ends the recording with what there is: up to now, where there was no trigger yet.
    pub const fn stop(&mut self) {
        if !self.is_over() {
            self.state = State::Stopped;
        }
    }

    /// Ticks passed in which the axis made no step, so that its own number of the tick does not show them.
    pub const fn miss(&mut self, ticks: u32) {
        // Before the first sample there is nothing to be away from.
        if self.taken > 0 {
            self.missed = self.missed.wrapping_add(ticks);
        }
    }

    /// Takes what the step just past gave. Bounded time; to be called after every step.
    #[inline]
    pub fn take(&mut self, axis: &Axis<'_>) {
        if !self.is_over() {
            self.record(axis);
        }
    }

    #[inline(never)]
    fn record(&mut self, axis: &Axis<'_>) {
        let tick = axis.outputs().tick;
        if let Some(expected) = self.next_tick
            && expected != tick
        {
            self.miss(tick.wrapping_sub(expected));
        }
        self.next_tick = Some(tick.wrapping_add(1));
        if matches!(self.state, State::Waiting) && (self.watch.sees(axis) || self.is_forced) {
            self.begin(tick);
        }
        if let Some(rest) = self.rest.checked_sub(1) {
            self.rest = rest;
        } else {
            self.rest = self.setup.every.wrapping_sub(1);
            self.keep(axis, tick);
        }
    }

    /// The trigger: the next sample is its own.
    #[cold]
    fn begin(&mut self, tick: u32) {
        let Setup { pre, samples, .. } = self.setup;
        let before = u32::try_from(self.taken).map_or(pre, |taken| taken.min(pre));
        self.state = State::Triggered;
        self.trigger_tick = tick;
        self.before = before;
        // `before` is at most `pre`, which is less than `samples`.
        self.left = samples.wrapping_sub(before);
    }

    /// Writes a sample.
    #[inline]
    fn keep(&mut self, axis: &Axis<'_>, tick: u32) {
        if self.missed != 0 {
            self.interrupt_by_missed();
        }
        let behind = self.next.wrapping_add(self.words.len());
        // There are always so many: `end` lies within the memory.
        let words = self.memory.get_mut(self.next..behind).unwrap_or_default();
        self.words.read(axis, words);
        let (taken, samples) = (self.taken, self.setup.samples);
        self.wide.note(axis, |jump| {
            // The first sample comes from nowhere.
            if taken > 0 {
                let what = Interruption::Jump {
                    signal: jump.place,
                    from: jump.from,
                    to: jump.to,
                };
                self.interruptions
                    .keep(taken, self.newest_tick, &what, samples);
            }
        });
        self.next = if behind >= self.end { 0 } else { behind };
        self.taken = self.taken.wrapping_add(1);
        self.newest_tick = tick;
        if matches!(self.state, State::Triggered) {
            self.left = self.left.wrapping_sub(1);
            if self.left == 0 {
                self.state = State::Complete;
            }
        }
    }

    /// Notes that ticks are missing before the sample that comes.
    #[cold]
    fn interrupt_by_missed(&mut self) {
        let what = Interruption::Missed { ticks: self.missed };
        self.missed = 0;
        let samples = self.setup.samples;
        self.interruptions
            .keep(self.taken, self.newest_tick, &what, samples);
    }

    /// What was recorded; none before [`Self::is_over`]. Outside the tick.
    #[must_use]
    pub fn recording(&self) -> Option<Recording<'_>> {
        self.is_over().then(|| Recording::of(self))
    }

    /// Gives the memory back.
    #[must_use]
    pub fn into_memory(self) -> &'m mut [i32] {
        self.memory
    }
}
