//! Moves of ours and of the peer.

use super::cells::{beside, digits, lines, yes_or_no};
use crate::report::text_table;
use crate::tracking::figures::{MoveRow, PeerGains, PeerRow};

pub(super) fn moves(rows: &[MoveRow]) -> String {
    let header = [
        "machine", "mm/min", "peak", "rms", "standing", "mean", "rest", "swings", "quiet",
        "moonshot",
    ];
    let mut table = text_table(&header);
    for row in rows {
        let figures = &row.figures;
        table.add_row([
            row.machine.to_owned(),
            format!("{:.0}", row.feed_mm_per_min),
            beside(figures.peak, row.peak),
            digits(figures.rms),
            beside(figures.standing_peak, row.standing),
            digits(figures.standing_mean),
            digits(figures.rest_swing),
            format!("{:.0}", figures.output_swings),
            row.quiet.map_or("-", yes_or_no).to_owned(),
            row.moonshot.map_or_else(
                || "-".to_owned(),
                |moonshot| {
                    format!(
                        "{:.1} x {}",
                        moonshot.value / moonshot.limit,
                        moonshot.limit
                    )
                },
            ),
        ]);
    }
    lines(&table)
}

pub(super) fn gains(rows: &[PeerGains]) -> String {
    let header = [
        "tuning",
        "P 1/s",
        "I 1/s2",
        "D",
        "FF1",
        "FF2 s",
        "FF3 s2",
        "bias d/s",
        "deadband",
        "margin dB",
        "deg",
    ];
    let mut table = text_table(&header);
    for row in rows {
        table.add_row([
            row.tuning.to_owned(),
            format!("{:.1}", row.p),
            format!("{:.0}", row.i),
            format!("{:.2}", row.d),
            format!("{:.3}", row.ff1),
            format!("{:.4}", row.ff2),
            format!("{:.6}", row.ff3),
            format!("{:.0}", row.bias),
            format!("{:.1}", row.deadband),
            format!("{:.1}", row.gain_margin_db),
            format!("{:.0}", row.phase_margin_deg),
        ]);
    }
    lines(&table)
}

pub(super) fn peer(rows: &[PeerRow]) -> String {
    let header = [
        "tuning", "machine", "mm/min", "peak", "rms", "standing", "rest", "swings", "ratio",
    ];
    let mut table = text_table(&header);
    for row in rows {
        let figures = &row.figures;
        let ratio = match row.judged {
            None => format!("1/{:.1}", 1.0 / row.ratio),
            Some(judged) => format!(
                "1/{:.1} {} 1/{:.0}",
                1.0 / row.ratio,
                yes_or_no(judged.reached),
                1.0 / judged.limit
            ),
        };
        table.add_row([
            row.tuning.to_owned(),
            row.machine.to_owned(),
            format!("{:.0}", row.feed_mm_per_min),
            digits(figures.peak),
            digits(figures.rms),
            digits(figures.standing_peak),
            digits(figures.rest_swing),
            format!("{:.0}", figures.output_swings),
            ratio,
        ]);
    }
    lines(&table)
}
