//! Parts by their files: tables, logs, programs.

use leadscrew_process::metrology::part::report::Report;
use leadscrew_process::metrology::part::{self, Kind, Part, evaluate, log, program, touches};
use leadscrew_process::metrology::{Axis, Settings, Touch};
use leadscrew_process::setting_vector::SettingVector;

use crate::support::{STILL, assert_near, touch_cylinder, touch_plane, v};

pub const HOUSING: &str = include_str!("data/housing.toml");
pub const SHAFT: &str = include_str!("data/shaft.toml");

/// Every planned touch of a displaced part, exactly; holes 20 µm too wide.
fn touched(part: &Part, displaced: &SettingVector) -> Vec<(String, String, Touch)> {
    let mut all = Vec::new();
    for feature in &part.features {
        for planned in &feature.planned {
            let touch = match &feature.kind {
                Kind::Circle { nominal, .. } | Kind::Axis { nominal, .. } => {
                    let [first, second] = nominal.across().map(Axis::index);
                    let off = v(planned.nominal) - v(nominal.centre_mm);
                    let height = off[nominal.axis.index()];
                    let angle = off[second].atan2(off[first]);
                    touch_cylinder(displaced, nominal, (height, angle), true, 0.01)
                }
                _ => touch_plane(displaced, planned.nominal, planned.normal),
            };
            all.push((feature.name.clone(), planned.point.clone(), touch));
        }
    }
    all
}

/// The log that the control would write: where the stylus' centre was at the latch.
fn as_log(part: &Part, touches: &[(String, String, Touch)]) -> String {
    let line = |(_, _, touch): &(String, String, Touch)| {
        let normal = v(touch.normal);
        let pretravel = if normal.z > 0.9 {
            0.002
        } else {
            part.probe.pretravel_mm
        };
        let centre = v(touch.measured) + normal * (part.probe.radius_mm - pretravel);
        format!(
            "{:.6} {:.6} {:.6} 0.000000 0.000000 0.000000 0.000000 0.000000 0.000000\n",
            centre.x, centre.y, centre.z
        )
    };
    touches.iter().map(line).collect()
}

fn as_table(touches: &[(String, String, Touch)]) -> String {
    let row = |(feature, point, touch): &(String, String, Touch)| {
        let [x, y, z] = touch.measured;
        format!("{feature},{point},{x:.9},{y:.9},{z:.9}\n")
    };
    let head = "feature,point,measured_x_mm,measured_y_mm,measured_z_mm\n".to_owned();
    head + &touches.iter().map(row).collect::<String>()
}

#[track_caller]
fn value(report: &Report, feature: &str, quantity: &str) -> f64 {
    let feature = report
        .features
        .iter()
        .find(|one| one.name == feature)
        .expect(feature);
    let found = feature
        .values
        .iter()
        .find(|value| value.quantity == quantity);
    found
        .unwrap_or_else(|| panic!("{quantity} is not among {:?}", feature.values))
        .value
}

const DISPLACED: SettingVector = SettingVector::new([0.02, -0.03, 0.05, 2e-4, -1e-4, 3e-4]);

#[test]
fn a_table_and_a_log_say_the_same_of_a_displaced_part() {
    let part = part::read(HOUSING).unwrap();
    let touched = touched(&part, &DISPLACED);
    let settings = Settings::default();
    let by_table = touches::read(&as_table(&touched), &part).unwrap();
    let by_table = evaluate::evaluate(HOUSING, &part, &by_table, &settings).unwrap();
    let by_log = log::read(&as_log(&part, &touched), &part).unwrap();
    let by_log = evaluate::evaluate(HOUSING, &part, &by_log, &settings).unwrap();
    for (table, log) in by_table.features.iter().zip(&by_log.features) {
        for (table, log) in table.values.iter().zip(&log.values) {
            // The log has whole nanometres.
            let rounding = if table.unit == "mm" { 4e-6 } else { 1e-7 };
            assert_near(log.value, table.value, rounding);
        }
    }
    // What the part is.
    // Places move along the face: that drops angle · shift.
    assert_near(value(&by_table, "top", "offset z"), 0.05, 1e-5);
    assert_near(value(&by_table, "top", "λ"), 2e-4, 2e-7);
    assert_near(value(&by_table, "top", "β"), -1e-4, 2e-7);
    assert_near(value(&by_table, "side", "γ"), 3e-4, 1e-6);
    assert_near(value(&by_table, "bore", "λ"), 2e-4, 1e-6);
    assert_near(value(&by_table, "top to bore", "λ"), 0.0, 2e-7);
    assert_near(value(&by_table, "I", "diameter"), 40.02, 1e-5);
    assert_near(value(&by_table, "I to II", "distance error"), 0.0, 3e-5);
    assert_near(value(&by_table, "workpiece", "γ"), 3e-4, 1e-6);
    assert_near(value(&by_table, "workpiece", "a"), 0.02, 3e-5);
    assert_near(value(&by_table, "T5", "wear"), 120.002 - 120.020, 1e-12);
    // The highest touch stands 4 mm and its deviation over what is wanted.
    let highest = touched[..5]
        .iter()
        .map(|one| one.2.measured[2])
        .fold(f64::MIN, f64::max);
    assert_near(value(&by_table, "rough top", "stock"), 4.0 + highest, 1e-9);
    assert_near(value(&by_table, "rough top", "passes"), 4.0, 0.0);
    assert_near(value(&by_table, "rough top", "size 4"), -4.0, 1e-12);
}

#[test]
fn x_of_a_lathe_may_be_in_diameters() {
    let part = part::read(SHAFT).unwrap();
    // Diameter 60.02 at every place, the axis 5 µm off; X in diameters; the bore 30.01.
    let mut table = "feature,point,deviation_mm\n".to_owned();
    for point in 1..=6 {
        // Deviation of X in diameter: twice (5 µm ± 10 µm).
        let deviation = if point % 2 == 1 { 0.030 } else { -0.010 };
        table += &format!("journal,{point},{deviation}\n");
    }
    table += "bore,1,0.01\n";
    let found = touches::read(&table, &part).unwrap();
    let report = evaluate::evaluate(SHAFT, &part, &found, &Settings::default()).unwrap();
    assert_near(value(&report, "journal", "diameter at z -40"), 60.02, 1e-9);
    assert_near(value(&report, "journal", "offset x"), 0.005, 1e-9);
    assert_near(value(&report, "journal", "β"), 0.0, 1e-12);
    assert_near(value(&report, "journal", "taper error"), 0.0, 1e-12);
    assert_near(value(&report, "journal", "tool tip x"), 0.01, 1e-9);
    assert_near(value(&report, "bore", "diameter at z -5"), 30.01, 1e-9);
}

#[track_caller]
fn refused<T: std::fmt::Debug>(result: Result<T, leadscrew_nc::source::Complaint>, parts: &[&str]) {
    let message = result.unwrap_err().to_string();
    for part in parts {
        assert!(message.contains(part), "`{part}` is not in: {message}");
    }
}

#[test]
fn a_file_of_a_part_is_refused_where_it_is_wrong() {
    let read = |from: &str, to: &str| part::read(&HOUSING.replacen(from, to, 1));
    refused(
        read("normal = \"+z\"", "normal = \"up\""),
        &["18:10:", "`up`", "\"+z\""],
    );
    refused(
        read("diameter_mm = 40", "diameter_mm = -40"),
        &["31:15:", "diameter_mm = -40 mm", "allowed are"],
    );
    refused(
        read("diameter_mm = 40", "diametre_mm = 40"),
        &["31:1:", "unknown field", "diameter_mm"],
    );
    refused(
        read("name = \"side\"", "name = \"top\""),
        &["22:8:", "`top` is there twice"],
    );
    refused(
        read("name = \"side\"", "name = \"a (b\""),
        &["22:8:", "letters"],
    );
    refused(
        read("of = [\"I\", \"lower\"]", "of = [\"I\", \"bore\"]"),
        &["`bore`", "a hole or a boss", "I, II, lower"],
    );
    refused(
        read("sigma_mm = 0.001", "sigma_mm = nan"),
        &["3:12:", "sigma_mm = NaN mm"],
    );
    refused(
        read("of = \"top\"\nfinished", "finished"),
        &["`of`", "`blank_mm`"],
    );
    refused(
        read("\"-z\" = 0.002", "\"down\" = 0.002"),
        &["6:", "`down`"],
    );
    refused(read("housing.txt", "a) (b.txt"), &["log"]);
}

#[test]
fn a_table_is_refused_where_it_is_wrong() {
    let part = part::read(HOUSING).unwrap();
    let whole = as_table(&touched(&part, &STILL));
    let read = |from: &str, to: &str| touches::read(&whole.replacen(from, to, 1), &part);
    assert!(read("", "").is_ok());
    refused(
        read("measured_z_mm", "deviation_mm"),
        &["1:1:", "one of the two only"],
    );
    refused(
        read("measured_z_mm", "z_mm"),
        &["1:1:", "no column", "measured_z_mm"],
    );
    refused(
        read("top,2", "roof,2"),
        &["3:1:", "`roof`", "it has top, side, I, II, lower, bore"],
    );
    refused(
        read("top,2", "top,1"),
        &["3:5:", "point 1 of top is there twice"],
    );
    refused(read("top,2", "top,9"), &["3:5:", "point 9 of top", "x_mm"]);
    refused(
        read("top,2,190", "top,2,19o"),
        &["3:7:", "expected a number"],
    );
    let short = whole
        .lines()
        .filter(|line| !line.starts_with("side,3"))
        .collect::<Vec<_>>()
        .join("\n");
    refused(
        touches::read(&short, &part),
        &["side", "point 3", "missing"],
    );
    let oblique = "feature,point,deviation_mm\nII,2,0.001\n";
    refused(touches::read(oblique, &part), &["2:6:", "oblique"]);
}

#[test]
fn a_log_is_refused_where_it_is_wrong() {
    let part = part::read(HOUSING).unwrap();
    let whole = as_log(&part, &touched(&part, &STILL));
    let lines: Vec<&str> = whole.lines().collect();
    let read = |lines: &[&str]| log::read(&lines.join("\n"), &part);
    assert!(read(&lines).is_ok());
    refused(
        read(&lines[..7]),
        &["7 lines for 30 touches", "point 3 of side is the next"],
    );
    let mut more = lines.clone();
    more.push(lines[0]);
    refused(read(&more), &["31:1:", "more lines than the 30 touches"]);
    let mut lost = lines.clone();
    lost.remove(2);
    refused(
        read(&lost),
        &[
            "3:1:",
            "should be point 3 of top",
            "beside it",
            "line missing",
        ],
    );
    let mut bad = lines.clone();
    bad[4] = "1 2 3";
    refused(read(&bad), &["5:1:", "3 numbers: expected 9"]);
    bad[4] = "1 2 x 0 0 0 0 0 0";
    refused(read(&bad), &["5:5:", "`x`: expected a number"]);
}

#[test]
fn a_feature_that_its_touches_do_not_tell_is_refused_at_its_place() {
    let line = HOUSING
        .replacen("[190, 90, 0], [100, 20, 0]]", "]", 1)
        .replacen("[10, 90, 0]", "[100, 10, 0]", 1);
    let part = part::read(&line).unwrap();
    let table = touches::read(&as_table(&touched(&part, &STILL)), &part).unwrap();
    refused(
        evaluate::evaluate(&line, &part, &table, &Settings::default()),
        &["16:1:", "top:", "on one line"],
    );
}

#[test]
fn a_program_that_cannot_be_is_refused() {
    let write = |from: &str, to: &str| {
        let text = HOUSING.replacen(from, to, 1);
        program::write(&text, &part::read(&text).unwrap())
    };
    assert!(write("", "").is_ok());
    refused(write("safe_mm = 60.0\n", ""), &["safe_mm is missing"]);
    refused(
        write("safe_mm = 60.0", "safe_mm = 1.0"),
        &["16:1:", "top: point 1", "above safe_mm"],
    );
    refused(
        write(
            "safe_axis = \"z\"\nsafe_mm = 60.0",
            "safe_axis = \"x\"\nsafe_mm = 260.0",
        ),
        &["I: its axis is z", "along x"],
    );
    refused(
        write("radius_mm = 3.0", "radius_mm = 15.0"),
        &["II: the stylus, radius 15 mm"],
    );
    refused(
        write("normal = \"+z\"", "normal = \"-z\""),
        &["top: point 1", "looks away"],
    );
    refused(
        write("angles_deg = [0, 90, 180, 270]", "angles_deg = []"),
        &["I: its touches are not in the part's file"],
    );
    refused(
        program::write("", &part::read("").unwrap()),
        &["nothing to touch"],
    );
}

/// Where a conical hole is narrow a touch begins on its axis at the farthest: beyond it the stylus would meet the other wall.
#[test]
fn a_touch_begins_within_a_hole_that_narrows() {
    let cone = "[probe]\nradius_mm = 1\n[program]\nsafe_mm = 10\napproach_mm = 50\n[[axis]]\nname = \"cone\"\naxis = \"z\"\n\
                inside = true\ncentre_mm = [0, 0, 0]\ndiameter_mm = 20\ntaper = 0.25\nsections_mm = [0, -40]\nangles_deg = [0]\n";
    let program = program::write(cone, &part::read(cone).unwrap()).unwrap();
    let starts: Vec<&str> = program
        .lines()
        .filter(|line| line.starts_with("G1 X"))
        .collect();
    assert_eq!(starts.len(), 4, "{program}");
    assert!(
        starts.iter().all(|line| line.starts_with("G1 X0.0000")),
        "{starts:?}"
    );
    let deep = cone.replace("radius_mm = 1\n", "radius_mm = 6\n");
    refused(
        program::write(&deep, &part::read(&deep).unwrap()),
        &["cone: the stylus, radius 6 mm", "at point 2"],
    );
}

/// A bored surface grows: its stock is what the least radius lacks, and the sizes after the passes are diameters that grow.
#[test]
fn a_bored_blank_is_opened_up_to_its_size() {
    let text = "[[turned]]\nname = \"bore\"\ndiameter_mm = 40\ninside = true\nplaces_mm = [-5, -20]\n\
                [[passes]]\nname = \"open up\"\nof = \"bore\"\nfinished_mm = 50\nmax_depth_mm = 2\nfinishing_mm = 0.5\n";
    let part = part::read(text).unwrap();
    let table = "feature,point,measured_x_mm,measured_y_mm,measured_z_mm\nbore,1,20.1,0,-5\nbore,2,20,0,-20\n";
    let touches = touches::read(table, &part).unwrap();
    let report = evaluate::evaluate(text, &part, &touches, &Settings::default()).unwrap();
    for (quantity, expected) in [
        ("stock", 5.0),
        ("passes", 4.0),
        ("depth 1", 1.5),
        ("size 1", 43.0),
        ("size 3", 49.0),
        ("size 4", 50.0),
    ] {
        assert_near(value(&report, "open up", quantity), expected, 1e-12);
    }
}
