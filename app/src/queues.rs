//! The queues between the tick and thread mode: one producer and one consumer each, and nobody waits.

use core::sync::atomic::{AtomicU32, Ordering};

use heapless::Vec;
use heapless::spsc::{Consumer, Producer, Queue};
use leadscrew::estimator::observer::Gains;
use leadscrew::params::AxisConfig;
use leadscrew::probe;
use leadscrew::protocol::refusal::Refusal;
use leadscrew::protocol::service::Ticket;
use leadscrew::scope::{Sample, Scope};
use leadscrew::supervisor::FirstFault;

use crate::axis_control::Request;
use crate::captures::{CaptureReceiver, CaptureSender, EDGES, WORDS};

/// As the queue's own, for the tick: the compiler does not know that the length of a queue, by which heapless divides, is
/// never zero, and without the question there would be a panic in the tick.
#[inline]
pub(crate) fn enqueue<T>(producer: &mut Producer<'_, T>, value: T) -> Result<(), T> {
    if producer.capacity() == NO_PLACES {
        return Err(value);
    }
    producer.enqueue(value)
}

/// As the queue's own, for the tick: see [`enqueue`].
#[inline]
pub(crate) fn dequeue<T>(consumer: &mut Consumer<'_, T>) -> Option<T> {
    if consumer.capacity() == NO_PLACES {
        return None;
    }
    consumer.dequeue()
}

/// Capacity of a queue without memory: one less than its length.
const NO_PLACES: usize = usize::MAX;
/// Requests that may wait.
const REQUESTS: usize = 8;
/// Outcomes that may wait: more than there are requests.
const OUTCOMES: usize = 32;
/// Samples that may wait: 60 ms at 1 kHz.
const SAMPLES: usize = 64;

/// What came of a request.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Outcome {
    /// That of the request.
    pub ticket: Ticket,
    /// What came of it.
    pub result: Result<(), Refusal>,
}

/// A configuration as the tick takes it, with the gains that were solved for it.
#[derive(Debug)]
pub struct Prepared {
    /// The configuration.
    pub config: AxisConfig,
    /// Those of its estimators.
    pub gains: Gains,
}

/// A place for one, which goes back and forth: a configuration is large.
pub type ConfigPlace = &'static mut Vec<Prepared, 1>;

/// Memory of the queues; captures have `CAPTURED` words, and the one that thread mode looks at `LOOKED_AT` edges.
pub struct Queues<const CAPTURED: usize = WORDS, const LOOKED_AT: usize = EDGES> {
    requests: Queue<Request, REQUESTS>,
    prepared: Vec<Prepared, 1>,
    configs: Queue<(Ticket, ConfigPlace), 2>,
    configs_back: Queue<ConfigPlace, 2>,
    outcomes: Queue<Outcome, OUTCOMES>,
    faults: Queue<FirstFault, 4>,
    touches: Queue<probe::Report, 4>,
    scopes: Queue<Scope<'static>, 2>,
    scopes_back: Queue<Scope<'static>, 2>,
    samples: Queue<Sample, SAMPLES>,
    captures: Queue<u32, CAPTURED>,
    edges: [u32; LOOKED_AT],
    refused: AtomicU32,
    /// One more than the tick whose report thread mode took last; [`NO_BEAT`] before the first one.
    beat: AtomicU32,
}

/// Thread mode has taken no report yet: it has no link, or has not begun. Beats are kept one higher, so that all of the memory
/// is zero at first, and no image has to hold it.
const NO_BEAT: u32 = 0;

/// What the tick holds of them.
pub struct TickEnds {
    pub(crate) requests: Consumer<'static, Request>,
    pub(crate) configs: Consumer<'static, (Ticket, ConfigPlace)>,
    pub(crate) configs_back: Producer<'static, ConfigPlace>,
    pub(crate) outcomes: Producer<'static, Outcome>,
    pub(crate) faults: Producer<'static, FirstFault>,
    pub(crate) touches: Producer<'static, probe::Report>,
    pub(crate) scopes: Consumer<'static, Scope<'static>>,
    pub(crate) scopes_back: Producer<'static, Scope<'static>>,
    pub(crate) samples: Producer<'static, Sample>,
    refused: &'static AtomicU32,
    beat: &'static AtomicU32,
}

/// What thread mode holds of them.
pub struct LinkEnds {
    /// To the axis.
    pub requests: Producer<'static, Request>,
    configs: Producer<'static, (Ticket, ConfigPlace)>,
    configs_back: Consumer<'static, ConfigPlace>,
    /// Here, unless the tick has it.
    config_place: Option<ConfigPlace>,
    /// What came of requests and configurations.
    pub outcomes: Consumer<'static, Outcome>,
    /// The first fault, told again when others follow it.
    pub faults: Consumer<'static, FirstFault>,
    /// What the probe came to, told anew with each touch and each end.
    pub touches: Consumer<'static, probe::Report>,
    /// Scopes for the tick.
    pub scopes: Producer<'static, Scope<'static>>,
    /// Scopes that are over.
    pub scopes_back: Consumer<'static, Scope<'static>>,
    /// Samples of the stream.
    pub samples: Consumer<'static, Sample>,
    /// Refusals whose outcome nobody fetched.
    pub refused: &'static AtomicU32,
    beat: &'static AtomicU32,
}

impl<const CAPTURED: usize, const LOOKED_AT: usize> Default for Queues<CAPTURED, LOOKED_AT> {
    fn default() -> Self {
        Self::new()
    }
}

impl<const CAPTURED: usize, const LOOKED_AT: usize> Queues<CAPTURED, LOOKED_AT> {
    /// Empty queues.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            requests: Queue::new(),
            prepared: Vec::new(),
            configs: Queue::new(),
            configs_back: Queue::new(),
            outcomes: Queue::new(),
            faults: Queue::new(),
            touches: Queue::new(),
            scopes: Queue::new(),
            scopes_back: Queue::new(),
            samples: Queue::new(),
            captures: Queue::new(),
            edges: [0; LOOKED_AT],
            refused: AtomicU32::new(0),
            beat: AtomicU32::new(NO_BEAT),
        }
    }

    /// The ends for the tick, and those for thread mode.
    pub fn split(&'static mut self) -> (TickEnds, CaptureSender, LinkEnds, CaptureReceiver) {
        let (ask, asked) = self.requests.split();
        let (configure, configs) = self.configs.split();
        let (configured, configs_back) = self.configs_back.split();
        let (answer, outcomes) = self.outcomes.split();
        let (tell, faults) = self.faults.split();
        let (touch, touches) = self.touches.split();
        let (lend, scopes) = self.scopes.split();
        let (give_back, scopes_back) = self.scopes_back.split();
        let (sample, samples) = self.samples.split();
        let (capture, captures) = self.captures.split();
        let tick = TickEnds {
            requests: asked,
            configs,
            configs_back: configured,
            outcomes: answer,
            faults: tell,
            touches: touch,
            scopes,
            scopes_back: give_back,
            samples: sample,
            refused: &self.refused,
            beat: &self.beat,
        };
        let link = LinkEnds {
            requests: ask,
            configs: configure,
            configs_back,
            config_place: Some(&mut self.prepared),
            outcomes,
            faults,
            touches,
            scopes: lend,
            scopes_back,
            samples,
            refused: &self.refused,
            beat: &self.beat,
        };
        let capture = CaptureSender::new(capture, LOOKED_AT);
        let captures = CaptureReceiver::new(captures, &mut self.edges);
        (tick, capture, link, captures)
    }
}

impl LinkEnds {
    /// Solves for the gains of a configuration, unless the one before had the same estimators, and hands both to the tick, which
    /// answers with `ticket`.
    ///
    /// # Errors
    /// [`Refusal::QueueFull`] while the tick has not taken the one before.
    pub fn configure(&mut self, ticket: Ticket, config: &AxisConfig) -> Result<(), Refusal> {
        let place = self.config_place.take();
        let place = place.or_else(|| self.configs_back.dequeue());
        let place = place.ok_or(Refusal::QueueFull)?;
        match place.first_mut() {
            // They take seconds.
            Some(before) if before.config.estimators == config.estimators => {
                before.config = *config;
            }
            _ => {
                place.clear();
                // There is room, now that it is empty.
                let _ = place.push(Prepared {
                    config: *config,
                    gains: config.estimators.gains(),
                });
            }
        }
        // There is room, as there is no other place.
        let _ = self.configs.enqueue((ticket, place));
        Ok(())
    }

    /// Tells the tick that thread mode lives: it has taken the report of `tick`.
    pub fn beat(&self, tick: u32) {
        // One tick in 2³² is told late.
        self.beat.store(tick.saturating_add(1), Ordering::Relaxed);
    }
}

impl TickEnds {
    /// How many ticks thread mode is behind; 0 if there is nobody who could be.
    pub(crate) fn behind(&self, tick: u32) -> u32 {
        match self.beat.load(Ordering::Relaxed) {
            NO_BEAT => 0,
            beat => tick.wrapping_sub(beat.wrapping_sub(1)),
        }
    }

    /// Counts a refusal whose outcome found no room.
    pub(crate) fn note_lost_outcome(&self, result: Result<(), Refusal>) {
        let refused = self.refused.load(Ordering::Relaxed);
        let more = u32::from(result.is_err());
        self.refused
            .store(refused.wrapping_add(more), Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests {
    extern crate std;

    use leadscrew::estimator::EstimatorConfig;
    use leadscrew::estimator::observer::{Config, ObserverParams};
    use leadscrew::params::AxisParams;
    use leadscrew::units::AxisScale;
    use std::boxed::Box;

    use super::*;

    fn config_of(natural_period_s: f64, full_command_feed_mm_per_min: f64) -> AxisConfig {
        let params = ObserverParams {
            natural_period_s,
            ..ObserverParams::default()
        };
        let scale = AxisScale::new(1000.0, 1000.0).unwrap();
        let observer = EstimatorConfig::Observer(Config::new(&params, scale).unwrap());
        let mut params = AxisParams::new(observer);
        params.motion.full_command_feed_mm_per_min = full_command_feed_mm_per_min;
        params.validate().unwrap()
    }

    #[test]
    fn every_configuration_comes_with_its_own_gains() {
        let queues: &'static mut Queues = Box::leak(Box::new(Queues::new()));
        let (mut tick, _, mut link, _) = queues.split();
        let slow = config_of(0.09, 9600.0);
        let same_estimator = config_of(0.09, 12_000.0);
        let fast = config_of(0.03, 12_000.0);
        for (ticket, config) in [slow, same_estimator, fast, slow].iter().enumerate() {
            let ticket = ticket as Ticket;
            assert_eq!(link.configure(ticket, config), Ok(()));
            assert_eq!(link.configure(ticket, config), Err(Refusal::QueueFull));
            let (told, place) = tick.configs.dequeue().unwrap();
            let prepared = place.first().unwrap();
            assert_eq!((told, prepared.config), (ticket, *config));
            assert_eq!(prepared.gains, config.estimators.gains());
            assert!(tick.configs_back.enqueue(place).is_ok());
        }
        assert_ne!(slow.estimators.gains(), fast.estimators.gains());
    }
}
