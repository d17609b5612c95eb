//! The sign of it all: an axis with a known error and play, measured, its table given to the core's compensation, ends where it was
//! told to.

use leadscrew::compensation::{Compensation, CompensationParams, ScrewTable, Stretch};
use leadscrew::setpoint::Setpoint;
use leadscrew::setpoint::profile::Limits;
use leadscrew::units::{AxisScale, Position, Velocity};
use leadscrew_process::axis_calibration::{Calibration, Direction, ErrorTable, Expansion, Runs};

use crate::{assert_near, runs_of};

const COUNTS_PER_MM: f64 = 1000.0;
const BACKLASH_UM: f64 = 6.0;

/// Where the carriage is with the encoder at `encoder_mm`, having come there that way, mm.
fn carriage(encoder_mm: f64, direction: Direction) -> f64 {
    let play = if direction == Direction::Up {
        -0.5
    } else {
        0.5
    };
    let error_um =
        30.0 * encoder_mm / 1000.0 + 4.0 * (encoder_mm / 60.0).sin() + play * BACKLASH_UM;
    encoder_mm + error_um / 1000.0
}

/// An axis that goes where its compensation sends it.
struct SimulatedAxis<'m> {
    compensation: Compensation<'m>,
    at_mm: f64,
}

impl<'m> SimulatedAxis<'m> {
    fn new(table: Option<ScrewTable<'m>>) -> Self {
        let scale = AxisScale::new(COUNTS_PER_MM, 1000.0).unwrap();
        let limits = Limits::new(150.0, 1.0, 0.01).unwrap();
        let params = CompensationParams {
            screw_table: 1.0,
            ..CompensationParams::default()
        };
        let mut compensation = Compensation::new(params.quantise(scale, &limits).unwrap());
        compensation.set_table(table).unwrap();
        compensation.set_origin(Some(Position::ZERO));
        compensation.rest_at(Position::ZERO);
        Self {
            compensation,
            at_mm: 0.0,
        }
    }

    /// Goes to a place and stands; where the carriage is then, mm.
    fn go_to(&mut self, place_mm: f64) -> f64 {
        let direction = if place_mm > self.at_mm {
            Direction::Up
        } else {
            Direction::Down
        };
        let step_mm = 0.1;
        let ticks = ((place_mm - self.at_mm).abs() / step_mm).ceil();
        let velocity = (place_mm - self.at_mm) / ticks;
        let mut encoder = Position::ZERO;
        let mut tick = |compensation: &mut Compensation<'_>, place_mm: f64, velocity_mm: f64| {
            let setpoint = Setpoint {
                position: Position::from_num(place_mm * COUNTS_PER_MM),
                velocity: Velocity::from_num(velocity_mm * COUNTS_PER_MM),
                ..Setpoint::default()
            };
            encoder = compensation.step(&setpoint).position;
        };
        for at in 1..=ticks as u32 {
            tick(
                &mut self.compensation,
                self.at_mm + velocity * f64::from(at),
                velocity,
            );
        }
        for _ in 0..3000 {
            tick(&mut self.compensation, place_mm, 0.0);
        }
        self.at_mm = place_mm;
        carriage(encoder.to_num::<f64>() / COUNTS_PER_MM, direction)
    }

    /// Five runs there and back over targets.
    fn measure(&mut self, targets: &[f64]) -> Runs {
        let mut runs = runs_of(targets, 5, |_, _, _| 0.0);
        for reading in &mut runs.readings {
            let run_up = if reading.direction == Direction::Up {
                -1.0
            } else {
                1.0
            };
            self.go_to(reading.target_mm + run_up);
            reading.deviation_um = 1000.0 * (self.go_to(reading.target_mm) - reading.target_mm);
        }
        runs
    }
}

fn figures(runs: &Runs) -> Calibration {
    Calibration::of(runs, &Expansion::default(), true).unwrap()
}

#[test]
fn an_axis_with_the_table_written_of_its_errors_ends_at_the_right_place() {
    let targets: Vec<f64> = (0..24).map(|at| 3.0 + 13.7 * f64::from(at)).collect();
    let before = figures(&SimulatedAxis::new(None).measure(&targets));
    assert_near(before.axis.mean_reversal_um, -BACKLASH_UM, 0.01);
    assert!(before.axis.accuracy_um > 12.0, "{:?}", before.axis);
    // By the file that is written, as a user does.
    let file = ErrorTable::of(&before).to_csv();
    let points = ErrorTable::read(&file)
        .unwrap()
        .to_screw(COUNTS_PER_MM)
        .unwrap();
    let mut memory = vec![Stretch::EMPTY; points.len()];
    let table = ScrewTable::build(&points, &mut memory).unwrap();
    // At the table's points, and between them, where the wave is met to A·(h/60 mm)²/8.
    let at_points = figures(&SimulatedAxis::new(Some(table)).measure(&targets));
    assert!(at_points.axis.accuracy_um < 0.05, "{:?}", at_points.axis);
    let between: Vec<f64> = (0..23).map(|at| 9.0 + 13.7 * f64::from(at)).collect();
    let after = figures(&SimulatedAxis::new(Some(table)).measure(&between));
    assert!(
        after.axis.accuracy_um < 0.1 && after.axis.reversal_um < 0.05,
        "{:?}",
        after.axis
    );
}

#[test]
fn the_other_sign_doubles_the_error() {
    let targets: Vec<f64> = (0..6).map(|at| 3.0 + 13.7 * f64::from(at)).collect();
    let before = figures(&SimulatedAxis::new(None).measure(&targets));
    let mut wrong = ErrorTable::of(&before);
    for point in &mut wrong.points {
        point.error_um = point.error_um.map(|error| -error);
    }
    let points = wrong.to_screw(COUNTS_PER_MM).unwrap();
    let mut memory = vec![Stretch::EMPTY; points.len()];
    let table = ScrewTable::build(&points, &mut memory).unwrap();
    let after = figures(&SimulatedAxis::new(Some(table)).measure(&targets));
    assert_near(
        after.axis.systematic_um,
        2.0 * before.axis.systematic_um,
        0.05,
    );
}
