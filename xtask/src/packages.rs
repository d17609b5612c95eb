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
    "leadscrew-host",
    QEMU,
    "leadscrew-emulator",
    "xtask",
];

/// The QEMU harness; all its ignored tests need QEMU.
pub const QEMU: &str = "leadscrew-qemu";

/// Board crates with the target of each, and the words that choose its chip; one cargo call a line.
pub const BOARDS: &[(&str, &str, &[&str])] = &[
    ("board-mps2-an386", TARGET, &[]),
    ("board-stm32f4", TARGET, &[]),
    ("board-stm32f4", TARGET, F405),
    ("board-stm32f4", TARGET, F446),
];

const F405: &[&str] = &["--no-default-features", "--features", "stm32f405rg"];
const F446: &[&str] = &["--no-default-features", "--features", "stm32f446re"];

/// The target of all boards so far.
pub const TARGET: &str = "thumbv7em-none-eabihf";

/// The board whose program `sized` is a firmware without a board's drivers, for its size.
pub const SIZED_BOARD: &str = "board-mps2-an386";

/// The board that is flashed.
pub const AXIS_BOARD: &str = "board-stm32f4";
