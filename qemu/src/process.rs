use std::io;
use std::process::{Child, ExitStatus};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

const POLL: Duration = Duration::from_millis(5);

/// A QEMU that runs, for all who have to know when it does not any more.
#[derive(Clone, Debug)]
pub(crate) struct Process(Arc<Mutex<Child>>);

impl Process {
    pub(crate) fn new(child: Child) -> Self {
        Self(Arc::new(Mutex::new(child)))
    }

    /// How it ended, if it has.
    pub(crate) fn ended(&self) -> io::Result<Option<ExitStatus>> {
        self.child().try_wait()
    }

    /// Waits for its end; `None` if it has not ended in time.
    pub(crate) fn wait(&self, timeout: Duration) -> io::Result<Option<ExitStatus>> {
        let started = Instant::now();
        loop {
            match self.ended() {
                Ok(None) if started.elapsed() < timeout => thread::sleep(POLL),
                ended => return ended,
            }
        }
    }

    /// Ends it as a power cut ends a board.
    pub(crate) fn kill(&self) -> io::Result<ExitStatus> {
        let mut child = self.child();
        child.kill()?;
        child.wait()
    }

    fn child(&self) -> MutexGuard<'_, Child> {
        // A panic elsewhere leaves the child as it is.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use std::process::Command;

    use super::*;

    #[test]
    fn what_does_not_end_can_be_killed() {
        let endless = Process::new(Command::new("sleep").arg("600").spawn().unwrap());
        assert_eq!(endless.wait(Duration::from_millis(1)).unwrap(), None);
        endless.kill().unwrap();
        assert!(endless.ended().unwrap().is_some());
        let short = Process::new(Command::new("false").spawn().unwrap());
        let status = short.wait(Duration::from_secs(60)).unwrap().unwrap();
        assert_eq!(status.code(), Some(1));
    }
}
