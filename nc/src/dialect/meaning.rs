//! What a G or M code does, as far as a correction must know.

use serde::Deserialize;

/// What a code does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Meaning {
    /// Nothing that a correction must know; its words are no places.
    Harmless,
    /// As `harmless`, and done when the movement of its block has ended.
    AfterMotion,
    /// The program ends; what follows is not run.
    End,
    /// Positioning, on any path.
    Rapid,
    /// A straight feed.
    Line,
    /// An arc clockwise.
    ArcClockwise,
    /// An arc counterclockwise.
    ArcCounterclockwise,
    /// A spline whose inner points I, J, P, Q are given from its ends.
    Spline,
    /// A thread from where the tool stands to the place given.
    Thread,
    /// Towards a place until a probe touches.
    Probe,
    /// Time; X, U and P are no places.
    Dwell,
    /// Plane of arcs X, Y.
    PlaneXy,
    /// Plane of arcs Z, X.
    PlaneZx,
    /// Plane of arcs Y, Z.
    PlaneYz,
    /// Inches.
    Inches,
    /// Millimetres.
    Millimetres,
    /// Words are places.
    Absolute,
    /// Words are ways.
    Incremental,
    /// I, J, K are places.
    CentreAbsolute,
    /// I, J, K are ways from the start.
    CentreIncremental,
    /// X words are diameters.
    Diameter,
    /// X words are radii.
    Radius,
    /// Cutter or nose radius compensation ends.
    CompensationOff,
    /// Cutter or nose radius compensation begins.
    CompensationOn,
    /// Tool length in force: of H, or of the tool in use.
    ToolLength,
    /// Tool length of H in force, its sign turned.
    ToolLengthNegative,
    /// Tool length of H on top.
    ToolLengthAdded,
    /// Tool offset given in the words.
    ToolOffsetGiven,
    /// No tool length in force.
    ToolLengthOff,
    /// The coordinates get an origin so that the tool stands at the place given.
    Shift,
    /// The origin of `shift` ends.
    ShiftOff,
    /// A local origin, given in the coordinates in force.
    Local,
    /// Sets offsets and tools (G10).
    SetData,
    /// The words of this block are machine coordinates.
    MachineCoordinates,
    /// To the reference, over the place given.
    Reference,
    /// The reference is where the tool stands.
    SetReference,
    /// Drilling ends at the height where it began.
    ReturnToStart,
    /// Drilling ends at R.
    ReturnToRetract,
    /// F is the inverse of the time of a block.
    InverseTime,
    /// F is a feed.
    FeedRate,
    /// No cycle any more.
    CancelCycle,
    /// No cycle any more, and positioning from now on.
    CancelCycleAndPosition,
    /// The tool selected comes into use.
    ToolChange,
    /// The tool in use gets the number Q.
    SetTool,
    /// The profile of a roughing or finishing cycle: blocks P to Q; U, W and the rest are no places.
    Profile,
    /// Runs such a profile again to finish it.
    FinishProfile,
}

/// Where a cycle leaves the axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum CycleEnd {
    /// Over the hole: at R, or where it began.
    Retract,
    /// Over the hole, at the height where it began.
    Height,
    /// Where it began.
    Start,
}

/// A canned cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cycle {
    /// Letters of axes whose words are places the tool goes to. R, Q, I, J, K, P, D, L are none.
    pub targets: crate::coordinates::AxisSet,
    /// Where it leaves the axes.
    pub end: CycleEnd,
    /// The following blocks repeat it.
    pub modal: bool,
    /// It cuts a thread.
    pub thread: bool,
}

/// What a code does, with its details.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Code {
    /// One of the meanings.
    Of(Meaning),
    /// A cycle, by its number in the dialect.
    Cycle(u8),
    /// A work offset: its code in tenths, 540 for G54.
    WorkOffset(u16),
    /// Known, and why it is refused: the number of the reason.
    Refused(u8),
}
