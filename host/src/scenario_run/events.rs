//! What happened in a run, in order.

use leadscrew::supervisor::{Fault, FaultSet, State};

use super::Record;

/// Something that happened.
#[derive(Clone, Debug, PartialEq)]
pub struct Event {
    /// The tick that first saw it.
    pub tick: usize,
    /// What.
    pub what: What,
}

/// What happened.
#[derive(Clone, Debug, PartialEq)]
pub enum What {
    /// An action of the timeline, by its place there; with the reason if it was refused.
    Action(usize, Option<String>),
    /// The supervisor went to another state.
    State(State),
    /// A fault stopped the axis.
    Fault(Fault),
    /// A fault that only warns, or the warning before one.
    Warning(Fault),
    /// The latched fault was cleared.
    Cleared,
}

impl Event {
    /// All events of a run.
    #[must_use]
    pub fn all(record: &Record) -> Vec<Self> {
        let mut events: Vec<Self> = record
            .actions
            .iter()
            .map(|happening| Self {
                tick: happening.tick as usize,
                what: What::Action(
                    happening.index,
                    happening.refused.map(|error| error.to_string()),
                ),
            })
            .collect();
        let (mut state, mut fault) = (State::Disabled, None);
        let mut warnings = FaultSet::default();
        for (tick, found) in record.ticks.iter().enumerate() {
            let outputs = &found.outputs;
            let mut push = |what| events.push(Self { tick, what });
            if outputs.fault != fault {
                fault = outputs.fault;
                push(fault.map_or(What::Cleared, What::Fault));
            }
            let is_new =
                |fault: &&Fault| outputs.warnings.contains(**fault) && !warnings.contains(**fault);
            for &warning in Fault::ALL.iter().filter(is_new) {
                push(What::Warning(warning));
            }
            warnings = outputs.warnings;
            if outputs.state != state {
                state = outputs.state;
                push(What::State(state));
            }
        }
        events.sort_by_key(|event| event.tick);
        events
    }
}
