//! Programs for a mill, at random: lines and arcs in all planes and forms, absolute and incremental, and G92. Not in inches: the
//! interpreter's output has too few digits then.

use std::f64::consts::TAU;
use std::fmt::Write;

use proptest::prelude::*;
use proptest::test_runner::RngSeed;

/// One movement as it is drawn.
#[derive(Clone, Debug)]
pub struct Draw {
    kind: u8,
    a: f64,
    b: f64,
    c: f64,
    d: f64,
}

/// So many cases, twenty times as many in the long run.
pub fn cases(count: u32) -> ProptestConfig {
    let long = std::env::var_os("LEADSCREW_LONG").is_some();
    ProptestConfig {
        max_shrink_iters: if long { 80 } else { 0 },
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(1),
        ..ProptestConfig::with_cases(if long { 20 * count } else { count })
    }
}

pub fn draws() -> impl Strategy<Value = Vec<Draw>> {
    let unit = -1.0..1.0_f64;
    let draw = (0..16_u8, unit.clone(), unit.clone(), unit.clone(), unit);
    proptest::collection::vec(
        draw.prop_map(|(kind, a, b, c, d)| Draw { kind, a, b, c, d }),
        4..14,
    )
}

/// The writer's own idea of where it is, mm, in the coordinates in force.
struct Writer {
    text: String,
    at: [f64; 3],
    incremental: bool,
    plane: usize,
    centre_absolute: bool,
    steps: usize,
}

/// Step of the words, mm: a fine one, or the coarse one of some posts.
const STEPS: [f64; 2] = [1e-4, 1e-3];

impl Writer {
    fn round(&self, mm: f64) -> f64 {
        let step = STEPS[self.steps];
        (mm / step).round() * step
    }

    fn word(&mut self, letter: char, mm: f64) {
        let _ = write!(self.text, " {letter}{mm:.4}");
    }

    /// Axis words to a place that is rounded to what can be written.
    fn go(&mut self, to: [f64; 3]) {
        for (axis, letter) in "XYZ".chars().enumerate() {
            let way = self.round(to[axis] - self.at[axis]);
            if way != 0.0 {
                let value = if self.incremental {
                    way
                } else {
                    self.round(to[axis])
                };
                let new = if self.incremental {
                    self.at[axis] + way
                } else {
                    value
                };
                self.word(letter, value);
                self.at[axis] = new;
            }
        }
    }

    fn arc(&mut self, draw: &Draw) {
        let [first, second] = [[0, 1], [2, 0], [1, 2]][self.plane];
        let across = 3 - first - second;
        let radius = 0.2 + 15.0 * draw.a * draw.a;
        let start = draw.b * TAU / 2.0;
        let turned = match draw.kind {
            7 => TAU / 2.0 + 2e-4 * draw.c,
            8 => 0.05 + draw.c.abs() * 0.1,
            _ => 0.3 + draw.c.abs() * 5.6,
        };
        let clockwise = draw.d > 0.0;
        let turned = if clockwise { -turned } else { turned };
        let from = self.at;
        let mut centre = [0.0; 3];
        centre[first] = self.round(from[first] - radius * start.cos());
        centre[second] = self.round(from[second] - radius * start.sin());
        let exact = (from[first] - centre[first]).hypot(from[second] - centre[second]);
        let begun = (from[second] - centre[second]).atan2(from[first] - centre[first]);
        let mut to = from;
        to[first] = centre[first] + exact * (begun + turned).cos();
        to[second] = centre[second] + exact * (begun + turned).sin();
        if draw.kind == 9 {
            to[across] += 3.0 * draw.d;
        }
        let full = draw.kind == 10;
        if full {
            to = from;
        }
        let _ = write!(self.text, "{}", if clockwise { "G2" } else { "G3" });
        let in_r = matches!(draw.kind, 6 | 7) && !full;
        self.go(to);
        if in_r {
            let half = self
                .at
                .iter()
                .zip(&from)
                .map(|(a, b)| (a - b) * (a - b))
                .sum::<f64>()
                .sqrt()
                / 2.0;
            let signed = if turned.abs() > TAU / 2.0 {
                -exact.max(half)
            } else {
                exact.max(half)
            };
            // Rounded up, the end can be reached.
            let step = self.round(1e-3).max(1e-4);
            let reach = (signed.abs() / step).ceil() * step * signed.signum();
            self.word('R', reach);
        } else {
            for (axis, letter) in [first, second].map(|axis| (axis, ['I', 'J', 'K'][axis])) {
                let value = if self.centre_absolute {
                    centre[axis]
                } else {
                    centre[axis] - from[axis]
                };
                self.word(letter, value);
            }
        }
        self.text.push('\n');
    }

    fn step(&mut self, draw: &Draw) {
        match draw.kind {
            0..=2 => {
                self.text.push_str("G1");
                self.go([60.0 * draw.a, 60.0 * draw.b, 40.0 * draw.c]);
                self.text.push('\n');
            }
            3 => {
                self.text.push_str("G0");
                self.go([60.0 * draw.a, 60.0 * draw.b, self.at[2]]);
                self.text.push('\n');
            }
            4..=10 => self.arc(draw),
            11 => {
                self.incremental = !self.incremental;
                self.text
                    .push_str(if self.incremental { "G91\n" } else { "G90\n" });
            }
            12 => self.text.push_str("G4 P0\n"),
            13 => {
                self.plane = (self.plane + 1) % 3;
                self.text.push_str(["G17\n", "G18\n", "G19\n"][self.plane]);
            }
            14 => {
                self.centre_absolute = !self.centre_absolute;
                self.text.push_str(if self.centre_absolute {
                    "G90.1\n"
                } else {
                    "G91.1\n"
                });
            }
            _ => {
                self.text.push_str("G92");
                let x = self.round(20.0 * draw.a);
                self.word('X', x);
                self.at[0] = x;
                self.text.push('\n');
            }
        }
    }
}

pub fn program(draws: &[Draw]) -> String {
    let mut writer = Writer {
        text: "G21 G17 G90 G91.1 G94 G40 G49 G54\nF100\nG0 X-70 Y-70 Z-50\nG1 X10 Y20 Z-5\n"
            .to_owned(),
        at: [10.0, 20.0, -5.0],
        incremental: false,
        plane: 0,
        centre_absolute: false,
        steps: usize::from(draws.len().is_multiple_of(2)),
    };
    for draw in draws {
        writer.step(draw);
    }
    writer.text.push_str("G92.1\nM2\n");
    writer.text
}
