//! Any bytes as a program, in any dialect, under any kind of correction, on machines of which much or little is known. For the
//! tests and for the fuzzer.
//!
//! The first four bytes choose dialect, terms, state of the machine and tolerance, each by its remainder; the rest is the program.

use leadscrew_nc::block::{Block, Blocks, Word, body_len};
use leadscrew_nc::corrector::Refusal;
use leadscrew_nc::dialect::{Code, Dialect, Letter, Meaning};
use leadscrew_nc::terms::Terms;

use super::any_case::{CHOICES, Case, NOTHING};
use super::shop;
use super::side_by_side::Outcome;

/// Farther out than this, mm, sums in f64 are no longer exact to the last digit of the words.
const FARTHEST_MM: f64 = 1e4;
/// Holds a program against what must be true of every one: see the functions below.
pub fn check(bytes: &[u8]) {
    let mut choices = [0; CHOICES];
    for (choice, byte) in choices.iter_mut().zip(bytes) {
        *choice = usize::from(*byte);
    }
    let case = Case::of(choices);
    let program = bytes.get(CHOICES..).unwrap_or_default();
    let blocks = blocks(program);
    assert_eq!(blocks.concat(), program);
    is_untouched_by_nothing(&case, &blocks);
    is_written_well(&case, &blocks);
    ends_where_it_should(&case, &blocks);
}

fn blocks(program: &[u8]) -> Vec<Vec<u8>> {
    let mut reader = Blocks::new(program);
    let (mut all, mut block) = (Vec::new(), Vec::new());
    while reader.next_into(&mut block).unwrap_or(false) {
        all.push(block.clone());
    }
    all
}

/// Without a correction all passes; with one by nothing all up to the block that is refused.
fn is_untouched_by_nothing(case: &Case, blocks: &[Vec<u8>]) {
    let state = case.machine();
    let mut identity = case.corrector(Terms::none(), &state);
    let mut nothing = case.corrector(shop::terms(&NOTHING), &state);
    let mut is_refused = false;
    for (index, block) in blocks.iter().enumerate() {
        let mut out = Vec::new();
        identity.block(block, &mut out).unwrap();
        assert_eq!(out, *block);
        if !is_refused {
            out.clear();
            match nothing.block(block, &mut out) {
                Ok(()) => assert_eq!(out, *block),
                Err(refusal) => {
                    is_refused = true;
                    is_within(&refusal, index, block, &out);
                }
            }
        }
    }
}

/// Nothing is written of a block that is refused, and the place told is in it.
fn is_within(refusal: &Refusal, index: usize, block: &[u8], out: &[u8]) {
    assert!(out.is_empty(), "{refusal}");
    assert_eq!(refusal.block, index as u64 + 1, "{refusal}");
    assert!((1..=block.len() + 1).contains(&refusal.column), "{refusal}");
    assert!(!refusal.to_string().contains('\n'), "{refusal}");
}

/// A block in is a block out, or several: with the same end, the same comments and the same words that are no places; one alone
/// where the radius is compensated; and what comes out can be read again and is refused by no control as exact as this one.
fn is_written_well(case: &Case, blocks: &[Vec<u8>]) {
    let mut state = case.machine();
    let mut corrector = case.corrector(case.terms(), &state);
    let mut original = case.corrector(case.less_than_a_step(), &state);
    // Rounding of the sums.
    let radii = state.radius_tolerance_mm.unwrap_or(0.01) + 1e-6;
    state.radius_tolerance_mm = Some(radii);
    let mut again = Some(case.corrector(case.less_than_a_step(), &state));
    let dialect = case.dialect();
    let mut follower = Follower::default();
    for (index, block) in blocks.iter().enumerate() {
        let mut out = Vec::new();
        if let Err(refusal) = corrector.block(block, &mut out) {
            return is_within(&refusal, index, block, &out);
        }
        let written = self::blocks(&out);
        let Some(last) = written.last() else {
            panic!("a block is lost: {}", String::from_utf8_lossy(block));
        };
        assert_eq!(end_of(last), end_of(block), "{}", shown(block, &out));
        if follower.compensated(block, &dialect) {
            assert_eq!(written.len(), 1, "{}", shown(block, &out));
        }
        if !follower.has_ended {
            assert_eq!(
                kept([block.as_slice()], &dialect),
                kept(written.iter().map(Vec::as_slice), &dialect),
                "{}",
                shown(block, &out)
            );
        }
        // What is wrong with the program itself is wrong with its correction, too.
        if original.block(block, &mut Vec::new()).is_err() {
            again = None;
        }
        for block_out in &written {
            let mut same = Vec::new();
            let passed = again
                .as_mut()
                .map(|again| again.block(block_out, &mut same));
            if let Some(Err(refusal)) = passed {
                panic!(
                    "{}{refusal}\n{}",
                    shown(block, &out),
                    String::from_utf8_lossy(&blocks.concat())
                );
            }
        }
    }
}

fn end_of(block: &[u8]) -> &[u8] {
    &block[body_len(block)..]
}

fn shown(block: &[u8], out: &[u8]) -> String {
    let text = |bytes| String::from_utf8_lossy(bytes).into_owned();
    format!("{:?} -> {:?}: ", text(block), text(out))
}

/// Words that are no places, feeds and turns of arcs, and comments, in their order.
fn kept<'a>(blocks: impl IntoIterator<Item = &'a [u8]>, dialect: &Dialect) -> Vec<Vec<u8>> {
    let mut all = Vec::new();
    let mut read = Block::default();
    for block in blocks {
        if read.read(block, dialect.lexis()).is_err() {
            // Left out by a switch of the control, or behind the end: it is not read.
            all.push(block.to_vec());
            continue;
        }
        let stays = |word: &&Word| match dialect.letter(word.letter) {
            Letter::M | Letter::Label | Letter::Unknown => true,
            Letter::Parameter => !b"RFP".contains(&word.letter),
            Letter::G | Letter::Axis(_) | Letter::Way(_) | Letter::Centre(_) => false,
        };
        let words = read.words.iter().filter(stays);
        all.extend(words.map(|word| block[word.span()].to_vec()));
        all.extend(
            read.comments
                .iter()
                .map(|span| block[span.clone()].to_vec()),
        );
    }
    all
}

/// What of a program must be known to say whether the radius is compensated.
#[derive(Default)]
struct Follower {
    compensates: bool,
    has_ended: bool,
    block: Block,
}

impl Follower {
    /// True where the radius is compensated before the block or behind it.
    fn compensated(&mut self, block: &[u8], dialect: &Dialect) -> bool {
        let before = self.compensates;
        if self.block.read(block, dialect.lexis()).is_err() || self.block.delete.is_some() {
            return before;
        }
        for word in self
            .block
            .words
            .iter()
            .filter(|word| b"GM".contains(&word.letter))
        {
            let code = word
                .number()
                .and_then(|number| dialect.code(word.letter, number));
            match code {
                Some(Code::Of(Meaning::CompensationOn)) => self.compensates = true,
                Some(Code::Of(Meaning::CompensationOff)) => self.compensates = false,
                Some(Code::Of(Meaning::End)) => self.has_ended = true,
                _ => {}
            }
        }
        self.has_ended |= self.block.percent.is_some();
        (before || self.compensates) && !self.has_ended
    }
}

/// As long as the simple control knows what the program does, every block ends at its target plus K.
fn ends_where_it_should(case: &Case, blocks: &[Vec<u8>]) {
    let Some(polynomials) = case.polynomials() else {
        return;
    };
    let state = case.machine();
    let mut pair = shop::side_by_side(case.dialect, &state, polynomials, case.tolerance);
    for block in blocks {
        let body = &block[..block.len() - end_of(block).len()];
        let Ok(text) = std::str::from_utf8(body) else {
            return;
        };
        let Outcome::Compared = pair.run(text) else {
            return;
        };
        if pair
            .meant
            .machine
            .iter()
            .any(|(_, place)| place.abs() > FARTHEST_MM)
        {
            return;
        }
    }
}
