//! Every number and name of the machine's state that is refused is refused at its own place in the setup.

use leadscrew_nc::corrector::Corrector;
use leadscrew_nc::setup::Setup;

const SETUP: &str = "dialect = \"iso-mill\"\n\
    [control]\n\
    start = { X = 0.0, Z = 100.0 }\n\
    radius_tolerance_mm = 0.01\n\
    [control.work_offsets]\n\
    active = \"G54\"\n\
    origins.G54 = { X = 0.0, Y = 0.0 }\n\
    external = { Z = 1.0 }\n\
    [control.references]\n\
    G28 = { Z = 300.0 }\n\
    [control.tools.3]\n\
    offset = { Z = 80.0 }\n\
    radius_mm = 4.0\n";

/// What is wrong with a setup, and where.
fn refused(setup: &str) -> String {
    let read = |name: &str| Err(format!("{name} is not there"));
    let setup_read = match Setup::read(setup, &read) {
        Ok(read) => read,
        Err(complaint) => return complaint.to_string(),
    };
    let made = Corrector::new(
        setup_read.dialect.unwrap(),
        &setup_read.control,
        setup_read.terms,
        setup_read.tolerance,
    );
    made.expect_err("a refusal").in_setup(setup).to_string()
}

#[test]
fn it_is_refused_at_its_own_place() {
    for (from, to, message) in [
        (
            "X = 0.0, Z",
            "X = 2e6, Z",
            "3:15: control: X = 2000000 mm is out of range",
        ),
        (
            "Y = 0.0",
            "Y = nan",
            "7:30: control: Y = NaN mm is out of range",
        ),
        (
            "Z = 1.0",
            "Z = -1e9",
            "8:18: control: Z = -1000000000 mm is out of range",
        ),
        ("Z = 300.0", "Z = inf", "10:13: control: Z = inf mm"),
        ("Z = 80.0", "Z = 1e7", "12:16: control: Z = 10000000 mm"),
        (
            "= 4.0",
            "= -4.0",
            "13:13: control: radius_mm = -4 mm is out of range: allowed are 0 to 1000 mm",
        ),
        (
            "= 4.0",
            "= nan",
            "13:13: control: radius_mm = NaN mm is out of range",
        ),
        (
            "= 0.01\n",
            "= 2.0\n",
            "4:23: control: radius_tolerance_mm = 2 mm",
        ),
        (
            "\"G54\"",
            "\"G71\"",
            "6:10: control.work_offsets.active: G71 is no work offset of dialect iso-mill",
        ),
        (
            "origins.G54",
            "origins.G12",
            "7:15: control.work_offsets.origins.G12: G12 is no work offset of dialect iso-mill",
        ),
        (
            "G28 =",
            "G29 =",
            "10:7: control.references.G29: G29 goes to no reference in dialect iso-mill",
        ),
    ] {
        let setup = SETUP.replacen(from, to, 1);
        assert_ne!(setup, SETUP, "{from}");
        let refusal = refused(&setup);
        assert!(refusal.starts_with(message), "{from} -> {to}: {refusal}");
    }
}
