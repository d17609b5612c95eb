//! The faults there are.

use leadscrew::units::{RangeError, checked};

/// What is wrong with an encoder, its lines or its capture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// Interference on A: false edges in pairs, there and back. They add times and leave the count.
    FalseEdges(Bursts),
    /// Interference on A and B at once: each pulse is two illegal transitions.
    IllegalTransitions(Bursts),
    /// The counter misses one of so many edges: time and count.
    LostEdges {
        /// Edges from one that is lost to the next.
        every: u32,
    },
    /// The counter takes one of so many edges twice.
    DoubledEdges {
        /// Edges from one that is doubled to the next.
        every: u32,
    },
    /// A channel stays at its level: the edges of the other one count up and down in turn.
    DeadChannel(Channel),
    /// A falls late, so that its duty grows with speed: by the delay times the speed each falling edge lies
    /// off. Edges keep their order.
    DutyDrift {
        /// Delay of the falling edges, clocks of the edge timer.
        delay_clocks: u32,
    },
    /// All lines stay at their levels: no edge, no index.
    LineLoss,
    /// The buffer of edge times is too small: the rest of a tick's times is lost, the count stays good.
    Overrun {
        /// Times that the buffer holds.
        kept: u32,
    },
}

/// One of the lines of a quadrature encoder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Channel {
    /// Its edges are the odd boundaries.
    A,
    /// Its edges are the even boundaries.
    B,
}

/// Pulses of interference that come in bursts, as rectifiers make them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bursts {
    /// From one burst to the next, clocks of the edge timer.
    pub period_clocks: u32,
    /// Pulses of a burst.
    pub pulses: u32,
    /// Width of a pulse, and of the pause after it, clocks. A pulse ends early where an edge or the sampling
    /// instant comes before its end.
    pub width_clocks: u32,
}

impl Bursts {
    /// Three pulses of 2 µs at `burst_hz`, in clocks of `timer_hz`.
    #[must_use]
    pub fn at(burst_hz: f64, timer_hz: f64) -> Self {
        Self {
            period_clocks: (timer_hz / burst_hz) as u32,
            pulses: 3,
            width_clocks: (timer_hz * 2e-6) as u32,
        }
    }
}

impl Fault {
    /// Checks what the fault is made of.
    pub(super) fn check(&self) -> Result<(), RangeError> {
        let at_least = |name, value: u32, least: f64| {
            checked(name, f64::from(value), least, f64::from(u32::MAX)).map(|_| ())
        };
        match self {
            Self::FalseEdges(bursts) | Self::IllegalTransitions(bursts) => {
                let length = 2.0 * f64::from(bursts.pulses) * f64::from(bursts.width_clocks);
                at_least("period_clocks", bursts.period_clocks, length.max(1.0))
            }
            Self::LostEdges { every } | Self::DoubledEdges { every } => {
                at_least("every", *every, 1.0)
            }
            Self::DutyDrift { delay_clocks } => {
                checked("delay_clocks", f64::from(*delay_clocks), 0.0, MAX_DELAY).map(|_| ())
            }
            Self::DeadChannel(_) | Self::LineLoss | Self::Overrun { .. } => Ok(()),
        }
    }
}

/// Far below the wrap of the timer.
const MAX_DELAY: f64 = 1e6;
