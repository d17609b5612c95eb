//! LinuxCNC: its own programs corrected by nothing (`own_programs`); corrected programs through its own interpreter: that every
//! block ends at its target plus K (`ends`), that the way to it is the true one (`paths`, `drawn`). What is not installed is said
//! aloud and left out.

mod drawn;
mod ends;
mod own_programs;
mod paths;
mod rs274;
mod true_path;
