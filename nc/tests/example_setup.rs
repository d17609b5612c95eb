//! The example of docs/correct.md: its setup can be read, and K over its volume is a golden table.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use leadscrew_nc::coordinates::{Axis, Coordinates};
use leadscrew_nc::setup::Setup;
use leadscrew_nc::terms::{Approach, Circumstances, Direction};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/examples/correct")
}

fn setup() -> Setup {
    let read = |name: &str| {
        std::fs::read_to_string(folder().join(name)).map_err(|error| error.to_string())
    };
    Setup::read(&read("setup.toml").unwrap(), &read).unwrap()
}

fn circumstances(direction: Direction) -> Circumstances {
    Circumstances {
        tool: Some(3),
        tool_offset: Some(Coordinates::xyz(0.0, 0.0, 80.0)),
        approach: Approach::UNKNOWN.with(Axis::X, direction),
    }
}

#[test]
fn k_of_the_example_over_its_volume() {
    let setup = setup();
    let mut table =
        String::from("       X        Y        Z  way of X      K_X      K_Y      K_Z, mm\n");
    for x in [20.0, 100.0, 225.5, 380.0] {
        for (y, z) in [(80.0, 140.0), (200.0, 140.0), (200.0, 290.0)] {
            for (direction, way) in [(Direction::Up, "up"), (Direction::Down, "down")] {
                let at = Coordinates::xyz(x, y, z);
                let k = setup
                    .terms
                    .correction(&at, &circumstances(direction))
                    .unwrap();
                writeln!(
                    table,
                    "{x:8.1} {y:8.1} {z:8.1}  {way:>8} {:8.5} {:8.5} {:8.5}",
                    k[Axis::X],
                    k[Axis::Y],
                    k[Axis::Z]
                )
                .unwrap();
            }
        }
    }
    insta::assert_snapshot!(table);
}

#[test]
fn the_shares_of_its_terms_at_one_place() {
    let setup = setup();
    let at = Coordinates::xyz(225.5, 200.0, 140.0);
    let mut table = String::new();
    for (name, k) in setup
        .terms
        .each(&at, &circumstances(Direction::Down))
        .unwrap()
    {
        writeln!(
            table,
            "{name:24} {:8.5} {:8.5} {:8.5}",
            k[Axis::X],
            k[Axis::Y],
            k[Axis::Z]
        )
        .unwrap();
    }
    insta::assert_snapshot!(table);
}
