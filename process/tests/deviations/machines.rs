//! The built-in machines, and random ones of their arrangement.

use leadscrew_nc::coordinates::Coordinates;
use leadscrew_process::deviations::{BUILT_IN, Law, Machine, SettingVector, Table, built_in, read};
use proptest::prelude::*;

/// The built-in machine of that name.
pub fn machine(name: &str) -> Machine {
    read(built_in(name).expect("built in"))
        .expect("a good file")
        .machine
}

/// A built-in machine by number, without deviations.
pub fn bare(number: usize) -> Machine {
    machine(BUILT_IN[number].0).perfect()
}

/// A trunnion that carries a rotary table, under three slides: the table's own deviations go round with the trunnion.
const FIVE_AXES: &str = r#"
name = "five axes"
origin = "of the tests"
drive_errors = "included"
tool_mm = [0.0, 0.0, -120.0]
[[workpiece]]
name = "trunnion"
axis = "A"
rotary = "-x"
range_deg = [-110.0, 110.0]
frame_mm = [0.0, 50.0, -30.0]
[[workpiece]]
name = "table"
axis = "C"
rotary = "-z"
range_deg = [0.0, 360.0]
frame_mm = [0.0, -20.0, 60.0]
[[tool]]
name = "portal"
axis = "Y"
linear = "+y"
range_mm = [-200.0, 200.0]
frame_mm = [-300.0, 0.0, 500.0]
[[tool]]
name = "carriage"
axis = "X"
linear = "+x"
range_mm = [-250.0, 250.0]
frame_mm = [300.0, 0.0, 0.0]
[[tool]]
name = "ram"
axis = "Z"
linear = "+z"
range_mm = [-200.0, 100.0]
frame_mm = [0.0, -100.0, -150.0]
"#;

/// A machine with two rotary axes, one on the other, without deviations.
pub fn five_axes() -> Machine {
    read(FIVE_AXES).expect("a good file").machine
}

/// Setting vectors with shifts and turns up to these.
pub fn settings(shift_mm: f64, turn: f64) -> impl Strategy<Value = SettingVector> {
    let shift = prop::array::uniform3(-shift_mm..=shift_mm);
    let turn = prop::array::uniform3(-turn..=turn);
    (shift, turn).prop_map(|(a, b)| SettingVector::new([a[0], a[1], a[2], b[0], b[1], b[2]]))
}

/// A place within the ends of a machine's axes, from numbers of 0 to 1.
pub fn place(machine: &Machine, parts: &[f64]) -> Coordinates {
    let axes = machine.axes().into_iter().zip(parts);
    axes.map(|((axis, (low, high)), part)| (axis, low + (high - low) * part))
        .collect()
}

/// The machine with a constant setting vector for each unit in turn.
pub fn with_constants(mut machine: Machine, settings: &[SettingVector]) -> Machine {
    let units = machine.workpiece.iter_mut().chain(&mut machine.tool);
    for (unit, setting) in units.zip(settings) {
        let rotary = unit.motion.is_rotary();
        let ends = if rotary { [0.0, 360.0] } else { [-1e4, 1e4] };
        let table = Table::new(ends.to_vec(), vec![*setting; 2], rotary);
        unit.law = Law::table(table.expect("a good table"));
    }
    machine
}
