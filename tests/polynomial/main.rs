//! The local polynomial: against the fit in floating point, its symmetries, at low speed, under any captures whatever.

mod any_captures;
mod low_speed;
mod oracle;
mod steady;
mod support;
