//! The figures as text: tables for people to review.

mod cells;
mod moves;
mod others;

use self::moves::{gains, moves, peer};
use self::others::{carriage, creep, identified, threads};
use super::figures::Figures;

const HEAD: &str = "\
How the axis follows, 1 kHz, encoder \"real\" with the map that the product's own calibration learned, the worst of five
encoders (seeds 1 to 5). Moves: 300 mm there and back, S-curve, 0.9 d/tick2. Following error = setpoint less the true
position of the encoder's shaft, dwells included; rms while a move runs. Standing: largest error from 100 ms after a
profile's end to 1 s. Rest: the shaft, peak to peak, over 10 s after the last move; swings: how often the output turns
round by more than 0.5 % of full command in them (20 and more: it oscillates). All in d = 0.001 mm; ok or NO beside a
limit.
Each axis is commissioned from cold on its nominal machine with the encoder that it then runs with: the drive identified by
the product's own experiments by the learned map, the parameters by autotune from that. Off nominal: run on another machine.
";

const KNOWN_LEGEND: &str = "\
The same moves by axes that were tuned on their drives' true figures: what identification costs.
";

const THERE_LEGEND: &str = "\
The off nominal machines by axes commissioned on them.
";

const IDENTIFIED_LEGEND: &str = "\
Identified less true figures, the largest of five encoders; - where nothing was seen.
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
The carriage over 300 mm as a laser sees it, 3 d of backlash outside the loop, seed 1: largest errors before and after
compensation by a table of 256 points both ways (mean of three runs), at targets between them; backlash: mean reversal with
the backlash as a parameter alone; standing: what the servo leaves at rest. The bare drive goes without a map.
";

const THREADS_LEGEND: &str = "\
Threads of 2 mm, spindle of 1 024 lines with ripple and a drop of speed at the cut; encoders \"real\" (seed 1), that of the
axis with its learned map, which shifts all phases alike: its zero is that of the disc.
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
            format!("\n{KNOWN_LEGEND}{}", moves(&self.known)),
            format!("\n{THERE_LEGEND}{}", moves(&self.there)),
            format!("\n{IDENTIFIED_LEGEND}{}", identified(&self.identified)),
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
