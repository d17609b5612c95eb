//! The scope of an axis: arm it, wait for it, read what it recorded.

use leadscrew::protocol::reply::Reply;
use leadscrew::protocol::request::Request;
use leadscrew::scope::{Interrupted, MOST_SIGNALS, Setup, Side, Signal, Slope, Trigger};

use super::Axis;
use crate::error::Error;

/// Where a scope is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ScopePhase {
    /// Not armed.
    Off,
    /// Waits for its trigger.
    Waits,
    /// Triggered, and fills.
    Triggered,
    /// Complete.
    Complete,
    /// Ended before it was complete.
    Ended,
}

/// How a scope stands.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ScopeStatus {
    /// Where it is.
    pub phase: ScopePhase,
    /// The signals, once it is over.
    pub signals: Vec<Signal>,
    /// Ticks a sample.
    pub every: u16,
    /// Samples that there are to be read.
    pub samples: u32,
    /// The sample at the trigger.
    pub trigger: Option<u32>,
    /// Tick of the first sample.
    pub tick: u32,
    /// Whole value of each signal in the first sample: of wide ones the samples are the low words.
    pub bases: [i64; MOST_SIGNALS],
    /// Where ticks were missed, or a wide signal jumped.
    pub interruptions: Vec<Interrupted>,
    /// There were more interruptions: before those told time and wide signals are not known.
    pub is_torn: bool,
}

impl ScopeStatus {
    /// True once there is nothing more to come.
    #[must_use]
    pub const fn is_over(&self) -> bool {
        matches!(self.phase, ScopePhase::Complete | ScopePhase::Ended)
    }

    fn of(reply: &Reply<'_>) -> Option<Self> {
        let Reply::Scope {
            phase,
            signals,
            every,
            samples,
            trigger,
            tick,
            bases,
            interruptions,
            is_torn,
        } = *reply
        else {
            return None;
        };
        let phase = match phase {
            0 => ScopePhase::Off,
            1 => ScopePhase::Waits,
            2 => ScopePhase::Triggered,
            3 => ScopePhase::Complete,
            4 => ScopePhase::Ended,
            _ => return None,
        };
        let signals = signals.iter().map(|number| Signal::from_number(*number));
        Some(Self {
            phase,
            signals: signals.collect::<Option<_>>()?,
            every,
            samples,
            trigger,
            tick,
            bases,
            interruptions: interruptions.into_iter().flatten().collect(),
            is_torn,
        })
    }
}

/// A trigger as the link tells it: its kind, source and level.
fn told(trigger: &Trigger) -> (u8, u8, i64) {
    match *trigger {
        Trigger::Now => (0, 0, 0),
        Trigger::Force => (1, 0, 0),
        Trigger::Level {
            signal,
            level,
            side,
        } => {
            let kind = match side {
                Side::Above => 2,
                Side::Below => 3,
            };
            (kind, signal as u8, level)
        }
        Trigger::Edge {
            signal,
            level,
            slope,
        } => {
            let kind = match slope {
                Slope::Rising => 4,
                Slope::Falling => 5,
                Slope::Either => 6,
            };
            (kind, signal as u8, level)
        }
        Trigger::Fault(fault) => (7, fault.map_or(0, |fault| fault as u8), 0),
        Trigger::Warning => (8, 0, 0),
        Trigger::Command => (9, 0, 0),
    }
}

impl Axis {
    /// Arms the scope, on the work memory. Needs no lease.
    ///
    /// # Errors
    /// [`Error::Refused`] where the setup is not right, or the work memory in use.
    pub fn arm_scope(&mut self, setup: &Setup) -> Result<(), Error> {
        let signals: Vec<u8> = setup
            .signals
            .as_slice()
            .iter()
            .map(|signal| *signal as u8)
            .collect();
        let (trigger, source, level) = told(&setup.trigger);
        self.order(&Request::ArmScope {
            signals: &signals,
            every: setup.every,
            samples: setup.samples,
            before: setup.pre,
            trigger,
            source,
            level,
        })
    }

    /// Triggers the scope now.
    ///
    /// # Errors
    /// [`Error::Refused`]
    pub fn trigger_scope(&mut self) -> Result<(), Error> {
        self.order(&Request::TriggerScope {})
    }

    /// Ends the scope; what it has is there to be read.
    ///
    /// # Errors
    /// [`Error::Refused`]
    pub fn end_scope(&mut self) -> Result<(), Error> {
        self.order(&Request::EndScope {})
    }

    /// How the scope stands.
    ///
    /// # Errors
    /// Of a lost axis.
    pub fn scope(&mut self) -> Result<ScopeStatus, Error> {
        self.query(&Request::Scope {}, ScopeStatus::of)
    }

    /// The samples of a scope that is over, each with its signals in their order, in the bits of the signals.
    ///
    /// # Errors
    /// [`Error::Refused`] while there is nothing to read.
    pub fn read_scope(&mut self, scope: &ScopeStatus) -> Result<Vec<Vec<i32>>, Error> {
        let width = scope.signals.len().max(1);
        let mut samples: Vec<Vec<i32>> = Vec::new();
        while samples.len() < scope.samples as usize {
            let index = samples.len() as u32;
            let more = self.query(&Request::ReadScope { index }, |reply| match *reply {
                Reply::Samples { index: at, bytes } if at == index && bytes.len() >= 4 * width => {
                    let (words, _) = bytes.as_chunks::<4>();
                    let words: Vec<i32> =
                        words.iter().map(|word| i32::from_le_bytes(*word)).collect();
                    Some(words)
                }
                _ => None,
            })?;
            samples.extend(more.chunks_exact(width).map(<[i32]>::to_vec));
        }
        samples.truncate(scope.samples as usize);
        Ok(samples)
    }
}
