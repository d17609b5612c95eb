//! The monitor: its screen as text, and its keys on an axis.

use std::time::Duration;

use leadscrew_client::Axis;
use leadscrew_hal_mock::scenario::{EncoderTrouble, Trouble};
use leadscrew_host::monitor::{Key, Session, draw};
use ratatui::Terminal;
use ratatui::backend::TestBackend;

use crate::support::Shared;

const MS: fn(u64) -> Duration = Duration::from_millis;

/// The screen of a session, as text.
fn screen(session: &Session<'_>, width: u16, height: u16) -> String {
    let mut terminal = Terminal::new(TestBackend::new(width, height)).unwrap();
    terminal.draw(|frame| draw(frame, session.state())).unwrap();
    terminal.backend().to_string()
}

/// Looks for so long, picture by picture.
fn look(session: &mut Session<'_>, time: u64) {
    for _ in 0..time / 30 {
        session.look(MS(30)).unwrap();
    }
}

fn session(tool: &mut Axis) -> Session<'_> {
    let mut session = Session::new(tool).unwrap();
    look(&mut session, 300);
    session
}

#[test]
fn the_screen_shows_a_move_in_80_by_24() {
    let mut tool = Shared::new(1000.0).ready();
    tool.move_to(20.0, 600.0).unwrap();
    let mut session = session(&mut tool);
    look(&mut session, 1200);
    let shown = screen(&session, 80, 24);
    insta::assert_snapshot!(shown);
    session.press(Key::Letter('t'), MS(0)).unwrap();
    assert!(screen(&session, 80, 24).contains(" velocity, mm/min (t: another) "));
    assert!(screen(&session, 120, 40).contains("moving"));
    assert!(screen(&session, 40, 10).contains("too small"));
}

#[test]
fn a_jog_ends_when_its_key_is_let_go() {
    let mut tool = Shared::new(1000.0).ready();
    let mut session = session(&mut tool);
    session.press(Key::Right, MS(0)).unwrap();
    look(&mut session, 300);
    assert!(session.state().status.is_moving);
    session.pass(MS(590)).unwrap();
    look(&mut session, 300);
    assert!(session.state().status.is_moving);
    session.pass(MS(610)).unwrap();
    look(&mut session, 600);
    let status = session.state().status;
    assert!(!status.is_moving && status.position_mm > 1.0, "{status:?}");
    assert!(session.state().message.is_empty());
    assert!(!session.press(Key::Letter('q'), MS(2000)).unwrap());
}

#[test]
fn quitting_stops_the_axis_first() {
    let mut tool = Shared::new(1000.0).ready();
    let mut session = session(&mut tool);
    session.press(Key::Left, MS(0)).unwrap();
    look(&mut session, 300);
    assert!(!session.press(Key::Interrupt, MS(300)).unwrap());
    assert!(!tool.status().unwrap().is_moving);
}

#[test]
fn a_fault_is_shown_and_cleared_and_what_is_refused_is_told() {
    let shared = Shared::new(1000.0);
    let mut tool = shared.ready();
    let mut session = session(&mut tool);
    shared.break_it(&Trouble::Encoder(EncoderTrouble::LineLoss));
    session.press(Key::Right, MS(0)).unwrap();
    look(&mut session, 1800);
    let shown = screen(&session, 80, 24);
    assert!(shown.contains("in fault"), "{shown}");
    assert!(
        shown.contains("following-error") || shown.contains("encoder-loss"),
        "{shown}"
    );
    session.press(Key::Right, MS(3000)).unwrap();
    assert!(!session.state().message.is_empty());
    session.press(Key::Letter('c'), MS(4000)).unwrap();
    look(&mut session, 300);
    assert_eq!(session.state().status.fault_number, 0);
}
