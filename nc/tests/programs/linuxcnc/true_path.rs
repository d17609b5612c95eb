//! A program and its setup, corrected, run through the interpreter; what it does against the original path plus K.

use std::io::BufReader;

use leadscrew_nc::coordinates::{Axis, Coordinates};
use leadscrew_nc::corrector::{CorrectError, Corrector, correct};
use leadscrew_nc::setup::Setup;
use leadscrew_nc::terms::{Approach, Circumstances, Direction};

use super::rs274::{self, Canon, Control};
use crate::polyline::strays;

/// Lines of a path that are looked at ahead of where it may have been at the place before.
const AHEAD: usize = 300;
/// Ways below it are rounding of sums and turn no axis round.
const TURNS_MM: f64 = 1e-6;
/// Half a step of the words, 0.0001 mm, on three axes and in I, J.
const ROUNDING_MM: f64 = 0.0003;

pub struct Case {
    pub setup: &'static str,
    pub files: fn(&str) -> Result<String, String>,
    pub program: String,
    pub control: Control,
    /// Blocks whose movements are those of cycles: only where their feeds end is compared.
    pub cycles: &'static [&'static str],
}

/// The corrected program, or why it is refused.
pub fn corrected(case: &Case) -> Result<Vec<u8>, CorrectError> {
    let setup = Setup::read(case.setup, &case.files).unwrap();
    let dialect = setup.dialect.unwrap();
    let corrector = Corrector::new(dialect, &setup.control, setup.terms, setup.tolerance);
    let mut out = Vec::new();
    let reader = BufReader::new(case.program.as_bytes());
    correct(reader, &mut out, &mut corrector.unwrap())?;
    Ok(out)
}

/// Where the tool goes by the program plus K, finely sampled, feeds only.
fn true_path(case: &Case, canons: &[Canon]) -> (Vec<Coordinates>, Vec<Coordinates>) {
    let setup = Setup::read(case.setup, &case.files).unwrap();
    let mut with = Circumstances {
        tool: setup.control.tool,
        ..Circumstances::default()
    };
    let (mut path, mut cycle_ends) = (Vec::new(), Vec::new());
    for canon in canons {
        let motion = &canon.motion;
        with.tool = canon.tool.or(with.tool);
        with.tool_offset = Some(canon.tool_offset);
        let k = |at: &Coordinates, approach: Approach| {
            let with = Circumstances { approach, ..with };
            *at + setup.terms.correction(at, &with).unwrap()
        };
        let in_cycle = case.cycles.contains(&canon.block.as_str());
        let samples = motion.samples();
        let mut approach = with.approach;
        for (index, at) in samples.iter().enumerate() {
            let onward = onward(approach, &samples[index..]);
            if motion.is_feed && !in_cycle {
                // Where an axis turns round the true place jumps.
                path.push(k(at, approach));
                if onward != approach {
                    path.push(k(at, onward));
                }
            }
            approach = onward;
        }
        if motion.is_feed && in_cycle {
            cycle_ends.push(k(samples.last().unwrap(), approach));
        }
        with.approach = approach;
    }
    (path, cycle_ends)
}

/// From where the axes come when they go on from the first of `samples`. About a turning point the steps from sample to sample are
/// below what turns an axis round; where it turns, and farther, it does so at that point.
fn onward(approach: Approach, samples: &[Coordinates]) -> Approach {
    let [at, next, ..] = samples else {
        return approach;
    };
    let turns = |(axis, by): (Axis, f64)| {
        let goes = |to: &Coordinates| (to[axis] - at[axis]) * by.signum() > TURNS_MM;
        let direction = if by > 0.0 {
            Direction::Up
        } else {
            Direction::Down
        };
        (by != 0.0 && samples.iter().any(goes)).then_some((axis, direction))
    };
    let by = *next - *at;
    by.iter()
        .filter_map(turns)
        .fold(approach, |approach, (axis, direction)| {
            approach.with(axis, direction)
        })
}

fn written_path(case: &Case, canons: &[Canon]) -> (Vec<Coordinates>, Vec<Coordinates>) {
    let (mut path, mut cycle_ends) = (Vec::new(), Vec::new());
    for canon in canons.iter().filter(|canon| canon.motion.is_feed) {
        let samples = canon.motion.samples();
        if case.cycles.contains(&canon.block.as_str()) {
            cycle_ends.extend(samples.last());
        } else {
            path.extend(samples);
        }
    }
    (path, cycle_ends)
}

/// Holds the path of the corrected program against the true one, each way round.
pub fn check(case: &Case) {
    let corrected = corrected(case).unwrap_or_else(|error| panic!("{error}"));
    if !rs274::is_installed() {
        return;
    }
    let original = case.control.run(case.program.as_bytes());
    let text = String::from_utf8_lossy(&corrected).into_owned();
    let written = case.control.run(&corrected);
    let (true_path, true_ends) = true_path(case, &original);
    let (written_path, written_ends) = written_path(case, &written);
    assert!(true_path.len() > 40, "the program moves");
    let tolerance = Setup::read(case.setup, &case.files).unwrap().tolerance.mm;
    for (places, path) in [(&true_path, &written_path), (&written_path, &true_path)] {
        if let Some((off, at)) = strays(places, path, tolerance + ROUNDING_MM, AHEAD) {
            panic!("{off} mm at {at:?}:\n{text}");
        }
    }
    assert_eq!(true_ends.len(), written_ends.len(), "{text}");
    for (truly, written) in true_ends.iter().zip(&written_ends) {
        let off = (*truly - *written).length_mm();
        assert!(off < ROUNDING_MM, "{truly:?} {written:?}\n{text}");
    }
    // Were nothing corrected, the test would have seen it.
    let feeds = original.iter().filter(|canon| canon.motion.is_feed);
    let uncorrected: Vec<_> = feeds.flat_map(|canon| canon.motion.samples()).collect();
    assert!(strays(&true_path, &uncorrected, 5.0 * tolerance, AHEAD).is_some());
}
