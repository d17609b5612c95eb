//! The tables of accuracy: against their golden copy, against the figures to reach, and the honesty of the 1σ.

mod two_edge;

use std::sync::LazyLock;

use leadscrew_host::accuracy::{COLUMNS, Figures, LoopRow, ROWS, Variant, figures};

/// Learned and measured once for all tests.
static FIGURES: LazyLock<Figures> = LazyLock::new(|| figures().unwrap());

/// Compares with the reviewed tables under `tests/golden`; `cargo xtask golden` writes them anew.
#[test]
fn the_tables_are_the_reviewed_ones() {
    insta::with_settings!({ snapshot_path => "../golden", prepend_module_to_snapshot => false, omit_expression => true }, {
        insta::assert_snapshot!("accuracy", FIGURES.to_text());
    });
}

#[test]
fn the_figures_are_reached() {
    let main = &FIGURES.variants[0];
    assert_eq!(main.variant, Variant::Learned);
    let mut limits = 0;
    for (row, seen) in ROWS.iter().zip(&main.rows) {
        assert_eq!(seen.cells.len(), COLUMNS.len());
        for (column, cell) in seen.cells.iter().enumerate() {
            assert_eq!(cell.limit, row.limits[column]);
            limits += usize::from(cell.limit.is_some());
            assert_ne!(cell.reached, Some(false), "{} {column}: {cell:?}", row.name);
        }
    }
    assert_eq!(limits, 25);
}

/// Steady motion: what a motion's own jerk makes of a quadratic the estimator cannot know, so that the rows with jerk
/// are shown and not judged.
#[test]
fn the_stated_uncertainty_is_honest() {
    let steady: Vec<_> = ROWS[..5].iter().map(|row| row.name).collect();
    let mut judged = 0;
    for stated in &FIGURES.stated {
        if !steady.contains(&stated.row) {
            continue;
        }
        judged += 1;
        for honesty in [stated.honesty_v, stated.honesty_a] {
            assert!((0.8..=1.25).contains(&honesty), "{stated:?}");
        }
        for within in [stated.within_v, stated.within_a] {
            assert!(within >= 0.9, "{stated:?}");
        }
    }
    assert_eq!(judged, 30);
}

#[test]
fn the_observer_in_the_loop_reaches_its_figures() {
    let judged = FIGURES.in_loop.iter().filter_map(LoopRow::reached);
    assert_eq!(judged.clone().count(), 6);
    assert!(
        judged.clone().all(|reached| reached),
        "{:#?}",
        FIGURES.in_loop
    );
}

#[test]
fn the_bound_is_met_on_its_own_scene() {
    assert_eq!(FIGURES.bound.len(), 11);
    for figure in &FIGURES.bound {
        assert!((0.95..=1.1).contains(&figure.to_bound), "{figure:?}");
    }
}

/// The parts are measured each by itself: that their squares add up to the whole shows that none is missing.
#[test]
fn the_parts_of_an_error_make_up_the_whole() {
    for row in &FIGURES.variants[0].rows {
        for cell in &row.cells {
            let parts = cell.parts.unwrap();
            let all = [
                parts.white,
                parts.short_wave,
                parts.long_wave,
                parts.timer,
                parts.fixed_point,
                parts.bias,
                parts.low_speed,
            ];
            let sum = all.iter().map(|part| part * part).sum::<f64>().sqrt();
            assert!(
                (sum / cell.sigma - 1.0).abs() < 0.1,
                "{}: {sum}, {cell:?}",
                row.name
            );
        }
    }
}
