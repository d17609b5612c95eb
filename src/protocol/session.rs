//! Sessions: each request of a session is taken once, and none of a session before.
//!
//! The axis gives a session its number, another one every time, so that bytes recorded of one are nothing in the next.

/// What is to be done with a request.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arrival {
    /// It is new.
    Fresh,
    /// It is the one that came last: the answer may have been lost.
    Repeated,
    /// A later one came before it.
    Late,
    /// No session is open.
    NoSession,
    /// It belongs to another session.
    OtherSession,
}

/// The session of a link.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Session {
    /// 0 for none.
    number: u32,
    nonce: u32,
    nonce_before: Option<u32>,
    last: u16,
    opened: u16,
}

impl Session {
    /// Its number; 0 for none.
    #[must_use]
    pub const fn number(&self) -> u32 {
        self.number
    }

    /// Opens a session by a hello with `nonce` and `sequence` at `tick`: true if it is a new one, false if that nonce's is
    /// open already. `None` for a hello of a session before: it comes late.
    pub fn open(&mut self, nonce: u32, sequence: u16, tick: u32) -> Option<bool> {
        let is_open = self.number != 0;
        if is_open && self.nonce == nonce {
            return Some(false);
        }
        if self.nonce_before == Some(nonce) {
            return None;
        }
        self.nonce_before = is_open.then_some(self.nonce);
        // 1 to 65 535: a number is not 0 whatever the tick.
        self.opened = self.opened.checked_add(1).unwrap_or(1);
        self.number = u32::from(self.opened).wrapping_shl(16) | (tick & 0xffff);
        self.nonce = nonce;
        self.last = sequence;
        Some(true)
    }

    /// Takes the request of `sequence` in `session`.
    pub const fn arrive(&mut self, session: u32, sequence: u16) -> Arrival {
        if self.number == 0 {
            return Arrival::NoSession;
        }
        if session != self.number {
            return Arrival::OtherSession;
        }
        let ahead = sequence.wrapping_sub(self.last).cast_signed();
        if ahead > 0 {
            self.last = sequence;
            Arrival::Fresh
        } else if ahead == 0 {
            Arrival::Repeated
        } else {
            Arrival::Late
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_request_is_fresh_once() {
        let mut session = Session::default();
        assert_eq!(session.arrive(0, 1), Arrival::NoSession);
        assert_eq!(session.open(5, u16::MAX - 1, 7), Some(true));
        let number = session.number();
        for sequence in [u16::MAX, 0, 2] {
            assert_eq!(session.arrive(number, sequence), Arrival::Fresh);
            assert_eq!(session.arrive(number, sequence), Arrival::Repeated);
        }
        assert_eq!(session.arrive(number, 1), Arrival::Late);
        assert_eq!(session.arrive(number, u16::MAX), Arrival::Late);
        assert_eq!(session.arrive(number ^ 1, 3), Arrival::OtherSession);
    }

    #[test]
    fn another_session_has_another_number_and_a_repeated_hello_opens_none() {
        let mut session = Session::default();
        assert_eq!(session.open(5, 0, 7), Some(true));
        let first = session.number();
        assert_eq!(session.arrive(first, 1), Arrival::Fresh);
        assert_eq!(session.open(5, 0, 7), Some(false));
        assert_eq!(session.arrive(first, 1), Arrival::Repeated);
        assert_eq!(session.open(6, 0, 7), Some(true));
        assert_ne!(session.number(), first);
        assert_eq!(session.open(5, 0, 8), None, "late");
        assert_eq!(session.arrive(first, 2), Arrival::OtherSession);
    }
}
