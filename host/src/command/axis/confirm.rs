//! Questions to whoever sits before the axis.

use std::io::{IsTerminal as _, Write as _, stdin};

use crate::error::CommandError;

/// Asks whether to go on, on standard error; only a clear yes is one.
///
/// # Errors
/// The answer is another one, or nobody is there to answer.
pub fn confirm(question: &str, yes: bool) -> Result<(), CommandError> {
    if yes {
        return Ok(());
    }
    if !stdin().is_terminal() {
        return Err(CommandError::Usage(format!(
            "{question} Nobody is there to answer: add --yes to do it without being asked"
        )));
    }
    let mut terminal = std::io::stderr();
    let asked = write!(terminal, "{question} [y/N] ").and_then(|()| terminal.flush());
    asked.map_err(CommandError::Print)?;
    let mut answer = String::new();
    stdin()
        .read_line(&mut answer)
        .map_err(|error| CommandError::Data(format!("the answer cannot be read: {error}")))?;
    if matches!(answer.trim(), "y" | "Y" | "yes") {
        Ok(())
    } else {
        Err(CommandError::Data("not done: the answer was no".to_owned()))
    }
}
