//! The store on a simulated flash.

mod contents;
mod flash;
mod power_cut;
mod saving;
mod upgrade;
