//! The program corrected by the terms.

use std::fmt::Write as _;

use leadscrew_nc::coordinates::{Axis, Coordinates};
use leadscrew_nc::terms::{Circumstances, Terms};

use super::ProveOutError;
use super::part::tool;
use super::world::control_point;

/// The program with K added to every target, feeds in pieces of 5 mm: for straight programs in absolute coordinates of one work
/// offset, as this one is.
pub(super) fn corrected(program: &str, terms: &Terms) -> Result<String, ProveOutError> {
    let mut out = String::new();
    let mut at = [0.0_f64; 3];
    let (mut number, mut feeding) = (0, false);
    for line in program.lines() {
        let mut to = at;
        for word in line.split_whitespace().filter(|_| !line.starts_with('(')) {
            let value: f64 = word[1..].parse().unwrap_or(0.0);
            match &word[..1] {
                "X" => to[0] = value,
                "Y" => to[1] = value,
                "Z" => to[2] = value,
                "T" => number = value as u32,
                "G" if word == "G0" => feeding = false,
                "G" if word == "G1" => feeding = true,
                _ => {}
            }
        }
        if to == at {
            out += line;
            out.push('\n');
            continue;
        }
        let length = (0..3).map(|i| (to[i] - at[i]).powi(2)).sum::<f64>().sqrt();
        let pieces = if feeding {
            (length / 5.0).ceil() as usize
        } else {
            1
        };
        let tool = tool(number).ok_or(ProveOutError::Tool(number))?;
        let with = Circumstances {
            tool: Some(number),
            tool_offset: Some(Coordinates::xyz(0.0, 0.0, tool.length_mm)),
            ..Circumstances::default()
        };
        for piece in 1..=pieces {
            let part = piece as f64 / pieces as f64;
            let place: [f64; 3] = std::array::from_fn(|i| at[i] * (1.0 - part) + to[i] * part);
            let k = terms
                .correction(&control_point(place, tool.length_mm), &with)
                .map_err(|error| ProveOutError::Correction(error.to_string()))?;
            let code = if feeding { "G1" } else { "G0" };
            let _ = writeln!(
                out,
                "{code} X{:.4} Y{:.4} Z{:.4}",
                place[0] + k[Axis::X],
                place[1] + k[Axis::Y],
                place[2] + k[Axis::Z]
            );
        }
        at = to;
    }
    Ok(out)
}
