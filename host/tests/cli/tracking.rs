//! `leadscrew tracking`: the text is the golden table of the core's tests; here, that the JSON says the same.

use serde_json::Value;

use crate::Folder;

fn rows<'v>(report: &'v Value, table: &str) -> &'v [Value] {
    report[table].as_array().map_or(&[], Vec::as_slice)
}

#[test]
fn the_json_has_a_row_for_every_machine_of_every_table() {
    let report = Folder::new().json("tracking");
    assert_eq!(report["schema"], "leadscrew/tracking/1");
    let lengths = [
        ("moves", 5),
        ("peer_gains", 5),
        ("peer", 25),
        ("backlash", 3),
        ("creep", 4),
        ("carriage", 2),
        ("threads", 2),
    ];
    for (table, length) in lengths {
        assert_eq!(rows(&report, table).len(), length, "{table}");
    }
    for table in ["moves", "peer", "backlash"] {
        for row in rows(&report, table) {
            let peak = row["figures"]["peak"].as_f64();
            assert!(peak.is_some_and(|peak| peak > 0.0), "{row}");
        }
    }
    // What is judged says against which limit, and whether it is reached.
    for row in rows(&report, "creep") {
        let peak = &row["peak"];
        let (value, limit) = (peak["value"].as_f64(), peak["limit"].as_f64());
        assert_eq!(peak["reached"].as_bool(), Some(value <= limit), "{row}");
    }
    assert!(report["reached"].as_u64() <= report["judged"].as_u64());
}
