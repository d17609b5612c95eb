//! The queue of one running and one waiting move.

use leadscrew::setpoint::profile::{Limits, Profile};
use leadscrew::setpoint::trajectory::{QueueError, Trajectory};
use leadscrew::setpoint::{Setpoint, Turn};
use leadscrew::units::Position;

fn plan(distance: i32) -> Profile {
    let limits = Limits::new(10.0, 1.0, 0.2).unwrap();
    Profile::plan(Position::from_num(distance), &limits).unwrap()
}

/// Steps over the ticks from `from` to `to`, both included; the last setpoint.
fn step_through(trajectory: &mut Trajectory, from: u32, to: u32) -> Setpoint {
    let mut setpoint = trajectory.step(from);
    let mut tick = from;
    while tick != to {
        tick = tick.wrapping_add(1);
        setpoint = trajectory.step(tick);
    }
    setpoint
}

#[test]
fn a_move_waits_for_its_start_and_ends_after_its_duration() {
    let profile = plan(100);
    let mut trajectory = Trajectory::new();
    trajectory.step(0);
    trajectory.queue(&profile, 50, 0).unwrap();
    let before = step_through(&mut trajectory, 1, 49);
    let announced = Setpoint {
        turn: before.turn,
        ..Setpoint::default()
    };
    assert_eq!((before, trajectory.is_moving()), (announced, false));
    let start = trajectory.step(50);
    assert_eq!(
        (start.position, start.velocity.to_bits()),
        (Position::ZERO, 0)
    );
    assert!(
        start.jerk > 0 && trajectory.is_moving(),
        "the jerk in force from this tick on"
    );
    let turn = Turn {
        ticks: 1,
        jerk: start.jerk,
    };
    assert_eq!(before.turn, turn, "the start is announced");
    let end = step_through(&mut trajectory, 51, 50 + profile.ticks());
    assert_eq!(
        end,
        Setpoint {
            position: Position::from_num(100),
            ..Setpoint::default()
        }
    );
    assert!(!trajectory.is_moving());
}

#[test]
fn a_start_that_has_passed_is_late_and_changes_nothing() {
    let mut trajectory = Trajectory::new();
    for start in [
        100,
        99,
        0,
        100_u32.wrapping_sub(i32::MAX.cast_unsigned()),
        100 + (1 << 31),
    ] {
        assert_eq!(
            trajectory.queue(&plan(5), start, 100),
            Err(QueueError::Late),
            "{start}"
        );
    }
    assert_eq!(step_through(&mut trajectory, 101, 300), Setpoint::default());
    assert_eq!(
        trajectory.queue(&plan(5), 300 + i32::MAX.cast_unsigned(), 300),
        Ok(()),
        "the latest start there is"
    );
}

#[test]
fn a_second_waiting_move_is_refused_and_the_first_goes_on() {
    let mut trajectory = Trajectory::new();
    let first = plan(5);
    trajectory.queue(&first, 10, 0).unwrap();
    assert_eq!(trajectory.queue(&plan(-7), 500, 0), Err(QueueError::Busy));
    assert_eq!(
        step_through(&mut trajectory, 1, 600).position,
        Position::from_num(5)
    );
}

#[test]
fn a_move_may_start_in_the_tick_in_which_the_running_one_ends_and_no_earlier() {
    let (first, second) = (plan(100), plan(-30));
    let end = 10 + first.ticks();
    for queued_at in [10, 11, end - 1] {
        let mut trajectory = Trajectory::new();
        trajectory.queue(&first, 10, 9).unwrap();
        step_through(&mut trajectory, 10, queued_at);
        assert_eq!(
            trajectory.queue(&second, end - 1, queued_at),
            if queued_at < end - 1 {
                Err(QueueError::Busy)
            } else {
                Err(QueueError::Late)
            }
        );
        trajectory.queue(&second, end, queued_at).unwrap();
        let turn = step_through(&mut trajectory, queued_at + 1, end);
        assert_eq!(
            (turn.position, turn.velocity.to_bits()),
            (Position::from_num(100), 0)
        );
        assert!(turn.jerk < 0, "the second move has begun");
        let last = step_through(&mut trajectory, end + 1, end + second.ticks());
        assert_eq!(
            last,
            Setpoint {
                position: Position::from_num(70),
                ..Setpoint::default()
            }
        );
    }
}

#[test]
fn ticks_wrap_while_a_move_waits_and_while_it_runs() {
    let profile = plan(100);
    for lead in [0, 1, 20, profile.ticks() - 1, profile.ticks()] {
        // The move ends `lead` ticks after the wrap.
        let start = lead.wrapping_sub(profile.ticks());
        let mut trajectory = Trajectory::new();
        let now = start.wrapping_sub(40);
        trajectory.queue(&profile, start, now).unwrap();
        let end = step_through(&mut trajectory, now.wrapping_add(1), lead);
        assert_eq!(
            end,
            Setpoint {
                position: Position::from_num(100),
                ..Setpoint::default()
            }
        );
        assert!(!trajectory.is_moving());
    }
}

#[test]
fn hold_ends_a_move_at_once_drops_the_waiting_one_and_the_next_starts_from_there() {
    let profile = plan(100);
    let mut trajectory = Trajectory::new();
    trajectory.queue(&profile, 1, 0).unwrap();
    step_through(&mut trajectory, 1, profile.ticks() / 2);
    let now = profile.ticks() / 2;
    trajectory
        .queue(&plan(50), 1 + profile.ticks(), now)
        .unwrap();

    let place = Position::lit("-123.25");
    trajectory.hold(place);
    assert!(!trajectory.is_moving());
    let standing = step_through(&mut trajectory, now + 1, 3 * profile.ticks());
    assert_eq!(
        standing,
        Setpoint {
            position: place,
            ..Setpoint::default()
        }
    );

    let again = 3 * profile.ticks() + 1;
    trajectory.queue(&profile, again, again - 1).unwrap();
    let end = step_through(&mut trajectory, again, again + profile.ticks());
    assert_eq!(
        end,
        Setpoint {
            position: place + Position::from_num(100),
            ..Setpoint::default()
        }
    );
}

#[test]
fn errors_say_what_to_do() {
    assert!(
        QueueError::Late
            .to_string()
            .contains("plan the move for a later one")
    );
    assert!(QueueError::Busy.to_string().contains("wait for its end"));
    assert!(QueueError::Disabled.to_string().contains("enable it first"));
}
