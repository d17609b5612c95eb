//! The map in the axis: tied while the loop runs, kept over a change of parameters.

use leadscrew::encoder_map::tie::{MapHealth, MapState};
use leadscrew::encoder_map::{EncoderMap, Form};
use leadscrew::estimator::EstimatorConfig;
use leadscrew_hal_mock::encoder::EncoderModel;
use leadscrew_hal_mock::machine::MachineParams;
use leadscrew_hal_mock::scenario::{MoveAndBack, Setup, Simulation};

use crate::content::Errors;

#[test]
fn a_move_there_and_back_ties_the_map_once_and_for_all() {
    let image = Errors::true_of(&EncoderModel::real(), 1).encode(Form::Full);
    let scenario = MoveAndBack {
        move_mm: 40.0,
        ..MoveAndBack::standard(1000.0)
    };
    let estimator = EstimatorConfig::by_name("exponential").unwrap().unwrap();
    let Setup {
        machine,
        mut axis,
        script,
    } = Setup::new(&scenario, &MachineParams::z_16k20f3(), estimator, 1).unwrap();
    assert_eq!(
        (axis.map_state(), axis.map_health()),
        (None, MapHealth::default())
    );
    axis.set_map(Some(EncoderMap::from_bytes(&image).unwrap()));
    assert_eq!(axis.map_state(), Some(MapState::Unfound));

    let mut simulation = Simulation::new(machine, axis, script);
    while simulation.step().unwrap().is_some() {}
    let mut axis = simulation.axis;
    let tied = (Some(MapState::Tied), MapHealth { ties: 1, slips: 0 });
    assert_eq!((axis.map_state(), axis.map_health()), tied);
    let config = *axis.config();
    axis.reconfigure(&config).unwrap();
    assert_eq!((axis.map_state(), axis.map_health()), tied);
    axis.set_map(None);
    assert_eq!(axis.map_state(), None);
}
