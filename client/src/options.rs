//! How a tool talks to its axis.

use std::hash::{BuildHasher as _, Hasher as _, RandomState};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// Times of a connection, on the clock of its line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Timing {
    /// A request that is not answered is sent again after this. Longer than a frame takes to the axis and back.
    pub repeat: Duration,
    /// An axis that has not answered for so long is lost.
    pub lost: Duration,
    /// An axis that has not answered the first words of a session for so long is not there. Boards start anew when their
    /// port is opened, and an STM32F4 takes some 5 s to solve for the gains of a commissioned observer before it listens.
    pub greeting: Duration,
    /// The control lease is renewed so often; it lasts 100 ms of axis time.
    pub renew: Duration,
    /// How long a request that is refused only for the moment is given again.
    pub patience: Duration,
    /// How long what has no duration of its own may take: enabling, disabling, a stop.
    pub settle: Duration,
}

impl Default for Timing {
    fn default() -> Self {
        Self {
            repeat: Duration::from_millis(20),
            lost: Duration::from_secs(1),
            greeting: Duration::from_secs(10),
            renew: Duration::from_millis(20),
            patience: Duration::from_millis(200),
            settle: Duration::from_secs(10),
        }
    }
}

/// How a tool talks to its axis.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Its times.
    pub timing: Timing,
    /// Where the numbers begin that the tool's sessions are told apart by; another one in every connection to the same
    /// axis. A random one if there is none.
    pub seed: Option<u32>,
    /// Set by somebody else, as a handler of Ctrl-C does: whatever waits then stops the axis and gives up with
    /// [`Error::Interrupted`](crate::Error::Interrupted). It is never reset here.
    pub interrupted: Option<Arc<AtomicBool>>,
}

impl Options {
    pub(crate) fn is_interrupted(&self) -> bool {
        self.interrupted
            .as_ref()
            .is_some_and(|flag| flag.load(Ordering::Relaxed))
    }

    pub(crate) fn first_nonce(&self) -> u32 {
        // The keys of a `RandomState` are random, which is as good as needed: a nonce only must not come twice.
        let random = || RandomState::new().build_hasher().finish() as u32;
        self.seed.unwrap_or_else(random)
    }
}
