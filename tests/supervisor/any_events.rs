//! Any sequence of events: no panic, and the invariants hold in every tick.

use leadscrew::supervisor::Fault;
use leadscrew::units::Command;
use leadscrew_hal_mock::board::{Converter, DriveHealth};
use leadscrew_hal_mock::faults::{Bursts, Channel, Fault as EncoderFault};
use proptest::prelude::*;

use crate::rig::{Plan, Rig};
use crate::seeded::seeded;

#[derive(Clone, Debug)]
enum Event {
    Run(u32),
    Enable(bool),
    Go(f64),
    Clear,
    Report(usize),
    Store(bool),
    EmergencyStop(bool),
    EncoderLost(bool),
    Reversed(bool, bool),
    Drive(u8),
    Converter(u8),
    Encoder(u8),
    Miss(u16),
    Reconfigure(f64),
}

fn event() -> impl Strategy<Value = Event> {
    let rare = prop::bool::weighted(0.4);
    prop_oneof![
        8 => (1..400_u32).prop_map(Event::Run),
        4 => prop::bool::weighted(0.7).prop_map(Event::Enable),
        5 => (-50.0..50.0_f64).prop_map(Event::Go),
        4 => Just(Event::Clear),
        1 => (0..Fault::ALL.len()).prop_map(Event::Report),
        1 => prop::bool::weighted(0.3).prop_map(Event::Store),
        1 => rare.prop_map(Event::EmergencyStop),
        1 => prop::bool::weighted(0.4).prop_map(Event::EncoderLost),
        1 => (prop::bool::weighted(0.2), prop::bool::weighted(0.2)).prop_map(|(d, e)| Event::Reversed(d, e)),
        1 => (0..4_u8).prop_map(Event::Drive),
        1 => (0..6_u8).prop_map(Event::Converter),
        2 => (0..8_u8).prop_map(Event::Encoder),
        1 => (0..5_u16).prop_map(Event::Miss),
        1 => (0.05..5.0_f64).prop_map(Event::Reconfigure),
    ]
}

fn happen(rig: &mut Rig, plan: &Plan, event: &Event) {
    match *event {
        Event::Run(ticks) => _ = rig.run(ticks),
        Event::Enable(enable) => rig.enable = enable,
        Event::Go(distance) => _ = rig.try_to_go(distance),
        Event::Clear => _ = rig.clear(),
        Event::Report(number) => rig.axis.supervisor_mut().report(Fault::ALL[number]),
        Event::Store(corrupt) => rig.axis.supervisor_mut().set_store_corrupt(corrupt),
        Event::EmergencyStop(open) => rig.board.trouble.emergency_stop = open,
        Event::EncoderLost(lost) => rig.board.trouble.encoder_lost = lost,
        Event::Reversed(drive, encoder) => {
            rig.board.trouble.drive_reversed = drive;
            rig.board.trouble.encoder_reversed = encoder;
        }
        Event::Drive(health) => {
            rig.board.trouble.drive = match health {
                0 => DriveHealth::NeverReady,
                1 => DriveHealth::Faulty,
                _ => DriveHealth::Good,
            };
        }
        Event::Converter(kind) => {
            rig.board.trouble.converter = match kind {
                0 => Converter::Stuck(Command::lit("0.3")),
                1 => Converter::OffBy(Command::lit("-0.1")),
                _ => Converter::Good,
            };
        }
        Event::Encoder(kind) => {
            let bursts = Bursts::at(300.0, 84e6);
            let fault = match kind {
                0 => EncoderFault::IllegalTransitions(bursts),
                1 => EncoderFault::FalseEdges(bursts),
                2 => EncoderFault::LostEdges { every: 100 },
                3 => EncoderFault::DeadChannel(Channel::B),
                4 => EncoderFault::LineLoss,
                _ => EncoderFault::Overrun { kept: 10 },
            };
            rig.board.break_encoder(fault, 0..200).unwrap();
        }
        Event::Miss(ticks) => rig.board.miss(ticks),
        Event::Reconfigure(error_mm) => {
            let mut params = plan.axis_params();
            params.supervisor.following_error_mm = error_mm;
            // Refused in motion where it would move the axis.
            let _ = rig.axis.reconfigure(&params.validate().unwrap());
        }
    }
}

proptest! {
    #![proptest_config(seeded(200))]

    #[test]
    fn for_any_sequence_of_events_the_invariants_hold(
        events in prop::collection::vec(event(), 5..60),
        vertical in any::<bool>(),
    ) {
        let mut plan = Plan::full();
        plan.board.switches.limit_low_mm = -40.0;
        plan.board.switches.limit_high_mm = 40.0;
        if vertical {
            plan.board.brake.fitted = 1.0;
            plan.board.brake.load_m_s2 = -5.0;
            plan.supervisor.hold_before_release_s = 0.05;
            plan.supervisor.brake_delay_s = 0.06;
        }
        let mut rig = plan.rig();
        for event in &events {
            happen(&mut rig, &plan, event);
        }
    }
}
