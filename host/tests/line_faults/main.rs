//! What a bad line does to a whole axis that is moved over it, in figures: the table of docs/wire-format.md.
//! `INSTA_UPDATE=always` writes it anew.

mod axis;
#[path = "../support/shuttle.rs"]
mod shuttle;
#[path = "../support/tuned.rs"]
mod tuned;
#[path = "../support/watch.rs"]
mod watch;

use std::fmt::Write as _;
use std::path::Path;
use std::time::Duration;

use leadscrew_client::noisy::Faults;

use axis::{MOVES, run};
use shuttle::{NONE, Run, cuts, late, worst};

const GOLDEN: &str = "../tests/golden/line_faults.txt";
const PAGE: &str = "../docs/wire-format.md";
const MARK: &str = "<!-- made: line faults -->\n";
const END: &str = "<!-- end -->";

/// Lines, from good to worst.
fn lines() -> Vec<(&'static str, Faults)> {
    let drops = |drops| Faults { drops, ..NONE };
    vec![
        ("good", NONE),
        ("1 % dropped", drops(0.01)),
        ("5 % dropped", drops(0.05)),
        ("20 % dropped", drops(0.2)),
        ("10 % with a flipped bit", Faults { flips: 0.1, ..NONE }),
        (
            "20 % doubled",
            Faults {
                doubles: 0.2,
                ..NONE
            },
        ),
        ("20 % late by 30 ms", late(30)),
        ("20 % late by 120 ms", late(120)),
        ("cut for 0.5 s every 3 s", cuts()),
        (
            "cut for 1.5 s every 4 s",
            Faults {
                cut: Duration::from_millis(1500),
                cut_every: Duration::from_millis(4000),
                ..NONE
            },
        ),
        (
            "5 % dropped, 5 % flipped, 20 % doubled, 20 % late by 120 ms, cuts",
            worst(),
        ),
    ]
}

fn table(rows: &[(&str, Run)]) -> String {
    let mut text = String::from(
        "| frames, each way | moves made | ticks of wrong motion | repeats | lapses told | sessions ended, reconnected | \
         controlled stops | longest, ms | farthest, mm | longest from the last byte to rest, ms |\n\
         | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n",
    );
    for (name, run) in rows {
        let seen = &run.seen;
        let _ = writeln!(
            text,
            "| {name} | {} | {} | {} | {} | {} | {} | {} | {:.2} | {} |",
            run.made,
            seen.wrong,
            run.done.repeated,
            run.lapsed,
            run.lost,
            seen.stops,
            seen.longest_ms,
            seen.farthest_mm,
            seen.deaf_ms
        );
    }
    text
}

/// Compares a text with a file, or writes it there.
#[track_caller]
fn reviewed(file: &str, make: impl Fn(&str) -> String) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(file);
    let found = std::fs::read_to_string(&path).unwrap_or_default();
    let text = make(&found);
    if std::env::var_os("INSTA_UPDATE").is_some_and(|update| update == "always") {
        std::fs::write(&path, &text).unwrap();
        return;
    }
    assert!(
        found == text,
        "{file} is not what the axis does: run `cargo xtask golden` and review it\n{text}"
    );
}

#[test]
fn no_fault_of_the_line_moves_the_axis_otherwise_than_it_was_told() {
    let rows: Vec<_> = lines()
        .into_iter()
        .map(|(name, faults)| (name, run(faults, 1)))
        .collect();
    for (name, run) in &rows {
        assert_eq!((run.made, run.seen.wrong), (MOVES, 0), "{name}: {run:?}");
        // Two leases, the tick of the lapse, and the stop itself.
        assert!(
            run.seen.deaf_ms <= 200 + run.seen.longest_ms,
            "{name}: {run:?}"
        );
    }
    let of = |name: &str| &rows.iter().find(|(row, _)| *row == name).unwrap().1;
    assert_eq!((of("good").done.repeated, of("good").seen.stops), (0, 0));
    assert!(
        of("cut for 0.5 s every 3 s").seen.stops > 0,
        "it was cut at rest"
    );
    assert!(
        of("cut for 1.5 s every 4 s").lost > 0,
        "no session has ended"
    );
    let text = table(&rows);
    reviewed(GOLDEN, |_| text.clone());
    reviewed(PAGE, |page| {
        let (before, rest) = page.split_once(MARK).expect("the page has the mark");
        let (_, after) = rest.split_once(END).expect("it has an end");
        format!("{before}{MARK}{text}{END}{after}")
    });
}
