//! Faults and states by the names that files and reports give them.

use std::str::from_utf8;

use leadscrew::probe::ProbeEnd;
use leadscrew::supervisor::{Fault, State};

/// How many faults there are.
pub const FAULT_COUNT: usize = Fault::ALL.len();
/// Longest name, hyphens included.
const LONGEST: usize = 32;

/// Names of all faults, in the order of [`Fault::ALL`]: those of the code, words parted by hyphens.
pub const FAULT_NAMES: [&str; FAULT_COUNT] = {
    let mut names = [""; FAULT_COUNT];
    let mut index = 0;
    while index < FAULT_COUNT {
        let (bytes, length) = &SPELT[index];
        let (name, _) = bytes.split_at(*length);
        names[index] = match from_utf8(name) {
            Ok(name) => name,
            Err(_) => panic!("names are ASCII"),
        };
        index += 1;
    }
    names
};

static SPELT: [([u8; LONGEST], usize); FAULT_COUNT] = {
    let mut spelt = [([0; LONGEST], 0); FAULT_COUNT];
    let mut index = 0;
    while index < FAULT_COUNT {
        spelt[index] = kebab(Fault::ALL[index].name());
        index += 1;
    }
    spelt
};

/// `FollowingError` as `following-error`, and its length.
const fn kebab(name: &str) -> ([u8; LONGEST], usize) {
    let name = name.as_bytes();
    let (mut bytes, mut length, mut index) = ([0; LONGEST], 0, 0);
    while index < name.len() {
        if name[index].is_ascii_uppercase() && index > 0 {
            bytes[length] = b'-';
            length += 1;
        }
        bytes[length] = name[index].to_ascii_lowercase();
        length += 1;
        index += 1;
    }
    (bytes, length)
}

/// All states with their names.
pub const STATES: [(State, &str); 6] = [
    (State::Disabled, "disabled"),
    (State::Enabling, "enabling"),
    (State::Ready, "ready"),
    (State::Moving, "moving"),
    (State::Stopping, "stopping"),
    (State::Fault, "fault"),
];

/// The name of a fault.
#[must_use]
pub fn fault_name(fault: Fault) -> &'static str {
    let place = Fault::ALL.iter().position(|known| *known == fault);
    place.map_or("unknown", |place| FAULT_NAMES[place])
}

/// The name of a state.
#[must_use]
pub fn state_name(state: State) -> &'static str {
    let found = STATES.iter().find(|(known, _)| *known == state);
    found.map_or("unknown", |(_, name)| name)
}

/// Names of [`ProbeEnd`]s, in the order of their numbers.
pub const PROBE_ENDS: [&str; ProbeEnd::ALL.len()] = [
    "touched",
    "no-touch",
    "already-touching",
    "touched-on-retract",
    "still-touching",
    "interrupted",
    "encoder-lost",
    "unasked",
];

/// The name of an end of probing.
#[must_use]
pub fn probe_end_name(end: ProbeEnd) -> &'static str {
    let place = ProbeEnd::ALL.iter().position(|other| *other == end);
    place.map_or("", |place| PROBE_ENDS[place])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_those_of_the_code_in_words() {
        assert_eq!(fault_name(Fault::FollowingError), "following-error");
        assert_eq!(fault_name(Fault::EmergencyStop), "emergency-stop");
        assert_eq!(FAULT_NAMES.len(), Fault::ALL.len());
        for name in FAULT_NAMES {
            let is_plain = |letter: char| letter.is_ascii_lowercase() || letter == '-';
            assert!(name.chars().all(is_plain), "{name}");
        }
    }
}
