//! What is built where. Boards are never built together with the host's packages: cargo would unify
//! their features.

/// Packages that build and are tested on the host. All rings name all of them: another choice has
/// other features of shared dependencies, and cargo would build those again.
pub const HOST: &[&str] = &[
    "leadscrew",
    "leadscrew-hal-mock",
    "leadscrew-app",
    "board-common",
    "leadscrew-client",
    "leadscrew-nc",
    "leadscrew-process",
    "leadscrew-host",
    QEMU,
    EMULATOR,
    "xtask",
];

/// The QEMU harness; all its ignored tests need QEMU.
pub const QEMU: &str = "leadscrew-qemu";

/// The emulated part; its ignored tests need the image of [`AXIS_BOARD`].
pub const EMULATOR: &str = "leadscrew-emulator";

/// Board crates with the target of each, and the words that choose its chip; one cargo call a line.
pub const BOARDS: &[(&str, &str, &[&str])] = &[
    ("board-mps2-an386", TARGET, &[]),
    (AXIS_BOARD, TARGET, F407),
    (AXIS_BOARD, TARGET, F405),
];

/// Chips of the board that is flashed, by name, with the words that choose each: one cargo call a chip.
/// The last one's image is the one that the emulated part runs.
pub const CHIPS: &[(&str, &[&str])] = &[("stm32f405rg", F405), ("stm32f407vg", &[])];

/// The chip by default, and the program of the proofs.
const F407: &[&str] = &["--features", "tick-only"];
const F405: &[&str] = &["--no-default-features", "--features", "stm32f405rg"];

/// The target of all boards so far.
pub const TARGET: &str = "thumbv7em-none-eabihf";

/// The board whose program `sized` is a firmware without a board's drivers, for its size.
pub const SIZED_BOARD: &str = "board-mps2-an386";

/// The board that is flashed.
pub const AXIS_BOARD: &str = "board-stm32f4";

#[cfg(test)]
mod tests {
    use std::fs;

    use crate::command::root;

    /// Among them that every `unsafe` block tells its reason.
    #[test]
    fn all_packages_keep_to_the_lints_of_the_workspace() {
        let text = fs::read_to_string(root().join("Cargo.toml")).unwrap();
        let manifest: toml::Table = text.parse().unwrap();
        let lints = &manifest["workspace"]["lints"]["clippy"];
        assert_eq!(lints["undocumented_unsafe_blocks"].as_str(), Some("deny"));
        let members = manifest["workspace"]["members"].as_array().unwrap();
        assert!(members.len() > 5);
        for member in members {
            let member = member.as_str().unwrap();
            let path = root().join(member).join("Cargo.toml");
            let text = fs::read_to_string(path).unwrap();
            let manifest: toml::Table = text.parse().unwrap();
            let lints = manifest
                .get("lints")
                .and_then(|lints| lints.get("workspace"));
            assert_eq!(lints.and_then(toml::Value::as_bool), Some(true), "{member}");
        }
    }
}
