//! Arguments of `deviations`.

use std::path::PathBuf;

use clap::Args;
use leadscrew_nc::coordinates::Axis;

/// Places of axes: `X=100,B=90`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Places(pub Vec<(Axis, f64)>);

fn places(text: &str) -> Result<Places, String> {
    let one = |part: &str| {
        let wrong = || format!("`{part}`: an axis and its coordinate are expected, as X=100");
        let (letter, value) = part.split_once('=').ok_or_else(wrong)?;
        let mut letters = letter.trim().chars();
        let axis = letters.next().and_then(Axis::from_letter);
        let axis = axis.filter(|_| letters.next().is_none());
        let value: Option<f64> = value.trim().parse().ok();
        let value = value.filter(|value| value.is_finite());
        axis.zip(value).ok_or_else(wrong)
    };
    let list: Vec<_> = text.split(',').map(one).collect::<Result<_, _>>()?;
    for (index, (axis, _)) in list.iter().enumerate() {
        if list[..index].iter().any(|(other, _)| other == axis) {
            return Err(format!("{axis} is given twice"));
        }
    }
    Ok(Places(list))
}

/// Arguments of `deviations`.
#[derive(Debug, Args)]
pub struct DeviationsArgs {
    /// The machine: a file, or one that is built in (6904MF2, lathe)
    pub machine: String,
    /// A place in machine coordinates, mm and degrees; with --map, --plot and --corrections these axes stand there, and the
    /// others move over their ends. Rotary axes stand at 0 if they are not named
    #[arg(long, value_name = "AXIS=PLACE,…", value_parser = places, allow_hyphen_values = true)]
    pub at: Option<Places>,
    /// Show deviation and correction at every place of the grid
    #[arg(long)]
    pub map: bool,
    /// Places on each axis of the grid, 2 to 101
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u16).range(2..=101))]
    pub steps: u16,
    /// Tip of the tool in the frame of the last unit that carries it, mm [default: that of the machine]
    #[arg(
        long,
        value_name = "X,Y,Z",
        value_delimiter = ',',
        num_args = 3,
        allow_negative_numbers = true
    )]
    pub tool: Option<Vec<f64>>,
    /// A screw map on the board or in the control corrects the drives' own errors: leave them out
    #[arg(long)]
    pub drive_errors_elsewhere: bool,
    /// Write the corrections over the grid to FILE, a term of `leadscrew correct`
    #[arg(long, value_name = "FILE.toml")]
    pub corrections: Option<PathBuf>,
    /// Error, µm, that tools of another length may bring into the table of corrections: so far it holds for them
    #[arg(long, value_name = "UM", default_value_t = 1.0)]
    pub tool_error_um: f64,
    /// Print the report as JSON, alone, on standard output
    #[arg(long)]
    pub json: bool,
    /// Draw the deformed working volume in its projections to FILE.svg or FILE.png
    #[arg(long, value_name = "FILE")]
    pub plot: Option<PathBuf>,
}
