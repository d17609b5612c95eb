//! Documents that are made from the code: each is what the code says now. `cargo xtask golden` writes them anew.

mod parameters;
mod scope;
mod wire_format;

use std::path::Path;

/// Compares `text` with the document `name` under `docs`, or writes it there.
#[track_caller]
fn reviewed(name: &str, text: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("docs")
        .join(name);
    if std::env::var_os("INSTA_UPDATE").is_some_and(|update| update == "always") {
        std::fs::write(&path, text).unwrap();
    }
    let found = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(
        found == text,
        "docs/{name} is not what the code says: run `cargo xtask golden` and review it"
    );
}

/// `page` with what is between the marks of `name` replaced.
fn with(page: &str, name: &str, text: &str) -> String {
    let mark = format!("<!-- made: {name} -->\n");
    let (before, rest) = page.split_once(&mark).expect("the page has the mark");
    let (_, after) = rest.split_once("<!-- end -->").expect("it has an end");
    format!("{before}{mark}{text}<!-- end -->{after}")
}
