//! What LinuxCNC's stand-alone interpreter makes of a program: its canonical movements, in machine coordinates.

use std::f64::consts::TAU;
use std::path::Path;
use std::process::Command;

use leadscrew_nc::coordinates::Coordinates;
use leadscrew_nc::path::arc::Plane;

const RS274: &str = "/usr/bin/rs274";

const ATTEMPTS: usize = 6;

pub fn is_installed() -> bool {
    Path::new(RS274).exists()
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

#[derive(Clone, Copy, Debug)]
enum Shape {
    Line,
    Arc {
        plane: Plane,
        centre: [f64; 2],
        sweep: f64,
    },
}

/// A canonical movement.
#[derive(Clone, Debug)]
pub struct Motion {
    /// `N30`, or `N.....` without a number.
    pub block: String,
    pub is_feed: bool,
    pub tool: Option<u32>,
    pub tool_offset: Coordinates,
    from: Coordinates,
    to: Coordinates,
    shape: Shape,
}

impl Control {
    /// Runs a program.
    pub fn run(&self, program: &[u8]) -> Vec<Motion> {
        let folder = tempfile::tempdir().unwrap();
        let file = |name: &str| folder.path().join(name);
        std::fs::write(file("program.ngc"), program).unwrap();
        std::fs::write(file("tool.tbl"), self.tools).unwrap();
        std::fs::write(file("control.var"), self.variables()).unwrap();
        let mut said = String::new();
        // Interpreters that run at the same time share a file of tools, and now and then one gives up for it.
        for _ in 0..ATTEMPTS {
            let output = Command::new(RS274)
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
            if canon.contains("PROGRAM_END") {
                return motions(&canon, self.start);
            }
            said = format!("{}{canon}", String::from_utf8_lossy(&output.stderr));
        }
        panic!("{said}\n{}", String::from_utf8_lossy(program));
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

fn motions(canon: &str, start: Coordinates) -> Vec<Motion> {
    let mut all = Vec::new();
    let (mut origin, mut shift) = (Coordinates::ZERO, Coordinates::ZERO);
    let mut tool_offset = Coordinates::ZERO;
    let (mut tool, mut selected) = (None, None);
    let mut plane = Plane::Xy;
    let mut from = start;
    for line in canon.lines() {
        let mut parts = line.split_whitespace().skip(1);
        let block = parts.next().unwrap_or("").to_owned();
        let Some((call, arguments)) = line.split_once('(') else {
            continue;
        };
        let call = call.split_whitespace().last().unwrap_or("");
        let n = numbers(arguments.trim_end_matches(')'));
        let (is_feed, end, shape) = match call {
            "SET_G5X_OFFSET" => {
                origin = Coordinates::xyz(n[1], n[2], n[3]);
                continue;
            }
            "SET_G92_OFFSET" => {
                shift = Coordinates::xyz(n[0], n[1], n[2]);
                continue;
            }
            "USE_TOOL_LENGTH_OFFSET" => {
                tool_offset = Coordinates::xyz(n[0], n[1], n[2]);
                continue;
            }
            "SELECT_TOOL" => {
                selected = Some(n[0] as u32);
                continue;
            }
            "CHANGE_TOOL" => {
                tool = selected;
                continue;
            }
            "SELECT_PLANE" => {
                plane = match arguments.trim_end_matches(')') {
                    "CANON_PLANE_XZ" => Plane::Zx,
                    "CANON_PLANE_YZ" => Plane::Yz,
                    _ => Plane::Xy,
                };
                continue;
            }
            "STRAIGHT_TRAVERSE" => (false, Coordinates::xyz(n[0], n[1], n[2]), None),
            "STRAIGHT_FEED" => (true, Coordinates::xyz(n[0], n[1], n[2]), None),
            "ARC_FEED" => {
                let [first, second] = plane.axes();
                let end = Coordinates::ZERO
                    .with(first, n[0])
                    .with(second, n[1])
                    .with(plane.across(), n[5]);
                (true, end, Some(([n[2], n[3]], n[4])))
            }
            _ => continue,
        };
        let to = end + origin + shift + tool_offset;
        let start = from;
        let shape = match shape {
            None => Shape::Line,
            Some((centre, turns)) => {
                let moved = plane.of(&(origin + shift + tool_offset));
                let centre = [centre[0] + moved[0], centre[1] + moved[1]];
                let angle = |place: &Coordinates| {
                    let [x, y] = plane.of(place);
                    (y - centre[1]).atan2(x - centre[0])
                };
                let way = (angle(&to) - angle(&start)) * turns.signum();
                let mut sweep = way.rem_euclid(TAU);
                let chord = plane.of(&(to - start));
                if chord[0].hypot(chord[1]) < 1e-5 {
                    sweep = TAU;
                }
                Shape::Arc {
                    plane,
                    centre,
                    sweep: turns.signum() * (sweep + TAU * (turns.abs() - 1.0)),
                }
            }
        };
        all.push(Motion {
            block,
            is_feed,
            tool,
            tool_offset,
            from: start,
            to,
            shape,
        });
        from = to;
    }
    all
}

impl Motion {
    /// Places along it, near enough to each other that the lines between them are within 0.1 µm of it; on arcs also where an
    /// axis turns round.
    pub fn samples(&self) -> Vec<Coordinates> {
        let count = match self.shape {
            Shape::Line if self.is_feed => 40,
            Shape::Line => 1,
            Shape::Arc { sweep, .. } => (sweep.abs() * 200.0).ceil() as usize + 20,
        };
        let mut fractions: Vec<f64> = (0..=count).map(|i| i as f64 / count as f64).collect();
        if let Shape::Arc {
            plane,
            centre,
            sweep,
        } = self.shape
        {
            let [x, y] = plane.of(&self.from);
            let start = (y - centre[1]).atan2(x - centre[0]);
            let quarters = (-20..=20).map(|quarter| f64::from(quarter) * TAU / 4.0);
            fractions.extend(
                quarters
                    .map(|angle| (angle - start) / sweep)
                    .filter(|fraction| (1e-6..1.0 - 1e-6).contains(fraction)),
            );
            fractions.sort_by(f64::total_cmp);
        }
        fractions
            .into_iter()
            .map(|fraction| self.at(fraction))
            .collect()
    }

    fn at(&self, fraction: f64) -> Coordinates {
        let mut place = self.from.towards(&self.to, fraction);
        if let Shape::Arc {
            plane,
            centre,
            sweep,
        } = self.shape
        {
            let [x, y] = plane.of(&self.from);
            let (sin, cos) = (fraction * sweep).sin_cos();
            let (dx, dy) = (x - centre[0], y - centre[1]);
            let [first, second] = plane.axes();
            place[first] = centre[0] + dx * cos - dy * sin;
            place[second] = centre[1] + dx * sin + dy * cos;
        }
        place
    }
}
