//! What a board's inputs can follow: asked at boot, and before a parameter is set.

use core::fmt;

use leadscrew::protocol::refusal::Refusal;
use leadscrew::settings::Settings;

use super::{EDGES_PER_LINE, FilterError, InputFilter, LineLimits, line_hz};
use crate::edge_ring::{HoldError, hold};

/// The inputs of a board.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inputs {
    /// Encoder and receivers.
    pub limits: LineLimits,
    /// Clock of the timers, Hz.
    pub timer_hz: f64,
    /// Words of the ring of edge times.
    pub ring_words: usize,
}

/// Why the inputs do not follow an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum InputError {
    /// Edges too fast for encoder, receiver or filter.
    Filter(FilterError),
    /// Too many of them in a tick.
    Hold(HoldError),
    /// The edge timer is told to run at another rate than the board's does.
    Timer {
        /// What `timer_hz` says.
        told_hz: f64,
        /// What the timer has.
        timer_hz: f64,
    },
}

impl fmt::Display for InputError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Filter(error) => error.fmt(f),
            Self::Hold(error) => error.fmt(f),
            Self::Timer { told_hz, timer_hz } => write!(
                f,
                "timer_hz = {told_hz}, and the board's edge timer runs at {timer_hz} Hz: set it to that"
            ),
        }
    }
}

impl core::error::Error for InputError {}

impl Inputs {
    /// The filter for an axis with `settings`: the longest that passes its edges at full command.
    ///
    /// # Errors
    /// [`InputError`] if they are too fast for a part of the inputs, or too many for the ring; or where `timer_hz` is not the
    /// board's, as every time would be scaled wrongly.
    pub fn filter(&self, settings: &Settings) -> Result<InputFilter, InputError> {
        let told_hz = settings.axis.timer_hz;
        if told_hz != self.timer_hz {
            return Err(InputError::Timer {
                told_hz,
                timer_hz: self.timer_hz,
            });
        }
        let motion = &settings.axis.motion;
        let filter = InputFilter::for_feed(
            motion.full_command_feed_mm_per_min,
            motion.counts_per_mm,
            self.timer_hz,
            &self.limits,
        );
        let filter = filter.map_err(InputError::Filter)?;
        self.hold(settings, filter).map_err(InputError::Hold)?;
        Ok(filter)
    }

    /// Whether the ring holds what passes `filter`.
    fn hold(&self, settings: &Settings, filter: InputFilter) -> Result<(), HoldError> {
        let motion = &settings.axis.motion;
        let lines = line_hz(motion.full_command_feed_mm_per_min, motion.counts_per_mm);
        hold(
            self.ring_words,
            settings.axis.tick_hz,
            EDGES_PER_LINE * lines,
            filter.passed_hz(self.timer_hz),
        )
    }
}

/// Inputs with the filter that was chosen for them at boot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InputsInForce {
    /// The inputs.
    pub inputs: Inputs,
    /// The filter; it is changed by a restart alone. `None` if no filter would do: edge times are not used then.
    pub filter: Option<InputFilter>,
}

impl InputsInForce {
    /// Whether an axis with `settings` may be enabled.
    ///
    /// # Errors
    /// [`Refusal::TooFastForInputs`] if no filter will do; [`Refusal::RestartNeeded`] if another than the one in force does;
    /// [`Refusal::Inconsistent`] for another clock of the edge timer than the board's.
    pub fn check(&self, settings: &Settings) -> Result<(), Refusal> {
        let best = self.inputs.filter(settings);
        let best = best.map_err(|error| match error {
            InputError::Timer { .. } => Refusal::Inconsistent,
            InputError::Filter(_) | InputError::Hold(_) => Refusal::TooFastForInputs,
        })?;
        let filter = self.filter.ok_or(Refusal::RestartNeeded)?;
        // A longer one would be better, a shorter one is needed.
        let is_passed = filter.clocks() <= best.clocks();
        if is_passed && self.inputs.hold(settings, filter).is_ok() {
            Ok(())
        } else {
            Err(Refusal::RestartNeeded)
        }
    }
}

#[cfg(test)]
mod tests {
    use leadscrew::estimator::EstimatorConfig;

    use super::super::Bottleneck;
    use super::*;

    const INPUTS: Inputs = Inputs {
        limits: LineLimits {
            encoder_hz: 300e3,
            receiver_hz: 1e6,
        },
        timer_hz: 84e6,
        ring_words: 4096,
    };

    fn settings(feed: f64, tick_hz: f64) -> Settings {
        let estimator = EstimatorConfig::by_name("simple").unwrap().unwrap();
        let mut settings = Settings::new(estimator);
        settings.axis.tick_hz = tick_hz;
        settings.axis.motion.full_command_feed_mm_per_min = feed;
        settings.axis.motion.counts_per_mm = 1000.0;
        settings
    }

    fn in_force(feed: f64, tick_hz: f64) -> InputsInForce {
        let filter = INPUTS.filter(&settings(feed, tick_hz)).unwrap();
        InputsInForce {
            inputs: INPUTS,
            filter: Some(filter),
        }
    }

    #[test]
    fn inputs_that_were_refused_at_boot_wait_for_a_restart() {
        let refused = InputsInForce {
            inputs: INPUTS,
            filter: None,
        };
        let slower = settings(9600.0, 10_000.0);
        assert!(INPUTS.filter(&slower).is_ok());
        assert_eq!(refused.check(&slower), Err(Refusal::RestartNeeded));
    }

    #[test]
    fn another_clock_than_the_board_s_is_refused() {
        let mut told = settings(9600.0, 1000.0);
        told.axis.timer_hz = 42e6;
        let error = INPUTS.filter(&told).unwrap_err();
        assert!(matches!(error, InputError::Timer { .. }), "{error}");
        let in_force = in_force(9600.0, 1000.0);
        assert_eq!(in_force.check(&told), Err(Refusal::Inconsistent));
    }

    #[test]
    fn what_boot_would_refuse_is_refused() {
        let in_force = in_force(9600.0, 1000.0);
        let refused = |feed, tick_hz| {
            let settings = settings(feed, tick_hz);
            (INPUTS.filter(&settings).err(), in_force.check(&settings))
        };
        // 875 000 edges a second have a filter of 48 clocks; a shorter one passes more in a tick than half the ring.
        assert_eq!(refused(52_500.0, 1000.0).0, None);
        let (error, refusal) = refused(52_501.0, 1000.0);
        assert!(matches!(
            error,
            Some(InputError::Hold(HoldError::Open { .. }))
        ));
        assert_eq!(refusal, Err(Refusal::TooFastForInputs));
        let (error, refusal) = refused(72_001.0, 2500.0);
        let Some(InputError::Filter(FilterError::TooFast { part, .. })) = error else {
            panic!("{error:?}")
        };
        assert_eq!(part, Bottleneck::Encoder);
        assert_eq!(refusal, Err(Refusal::TooFastForInputs));
    }

    #[test]
    fn a_shorter_filter_waits_for_a_restart_and_a_longer_one_does_not() {
        let lathe = in_force(9600.0, 1000.0);
        let faster = settings(24_000.0, 1000.0);
        assert_eq!(lathe.check(&settings(9600.0, 1000.0)), Ok(()));
        assert_eq!(lathe.check(&faster), Err(Refusal::RestartNeeded));
        let restarted = in_force(24_000.0, 1000.0);
        assert!(restarted.filter.unwrap().clocks() < lathe.filter.unwrap().clocks());
        assert_eq!(restarted.check(&faster), Ok(()));
        assert_eq!(restarted.check(&settings(9600.0, 1000.0)), Ok(()));
    }

    #[test]
    fn a_filter_in_force_that_passes_more_than_the_ring_holds_waits_for_a_restart() {
        let fast = in_force(52_000.0, 1000.0);
        // At a fifth of the rate a tick is five times as long, and the filter of before passes 8 750 in it.
        let slow = settings(6_000.0, 200.0);
        assert!(INPUTS.filter(&slow).is_ok());
        assert_eq!(fast.check(&slow), Err(Refusal::RestartNeeded));
    }
}
