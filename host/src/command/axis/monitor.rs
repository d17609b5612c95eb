//! `leadscrew monitor`: the screen on a terminal.

use std::io::{self, IsTerminal, stdout};
use std::time::{Duration, Instant};

use leadscrew_client::Axis;
use ratatui::crossterm::event::{self, Event, KeyCode, KeyEvent, KeyEventKind, KeyModifiers};

use crate::error::CommandError;
use crate::monitor::{Key, Session, draw};

/// Time between two pictures.
const PICTURE: Duration = Duration::from_millis(30);
/// Longest that the axis is listened to without a look at the keys.
const LONGEST: Duration = Duration::from_millis(60);

/// The terminal as the screen needs it, until it is dropped: also where something fails, or panics.
struct Screen(ratatui::DefaultTerminal);

impl Screen {
    fn open() -> io::Result<Self> {
        ratatui::try_init().map(Self)
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        ratatui::restore();
    }
}

/// Runs the command.
///
/// # Errors
/// No terminal, or the axis is lost.
pub fn run(axis: &mut Axis) -> Result<(), CommandError> {
    if !stdout().is_terminal() || !io::stdin().is_terminal() {
        return Err(CommandError::Usage(
            "monitor needs a terminal; `status` and `record` do without".to_owned(),
        ));
    }
    let mut session = Session::new(axis)?;
    let mut screen = Screen::open().map_err(failed)?;
    let ended = look(&mut session, &mut screen);
    drop(screen);
    ended
}

/// Looks until it is ended. Where the line has a clock of its own, the axis is led along with the wall's.
fn look(session: &mut Session<'_>, screen: &mut Screen) -> Result<(), CommandError> {
    let begin = Instant::now();
    let mut lead = session.now();
    loop {
        let behind = (begin.elapsed() + lead).saturating_sub(session.now());
        // An axis that cannot keep up with the wall is not chased.
        lead = lead.saturating_sub(behind.saturating_sub(LONGEST));
        session.look(behind.clamp(Duration::from_millis(1), LONGEST))?;
        let drawn = screen.0.draw(|frame| draw(frame, session.state()));
        drawn.map_err(failed)?;
        let mut patience = PICTURE;
        while event::poll(patience).map_err(failed)? {
            patience = Duration::ZERO;
            if let Event::Key(pressed) = event::read().map_err(failed)?
                && let Some(key) = key_of(&pressed)
                && !session.press(key, begin.elapsed())?
            {
                return Ok(());
            }
        }
        session.pass(begin.elapsed())?;
    }
}

fn key_of(pressed: &KeyEvent) -> Option<Key> {
    if pressed.kind == KeyEventKind::Release {
        return None;
    }
    Some(match pressed.code {
        KeyCode::Char('c') if pressed.modifiers.contains(KeyModifiers::CONTROL) => Key::Interrupt,
        KeyCode::Char(letter) => Key::Letter(letter.to_ascii_lowercase()),
        KeyCode::Left => Key::Left,
        KeyCode::Right => Key::Right,
        KeyCode::Up => Key::Up,
        KeyCode::Down => Key::Down,
        KeyCode::Esc => Key::Letter('q'),
        _ => return None,
    })
}

fn failed(error: io::Error) -> CommandError {
    CommandError::Data(format!("the terminal cannot be used: {error}"))
}
