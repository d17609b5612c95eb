//! The probing program in LinuxCNC's own interpreter, where that is installed.

use std::process::Command;

use leadscrew_process::metrology::part::{self, program};

use crate::part::HOUSING;
use crate::support::v;

/// Numbers of a canonical call.
fn numbers(line: &str) -> Option<Vec<f64>> {
    let (_, call) = line.split_once("STRAIGHT_PROBE(")?;
    let inside = call.split(')').next()?;
    Some(
        inside
            .split(',')
            .map(|number| number.trim().parse().unwrap())
            .collect(),
    )
}

#[test]
fn linuxcnc_reads_the_program_as_it_is_meant() {
    let text = part::read(HOUSING).unwrap();
    let written = program::write(HOUSING, &text).unwrap();
    if Command::new("rs274").arg("-h").output().is_err() {
        eprintln!(
            "SKIPPED: rs274 of LinuxCNC is not installed, the probing program was not interpreted"
        );
        return;
    }
    let folder = std::env::temp_dir().join(format!("leadscrew-probing-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let file = folder.join("housing.ngc");
    std::fs::write(&file, &written).unwrap();
    let output = Command::new("rs274")
        .arg("-g")
        .arg(&file)
        .current_dir(&folder)
        .output()
        .unwrap();
    std::fs::remove_dir_all(&folder).unwrap();
    let canon = String::from_utf8_lossy(&output.stdout);
    assert!(
        canon.contains("PROGRAM_END"),
        "{canon}{}",
        String::from_utf8_lossy(&output.stderr)
    );
    assert!(
        canon.contains("COMMENT(\"PROBEOPEN housing.txt\")"),
        "{canon}"
    );
    let ends: Vec<Vec<f64>> = canon.lines().filter_map(numbers).collect();
    let planned: Vec<_> = text
        .features
        .iter()
        .flat_map(|feature| &feature.planned)
        .collect();
    assert_eq!(ends.len(), planned.len());
    for (end, planned) in ends.iter().zip(planned) {
        // The stylus' centre 1.5 mm beyond contact; the interpreter prints four decimals.
        let expected = v(planned.nominal) + v(planned.normal) * (3.0 - 1.5);
        for axis in 0..3 {
            assert!(
                (end[axis] - expected[axis]).abs() < 2e-4,
                "{end:?} instead of {expected}"
            );
        }
    }
}
