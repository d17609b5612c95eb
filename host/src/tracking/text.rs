//! The figures as text: tables for people to review.

use super::figures::{
    CarriageRow, CreepRow, Figures, Judged, MoveRow, PeerGains, PeerRow, Threads,
};
use crate::report::text_table;

const HEAD: &str = "\
How the axis follows, 1 kHz, encoder \"real\" with the map that the product's own calibration learned, the worst of five
encoders (seeds 1 to 5). Moves: 300 mm there and back, S-curve, 0.9 d/tick2. Following error = setpoint less the true
position of the encoder's shaft, dwells included; rms while a move runs. Standing: largest error from 100 ms after a
profile's end to 1 s. Rest: the shaft, peak to peak, over 10 s after the last move; swings: how often the output turns
round by more than 0.5 % of full command in them (20 and more: it oscillates). All in d = 0.001 mm; ok or NO beside a
limit.
";

const PEER_LEGEND: &str = "\
The same moves by the law of LinuxCNC's pid on hostmot2's velocity, by their manual pages, fed so that the place commanded
in a tick is the one for the next: its error is then setpoint less position. Tuned on the full nominal machine: by its own
relay rule (Ziegler and Nichols, tune-type 0 and 1); by hand, with P, I, D, FF1, FF2, bias and deadband for the least
peak with 6 dB and 30 degrees in hand; the same to the edge, with nothing in hand; and with FF3 too for the worst of the
full machine, nominal and off nominal, by one who knows all three. Ratio: our peak over its.
";

const BACKLASH_LEGEND: &str = "\
Backlash on the full machine; in (c) the encoder is a linear scale, and the amplitude is shown.
";

const CREEP_LEGEND: &str = "\
Creep of 0.0167 d/tick, 18 s: largest error to the line after the first second, and in it (breaking away).
";

const CARRIAGE_LEGEND: &str = "\
The carriage over 300 mm as a laser sees it, 3 d of backlash outside the loop, seed 1, no map: largest errors before and after
compensation by a table of 256 points both ways, at targets between them; backlash: mean reversal with the backlash as a
parameter alone; standing: what the servo leaves at rest.
";

const THREADS_LEGEND: &str = "\
Threads of 2 mm, spindle of 1 024 lines with ripple and a drop of speed at the cut; encoders \"real\" (seed 1), no map.
Phase: mean over the full-depth part of 360 x/P - (theta - theta0); error: largest deviation from it at any instant, d.
";

impl Figures {
    /// All tables.
    #[must_use]
    pub fn to_text(&self) -> String {
        let section = |title: &str, body: String| format!("\n{title}\n{body}");
        [
            HEAD.to_owned(),
            section("Our moves", moves(&self.moves)),
            format!("\n{PEER_LEGEND}{}", gains(&self.peer_gains)),
            section("The peer's moves", peer(&self.peer)),
            format!("\n{BACKLASH_LEGEND}{}", moves(&self.backlash)),
            format!("\n{CREEP_LEGEND}{}", creep(&self.creep)),
            format!("\n{CARRIAGE_LEGEND}{}", carriage(&self.carriage)),
            format!("\n{THREADS_LEGEND}{}", threads(&self.threads)),
            self.verdict(),
        ]
        .concat()
    }

    fn verdict(&self) -> String {
        let (reached, judged) = self.score();
        format!("\n{reached} of {judged} figures are reached.\n")
    }

    /// Figures that are judged, and how many of them are reached.
    #[must_use]
    pub fn score(&self) -> (usize, usize) {
        let of_moves = self.moves.iter().chain(&self.backlash).flat_map(|row| {
            let judged = [row.peak, row.standing].map(|one| one.map(|one| one.reached));
            judged.into_iter().chain([row.quiet]).flatten()
        });
        let others = self
            .peer
            .iter()
            .filter_map(|row| row.judged)
            .chain(self.creep.iter().map(|row| row.peak))
            .chain(
                self.carriage
                    .iter()
                    .flat_map(|row| [row.positioning, row.reversal]),
            )
            .chain(self.threads.iter().map(|all| all.phase_spread_deg))
            .chain(
                self.threads
                    .iter()
                    .flat_map(|all| all.passes.iter().map(|pass| pass.pitch_error)),
            );
        let all: Vec<bool> = of_moves
            .chain(others.map(|judged| judged.reached))
            .collect();
        (all.iter().filter(|reached| **reached).count(), all.len())
    }
}

fn moves(rows: &[MoveRow]) -> String {
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

fn gains(rows: &[PeerGains]) -> String {
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

fn peer(rows: &[PeerRow]) -> String {
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

fn creep(rows: &[CreepRow]) -> String {
    let header = ["machine", "mm/min", "peak", "rms", "first second"];
    let mut table = text_table(&header);
    for row in rows {
        table.add_row([
            row.machine.to_owned(),
            format!("{:.0}", row.feed_mm_per_min),
            beside(row.peak.value, Some(row.peak)),
            digits(row.rms),
            digits(row.start_peak),
        ]);
    }
    lines(&table)
}

fn carriage(rows: &[CarriageRow]) -> String {
    let header = [
        "drive",
        "position before",
        "after",
        "reversal before",
        "after",
        "backlash",
        "standing",
    ];
    let mut table = text_table(&header);
    for row in rows {
        table.add_row([
            row.machine.to_owned(),
            digits(row.positioning_before),
            beside(row.positioning.value, Some(row.positioning)),
            digits(row.reversal_before),
            beside(row.reversal.value, Some(row.reversal)),
            digits(row.mean_reversal_of_backlash),
            digits(row.standing),
        ]);
    }
    let refusals = rows.iter().filter_map(|row| {
        let why = row.refused.as_ref()?;
        Some(format!("{}: no table: {why}\n", row.machine))
    });
    lines(&table) + &refusals.collect::<String>()
}

fn threads(all: &[Threads]) -> String {
    let header = [
        "machine",
        "rpm",
        "pass",
        "phase deg",
        "pitch error d",
        "error d",
        "following d",
        "spread deg",
    ];
    let mut table = text_table(&header);
    for threads in all {
        for (index, pass) in threads.passes.iter().enumerate() {
            let spread = threads.phase_spread_deg;
            table.add_row([
                threads.machine.to_owned(),
                format!("{:.0}", pass.rpm),
                pass.pass.to_string(),
                format!("{:.3}", pass.phase_deg),
                beside(pass.pitch_error.value, Some(pass.pitch_error)),
                digits(pass.instantaneous_d),
                digits(pass.following_d),
                if index == 0 {
                    format!(
                        "{:.3} {} {}",
                        spread.value,
                        yes_or_no(spread.reached),
                        spread.limit
                    )
                } else {
                    String::new()
                },
            ]);
        }
    }
    lines(&table)
}

const fn yes_or_no(reached: bool) -> &'static str {
    if reached { "ok" } else { "NO" }
}

/// A figure, with its limit where there is one.
fn beside(value: f64, judged: Option<Judged>) -> String {
    judged.map_or_else(
        || digits(value),
        |judged| {
            format!(
                "{} {} {}",
                digits(value),
                yes_or_no(judged.reached),
                judged.limit
            )
        },
    )
}

/// Three significant digits, at most two decimals.
fn digits(value: f64) -> String {
    let decimals = match value.abs() {
        size if size < 9.995 => 2,
        size if size < 99.95 => 1,
        _ => 0,
    };
    format!("{value:.decimals$}")
}

/// A table without blanks at the ends of its lines.
fn lines(table: &comfy_table::Table) -> String {
    table
        .lines()
        .map(|line| format!("{}\n", line.trim_end()))
        .collect()
}
