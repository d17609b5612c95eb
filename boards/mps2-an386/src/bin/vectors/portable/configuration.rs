//! The configuration of an axis from parameters in physical units, with each estimator at several rates.

use core::fmt::{self, Write};

use leadscrew::estimator::EstimatorConfig;
use leadscrew_hal_mock::machine::MachineParams;
use leadscrew_hal_mock::scenario::MoveAndBack;

use super::{Digest, ESTIMATORS, Words};

/// Rates of the tick, Hz.
const RATES: [f64; 2] = [1000.0, 20_000.0];

/// Takes in a text.
struct Text(Digest);

impl Write for Text {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        text.bytes().for_each(|byte| self.0.take(byte.into()));
        Ok(())
    }
}

/// The group.
pub fn run(words: &mut Words<'_>) {
    for tick_hz in RATES {
        for name in ESTIMATORS {
            let mut text = Text(Digest::new());
            configure(tick_hz, name, &mut text);
            words.push_digest(&text.0);
        }
    }
}

/// The configuration as text: every field of it, to its last bit. A refusal is one, too.
#[inline(never)]
fn configure(tick_hz: f64, name: &str, text: &mut Text) {
    let (scenario, machine) = (MoveAndBack::standard(tick_hz), MachineParams::z_16k20f3());
    let config = EstimatorConfig::by_name(name)
        .map_err(Into::into)
        .and_then(|known| scenario.tuned(&machine, known.expect("it is in the list"), false))
        .and_then(|estimator| scenario.axis_params(&machine, estimator))
        .and_then(|params| params.validate());
    // The digest takes all that is written.
    let _ = match config {
        Ok(config) => write!(text, "{config:?}"),
        Err(error) => write!(text, "{error:?}"),
    };
}
