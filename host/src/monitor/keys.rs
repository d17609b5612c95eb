//! What keys mean. Time comes from outside: the same keys give the same orders every time.

use std::time::Duration;

/// A jog goes on for so long after the first press of its key: terminals repeat it only after half a second.
const FIRST: Duration = Duration::from_millis(600);
/// And so long after every further one.
const REPEATED: Duration = Duration::from_millis(150);
/// Feeds of a jog, mm/min.
const FEEDS: [f64; 8] = [10.0, 30.0, 100.0, 300.0, 600.0, 1000.0, 2000.0, 4000.0];
/// The one at the beginning.
const FIRST_FEED: usize = 3;

/// A key, as the monitor knows them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Key {
    /// A letter, a digit, the space.
    Letter(char),
    /// Arrow to the left.
    Left,
    /// Arrow to the right.
    Right,
    /// Arrow up.
    Up,
    /// Arrow down.
    Down,
    /// Ctrl-C.
    Interrupt,
}

/// What is to be done.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Order {
    /// Jog with that feed, mm/min.
    Jog(f64),
    /// Stop.
    Stop,
    /// Feed hold.
    Hold,
    /// End a feed hold.
    Resume,
    /// Take the axis under control.
    Enable,
    /// Take it out of control.
    Disable,
    /// Clear fault and warnings.
    Clear,
    /// Show another signal in the chart.
    NextSignal,
    /// Stop the axis, then end.
    Quit,
}

/// What the keys were so far.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Keys {
    feed: usize,
    /// Direction of the jog under way, and when it ends.
    jog: Option<(f64, Duration)>,
    is_held: bool,
}

impl Default for Keys {
    fn default() -> Self {
        Self {
            feed: FIRST_FEED,
            jog: None,
            is_held: false,
        }
    }
}

impl Keys {
    /// Feed of a jog, mm/min.
    #[must_use]
    pub fn feed(&self) -> f64 {
        FEEDS[self.feed.min(FEEDS.len() - 1)]
    }

    /// True while a key holds the axis in motion.
    #[must_use]
    pub const fn is_jogging(&self) -> bool {
        self.jog.is_some()
    }

    /// Takes a key that was pressed, or repeated, at `now`.
    pub fn press(&mut self, key: Key, now: Duration) -> Option<Order> {
        match key {
            Key::Right => self.jog(1.0, now),
            Key::Left => self.jog(-1.0, now),
            Key::Up => self.choose_feed(self.feed + 1),
            Key::Down => self.choose_feed(self.feed.saturating_sub(1)),
            Key::Interrupt | Key::Letter('q') => {
                self.jog = None;
                Some(Order::Quit)
            }
            Key::Letter(' ' | 's') => {
                self.jog = None;
                Some(Order::Stop)
            }
            Key::Letter('h') => {
                self.is_held = !self.is_held;
                Some(if self.is_held {
                    Order::Hold
                } else {
                    Order::Resume
                })
            }
            Key::Letter('e') => Some(Order::Enable),
            Key::Letter('d') => {
                self.jog = None;
                Some(Order::Disable)
            }
            Key::Letter('c') => Some(Order::Clear),
            Key::Letter('t') => Some(Order::NextSignal),
            Key::Letter(_) => None,
        }
    }

    /// What is due as time passes: the end of a jog whose key is not held any more.
    pub fn pass(&mut self, now: Duration) -> Option<Order> {
        match self.jog {
            Some((_, until)) if now >= until => {
                self.jog = None;
                Some(Order::Stop)
            }
            _ => None,
        }
    }

    /// How the axis is really held, which others may change.
    pub const fn note_hold(&mut self, is_held: bool) {
        self.is_held = is_held;
    }

    /// The jog was refused: its key asks anew.
    pub const fn forget_jog(&mut self) {
        self.jog = None;
    }

    fn jog(&mut self, direction: f64, now: Duration) -> Option<Order> {
        match self.jog {
            Some((way, until)) if way == direction => {
                // The first wait is not made shorter by a repeat.
                self.jog = Some((way, until.max(now + REPEATED)));
                None
            }
            // The other way: first it stops.
            Some(_) => {
                self.jog = None;
                Some(Order::Stop)
            }
            None => {
                self.jog = Some((direction, now + FIRST));
                Some(Order::Jog(direction * self.feed()))
            }
        }
    }

    /// Another feed; a jog under way takes it over.
    fn choose_feed(&mut self, feed: usize) -> Option<Order> {
        self.feed = feed.min(FEEDS.len() - 1);
        self.jog.map(|(way, _)| Order::Jog(way * self.feed()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const fn ms(ms: u64) -> Duration {
        Duration::from_millis(ms)
    }

    #[test]
    fn a_jog_lasts_as_long_as_its_key_is_repeated() {
        let mut keys = Keys::default();
        assert_eq!(keys.press(Key::Right, ms(0)), Some(Order::Jog(300.0)));
        assert_eq!(keys.pass(ms(590)), None);
        for time in (500..1000).step_by(33) {
            assert_eq!(keys.press(Key::Right, ms(time)), None);
            assert_eq!(keys.pass(ms(time + 32)), None);
        }
        assert_eq!(keys.pass(ms(1100)), None);
        assert_eq!(keys.pass(ms(1150)), Some(Order::Stop));
        assert_eq!(keys.pass(ms(1200)), None);
    }

    #[test]
    fn the_other_arrow_stops_first() {
        let mut keys = Keys::default();
        keys.press(Key::Left, ms(0));
        assert_eq!(keys.press(Key::Right, ms(100)), Some(Order::Stop));
        assert!(!keys.is_jogging());
        assert_eq!(keys.press(Key::Right, ms(130)), Some(Order::Jog(300.0)));
    }

    #[test]
    fn a_stop_ends_the_jog_for_good() {
        let mut keys = Keys::default();
        keys.press(Key::Right, ms(0));
        assert_eq!(keys.press(Key::Letter(' '), ms(50)), Some(Order::Stop));
        assert_eq!(keys.pass(ms(2000)), None);
        assert_eq!(keys.press(Key::Interrupt, ms(2000)), Some(Order::Quit));
    }

    #[test]
    fn feeds_stay_within_their_list_and_a_jog_takes_them_over() {
        let mut keys = Keys::default();
        for _ in 0..20 {
            keys.press(Key::Down, ms(0));
        }
        assert_eq!(keys.feed(), 10.0);
        keys.press(Key::Left, ms(0));
        assert_eq!(keys.press(Key::Up, ms(10)), Some(Order::Jog(-30.0)));
        for _ in 0..20 {
            keys.press(Key::Up, ms(20));
        }
        assert_eq!(keys.feed(), 4000.0);
    }

    #[test]
    fn hold_and_resume_take_turns() {
        let mut keys = Keys::default();
        assert_eq!(keys.press(Key::Letter('h'), ms(0)), Some(Order::Hold));
        assert_eq!(keys.press(Key::Letter('h'), ms(0)), Some(Order::Resume));
        keys.note_hold(true);
        assert_eq!(keys.press(Key::Letter('h'), ms(0)), Some(Order::Resume));
    }
}
