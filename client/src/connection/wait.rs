//! Waiting: the only thing by which time passes. Whatever waits keeps the lease.

use std::panic::resume_unwind;
use std::thread;
use std::time::Duration;

use leadscrew::protocol::reply::{MOVING, Reply};
use leadscrew::protocol::request::Request;
use leadscrew::supervisor::State;

use super::{Connection, Lease};
use crate::error::Error;

/// Time between two looks at an axis that is waited for.
const LOOK: Duration = Duration::from_millis(10);

impl Connection {
    /// Lets a moment of the line's time pass: one exchange.
    pub(super) fn idle(&mut self) -> Result<(), Error> {
        self.exchange(&[], &mut |_| None::<()>).map(drop)
    }

    /// Lets time pass on the line's clock. A lease that is held is kept.
    ///
    /// # Errors
    /// [`Error::Interrupted`], after the axis was stopped; [`Error::LeaseLapsed`]; those of a lost axis.
    pub fn wait(&mut self, time: Duration) -> Result<(), Error> {
        let until = self.now.saturating_add(time);
        while self.now < until {
            self.go_on()?;
        }
        Ok(())
    }

    /// One step of waiting.
    pub(crate) fn go_on(&mut self) -> Result<(), Error> {
        self.step()?;
        self.check_lapse()
    }

    /// The same where a lease that lapses does not matter: what is waited for is that the axis stops.
    fn step(&mut self) -> Result<(), Error> {
        self.check_interrupted()?;
        self.idle()?;
        self.renew_if_due()
    }

    /// Tells of a lapse of the lease, once.
    pub(crate) fn check_lapse(&mut self) -> Result<(), Error> {
        match self.lease {
            Lease::Lapsed { is_told: false } => {
                self.lease = Lease::Lapsed { is_told: true };
                Err(Error::LeaseLapsed)
            }
            _ => Ok(()),
        }
    }

    /// Lets the time between two looks at the axis pass, whatever becomes of the lease.
    pub(crate) fn wait_a_look(&mut self) -> Result<(), Error> {
        let until = self.now.saturating_add(LOOK);
        while self.now < until {
            self.step()?;
        }
        Ok(())
    }

    /// Runs a long computation beside this thread, which keeps the lease meanwhile; on a line in lockstep, where no time
    /// passes, in this one.
    ///
    /// # Errors
    /// As of [`Self::wait`]; the work is waited for all the same, and its result is lost.
    ///
    /// # Panics
    /// If the work does.
    pub fn keep_alive_while<R: Send>(
        &mut self,
        work: impl FnOnce() -> R + Send,
    ) -> Result<R, Error> {
        if self.line.is_lockstep() {
            self.check_interrupted()?;
            return Ok(work());
        }
        thread::scope(|scope| {
            let work = scope.spawn(work);
            let mut kept = Ok(());
            while kept.is_ok() && !work.is_finished() {
                kept = self.go_on();
            }
            let result = work.join().unwrap_or_else(|panic| resume_unwind(panic));
            kept.map(|()| result)
        })
    }

    /// Where somebody has interrupted: stops the axis if it is this tool that moves it, and gives up.
    pub(crate) fn check_interrupted(&mut self) -> Result<(), Error> {
        if self.is_stopping || !self.options.is_interrupted() {
            return Ok(());
        }
        self.is_stopping = true;
        let stands = if self.lease.is_held() {
            self.stop_and_stand()
        } else {
            Ok(true)
        };
        self.is_stopping = false;
        Err(Error::Interrupted { stands: stands? })
    }

    fn stop_and_stand(&mut self) -> Result<bool, Error> {
        let ordered = self.order(&Request::Stop {})?;
        let until = self.now.saturating_add(self.options.timing.settle);
        while self.now < until {
            let (tick, state, flags) = self.query(&Request::Status {}, |reply| match *reply {
                Reply::Status {
                    tick, state, flags, ..
                } => Some((tick, state, flags)),
                _ => None,
            })?;
            let is_old = !self.has_begun(tick, ordered);
            let is_off = [State::Disabled, State::Fault, State::Ready]
                .into_iter()
                .any(|at| at as u8 == state);
            if is_off && flags & MOVING == 0 && !is_old {
                return Ok(true);
            }
            self.wait_a_look()?;
        }
        Ok(false)
    }

    /// True if by `tick` an order that was acknowledged at `ordered` shows in the axis: plans begin a few ticks
    /// after that, and a stop of one that has not begun as many later.
    pub(crate) fn has_begun(&self, tick: u32, ordered: u32) -> bool {
        let least = self.identity.ticks_of_ms(20).clamp(12, i32::MAX as u32);
        tick.wrapping_sub(ordered).cast_signed() >= least.cast_signed()
    }
}
