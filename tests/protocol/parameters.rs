//! Parameters over the link.

use leadscrew::estimator::paths::Choice;
use leadscrew::protocol::frame::{Channel, FrameBuffer, Header};
use leadscrew::protocol::parameters::{NewValue, Which, parameter, write};
use leadscrew::protocol::refusal::Refusal;
use leadscrew::protocol::reply::Reply;
use leadscrew::protocol::request::Request;
use leadscrew::settings::{Key, Number, Values};

use crate::rig::{Rig, Said, settings};

/// Names of all, numbers with their values.
#[derive(Default)]
struct Names(Vec<(String, Option<f64>)>);

impl Values for Names {
    fn number(&mut self, key: Key, _: &Number, value: f64) -> f64 {
        self.0.push((key.to_string(), Some(value)));
        value
    }

    fn word(&mut self, key: Key, _: &[&'static str], value: &'static str) -> &'static str {
        self.0.push((key.to_string(), None));
        value
    }
}

#[test]
fn every_parameter_is_listed_found_by_its_name_and_fits_a_frame() {
    let mut settings = settings();
    let mut names = Names::default();
    settings.visit(&mut names);
    for (place, (name, expected)) in (0..).zip(&names.0) {
        let reply = parameter(&mut settings, Which::At(place)).unwrap();
        let (told, found, told_count, told_value) = match reply {
            Reply::Parameter {
                index,
                count,
                section,
                name,
                value,
                ..
            } => (index, [section, name], count, Some(value)),
            Reply::Word {
                index,
                count,
                section,
                name,
                ..
            } => (index, [section, name], count, None),
            _ => panic!(),
        };
        assert_eq!((told, usize::from(told_count)), (place, names.0.len()));
        let found = found.join(".");
        assert_eq!(found.trim_start_matches('.'), name);
        assert_eq!(told_value, *expected);
        assert_eq!(parameter(&mut settings, Which::Named(name)).unwrap(), reply);
        let header = Header {
            channel: Channel::Reply,
            session: 1,
            sequence: 1,
        };
        assert!(FrameBuffer::default().message(header, &reply).is_ok());
    }
    let beyond = Which::At(names.0.len() as u16);
    for which in [
        beyond,
        Which::At(u16::MAX),
        Which::Named("output"),
        Which::Named(""),
        Which::Named("output.limit.x"),
    ] {
        assert_eq!(
            parameter(&mut settings, which),
            Err(Refusal::UnknownParameter)
        );
    }
}

#[test]
fn a_value_out_of_range_is_not_written() {
    let mut settings = settings();
    let before = settings;
    for value in [-1.0, 1.5, f64::NAN, f64::INFINITY] {
        let refused = write(
            &mut settings,
            Which::Named("output.limit"),
            NewValue::Number(value),
        );
        assert_eq!(refused, Err(Refusal::ParameterOutOfRange));
        assert_eq!(settings, before);
    }
    assert_eq!(
        write(
            &mut settings,
            Which::Named("output.limit"),
            NewValue::Number(0.5)
        ),
        Ok(())
    );
    assert_eq!(settings.axis.output.limit.to_bits(), 0.5_f64.to_bits());
    for (name, value, refusal) in [
        ("output.limit", NewValue::Word("full"), Refusal::WrongType),
        ("estimator", NewValue::Number(1.0), Refusal::WrongType),
        ("estimator", NewValue::Word("best"), Refusal::UnknownWord),
    ] {
        let refused = write(&mut settings, Which::Named(name), value);
        assert_eq!(refused, Err(refusal));
    }
}

#[test]
fn a_parameter_is_set_over_the_line_all_of_it_or_nothing() {
    let mut rig = Rig::new();
    rig.hello();
    rig.do_(&Request::TakeLease {});
    let before = *rig.way.axis.config();
    let set = |name, value| Request::SetParameter { name, value };
    rig.refused(&set("motion.max_feed", 1.0), Refusal::UnknownParameter);
    rig.refused(
        &set("motion.max_feed_mm_per_min", 1e7),
        Refusal::ParameterOutOfRange,
    );
    // More than the drive's full command gives.
    rig.refused(
        &set("motion.max_feed_mm_per_min", 1e5),
        Refusal::Inconsistent,
    );
    let name = "motion.max_feed_mm_per_min";
    let kept = Said::Parameter(settings().axis.motion.max_feed_mm_per_min);
    assert_eq!(rig.ask(&Request::Parameter { name }), kept);
    assert_eq!(*rig.way.axis.config(), before);
    rig.do_(&set("motion.max_feed_mm_per_min", 3000.0));
    assert!(rig.way.axis.config().limits.velocity() < before.limits.velocity());
    rig.refused(&set("motion.travel_low_mm", 5.0), Refusal::Inconsistent);

    rig.enabled();
    rig.refused(&Rig::move_to(5), Refusal::FeedOutOfRange);
    let slow = Request::Move {
        target_nm: 5_000_000,
        feed_um_per_min: 3_000_000,
    };
    rig.do_(&slow);
    rig.run(500);
    let Said::Status { setpoint_nm, .. } = rig.ask(&Request::Status {}) else {
        panic!()
    };
    assert_eq!(setpoint_nm, 5_000_000);
}

#[test]
fn an_edit_is_taken_as_a_whole_or_not_at_all() {
    let mut rig = Rig::new();
    rig.hello();
    rig.do_(&Request::TakeLease {});
    let before = *rig.way.axis.config();
    let set = |name, value| Request::SetParameter { name, value };
    rig.refused(&Request::TakeParameters {}, Refusal::NoEdit);
    rig.do_(&Request::EditParameters {});
    // Alone it does not go with the feed at full command.
    rig.do_(&set("motion.max_feed_mm_per_min", 20_000.0));
    rig.refused(&Request::TakeParameters {}, Refusal::Inconsistent);
    rig.do_(&set("motion.full_command_feed_mm_per_min", 24_000.0));
    assert_eq!(*rig.way.axis.config(), before);
    rig.do_(&Request::TakeParameters {});
    assert!(rig.way.axis.config().limits.velocity() > before.limits.velocity());
    let taken = *rig.way.axis.config();
    rig.do_(&Request::EditParameters {});
    rig.do_(&set("motion.max_feed_mm_per_min", 1000.0));
    rig.do_(&Request::DropParameters {});
    rig.refused(&Request::TakeParameters {}, Refusal::NoEdit);
    assert_eq!(*rig.way.axis.config(), taken);
}

#[test]
fn an_estimator_is_chosen_by_its_name_and_made_of_its_parameters() {
    let mut rig = Rig::new();
    rig.hello();
    rig.do_(&Request::TakeLease {});
    let word = |name, word| Request::SetWord { name, word };
    rig.do_(&Request::SetParameter {
        name: "observer.natural_period_s",
        value: 0.12,
    });
    rig.do_(&word("estimator", "observer"));
    rig.do_(&word("paths.position", "estimate"));
    let settings = *rig.service.settings();
    assert_eq!(settings.axis.estimator.name(), "observer");
    let of_parameters = settings.estimator("observer").unwrap();
    assert_eq!(Some(settings.axis.estimator), of_parameters);
    let in_force = rig.way.axis.config().estimators;
    assert_eq!(*in_force.of(Choice::First), settings.axis.estimator);
    rig.refused(&word("estimator", "obsrver"), Refusal::UnknownWord);
}

#[test]
fn another_control_rate_waits_for_a_restart() {
    let mut rig = Rig::new();
    rig.hello();
    rig.do_(&Request::TakeLease {});
    let before = *rig.way.axis.config();
    let rate = |value| Request::SetParameter {
        name: "tick_hz",
        value,
    };
    rig.do_(&rate(2500.0));
    assert_eq!(*rig.way.axis.config(), before);
    rig.refused(&Request::Enable {}, Refusal::RestartNeeded);
    rig.do_(&rate(1000.0));
    rig.do_(&Request::Enable {});
}

#[test]
fn what_the_inputs_cannot_follow_is_refused_and_what_they_could_waits_for_a_restart() {
    let mut rig = Rig::new();
    rig.hello();
    rig.do_(&Request::TakeLease {});
    rig.way.followed = Some((10_000.0, 20_000.0));
    let feed = |value| Request::SetParameter {
        name: "motion.full_command_feed_mm_per_min",
        value,
    };
    let before = *rig.service.settings();
    rig.refused(&feed(20_001.0), Refusal::TooFastForInputs);
    assert_eq!(*rig.service.settings(), before);
    rig.do_(&feed(20_000.0));
    rig.refused(&Request::Enable {}, Refusal::RestartNeeded);
    rig.do_(&feed(9_999.0));
    rig.do_(&Request::Enable {});
}
