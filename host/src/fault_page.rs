//! The page of faults, made from the table of the core.

use std::fmt::Write as _;

use leadscrew::supervisor::Fault;

const HEAD: &str = "\
# Faults

<!-- Made from src/supervisor/fault.rs by `cargo xtask golden`. -->

The axis keeps the **first** fault with its context (tick, state, position, velocity, setpoint, following error,
command, the value that tripped and its limit) until it is cleared; later ones are noted beside it. A stronger
reaction of a later fault acts all the same. Fault is left only by clearing it: with enable taken back, the drive off,
the axis at rest and the cause gone; an enable before that is refused, and told.

| reaction | what happens |
| --- | --- |
| warning | it is told; the axis goes on |
| controlled stop | jerk-limited stop in the loop, brake on, the loop holds while it closes, enable off; 0 V if it takes longer than `stop_timeout_s` |
| 0 V | 0 V in the same tick, the drive brakes by its own loop; after `zero_volts_s` brake on, `brake_delay_s` later enable off (stop category 1) |
| off | 0 V, brake on and enable off in the same tick |

**Removal of power is the hardware's emergency chain.** The board asks the drive to be off, by its enable; it cannot
make it powerless, and its emergency-stop input only tells of the chain. Switch the drive's power by contacts of
the chain, with a delay that leaves the 0 V its time where the drive brakes the axis.

States: Disabled → Enabling (enable on at 0 V, until the drive is ready; the loop holds for
`hold_before_release_s`; the brake opens for `brake_release_s`) → Ready ⇄ Moving → Stopping (controlled stop, brake on,
`brake_delay_s`) → Disabled, or → Fault where one is latched.

Bounds are those of the default parameters (`SupervisorParams`) at 1 kHz and 1 000 d/mm: from the fault's beginning to
the tick that detects it. The reaction is out in that tick where it is 0 V or off; a controlled stop begins in the
next one.
";

/// The page.
#[must_use]
pub fn page() -> String {
    let mut text = HEAD.to_owned();
    text.push_str("\n| number | fault | reaction |\n| --- | --- | --- |\n");
    for &fault in Fault::ALL {
        let (number, name) = (fault as u8, fault.name());
        let reaction = fault.reaction().text();
        let anchor = format!("{number}-{}", name.to_lowercase());
        // Writing to a String cannot fail.
        let _ = writeln!(text, "| {number} | [{name}](#{anchor}) | {reaction} |");
    }
    for &fault in Fault::ALL {
        let says = fault.description();
        let _ = write!(
            text,
            "\n## {} {}\n\n{}\n\n- **Detected:** {}\n- **Bound:** {}.\n- **Reaction:** {}.\n- **Recorded value and limit:** {}.\n- **Cause:** {}\n- **Remedy:** {}\n",
            fault as u8,
            fault.name(),
            says.what,
            says.condition,
            says.bound,
            says.reaction.text(),
            says.figure,
            says.cause,
            says.remedy,
        );
    }
    text
}
