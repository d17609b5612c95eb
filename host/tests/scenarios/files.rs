//! Runs of all files.

use leadscrew::supervisor::Fault;
use leadscrew_hal_mock::scenario::BUILT_IN;
use leadscrew_host::fault_names::fault_name;
use leadscrew_host::scenario_run::{Figures, judge, run};

use super::{complaints, paths, read};

#[test]
fn every_scenario_comes_to_what_it_expects() {
    let unmet = complaints(|path, file| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let scenario = file.scenario();
        let record = match run(&scenario) {
            Ok(record) => record,
            Err(error) => return vec![format!("{name}: {error}")],
        };
        let verdicts = judge(&file.expect, &Figures::new(&record, scenario.timeline));
        let unmet = verdicts.iter().filter(|verdict| !verdict.met);
        unmet
            .map(|verdict| {
                format!(
                    "{name}: {}: expected {}, found {}",
                    verdict.name, verdict.expected, verdict.found
                )
            })
            .collect()
    });
    assert!(unmet.is_empty(), "{}", unmet.join("\n"));
}

#[test]
fn every_fault_has_a_scenario_that_trips_it() {
    let tripped: Vec<Fault> = paths()
        .iter()
        .filter_map(|path| read(path).expect.fault)
        .collect();
    let missing: Vec<_> = Fault::ALL
        .iter()
        .filter(|fault| !tripped.contains(fault))
        .map(|fault| fault_name(*fault))
        .collect();
    assert!(missing.is_empty(), "{missing:?}");
}

#[test]
fn every_scenario_says_what_it_shows() {
    let silent = complaints(|path, file| {
        let is_silent = file.description.is_empty();
        is_silent
            .then(|| path.display().to_string())
            .into_iter()
            .collect()
    });
    assert!(silent.is_empty(), "{silent:?}");
}

#[test]
fn what_the_firmware_has_in_it_is_what_the_files_say() {
    for (name, scenario) in BUILT_IN {
        let file = read(&super::root().join(format!("tests/scenarios/{name}.toml")));
        assert_eq!(file.scenario(), *scenario, "{name}");
    }
}
