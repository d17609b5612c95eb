//! The boards that this firmware runs on, and whether an axis runs there at a tick rate. What is known of them is what was
//! shown on an emulated part and counted in instructions: `docs/board.md` says what nobody has measured.

use leadscrew::setpoint::profile::Limits;
use leadscrew::units::{AxisScale, RangeError, TICK_HZ};
use leadscrew_app::edge_ring::hold;
use leadscrew_app::input_filter::{InputFilter, Inputs, LineLimits, line_hz};
use serde::Serialize;

use super::cycle::Kinematics;

/// Instructions of the tick in the image of the STM32F4 board: the golden table.
const TICK_INSTRUCTIONS: &str = include_str!("../../../tests/golden/tick_instructions.txt");
/// Share of its period that a tick may take: beyond it counts as overlong (`docs/board.md`).
const TICK_SHARE: f64 = 6.0 / 8.0;
/// Tick rates at which the firmware was run.
const USUAL_HZ: [f64; 2] = [1000.0, 2500.0];
const EDGES_PER_LINE: f64 = 4.0;

/// A board.
#[derive(Clone, Copy, Debug)]
pub struct Board {
    /// Its name.
    pub name: &'static str,
    /// Clock of the processor, Hz.
    pub clock_hz: f64,
    /// What its inputs follow; none where the simulated machine gives counts and times.
    pub inputs: Option<Inputs>,
    /// Highest tick rate at which its firmware was run without a late tick, Hz.
    pub shown_hz: f64,
    /// How that was shown.
    pub shown_by: &'static str,
    /// Most instructions of a tick, where they are counted with all that the board does.
    pub tick_instructions: Option<u32>,
}

/// Whether an axis runs on a board.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Runs {
    /// It was shown, if not on hardware.
    Shown,
    /// Nothing forbids it, nobody has shown it.
    NotShown,
    /// It does not.
    No,
}

impl Runs {
    /// In words.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Shown => "yes",
            Self::NotShown => "not shown",
            Self::No => "no",
        }
    }
}

/// The verdict on a board.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BoardVerdict {
    /// The board.
    pub board: &'static str,
    /// Tick rate that was asked about, Hz.
    pub tick_hz: f64,
    /// Whether it runs.
    pub runs: Runs,
    /// Why.
    pub why: String,
}

/// The boards.
#[must_use]
pub fn boards() -> [Board; 2] {
    [
        Board {
            name: "stm32f4 (F405, F407)",
            clock_hz: 168e6,
            inputs: Some(Inputs {
                limits: LineLimits {
                    encoder_hz: 300e3,
                    receiver_hz: 1e6,
                },
                timer_hz: 84e6,
                ring_words: 4096,
            }),
            shown_hz: 2500.0,
            shown_by: "on an emulated part, never on hardware",
            tick_instructions: most_instructions(TICK_INSTRUCTIONS),
        },
        Board {
            name: "mps2-an386 (QEMU)",
            clock_hz: 25e6,
            inputs: None,
            shown_hz: 2500.0,
            shown_by: "in QEMU, with the simulated machine only",
            tick_instructions: None,
        },
    ]
}

/// The largest figure of the last column of a golden table.
fn most_instructions(table: &str) -> Option<u32> {
    let rows = table.lines().filter(|line| !line.starts_with('#'));
    rows.filter_map(|row| row.split_whitespace().last()?.parse().ok())
        .max()
}

impl Board {
    /// Where axes run that need a tick of `least_hz` or faster, one board each: there if that was shown, else at the least usual
    /// rate above at which it was; a slow tick may have more edges than the ring holds.
    #[must_use]
    pub fn verdict_from(&self, axes: &[Kinematics], least_hz: f64) -> BoardVerdict {
        let asked = self.verdict(axes, least_hz);
        if asked.runs == Runs::Shown {
            return asked;
        }
        let usual = USUAL_HZ.into_iter().filter(|rate| *rate > least_hz);
        let mut faster = usual.map(|rate| self.verdict(axes, rate));
        faster
            .find(|verdict| verdict.runs == Runs::Shown)
            .unwrap_or(asked)
    }

    /// Whether axes run here with a tick of `tick_hz`, one board each.
    #[must_use]
    pub fn verdict(&self, axes: &[Kinematics], tick_hz: f64) -> BoardVerdict {
        // The core's ticks are not slower.
        let tick_hz = tick_hz.max(TICK_HZ.0);
        let refused = axes.iter().find_map(|axis| {
            let refused = fits_core(axis, tick_hz).map_err(|error| error.to_string());
            refused.and_then(|()| self.follows(axis, tick_hz)).err()
        });
        let (runs, why) = match refused {
            Some(why) => (Runs::No, why),
            None => self.tick(tick_hz),
        };
        BoardVerdict {
            board: self.name,
            tick_hz,
            runs,
            why,
        }
    }

    /// By the rule that the firmware goes by when it starts.
    fn follows(&self, axis: &Kinematics, tick_hz: f64) -> Result<(), String> {
        let Some(inputs) = self.inputs else {
            return Ok(());
        };
        let (feed, counts_per_mm) = (axis.max_feed_mm_per_min(), axis.counts_per_mm());
        let filter = InputFilter::for_feed(feed, counts_per_mm, inputs.timer_hz, &inputs.limits)
            .map_err(|error| error.to_string())?;
        let edge_hz = EDGES_PER_LINE * line_hz(feed, counts_per_mm);
        let passed_hz = filter.passed_hz(inputs.timer_hz);
        hold(inputs.ring_words, tick_hz, edge_hz, passed_hz).map_err(|error| error.to_string())
    }

    fn tick(&self, tick_hz: f64) -> (Runs, String) {
        let shown_by = self.shown_by;
        if tick_hz <= self.shown_hz {
            return (
                Runs::Shown,
                format!("to {:.0} Hz {shown_by}", self.shown_hz),
            );
        }
        let not_shown = format!("shown to {:.0} Hz only, {shown_by}", self.shown_hz);
        let Some(instructions) = self.tick_instructions else {
            return (Runs::NotShown, not_shown);
        };
        let clocks = TICK_SHARE * self.clock_hz / tick_hz / f64::from(instructions);
        // No instruction of this core takes less than a clock.
        if clocks < 1.0 {
            let most = TICK_SHARE * self.clock_hz / f64::from(instructions);
            let why = format!(
                "a tick of {instructions} instructions takes longer than 6/8 of its period above {most:.0} Hz, at one clock each"
            );
            return (Runs::No, why);
        }
        let why = format!(
            "{not_shown}; {instructions} instructions a tick leave {clocks:.1} clocks for each, and the clocks are not measured"
        );
        (Runs::NotShown, why)
    }
}

/// Whether the core's formats and tick rates take the axis.
fn fits_core(axis: &Kinematics, tick_hz: f64) -> Result<(), RangeError> {
    let scale = AxisScale::new(axis.counts_per_mm(), tick_hz)?;
    let acceleration = scale.acceleration_from_m_s2(axis.max_acceleration_m_s2());
    // Where no jerk is watched the axis is given one by which it accelerates in a tick.
    let jerk = axis
        .max_jerk_m_s3()
        .map_or(acceleration, |jerk| scale.jerk_from_m_s3(jerk));
    Limits::new(
        scale.velocity_from_feed(axis.max_feed_mm_per_min())?,
        acceleration,
        jerk.min(acceleration),
    )
    .map(|_| ())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_facts_of_the_axis_board_are_those_of_its_source() {
        let encoder = include_str!("../../../boards/stm32f4/src/encoder.rs");
        let clocks = include_str!("../../../boards/stm32f4/src/clocks.rs");
        for fact in [
            "encoder_hz: 300e3",
            "receiver_hz: 1e6",
            "RING: usize = 4096",
        ] {
            assert!(encoder.contains(fact), "{fact}");
        }
        assert!(clocks.contains("TIMER_HZ: u32 = 84_000_000"));
        assert!(clocks.contains("FAST_TIMER_HZ: u32 = 168_000_000"));
        assert_eq!(
            most_instructions("# a\nstate median worst\nx 10 30\ny 20 25\n"),
            Some(30)
        );
        assert!(boards()[0].tick_instructions.is_some());
    }
}
