//! The page of faults is the one that the table makes.

use leadscrew::supervisor::{Fault, FaultSet};
use leadscrew_host::fault_page::page;

const PAGE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/faults.md");

/// `cargo xtask golden` writes it anew.
#[test]
fn the_page_is_the_reviewed_one() {
    let made = page();
    if std::env::var("INSTA_UPDATE").is_ok_and(|update| update == "always") {
        std::fs::write(PAGE, &made).unwrap();
    }
    let reviewed = std::fs::read_to_string(PAGE).unwrap_or_default();
    assert!(
        made == reviewed,
        "docs/faults.md is not what src/supervisor/fault.rs says: run `cargo xtask golden` and review it"
    );
}

#[test]
fn numbers_are_in_order_without_a_gap_and_lead_back_to_their_faults() {
    let mut all = FaultSet::default();
    for (number, &fault) in (1..).zip(Fault::ALL) {
        assert_eq!(fault as u8, number);
        assert_eq!(Fault::from_number(number), Some(fault));
        assert!(!all.contains(fault));
        all = all.with(fault);
        let says = fault.description();
        for text in [
            says.what,
            says.condition,
            says.bound,
            says.figure,
            says.cause,
            says.remedy,
        ] {
            assert!(text.len() > 5 && text.trim() == text, "{fault:?}: {text:?}");
        }
    }
    assert_eq!(all.len() as usize, Fault::ALL.len());
    assert_eq!(
        (Fault::from_number(0), Fault::from_number(200)),
        (None, None)
    );
}
