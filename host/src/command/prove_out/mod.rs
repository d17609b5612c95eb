//! `leadscrew prove-out`: a part machined, probed, its program corrected, machined again, on a simulated machine.

mod picture;
mod report;

use std::io::Write;

use leadscrew_process::prove_out::{Amounts, Plant, prove_out};

use self::report::Report;
use super::{check_outputs_of, print, print_json};
use crate::cli::ProveOutArgs;
use crate::error::CommandError;
use crate::probed_axis::{ProbedAxis, learned_map};
use crate::progress::Progress;
use crate::whole_file;

/// 2σ of a probe that is believed, µm: the simulated surface releases one that scatters by no more, well before the way back ends.
const PROBE_UM: (f64, f64) = (0.01, 50.0);

/// Runs the command.
///
/// # Errors
/// A part that does not come out within its bounds, output that cannot be written.
pub fn run(args: &ProveOutArgs) -> Result<(), CommandError> {
    check_outputs_of(
        ("--corrected", args.corrected.as_deref()),
        ("--plot", args.plot.as_deref()),
        None,
    )?;
    if !(PROBE_UM.0..=PROBE_UM.1).contains(&args.probe_um) {
        return Err(CommandError::Usage(format!(
            "--probe-um {}: {} to {} um is expected",
            args.probe_um, PROBE_UM.0, PROBE_UM.1
        )));
    }
    let data = |error: &dyn std::fmt::Display| CommandError::Data(error.to_string());
    let out = {
        let _proving = Progress::endless("machining and probing");
        let map = learned_map(args.seed).map_err(CommandError::Data)?;
        let mut axis =
            ProbedAxis::new(&map, 1e-3 * args.probe_um, args.seed).map_err(CommandError::Data)?;
        prove_out(&Amounts::default(), Plant::Nothing, args.seed, &mut axis)
            .map_err(|error| data(&error))?
    };
    if let Some(path) = &args.corrected {
        whole_file::write(path, |file| file.write_all(out.corrected.as_bytes()))
            .map_err(CommandError::write(path))?;
    }
    if let Some(path) = &args.plot {
        picture::figure(&out).save(path)?;
    }
    let report = Report::new(args.seed, args.probe_um, &out);
    if args.json {
        print_json(&report)?;
    } else {
        print(&report.to_text())?;
    }
    if out.holds() {
        return Ok(());
    }
    Err(CommandError::Data(
        "the corrected part is not within the bounds that follow from the noise of the probe"
            .into(),
    ))
}
