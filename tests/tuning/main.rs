//! Tuning: margins against the time domain, what autotune offers, and how the axis then follows.

mod margins;
mod offers;
mod refusals;
mod tracking;
