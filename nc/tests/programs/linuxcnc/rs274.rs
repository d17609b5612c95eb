//! What LinuxCNC's stand-alone interpreter makes of a program: its canonical movements, in machine coordinates.

use std::f64::consts::TAU;
use std::path::Path;
use std::process::Command;

use leadscrew_nc::coordinates::Coordinates;
use leadscrew_nc::path::arc::Plane;

use crate::motion::{Motion, Shape};

const RS274: &str = "/usr/bin/rs274";
/// Ends of an arc that are nearer than this, mm, are printed alike: a full circle.
const CLOSED_MM: f64 = 1e-5;

/// True where it is installed; said aloud where it is not.
pub fn is_installed() -> bool {
    let is_there = Path::new(RS274).exists();
    if !is_there {
        eprintln!("SKIPPED: no {RS274}: install linuxcnc-uspace to compare with its interpreter");
    }
    is_there
}

/// Its tables. The stand-alone interpreter counts them in inches.
pub struct Control {
    /// Of G54, mm.
    pub origin_mm: [f64; 3],
    /// Tool table, inches.
    pub tools: &'static str,
    /// Where the axes stand at the start, machine coordinates.
    pub start: Coordinates,
}

/// A canonical movement, and what is in force meanwhile.
#[derive(Clone, Debug)]
pub struct Canon {
    /// `N30`, or `N.....` without a number.
    pub block: String,
    pub tool: Option<u32>,
    pub tool_offset: Coordinates,
    /// Half of the last digit that its places are printed in, mm.
    pub printed_mm: f64,
    pub motion: Motion,
}

impl Control {
    /// Runs a program.
    pub fn run(&self, program: &[u8]) -> Vec<Canon> {
        let folder = tempfile::tempdir().unwrap();
        let file = |name: &str| folder.path().join(name);
        std::fs::write(file("program.ngc"), program).unwrap();
        std::fs::write(file("tool.tbl"), self.tools).unwrap();
        std::fs::write(file("control.var"), self.variables()).unwrap();
        // It keeps the tool table in a file at home, which others that run at the same time would share.
        let output = Command::new(RS274)
            .env("HOME", folder.path())
            .arg("-g")
            .arg("-t")
            .arg(file("tool.tbl"))
            .arg("-v")
            .arg(file("control.var"))
            .arg(file("program.ngc"))
            .arg(file("out.txt"))
            .output()
            .unwrap();
        let canon = std::fs::read_to_string(file("out.txt")).unwrap_or_default();
        assert!(
            canon.contains("PROGRAM_END"),
            "{}{canon}\n{}",
            String::from_utf8_lossy(&output.stderr),
            String::from_utf8_lossy(program)
        );
        motions(&canon, self.start)
    }

    fn variables(&self) -> String {
        let mut text = String::new();
        let mut put =
            |number: usize, value: f64| text.push_str(&format!("{number}\t{value:.12}\n"));
        for number in (5161..=5169).chain(5181..=5189).chain(5210..=5219) {
            put(number, 0.0);
        }
        put(5220, 1.0);
        for system in 0..9 {
            for axis in 0..10 {
                let mm = if system == 0 {
                    self.origin_mm.get(axis)
                } else {
                    None
                };
                put(5221 + 20 * system + axis, mm.copied().unwrap_or(0.0) / 25.4);
            }
        }
        text
    }
}

fn numbers(arguments: &str) -> Vec<f64> {
    arguments
        .split([',', ' '])
        .filter(|part| !part.is_empty())
        .filter_map(|part| part.parse().ok())
        .collect()
}

/// Movements of canonical commands: they come without the offsets, which commands of their own set.
struct Reader {
    origin: Coordinates,
    shift: Coordinates,
    tool_offset: Coordinates,
    tool: Option<u32>,
    selected: Option<u32>,
    plane: Plane,
    unit: f64,
    at: Coordinates,
    all: Vec<Canon>,
}

fn motions(canon: &str, start: Coordinates) -> Vec<Canon> {
    let mut reader = Reader {
        origin: Coordinates::ZERO,
        shift: Coordinates::ZERO,
        tool_offset: Coordinates::ZERO,
        tool: None,
        selected: None,
        plane: Plane::Xy,
        unit: 1.0,
        at: start,
        all: Vec::new(),
    };
    for line in canon.lines() {
        let block = line.split_whitespace().nth(1).unwrap_or("");
        if let Some((call, arguments)) = line.split_once('(') {
            let call = call.split_whitespace().last().unwrap_or("");
            reader.call(block, call, arguments.trim_end_matches(')'));
        }
    }
    reader.all
}

impl Reader {
    fn call(&mut self, block: &str, call: &str, arguments: &str) {
        let n: Vec<f64> = numbers(arguments);
        let place = |at: usize| Coordinates::xyz(n[at], n[at + 1], n[at + 2]) * self.unit;
        match call {
            "USE_LENGTH_UNITS" => {
                self.unit = if arguments.contains("INCHES") {
                    25.4
                } else {
                    1.0
                };
            }
            "SET_G5X_OFFSET" => self.origin = place(1),
            "SET_G92_OFFSET" => self.shift = place(0),
            "USE_TOOL_LENGTH_OFFSET" => self.tool_offset = place(0),
            "SELECT_TOOL" => self.selected = Some(n[0] as u32),
            "CHANGE_TOOL" => self.tool = self.selected,
            "SELECT_PLANE" => {
                self.plane = match arguments {
                    "CANON_PLANE_XZ" => Plane::Zx,
                    "CANON_PLANE_YZ" => Plane::Yz,
                    _ => Plane::Xy,
                }
            }
            "STRAIGHT_TRAVERSE" | "STRAIGHT_FEED" => {
                let to = place(0) + self.offset();
                self.go(block, call == "STRAIGHT_FEED", to, Shape::Line);
            }
            "ARC_FEED" => self.arc(block, &n),
            _ => {}
        }
    }

    fn offset(&self) -> Coordinates {
        self.origin + self.shift + self.tool_offset
    }

    fn arc(&mut self, block: &str, n: &[f64]) {
        let (plane, unit) = (self.plane, self.unit);
        let [first, second] = plane.axes();
        let end = Coordinates::ZERO
            .with(first, n[0] * unit)
            .with(second, n[1] * unit)
            .with(plane.across(), n[5] * unit);
        let to = end + self.offset();
        let moved = plane.of(&self.offset());
        let centre = [n[2] * unit + moved[0], n[3] * unit + moved[1]];
        let mut shape = Shape::arc(plane, &self.at, &to, centre, n[4] < 0.0, CLOSED_MM);
        if let Shape::Arc { sweep, .. } = &mut shape {
            *sweep += n[4].signum() * TAU * (n[4].abs() - 1.0);
        }
        self.go(block, true, to, shape);
    }

    fn go(&mut self, block: &str, is_feed: bool, to: Coordinates, shape: Shape) {
        let from = std::mem::replace(&mut self.at, to);
        self.all.push(Canon {
            block: block.to_owned(),
            tool: self.tool,
            tool_offset: self.tool_offset,
            printed_mm: 0.5e-4 * self.unit,
            motion: Motion {
                is_feed,
                from,
                to,
                shape,
            },
        });
    }
}
