//! The monitor on an axis: orders out, figures in.

use std::time::Duration;

use leadscrew::protocol::request::Request;
use leadscrew_client::{Axis, Error, Live};

use super::keys::{Key, Keys, Order};
use super::state::{CHART_SIGNALS, Sample, State};

/// Samples a second of the chart.
const SAMPLES_HZ: f64 = 100.0;

/// A monitor that looks at an axis.
pub struct Session<'a> {
    axis: &'a mut Axis,
    live: Live,
    keys: Keys,
    state: State,
    /// Samples that were put into the state.
    shown: usize,
}

impl<'a> Session<'a> {
    /// Begins to look.
    ///
    /// # Errors
    /// Of a lost axis.
    pub fn new(axis: &'a mut Axis) -> Result<Self, Error> {
        let scale = axis.scale()?;
        let every = (scale.tick_hz / SAMPLES_HZ).round().clamp(1.0, 60_000.0) as u16;
        let live = axis.live(&CHART_SIGNALS, every)?;
        let status = axis.status()?;
        let keys = Keys::default();
        let identity = axis.identity();
        let title = format!("{}, firmware {}", identity.board, identity.firmware);
        let title = format!("{}: {title}", axis.connection().port());
        let state = State::new(title, scale, status, keys.feed());
        Ok(Self {
            axis,
            live,
            keys,
            state,
            shown: 0,
        })
    }

    /// What is to be shown.
    #[must_use]
    pub const fn state(&self) -> &State {
        &self.state
    }

    /// Time on the line's clock.
    #[must_use]
    pub fn now(&mut self) -> Duration {
        self.axis.connection().now()
    }

    /// Lets so much time of the line pass, and takes what came.
    ///
    /// # Errors
    /// Of a lost axis, and [`Error::Interrupted`]; a lease that lapsed is told on the screen.
    pub fn look(&mut self, time: Duration) -> Result<(), Error> {
        let heard = self.axis.listen(&mut self.live, time);
        self.told(heard)?;
        self.state.status = self.axis.status()?;
        self.keys.note_hold(self.state.status.is_held);
        if !self.state.status.is_enabled {
            // Whatever stopped it, a key that is still held does not go on with it.
            self.keys.forget_jog();
        }
        self.state.feed = self.keys.feed();
        let recording = self.live.recording_mut();
        self.state.lost += recording.missing();
        for row in self.shown..recording.len() {
            let mut values = [0.0; CHART_SIGNALS.len()];
            for (value, (&signal, column)) in values
                .iter_mut()
                .zip(CHART_SIGNALS.iter().zip(&recording.columns))
            {
                *value = recording.scale.of(signal).value(column[row]);
            }
            let time_s = recording.ticks[row] as f64 / recording.scale.tick_hz;
            self.state.push(Sample { time_s, values });
        }
        // The last one stays: the next one follows it.
        let old = recording.len().saturating_sub(1);
        recording.ticks.drain(..old);
        for column in &mut recording.columns {
            column.drain(..old);
        }
        self.shown = recording.len();
        Ok(())
    }

    /// Takes a key at a time of the wall; false at the end.
    ///
    /// # Errors
    /// Of a lost axis.
    pub fn press(&mut self, key: Key, now: Duration) -> Result<bool, Error> {
        match self.keys.press(key, now) {
            Some(order) => self.carry_out(order),
            None => Ok(true),
        }
    }

    /// Does what is due at a time of the wall.
    ///
    /// # Errors
    /// Of a lost axis.
    pub fn pass(&mut self, now: Duration) -> Result<(), Error> {
        match self.keys.pass(now) {
            Some(order) => self.carry_out(order).map(drop),
            None => Ok(()),
        }
    }

    fn carry_out(&mut self, order: Order) -> Result<bool, Error> {
        let axis = &mut *self.axis;
        let done = match order {
            Order::Jog(feed) => axis.jog(feed),
            Order::Stop => axis.connection().order(&Request::Stop {}).map(drop),
            Order::Hold => axis.hold(),
            Order::Resume => axis.resume(),
            Order::Enable => axis.enable().map(drop),
            Order::Disable => axis.disable().map(drop),
            Order::Clear => clear(axis),
            Order::NextSignal => {
                self.state.show_next();
                return Ok(true);
            }
            Order::Quit => {
                axis.stop()?;
                return Ok(false);
            }
        };
        if done.is_err() {
            self.keys.forget_jog();
        } else {
            self.state.message.clear();
        }
        self.told(done)?;
        Ok(true)
    }

    /// What went wrong goes on the screen, unless there is no axis any more.
    fn told(&mut self, done: Result<(), Error>) -> Result<(), Error> {
        match done {
            Err(error) if error.is_lost() || matches!(error, Error::Interrupted { .. }) => {
                Err(error)
            }
            Err(error) => {
                self.state.message = error.to_string();
                Ok(())
            }
            Ok(()) => Ok(()),
        }
    }
}

fn clear(axis: &mut Axis) -> Result<(), Error> {
    let status = axis.status()?;
    if status.fault_number != 0 {
        // Enable is still asked for, though the drive is off.
        axis.disable()?;
        axis.clear_fault()?;
    }
    if status.warning_bits != 0 {
        axis.clear_warnings()?;
    }
    Ok(())
}
