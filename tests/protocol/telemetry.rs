//! Records of ticks on the telemetry channel.

use leadscrew::protocol::request::Request;

use crate::rig::Rig;

#[test]
fn records_come_as_they_were_subscribed_to_and_lost_ones_are_counted() {
    let mut rig = Rig::new();
    rig.hello();
    rig.do_(&Request::Subscribe { every: 1 });
    rig.run(50);
    let ticks: Vec<_> = rig.records.iter().map(|record| record.tick).collect();
    assert_eq!(ticks, (2..52).collect::<Vec<_>>());
    assert_eq!(rig.client.records_lost(), 0);

    // The line swallows what is on it for seven ticks.
    for _ in 0..7 {
        rig.step();
        rig.records.clear();
    }
    let record = *rig.way.axis.outputs();
    let record = leadscrew::telemetry::Record::new(&record);
    for _ in 0..5 {
        let _ = rig.service.record(&record);
        rig.service.note_record_lost();
    }
    rig.run(1);
    assert_eq!((rig.records.len(), rig.client.records_lost()), (1, 5));

    rig.do_(&Request::Subscribe { every: 10 });
    rig.records.clear();
    rig.run(100);
    let ticks: Vec<_> = rig.records.iter().map(|record| record.tick % 10).collect();
    assert_eq!(ticks, [ticks[0]; 10]);
    rig.do_(&Request::Subscribe { every: 0 });
    rig.records.clear();
    rig.run(20);
    assert!(rig.records.is_empty());
}

#[test]
fn records_end_with_their_session_and_count_anew_in_the_next() {
    let mut rig = Rig::new();
    rig.hello();
    rig.do_(&Request::Subscribe { every: 1 });
    rig.run(20);
    rig.hello();
    rig.records.clear();
    rig.run(20);
    assert!(rig.records.is_empty());
    rig.do_(&Request::Subscribe { every: 1 });
    rig.run(20);
    assert_eq!((rig.records.len(), rig.client.records_lost()), (20, 0));
}
