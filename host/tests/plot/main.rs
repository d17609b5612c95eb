//! Plots: what is drawn, read back from the SVG text and the PNG pixels.

mod decimation;
mod examples;
mod file;
mod input;
mod picture;
mod reading;
