//! What the simulated control makes of a program: straight feeds of a tool, in the coordinates of the work offset.

use leadscrew_nc::block::{Block, Blocks, Lexis};

use super::ProveOutError;

/// A straight feed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Feed {
    /// Number of the tool.
    pub tool: u32,
    /// Where it begins, mm.
    pub from: [f64; 3],
    /// Where it ends, mm.
    pub to: [f64; 3],
}

/// G codes that a straight program of one work offset needs and that change no place.
const IDLE_G: [i64; 7] = [17, 21, 40, 43, 54, 90, 94];

/// The feeds of a program. The control is a small one: straight lines in absolute coordinates of one work offset.
///
/// # Errors
/// A block that it does not know, by its line.
pub fn feeds(program: &str) -> Result<Vec<Feed>, ProveOutError> {
    let mut control = Control::default();
    let mut blocks = Blocks::new(program.as_bytes());
    let mut bytes = Vec::new();
    let mut block = Block::default();
    let mut line = 0;
    while blocks
        .next_into(&mut bytes)
        .map_err(|error| ProveOutError::Program {
            line,
            reason: error.to_string(),
        })?
    {
        line += 1;
        let read = block
            .read(&bytes, &Lexis::linuxcnc())
            .map_err(|flaw| format!("{flaw:?}"));
        read.and_then(|()| control.run(&block))
            .map_err(|reason| ProveOutError::Program { line, reason })?;
    }
    Ok(control.feeds)
}

#[derive(Default)]
struct Control {
    at: [f64; 3],
    feeding: bool,
    /// The tool called, and the one in the spindle.
    called: u32,
    tool: u32,
    feeds: Vec<Feed>,
}

impl Control {
    fn run(&mut self, block: &Block) -> Result<(), String> {
        let mut to = self.at;
        for word in &block.words {
            let number = word.number().ok_or("a word without a number")?;
            match word.letter {
                b'X' => to[0] = number.value(),
                b'Y' => to[1] = number.value(),
                b'Z' => to[2] = number.value(),
                b'G' => self.prepare(number.whole())?,
                b'T' => self.called = u32::try_from(number.whole().unwrap_or(-1)).unwrap_or(0),
                b'M' if number.whole() == Some(6) => self.tool = self.called,
                b'M' | b'N' | b'F' | b'S' | b'H' => {}
                letter => return Err(format!("the simulated control has no {}", letter as char)),
            }
        }
        if to != self.at && self.feeding {
            self.feeds.push(Feed {
                tool: self.tool,
                from: self.at,
                to,
            });
        }
        self.at = to;
        Ok(())
    }

    fn prepare(&mut self, code: Option<i64>) -> Result<(), String> {
        match code {
            Some(0) => self.feeding = false,
            Some(1) => self.feeding = true,
            Some(code) if IDLE_G.contains(&code) => {}
            code => return Err(format!("the simulated control has no G{code:?}")),
        }
        Ok(())
    }
}
