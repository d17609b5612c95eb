//! A progress bar that appears only where it is worth looking at.

use std::sync::mpsc::{self, RecvTimeoutError, Sender};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// Work shorter than this shows no bar.
const PATIENCE: Duration = Duration::from_secs(1);
/// Time between two turns of the spinner.
const TURN: Duration = Duration::from_millis(100);
/// Steps between two updates of the bar.
const STRIDE: u64 = 1024;

/// Progress of a piece of work, on standard error if that is a terminal, until it is dropped.
pub struct Progress {
    bar: ProgressBar,
    steps: u64,
    /// Dropped when the work is done.
    working: Option<Sender<()>>,
    patience: Option<JoinHandle<()>>,
}

impl Progress {
    /// Progress of `what` over `steps` steps.
    #[must_use]
    pub fn new(what: &str, steps: u64) -> Self {
        Self::start(
            what,
            ProgressBar::with_draw_target(Some(steps), ProgressDrawTarget::hidden()),
            "{msg} {wide_bar} {percent} % {eta}",
        )
    }

    /// Progress of `what`, of which only the end can be told.
    #[must_use]
    pub fn endless(what: &str) -> Self {
        Self::start(
            what,
            ProgressBar::with_draw_target(None, ProgressDrawTarget::hidden()),
            "{msg} {spinner} {elapsed}",
        )
    }

    fn start(what: &str, bar: ProgressBar, template: &str) -> Self {
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style);
        }
        bar.set_message(what.to_owned());
        let (working, done) = mpsc::channel();
        let shown = bar.clone();
        let patience = thread::spawn(move || {
            if done.recv_timeout(PATIENCE) == Err(RecvTimeoutError::Timeout) {
                shown.set_draw_target(ProgressDrawTarget::stderr());
                shown.enable_steady_tick(TURN);
            }
        });
        Self {
            bar,
            steps: 0,
            working: Some(working),
            patience: Some(patience),
        }
    }

    /// One step further.
    pub fn step(&mut self) {
        self.steps += 1;
        if self.steps.is_multiple_of(STRIDE) {
            self.bar.set_position(self.steps);
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.working = None;
        if let Some(patience) = self.patience.take() {
            // A bar that could not be shown is no reason to fail.
            let _ = patience.join();
        }
        self.bar.finish_and_clear();
    }
}
