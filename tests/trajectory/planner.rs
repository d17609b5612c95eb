//! The operator's side: orders at any tick, every tick of what comes of them, and exact arrival.

use leadscrew::setpoint::Setpoint;
use leadscrew::setpoint::limits::Limits;
use leadscrew::setpoint::planner::{Planner, PlannerError, Timed};
use leadscrew::setpoint::trajectory::Trajectory;
use leadscrew::setpoint::travel::TravelLimits;
use leadscrew::units::{Position, Velocity};
use proptest::prelude::*;

use crate::seeded::seeded;

/// Ticks from an order to the start of its plan.
const LEAD: u32 = 3;

fn limits() -> Limits {
    Limits::new(50.0, 0.9, 0.06).unwrap()
}

fn travel() -> TravelLimits {
    TravelLimits::new(Position::from_num(-20_000), Position::from_num(20_000)).unwrap()
}

/// A planner and the trajectory that follows its plans.
struct Bench {
    planner: Planner,
    trajectory: Trajectory,
    now: u32,
    last: Setpoint,
}

impl Bench {
    fn new(first_tick: u32) -> Self {
        let mut trajectory = Trajectory::new();
        let last = trajectory.step(first_tick);
        let mut planner = Planner::new(limits(), Position::ZERO, first_tick);
        planner.set_travel(Some(travel()));
        Self {
            planner,
            trajectory,
            now: first_tick,
            last,
        }
    }

    fn start(&self) -> u32 {
        self.now.wrapping_add(LEAD)
    }

    fn queue(&mut self, timed: Option<Timed>) {
        if let Some(Timed { plan, start }) = timed {
            self.trajectory.queue(&plan, start, self.now).unwrap();
        }
    }

    fn run(&mut self, ticks: u32) {
        for _ in 0..ticks {
            self.now = self.now.wrapping_add(1);
            let next = self.trajectory.step(self.now);
            check_tick(&self.last, &next);
            assert_eq!(self.planner.state_at(self.now).position(), next.position);
            self.last = next;
        }
    }

    fn finish(&mut self) {
        let left = self.planner.end_tick().wrapping_sub(self.now).cast_signed();
        assert!(left < 100_000, "{left} ticks");
        self.run(left.max(0).cast_unsigned() + 2);
        self.planner.pass(self.now);
        assert!(!self.trajectory.is_moving());
        assert_eq!(self.trajectory.dropped(), 0);
    }
}

fn check_tick(last: &Setpoint, next: &Setpoint) {
    let limits = limits();
    assert!(next.velocity.abs() <= limits.velocity(), "{next:?}");
    assert!(next.acceleration.abs() <= limits.acceleration(), "{next:?}");
    assert!(next.jerk.abs() <= limits.jerk(), "{next:?}");
    let bend = (next.acceleration - last.acceleration).to_num::<f64>();
    assert!(
        (bend - last.jerk.to_num::<f64>()).abs() < 6.2e-8,
        "{last:?} {next:?}"
    );
    assert!(travel().contains(next.position), "{next:?}");
}

#[derive(Clone, Copy, Debug)]
enum Order {
    Move(i32, f64),
    Jog(f64),
    Stop,
    Hold,
    Resume,
    Override(u16),
}

fn order() -> impl Strategy<Value = Order> {
    prop_oneof![
        (-20_000..=20_000_i32, 0.001..80.0_f64)
            .prop_map(|(target, feed)| Order::Move(target, feed)),
        (-60.0..60.0_f64).prop_map(Order::Jog),
        Just(Order::Stop),
        Just(Order::Hold),
        Just(Order::Resume),
        (0..=200_u16).prop_map(Order::Override),
    ]
}

proptest! {
    #![proptest_config(seeded(200))]

    #[test]
    fn any_orders_at_any_ticks_keep_limits_and_travel_and_the_last_target_is_met_exactly(
        first_tick in prop_oneof![Just(0), Just(u32::MAX - 500)],
        orders in prop::collection::vec((order(), LEAD..400_u32), 1..25),
        target in -20_000..=20_000_i32,
    ) {
        let mut bench = Bench::new(first_tick);
        for (order, ticks) in orders {
            let start = bench.start();
            let planner = &mut bench.planner;
            let timed = match order {
                Order::Move(target, feed) => planner.move_to(Position::from_num(target), Velocity::from_num(feed), start),
                Order::Jog(velocity) => planner.jog(Velocity::from_num(velocity), start),
                Order::Stop => planner.stop(start),
                Order::Hold => planner.hold(start),
                Order::Resume => planner.resume(start),
                Order::Override(percent) => planner.set_override(percent, start),
            };
            bench.queue(timed.unwrap());
            bench.run(ticks);
        }
        let start = bench.start();
        let timed = bench.planner.resume(start).unwrap();
        bench.queue(timed);
        bench.run(LEAD);
        let start = bench.start();
        let timed = bench.planner.set_override(100, start).unwrap();
        bench.queue(timed);
        bench.run(LEAD);
        let target = Position::from_num(target);
        let timed = bench.planner.move_to(target, Velocity::from_num(50), bench.start()).unwrap();
        bench.queue(timed);
        bench.finish();
        prop_assert_eq!(bench.last, Setpoint { position: target, ..Setpoint::default() });
    }
}

#[test]
fn a_hold_stops_in_the_middle_and_a_resume_goes_on_to_the_target() {
    let mut bench = Bench::new(0);
    let target = Position::from_num(10_000);
    let timed = bench
        .planner
        .move_to(target, Velocity::from_num(40), bench.start())
        .unwrap();
    bench.queue(timed);
    bench.run(100);
    let timed = bench.planner.hold(bench.start()).unwrap();
    bench.queue(timed);
    bench.finish();
    assert!(bench.planner.is_held() && bench.planner.target() == Some(target));
    let held = bench.last.position;
    assert!(held > 1000 && held < 6000, "{held}");

    // While held an override is only remembered.
    assert_eq!(bench.planner.set_override(50, bench.start()), Ok(None));
    bench.run(10);
    let timed = bench.planner.resume(bench.start()).unwrap();
    bench.queue(timed);
    bench.run(200);
    assert!(
        (bench.last.velocity.to_num::<f64>() - 20.0).abs() < 0.1,
        "{:?}",
        bench.last
    );
    bench.finish();
    assert_eq!(bench.last.position, target);
}

#[test]
fn an_override_changes_the_velocity_up_to_the_limit_and_zero_stops() {
    let mut bench = Bench::new(0);
    let target = Position::from_num(20_000);
    let timed = bench
        .planner
        .move_to(target, Velocity::from_num(30), bench.start())
        .unwrap();
    bench.queue(timed);
    bench.run(100);
    for (percent, velocity) in [(200, 50.0), (10, 3.0), (0, 0.0), (100, 30.0)] {
        let timed = bench.planner.set_override(percent, bench.start()).unwrap();
        bench.queue(timed);
        bench.run(120);
        let seen = bench.last.velocity.to_num::<f64>();
        // A cruise of whole ticks is a little slower.
        assert!(
            (seen - velocity).abs() <= 0.004 * velocity,
            "{percent} %: {seen}"
        );
    }
    bench.finish();
    assert_eq!(bench.last.position, target);
}

#[test]
fn a_jog_ends_at_the_limit_of_travel_or_where_it_is_released() {
    let mut bench = Bench::new(0);
    let timed = bench
        .planner
        .jog(Velocity::from_num(-45), bench.start())
        .unwrap();
    bench.queue(timed);
    bench.finish();
    assert_eq!(bench.last.position, travel().low());
    let timed = bench
        .planner
        .jog(Velocity::from_num(10), bench.start())
        .unwrap();
    bench.queue(timed);
    bench.run(300);
    assert!((bench.last.velocity.to_num::<f64>() - 10.0).abs() < 0.01);
    let timed = bench.planner.jog(Velocity::ZERO, bench.start()).unwrap();
    bench.queue(timed);
    bench.run(60);
    assert_eq!(bench.last.velocity, Velocity::ZERO);
}

#[test]
fn what_cannot_be_done_is_refused_with_figures_and_changes_nothing() {
    let mut planner = Planner::new(limits(), Position::ZERO, 5);
    planner.set_travel(Some(travel()));
    let feed = Velocity::from_num(10);
    let beyond = planner
        .move_to(Position::from_num(20_001), feed, 10)
        .unwrap_err();
    assert_eq!(
        beyond.to_string(),
        "the target 20001 d is beyond the soft limits -20000 to 20000 d: choose one within"
    );
    let percent = planner.set_override(201, 10).unwrap_err();
    assert_eq!(
        percent.to_string(),
        "an override of 201 % is out of range: allowed 0 to 200 %"
    );
    planner.move_to(Position::from_num(100), feed, 10).unwrap();
    let early = planner
        .move_to(Position::from_num(50), feed, 10)
        .unwrap_err();
    assert_eq!(
        early,
        PlannerError::TooEarly {
            start: 10,
            last: 10
        }
    );
    assert_eq!(planner.target(), Some(Position::from_num(100)));

    // The axis took the second plan too late: it goes on by the first.
    planner.move_to(Position::from_num(50), feed, 20).unwrap();
    planner.withdraw();
    assert_eq!(planner.target(), Some(Position::from_num(100)));
    assert_eq!(planner.state_at(500).position(), Position::from_num(100));
}
