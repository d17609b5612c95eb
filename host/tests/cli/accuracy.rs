//! `leadscrew accuracy`: the text is the golden table of the core's tests; here, that the JSON says the same.

use crate::Folder;

#[test]
fn the_json_has_a_cell_for_every_row_and_column_of_every_table() {
    let report = Folder::new().json("accuracy");
    assert_eq!(report["schema"], "leadscrew/accuracy/1");
    let columns = report["columns"].as_array().expect("columns");
    assert_eq!(columns.len(), 4);
    let variants = report["variants"].as_array().expect("tables");
    let names: Vec<_> = variants.iter().map(|table| &table["variant"]).collect();
    assert_eq!(
        names,
        [
            "learned",
            "without_map",
            "one_stamp",
            "shaft_synchronous",
            "drifted"
        ]
    );
    for table in variants {
        let rows = table["rows"].as_array().expect("rows");
        assert_eq!(rows.len(), 7);
        for row in rows {
            let cells = row["cells"].as_array().expect("cells");
            assert_eq!(cells.len(), columns.len());
            for cell in cells {
                assert!(
                    cell["sigma"].as_f64().is_some_and(|sigma| sigma > 0.0),
                    "{cell}"
                );
                let is_main = table["variant"] == "learned";
                assert_eq!(cell["parts"].is_object(), is_main, "{cell}");
                assert!(is_main || cell["limit"].is_null(), "{cell}");
            }
        }
    }
    assert_eq!(report["stated"].as_array().map(Vec::len), Some(42));
    assert_eq!(report["bound"].as_array().map(Vec::len), Some(11));
}
