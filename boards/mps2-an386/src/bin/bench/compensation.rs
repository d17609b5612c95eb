//! What compensation costs: at full speed there and back over a whole table, with backlash.

use board_mps2_an386::instructions::Counter;
use leadscrew::compensation::{Compensation, CompensationParams, ScrewPoint, ScrewTable, Stretch};
use leadscrew::setpoint::Setpoint;
use leadscrew::setpoint::profile::Limits;
use leadscrew::units::{AxisScale, Position, RangeError, Velocity};
use static_cell::ConstStaticCell;

use crate::samples::Samples;

const POINTS: usize = 128;
/// From point to point, d.
const SPACING: i64 = 2000;
/// Full speed, d/tick.
const SPEED: i64 = 148;

static MEMORY: ConstStaticCell<[Stretch; POINTS]> = ConstStaticCell::new([Stretch::EMPTY; POINTS]);
static SAMPLES: ConstStaticCell<Samples> = ConstStaticCell::new(Samples::of("compensation"));

pub fn run(counter: &mut Counter) -> Result<(), RangeError> {
    let params = CompensationParams {
        backlash_mm: 0.003,
        screw_table: 1.0,
        ..CompensationParams::default()
    };
    let limits = Limits::new(150.0, 0.9, 0.01)?;
    let config = params.quantise(AxisScale::new(1000.0, 1000.0)?, &limits)?;
    let mut points = [ScrewPoint::default(); POINTS];
    for (at, point) in points.iter_mut().enumerate() {
        point.position = Position::from_num(at as i64 * SPACING);
        point.error =
            [Position::from_num(at % 3), Position::from_num(at % 2)].map(|error| error.to_num());
    }
    let table = ScrewTable::build(&points, MEMORY.take()).expect("the points are in order");
    let mut compensation = Compensation::new(config);
    compensation
        .set_table(Some(table))
        .expect("it is flat enough");
    compensation.set_origin(Some(Position::ZERO));
    let samples = SAMPLES.take();
    let travel = POINTS as i64 * SPACING;
    let there = (0..travel).step_by(SPEED as usize).map(|at| (at, SPEED));
    let back = (0..travel)
        .rev()
        .step_by(SPEED as usize)
        .map(|at| (at, -SPEED));
    for (position, velocity) in there.chain(back) {
        let commanded = Setpoint {
            position: Position::from_num(position),
            velocity: Velocity::from_num(velocity),
            ..Setpoint::default()
        };
        samples.push(counter.count(|| compensation.step(&commanded)));
    }
    samples.log("compensation");
    Ok(())
}
