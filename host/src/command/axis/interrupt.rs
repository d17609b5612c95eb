//! Ctrl-C: the first one asks the axis to stop, whatever waits then ends; the second one ends the tool at once.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::error::CommandError;

/// Exit code of a tool that was interrupted twice, that of a shell.
const INTERRUPTED: i32 = 130;

/// The flag that Ctrl-C sets. To be asked for once in a process.
pub fn flag() -> Result<Arc<AtomicBool>, CommandError> {
    let flag = Arc::new(AtomicBool::new(false));
    let set = Arc::clone(&flag);
    ctrlc::set_handler(move || {
        if set.swap(true, Ordering::Relaxed) {
            // The axis stops by itself: its lease is not renewed any more.
            std::process::exit(INTERRUPTED);
        }
    })
    .map_err(|error| CommandError::Data(format!("Ctrl-C cannot be watched: {error}")))?;
    Ok(flag)
}
