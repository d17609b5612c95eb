//! A standing error at rest: held by static friction, pushed against, let go in time.

use leadscrew::controller::rest::{Config, Rest, Standing, State, Verdict};

/// A full command, and static friction of a hundredth of it.
const FULL: f64 = (1_u64 << 30) as f64;
const HELD: f64 = 0.02;

fn config() -> Config {
    Config::new(&Rest {
        band: 1.0,
        held: HELD,
        lift_ticks: 50.0,
        delay_ticks: 2.5,
        per_jerk: 1.28,
    })
    .unwrap()
}

fn fixed(error_d: f64) -> i32 {
    (error_d * 65_536.0) as i32
}

fn standing(error_d: f64, verdict: Verdict) -> Standing {
    Standing {
        error: fixed(error_d),
        verdict,
        law: 0,
        held: (HELD * FULL) as i32,
        velocity: 0,
    }
}

#[test]
fn an_error_is_left_pushed_against_or_integrated_by_its_size() {
    let mut state = State::new();
    for (error, verdict) in [
        (0.9, Verdict::Within),
        (-1.0, Verdict::Within),
        (1.1, Verdict::Near),
        (15.9, Verdict::Near),
        (16.1, Verdict::Far),
    ] {
        assert_eq!(state.judge(&config(), fixed(error)), verdict, "{error}");
    }
    let unknown = Config::new(&Rest::default()).unwrap();
    assert_eq!(state.judge(&unknown, 1), Verdict::Far);
    assert!(!unknown.pushes());
}

#[test]
fn swings_from_side_to_side_widen_the_band_until_the_next_motion() {
    let mut state = State::new();
    let config = config();
    assert!(state.enter() && !state.enter());
    for error in [2.0, -2.0] {
        assert_eq!(state.judge(&config, fixed(error)), Verdict::Near);
    }
    assert_eq!(state.judge(&config, fixed(2.0)), Verdict::Near);
    assert_eq!(state.judge(&config, fixed(1.9)), Verdict::Within);
    assert!(state.leave() && !state.leave());
    assert_eq!(state.judge(&config, fixed(1.9)), Verdict::Near);
}

#[test]
fn a_push_rises_from_half_of_static_friction_to_a_bound() {
    for side in [1.0, -1.0] {
        let mut state = State::new();
        let standing = standing(3.0 * side, Verdict::Near);
        let mut pushed = Vec::new();
        for _ in 0..200 {
            pushed.push(side * state.push(&config(), &standing) as f64 / FULL);
        }
        assert!((pushed[0] - 0.5 * HELD).abs() < HELD / 40.0);
        assert!((pushed[25] - HELD).abs() < HELD / 40.0, "{}", pushed[25]);
        assert!((pushed[199] - 1.625 * HELD).abs() < 1e-6, "{}", pushed[199]);
    }
}

#[test]
fn it_takes_the_place_of_the_law_and_begins_where_that_stands() {
    let mut state = State::new();
    let law = (0.8 * HELD * FULL) as i32;
    let standing = Standing {
        law,
        ..standing(3.0, Verdict::Near)
    };
    let whole = law + state.push(&config(), &standing);
    assert!((whole as f64 / FULL - 0.8 * HELD).abs() < HELD / 40.0);
}

#[test]
fn it_lets_go_when_the_axis_would_come_to_rest_at_its_target() {
    let mut state = State::new();
    for _ in 0..40 {
        state.push(&config(), &standing(6.0, Verdict::Near));
    }
    // The first edge: the axis slips, and is pushed on as it is.
    state.note(1);
    let slipping = |error, velocity: f64| Standing {
        velocity: (velocity * (1 << 20) as f64) as i32,
        ..standing(error, Verdict::Near)
    };
    let held = state.push(&config(), &slipping(5.0, 0.1));
    assert_eq!(state.push(&config(), &slipping(4.0, 0.1)), held);
    // From 0.2 d/tick 0.5 d of delay and v²·64/(2·0.02·...) = 0.04·32 d: not yet at 3 d, but at 2.7 d, 1 d of it slack.
    state.note(1);
    assert_eq!(state.push(&config(), &slipping(3.0, 0.2)), held);
    assert_eq!(state.push(&config(), &slipping(2.7, 0.2)), 0);
    // It settles before it is judged again.
    for _ in 0..17 {
        assert_eq!(state.push(&config(), &standing(1.5, Verdict::Near)), 0);
    }
    assert_ne!(state.push(&config(), &standing(1.5, Verdict::Near)), 0);
}

#[test]
fn an_axis_that_is_held_again_is_pushed_on_and_four_pushes_are_enough_for_a_band() {
    let mut state = State::new();
    let config = config();
    for _ in 0..40 {
        state.push(&config, &standing(6.0, Verdict::Near));
    }
    state.note(1);
    let held = state.push(&config, &standing(5.0, Verdict::Near));
    for _ in 0..33 {
        assert_eq!(state.push(&config, &standing(5.0, Verdict::Near)), held);
    }
    assert!(state.push(&config, &standing(5.0, Verdict::Near)) > held);

    let mut state = State::new();
    for _ in 0..4 {
        assert_eq!(state.judge(&config, fixed(1.5)), Verdict::Near);
        state.push(&config, &standing(1.5, Verdict::Near));
        // It is within the band for a moment, and settles.
        for _ in 0..40 {
            state.push(&config, &standing(0.0, Verdict::Within));
        }
    }
    assert_eq!(state.judge(&config, fixed(1.5)), Verdict::Within);
}
