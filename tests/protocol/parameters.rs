//! Parameters over the link.

use leadscrew::parameter_table::ParameterTable;
use leadscrew::params::SectionVisitor;
use leadscrew::protocol::frame::{Channel, FrameBuffer, Header};
use leadscrew::protocol::parameters::{Which, parameter, write};
use leadscrew::protocol::refusal::Refusal;
use leadscrew::protocol::reply::Reply;
use leadscrew::protocol::request::Request;

use crate::rig::{Rig, Said, params};

struct Names(Vec<(String, f64)>);

impl SectionVisitor for Names {
    fn section<T: ParameterTable>(&mut self, section: &'static str, table: &mut T) {
        for field in T::FIELDS {
            self.0
                .push((format!("{section}.{}", field.name), (field.get)(table)));
        }
    }
}

#[test]
fn every_parameter_is_listed_found_by_its_name_and_fits_a_frame() {
    let mut params = params();
    let mut names = Names(Vec::new());
    params.visit_sections(&mut names);
    for (place, (name, expected)) in (0..).zip(&names.0) {
        let reply = parameter(&mut params, Which::At(place)).unwrap();
        let Reply::Parameter {
            index,
            count,
            section,
            name: field,
            value,
            ..
        } = reply
        else {
            panic!()
        };
        assert_eq!((index, usize::from(count)), (place, names.0.len()));
        assert_eq!(
            (format!("{section}.{field}"), value),
            (name.clone(), *expected)
        );
        assert_eq!(parameter(&mut params, Which::Named(name)).unwrap(), reply);
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
            parameter(&mut params, which),
            Err(Refusal::UnknownParameter)
        );
    }
}

#[test]
fn a_value_out_of_range_is_not_written() {
    let mut params = params();
    let before = params;
    for value in [-1.0, 1.5, f64::NAN, f64::INFINITY] {
        let refused = write(&mut params, Which::Named("output.limit"), value);
        assert_eq!(refused, Err(Refusal::ParameterOutOfRange));
        assert_eq!(params, before);
    }
    assert_eq!(
        write(&mut params, Which::Named("output.limit"), 0.5),
        Ok(before.output.limit)
    );
    assert_eq!(params.output.limit.to_bits(), 0.5_f64.to_bits());
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
    let kept = Said::Parameter(params().motion.max_feed_mm_per_min);
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
