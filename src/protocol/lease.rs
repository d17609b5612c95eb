//! The control lease: who may move the axis, and until when.
//!
//! ```text
//!           take                     renewed for too long not
//!   Free ─────────► Held by a session ───────────────────────► Free, and the axis stops
//!     ▲              │    ▲  │ take, renew by the holder
//!     └── release ───┘    └──┘
//! ```
//!
//! Time is axis ticks, given as a value. A lease that has lapsed is not renewed but taken anew: the tool is to notice.

use super::refusal::Refusal;

/// The control lease of an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lease {
    ticks: u32,
    holder: Option<Holder>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Holder {
    session: u32,
    renewed: u32,
}

impl Lease {
    /// A lease that nobody holds, of 100 ms at `tick_hz` ticks a second.
    #[must_use]
    pub const fn new(tick_hz: u32) -> Self {
        let ticks = tick_hz / 10;
        Self {
            ticks: if ticks == 0 { 1 } else { ticks },
            holder: None,
        }
    }

    /// How long it lasts without being renewed, ticks.
    #[must_use]
    pub const fn ticks(&self) -> u32 {
        self.ticks
    }

    /// The session that holds it.
    #[must_use]
    pub fn holder(&self) -> Option<u32> {
        self.holder.map(|holder| holder.session)
    }

    /// Lets time pass until `tick`; true once when the lease lapses: the axis is then to stop. To be called at least
    /// every 2³¹ ticks, as ticks wrap, and before anything is asked.
    #[must_use]
    pub fn has_lapsed(&mut self, tick: u32) -> bool {
        let lapses = self
            .holder
            .is_some_and(|holder| tick.wrapping_sub(holder.renewed) >= self.ticks);
        if lapses {
            self.holder = None;
        }
        lapses
    }

    /// Gives it to `session` at `tick`, or renews it.
    ///
    /// # Errors
    /// [`Refusal::LeaseHeld`] by another.
    pub fn take(&mut self, session: u32, tick: u32) -> Result<(), Refusal> {
        if self.holder.is_some_and(|holder| holder.session != session) {
            return Err(Refusal::LeaseHeld);
        }
        self.holder = Some(Holder {
            session,
            renewed: tick,
        });
        Ok(())
    }

    /// Renews it at `tick` for a session that has seen tick `seen` of the axis.
    ///
    /// # Errors
    /// [`Refusal::LeaseRequired`] for one that does not hold it, [`Refusal::StaleRenewal`] if what it saw is too old, or is
    /// still to come.
    pub fn renew(&mut self, session: u32, seen: u32, tick: u32) -> Result<(), Refusal> {
        self.check(session)?;
        if tick.wrapping_sub(seen) >= self.ticks {
            return Err(Refusal::StaleRenewal);
        }
        self.take(session, tick)
    }

    /// Lets it count from `tick` on, whoever holds it.
    pub const fn prolong(&mut self, tick: u32) {
        if let Some(holder) = &mut self.holder {
            holder.renewed = tick;
        }
    }

    /// Takes it back from `session`.
    ///
    /// # Errors
    /// [`Refusal::LeaseRequired`] for one that does not hold it.
    pub fn release(&mut self, session: u32) -> Result<(), Refusal> {
        self.check(session)?;
        self.holder = None;
        Ok(())
    }

    /// Passes what `session` asks for if it holds the lease.
    ///
    /// # Errors
    /// [`Refusal::LeaseRequired`]
    pub fn check(&self, session: u32) -> Result<(), Refusal> {
        if self.holder() == Some(session) {
            Ok(())
        } else {
            Err(Refusal::LeaseRequired)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_lapses_once_a_hundred_milliseconds_after_the_last_renewal() {
        // Ticks wrap in between.
        let start = u32::MAX - 120;
        let at = |after: u32| start.wrapping_add(after);
        let mut lease = Lease::new(1000);
        assert_eq!((lease.ticks(), lease.holder()), (100, None));
        lease.take(7, at(0)).unwrap();
        assert!(!lease.has_lapsed(at(99)));
        lease.renew(7, at(30), at(99)).unwrap();
        assert!(!lease.has_lapsed(at(198)));
        assert!(lease.has_lapsed(at(199)));
        assert!(!lease.has_lapsed(at(200)), "once");
        assert_eq!(
            lease.renew(7, at(200), at(200)),
            Err(Refusal::LeaseRequired)
        );
        lease.take(7, at(201)).unwrap();
        assert_eq!(lease.holder(), Some(7));
    }

    #[test]
    fn one_holds_it_at_a_time() {
        let mut lease = Lease::new(2500);
        assert_eq!(lease.check(1), Err(Refusal::LeaseRequired));
        lease.take(1, 0).unwrap();
        lease.take(1, 10).unwrap();
        assert_eq!(lease.take(2, 20), Err(Refusal::LeaseHeld));
        assert_eq!(lease.renew(2, 20, 20), Err(Refusal::LeaseRequired));
        assert_eq!(lease.release(2), Err(Refusal::LeaseRequired));
        assert_eq!(lease.check(1), Ok(()));
        lease.release(1).unwrap();
        lease.take(2, 30).unwrap();
        assert!(!lease.has_lapsed(30 + 249) && lease.has_lapsed(30 + 250));
        lease.take(1, 281).unwrap();
    }

    #[test]
    fn a_renewal_that_waited_on_its_way_renews_nothing() {
        let mut lease = Lease::new(1000);
        lease.take(1, 1000).unwrap();
        assert_eq!(lease.renew(1, 950, 1050), Err(Refusal::StaleRenewal));
        assert_eq!(lease.renew(1, 1051, 1050), Err(Refusal::StaleRenewal));
        assert!(lease.has_lapsed(1100));
    }

    #[test]
    fn the_lowest_rates_have_a_lease_too() {
        assert_eq!(Lease::new(100).ticks(), 10);
        assert_eq!(Lease::new(0).ticks(), 1);
    }
}
