//! Whole programs, corrected: drawn at random and read again by a control as simple as can be (`drawn`), any bytes at all
//! (`any_bytes`), and those that LinuxCNC brings or runs, where it is installed (`linuxcnc`).

#[path = "../support/any_case.rs"]
mod any_case;
#[path = "../support/any_program.rs"]
mod any_program;
#[path = "../support/cases.rs"]
mod cases;
#[path = "../support/control.rs"]
mod control;
#[path = "../support/corpus.rs"]
mod corpus;
#[path = "../support/motion.rs"]
mod motion;
#[path = "../support/plain_words.rs"]
mod plain_words;
#[path = "../support/polyline.rs"]
mod polyline;
#[path = "../support/polynomial.rs"]
mod polynomial;
#[path = "../support/random_programs.rs"]
mod random_programs;
#[path = "../reader/files.rs"]
mod reader_files;
#[path = "../support/shop.rs"]
mod shop;
#[path = "../support/side_by_side.rs"]
mod side_by_side;

mod any_bytes;
mod drawn;
mod linuxcnc;
