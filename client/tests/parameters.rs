//! Parameters by name, with what is said of a wrong one; records.

mod support;

use std::time::Duration;

use leadscrew::protocol::refusal::Refusal;
use leadscrew_client::{Axis, Error, Options, Value};
use support::BenchLine;

fn connected() -> Axis {
    BenchLine::new().open(Options::default())
}

#[test]
fn all_parameters_are_listed_with_their_ranges() {
    let mut axis = connected();
    let all = axis.parameters().unwrap();
    assert!(all.len() > 50, "{}", all.len());
    for parameter in &all {
        if let Value::Number {
            value, min, max, ..
        } = parameter.value
        {
            assert!((min..=max).contains(&value), "{parameter:?}");
        }
        assert_eq!(axis.parameter(&parameter.name).unwrap(), *parameter);
    }
    let feed = all
        .iter()
        .find(|one| one.name == "motion.max_feed_mm_per_min");
    assert_eq!(feed.unwrap().value.to_string(), "9000 mm/min");
    assert!(all.iter().any(|one| matches!(one.value, Value::Word(_))));
}

#[test]
fn a_parameter_is_set_while_the_axis_is_off() {
    let mut axis = connected();
    axis.set_parameter("motion.max_feed_mm_per_min", 6000.0)
        .unwrap();
    let feed = axis.parameter("motion.max_feed_mm_per_min").unwrap();
    assert_eq!(feed.number(), Some(6000.0));

    let error = axis
        .set_parameter("motion.max_fed_mm_per_min", 1.0)
        .unwrap_err();
    let text = error.to_string();
    assert!(
        text.contains("did you mean `motion.max_feed_mm_per_min`?"),
        "{text}"
    );
    let error = axis.parameter("quite something else").unwrap_err();
    assert!(
        matches!(&error, Error::UnknownParameter { nearest: None, .. }),
        "{error}"
    );
    for value in [1e9, -1.0, f64::NAN] {
        let error = axis
            .set_parameter("motion.max_feed_mm_per_min", value)
            .unwrap_err();
        let text = error.to_string();
        assert!(text.contains("0.000001 to 1000000 mm/min"), "{text}");
    }

    axis.enable().unwrap();
    let error = axis
        .set_parameter("motion.max_feed_mm_per_min", 5000.0)
        .unwrap_err();
    let text = error.to_string();
    assert!(
        text.starts_with("motion.max_feed_mm_per_min = 5000 mm/min was refused: The axis is on"),
        "{text}"
    );
    let error = axis.move_to(1.0, 7000.0).unwrap_err();
    assert!(error.to_string().contains("is 6000 mm/min"), "{error}");
}

#[test]
fn words_are_set_as_words() {
    let mut axis = connected();
    let all = axis.parameters().unwrap();
    let name = &all
        .iter()
        .find(|one| matches!(one.value, Value::Word(_)))
        .unwrap()
        .name;
    let Value::Word(word) = axis.parameter(name).unwrap().value else {
        panic!();
    };
    axis.set_word(name, &word).unwrap();
    let error = axis.set_word(name, "no such word").unwrap_err();
    assert_eq!(error.refusal(), Some(Refusal::UnknownWord));
    let error = axis.set_parameter(name, 1.0).unwrap_err();
    assert_eq!(error.refusal(), Some(Refusal::WrongType));
}

#[test]
fn an_edit_is_taken_as_a_whole_or_not_at_all() {
    let mut axis = connected();
    let travel = |axis: &mut Axis| {
        let of = |axis: &mut Axis, name| axis.parameter(name).unwrap().number().unwrap();
        (
            of(axis, "motion.travel_low_mm"),
            of(axis, "motion.travel_high_mm"),
        )
    };
    // Each by itself would be refused: low above high.
    axis.edit_parameters(|axis| {
        axis.set_parameter("motion.travel_low_mm", 100.0)?;
        axis.set_parameter("motion.travel_high_mm", 400.0)
    })
    .unwrap();
    assert_eq!(travel(&mut axis), (100.0, 400.0));
    let error = axis.edit_parameters(|axis| axis.set_parameter("motion.travel_low_mm", 500.0));
    assert_eq!(error.unwrap_err().refusal(), Some(Refusal::Inconsistent));
    assert_eq!(travel(&mut axis), (100.0, 400.0));
    let error = axis.edit_parameters(|axis| {
        axis.set_parameter("motion.travel_low_mm", 200.0)?;
        axis.set_parameter("motion.no_such", 1.0)
    });
    assert!(matches!(error, Err(Error::UnknownParameter { .. })));
    assert_eq!(travel(&mut axis), (100.0, 400.0));
}

#[test]
fn records_come_in_order_and_what_is_lost_is_counted() {
    let line = BenchLine::new();
    let mut axis = line.open(Options::default());
    axis.subscribe(10).unwrap();
    axis.enable().unwrap();
    let mut records = axis.records(Duration::from_millis(50));
    let ticks: Vec<_> = records
        .by_ref()
        .take(100)
        .map(|record| record.unwrap().tick)
        .collect();
    assert!(
        ticks.windows(2).all(|pair| pair[1] == pair[0] + 10),
        "{ticks:?}"
    );
    assert_eq!(records.lost(), 0);
    // The bench runs on while nobody listens, 30 records long.
    line.run(300);
    let mut records = axis.records(Duration::from_millis(50));
    let _ = records.nth(3);
    assert_eq!(records.lost(), 30);
    axis.subscribe(0).unwrap();
    let left = axis.records(Duration::from_millis(50)).count();
    assert!(left < 10, "{left}");
}
