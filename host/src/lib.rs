//! The `leadscrew` command: the core of the axis on a simulated machine, or on a recording of a real
//! encoder, with reports and plots.

pub mod accuracy;
pub mod axis;
pub mod axis_file;
pub mod calibration;
pub mod cli;
pub mod closed_loop;
pub mod command;
pub mod commissioning;
pub mod error;
pub mod fault_names;
pub mod fault_page;
pub mod figures;
pub mod identify;
pub mod listening;
pub mod machine_file;
pub mod map_file;
pub mod parallel;
pub mod plot;
mod progress;
pub mod recorded;
pub mod recording;
pub mod report;
pub mod sampler;
pub mod scenario_file;
pub mod scenario_run;
pub mod screw;
pub mod sim_encoder;
pub mod simulated_axis;
pub mod simulation;
pub mod statistics;
pub mod tacho_watch;
pub mod threads;
pub mod toml_file;
pub mod tracking;
pub mod truth;
mod whole_file;
