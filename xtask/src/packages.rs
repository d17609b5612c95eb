//! What is built where. Boards are never built together with the host's packages: cargo would unify
//! their features.

/// Packages that build and are tested on the host. All rings name all of them: another choice has
/// other features of shared dependencies, and cargo would build those again.
pub const HOST: &[&str] = &[
    "leadscrew",
    "leadscrew-hal-mock",
    "leadscrew-app",
    "leadscrew-client",
    "leadscrew-host",
    QEMU,
    "leadscrew-emulator",
    "xtask",
];

/// The QEMU harness; all its ignored tests need QEMU.
pub const QEMU: &str = "leadscrew-qemu";

/// Board crates with the target of each; one cargo call a board.
pub const BOARDS: &[(&str, &str)] = &[("board-mps2-an386", TARGET), ("board-stm32f4", TARGET)];

/// The target of all boards so far.
pub const TARGET: &str = "thumbv7em-none-eabihf";

/// The board whose programs `sized` and `tick_only` stand for a board's firmware in sizes and proofs.
pub const PROOF: &str = "board-mps2-an386";
