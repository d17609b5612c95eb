//! Corrects a program block by block: block in, block out, nothing looked at ahead (latency 0 blocks), memory for one block.
//!
//! Two things are kept for each axis: where it is as the program means it, and by how much the control stands elsewhere because
//! of the words written (`applied`). A word is written so that the block ends at the place meant plus K; as what was written
//! before is known, rounding never adds up. `block` reads, `instruction` sorts, `task` runs, `settings`, `tools` and `takers` keep modes and
//! offsets, `straight`, `arcs` and `cycles` correct, `legs` leads over several blocks, `words` and `write` put numbers back.

mod arcs;
mod cycles;
mod instruction;
mod known;
mod legs;
mod places;
mod refusal;
mod settings;
mod state;
mod straight;
mod stream;
mod takers;
mod task;
mod tools;
mod words;
mod write;

pub use known::SetupError;
pub use refusal::{Lost, Missing, Reason, Refusal, Within};
pub use stream::{CorrectError, Report, correct};

use instruction::{Found, Instruction};
use known::Known;
use places::Goal;
use state::{AxisState, AxisStates, Modes, Motion};
use task::Task;
use write::{Edits, Scales};

use crate::block::{Block, MAX_BLOCK, column};
use crate::coordinates::{AXES, Coordinates};
use crate::dialect::Dialect;
use crate::machine_state::MachineState;
use crate::path::Tolerance;
use crate::terms::{Approach, Circumstances, Shape, Terms};

/// Corrects the blocks of one program, one after the other.
#[derive(Debug)]
pub struct Corrector {
    known: Known,
    now: Now,
    number: u64,
    block: Block,
    instruction: Instruction,
    edits: Edits,
    before: Vec<u8>,
    after: Vec<u8>,
}

/// What the program has done so far.
#[derive(Clone, Debug)]
struct Now {
    modes: Modes,
    /// How words count in these modes.
    scales: Scales,
    axes: AxisStates,
    approach: Approach,
    /// The last K that was worked out for the end of a line: mostly the one of where the next begins.
    last_k: Option<(Coordinates, Circumstances, Coordinates)>,
    /// Tool in use.
    tool: Option<u32>,
    /// Tool that the next change takes.
    selected: Option<u32>,
    /// Tool whose offset is in force, where one is.
    offset_of: Option<Option<u32>>,
    /// The offset in force; none where unknown.
    tool_offset: Option<Coordinates>,
    /// Number that the radius for compensation is looked up by.
    radius_of: Option<u32>,
    /// The radius where the block says it.
    radius_mm: Option<f64>,
    cycle: cycles::Sticky,
    profile: Option<Box<Profile>>,
    ended: bool,
    begun: bool,
    /// The last block of several words had blanks between them.
    spaced: bool,
    /// What blocks end with.
    line_end: &'static [u8],
}

/// A profile that a cycle runs; when it is read the axes are where they were before.
#[derive(Clone, Debug)]
struct Profile {
    last: u32,
    axes: AxisStates,
    approach: Approach,
}

impl Corrector {
    /// For one program.
    ///
    /// # Errors
    /// What the machine's state says and the dialect does not know.
    pub fn new(
        dialect: Dialect,
        state: &MachineState,
        terms: Terms,
        tolerance: Tolerance,
    ) -> Result<Self, SetupError> {
        let known = Known::new(dialect, state, terms, tolerance)?;
        let now = known.start(state)?;
        Ok(Self {
            known,
            now,
            number: 0,
            block: Block::default(),
            instruction: Instruction::default(),
            edits: Edits::default(),
            before: Vec::new(),
            after: Vec::new(),
        })
    }

    /// Corrects one block, with what ends it, and puts it behind `out`: often as it was, sometimes with other numbers or a word
    /// more, sometimes as several blocks.
    ///
    /// # Errors
    /// What is not known or cannot be done; nothing is put out then, and the corrector is of no more use.
    pub fn block(&mut self, bytes: &[u8], out: &mut Vec<u8>) -> Result<(), Refusal> {
        self.number += 1;
        if self.known.shape == Shape::None || self.now.ended {
            out.extend_from_slice(bytes);
            return Ok(());
        }
        self.corrected(bytes, out)
            .map_err(|(byte, reason)| Refusal {
                block: self.number,
                column: column(bytes, byte),
                reason,
            })
    }

    /// Blocks so far.
    #[must_use]
    pub const fn blocks(&self) -> u64 {
        self.number
    }

    /// True where nothing is corrected at all: a program comes out as it is, whatever is in it.
    #[must_use]
    pub fn is_identity(&self) -> bool {
        self.known.shape == Shape::None
    }

    fn corrected(&mut self, bytes: &[u8], out: &mut Vec<u8>) -> Result<(), Found> {
        if bytes.len() >= MAX_BLOCK {
            return Err((0, Reason::TooLong));
        }
        let read = self.block.read(bytes, self.known.dialect.lexis());
        read.map_err(|flaw| (flaw.byte, flaw.into()))?;
        if let Some(end) = bytes.get(self.block.end..).filter(|end| !end.is_empty()) {
            self.now.line_end = match end {
                b"\r\n" => b"\r\n",
                b"\r" => b"\r",
                _ => b"\n",
            };
        }
        if self.is_idle()? {
            out.extend_from_slice(bytes);
            return Ok(());
        }
        self.instruction
            .sort(&self.block, bytes, &self.known.dialect)?;
        self.edits.clear();
        self.before.clear();
        self.after.clear();
        let mut task = Task {
            known: &mut self.known,
            now: &mut self.now,
            bytes,
            block: &self.block,
            said: &self.instruction,
            edits: &mut self.edits,
            before: &mut self.before,
            after: &mut self.after,
            counts_anew: false,
        };
        task.run()?;
        self.put(bytes, out);
        Ok(())
    }

    fn put(&mut self, bytes: &[u8], out: &mut Vec<u8>) {
        out.extend_from_slice(&self.before);
        if self.edits.is_empty() {
            out.extend_from_slice(bytes);
        } else {
            self.edits.apply(bytes, out);
        }
        if !self.after.is_empty() {
            if self.block.end == bytes.len() {
                // The last block of a file without an end of its own: it gets one, its pieces' last does not.
                out.extend_from_slice(self.now.line_end);
                let kept = self.after.len() - self.now.line_end.len();
                self.after.truncate(kept);
            }
            out.extend_from_slice(&self.after);
        }
    }

    /// True where the control has nothing to do that matters here.
    fn is_idle(&mut self) -> Result<bool, Found> {
        let block = &self.block;
        if block.percent.is_some() {
            // The second one ends the tape.
            self.now.ended = self.now.begun;
            return Ok(true);
        }
        if let Some(flow) = &block.flow {
            return Err((flow.start, Reason::Flow));
        }
        if block.is_idle() {
            return Ok(true);
        }
        self.now.begun = true;
        if let Some(delete) = block.delete {
            return match self.known.block_delete {
                Some(leave_out) => Ok(leave_out),
                None => Err((delete, Reason::Delete)),
            };
        }
        Ok(false)
    }
}

/// All axes unknown.
const NOWHERE: AxisStates = [AxisState::UNKNOWN; AXES];
