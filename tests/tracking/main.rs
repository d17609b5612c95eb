//! The tables of tracking against their golden copy, and the peer that they compare with.

mod peer;

use std::sync::LazyLock;

use leadscrew_host::tracking::{Figures, figures};

/// Measured once for all tests.
static FIGURES: LazyLock<Figures> = LazyLock::new(|| figures().unwrap());

/// Compares with the reviewed tables under `tests/golden`; `cargo xtask golden` writes them anew.
#[test]
fn the_tables_are_the_reviewed_ones() {
    insta::with_settings!({ snapshot_path => "../golden", prepend_module_to_snapshot => false, omit_expression => true }, {
        insta::assert_snapshot!("tracking", FIGURES.to_text());
    });
}
