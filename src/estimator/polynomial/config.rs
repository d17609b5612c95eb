//! What is set on the local polynomial estimator.

use super::regular::Regular;
use super::window::CAPACITY;
use super::{Answer, GRID_BITS};
use crate::estimator::{Delay, Lags};
use crate::units::{Lag, RangeError, checked};

/// Window, answer and behaviour at low speed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Config {
    /// Window, grid steps.
    pub(super) window_steps: i32,
    /// Widest window, grid steps.
    pub(super) widest_steps: i32,
    pub(super) answer: Answer,
    /// Ticks without an edge after which the axis is at rest, Q24.8.
    pub(super) rest_ticks_q8: u32,
    lags: Lags,
    pub(super) regular: Regular,
}

/// Fewest samples that a quadratic goes through; the window widens until it has them.
pub const MIN_SAMPLES: usize = 4;

/// Widest window at low speed, ticks.
pub const WIDEST_TICKS: f64 = 64.0;

impl Config {
    /// Whether position and velocity are those of now.
    pub(crate) fn answers_newest(&self) -> bool {
        self.answer == Answer::Newest
    }

    /// A fit over the last `window` ticks that answers for `answer`. At low speed it widens up to
    /// 64 ticks; without an edge for 250 ticks the axis is at rest.
    ///
    /// # Errors
    /// [`RangeError`] unless 4 ≤ window ≤ 64.
    pub fn new(window: u32, answer: Answer) -> Result<Self, RangeError> {
        Self::with_low_speed(window, answer, WIDEST_TICKS, 250.0)
    }

    /// As [`Self::new`] with the widest window at low speed and the time to rest, ticks.
    ///
    /// # Errors
    /// [`RangeError`] unless 4 ≤ window ≤ 64, window ≤ `widest_ticks` ≤ 64 and 1 ≤ `rest_ticks` ≤ 1e6.
    pub fn with_low_speed(
        window: u32,
        answer: Answer,
        widest_ticks: f64,
        rest_ticks: f64,
    ) -> Result<Self, RangeError> {
        let ticks = f64::from(window);
        checked(
            "estimator.window",
            ticks,
            MIN_SAMPLES as f64,
            CAPACITY as f64,
        )?;
        let widest = checked("estimator.widest_ticks", widest_ticks, ticks, WIDEST_TICKS)?;
        let rest = checked("estimator.rest_ticks", rest_ticks, 1.0, 1e6)?;
        let middle = Lag::saturating_from_num(ticks / 2.0);
        let of_rest = match answer {
            Answer::Centre => middle,
            Answer::Newest => Lag::ZERO,
        };
        Ok(Self {
            window_steps: window.cast_signed().wrapping_shl(GRID_BITS),
            widest_steps: (widest * f64::from(1 << GRID_BITS)) as i32,
            answer,
            rest_ticks_q8: (rest * 256.0) as u32,
            lags: Lags {
                position: of_rest,
                velocity: of_rest,
                acceleration: middle,
            },
            regular: Regular::new(window),
        })
    }

    /// Window, ticks.
    #[must_use]
    pub const fn window(&self) -> u32 {
        self.window_steps.cast_unsigned().wrapping_shr(GRID_BITS)
    }

    /// Of a full window with all edges of each tick: their mean is half a tick old.
    pub(in crate::estimator) const fn lags(&self) -> Lags {
        self.lags
    }

    /// Of a motion j·u³/6 over ±T the fit keeps the cubic's projection on the line, j·T²·u/10, so under constant
    /// jerk its velocity is j·T²/10 too large in the middle and j·T²·(1/2 − 1/10) too small at the end.
    pub(in crate::estimator) fn delay(&self) -> Delay {
        let half = f64::from(self.window()) / 2.0;
        let pure = Delay::from(&self.lags);
        let bias = match self.answer {
            Answer::Centre => half * half / 5.0,
            Answer::Newest => -0.8 * half * half,
        };
        Delay {
            velocity_squared: pure.velocity_squared + bias,
            ..pure
        }
    }

    pub(in crate::estimator) const fn warm_up_ticks(&self) -> u32 {
        self.window().wrapping_add(2)
    }
}
