//! Positional deviations of machines: the small-angle sum against full rotations, indicators, files, maps.

mod exact;
mod files;
mod indicators;
mod machines;
mod maps;
mod rotary_table;
