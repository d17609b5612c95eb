//! The guided procedures, on the firmware in this process.

mod setup;
mod support;
