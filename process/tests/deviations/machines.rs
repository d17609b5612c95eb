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
