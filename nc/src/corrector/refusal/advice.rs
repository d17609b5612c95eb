//! What to do about a refusal.

use super::{Lost, Missing, Reason, Within, name};
use crate::coordinates::Axis;

impl Reason {
    /// What to do; none where the reason says it.
    #[must_use]
    pub fn advice(&self) -> Option<String> {
        Some(match self {
            Self::Text(_) => "mend the block, or choose the dialect it is written in".into(),
            Self::TooLong => "it is no NC program, or of another line end".into(),
            Self::Letter(_) | Self::Code(_) => {
                "check it, or state its meaning in a dialect file of your own".into()
            }
            Self::Expression(_) => {
                "write the number, or leave the axis out of the correction".into()
            }
            Self::Flow | Self::NotFollowed { .. } => "write out what it does block by block".into(),
            Self::Parameter(_) => "set offsets by G10 or in the setup".into(),
            Self::Delete => "give control.block_delete = true or false in the setup".into(),
            Self::NoMotion => "put G0, G1 or another movement before it".into(),
            Self::Overflow { .. } => "move the work, or check the correction's size".into(),
            Self::Place { axis, lost } => lost.advice(*axis),
            Self::Offset { axis, missing } => missing.advice(*axis),
            Self::Radius { tool: Some(tool) } => {
                format!("give control.tools.{tool}.radius_mm in the setup")
            }
            Self::Radius { tool: None } => {
                "give the tool in use and its radius_mm in the setup".into()
            }
            Self::RadiusTooLarge { .. } => {
                "raise the tolerance, or program the centre's path".into()
            }
            Self::NotSplit { within, .. } => within.advice().into(),
            Self::SplineStart { .. } => "lead in with a straight movement".into(),
            Self::RadiusForm { .. } => "write the arc with I, J and K instead of R".into(),
            Self::Sweep { .. } => "write a short arc as a line, a full circle as two arcs".into(),
            Self::Changes { .. } => "write it as single movements, or raise the tolerance".into(),
            _ => return None,
        })
    }
}

impl Lost {
    fn advice(self, axis: Axis) -> String {
        match self {
            Self::Start => {
                format!("give control.start.{axis} in the setup, or place the axis first")
            }
            Self::Reference(code) => {
                format!(
                    "give control.references.{}.{axis} in the setup, or place the axis first",
                    name('G', code)
                )
            }
            Self::Probe | Self::Expression | Self::ToolOffset | Self::Offset => {
                format!("place {axis} by an absolute word before")
            }
        }
    }
}

impl Missing {
    fn advice(self, axis: Axis) -> String {
        match self {
            Self::Work(code) => format!(
                "give control.work_offsets.origins.{}.{axis} in the setup",
                name('G', code)
            ),
            Self::Shift => format!("give control.start.{axis} and the work offset in the setup"),
            Self::Tool(Some(tool)) => format!("give control.tools.{tool}.offset in the setup"),
            Self::Tool(None) => {
                "give the tool's number by H or T, or control.tool_offset in the setup".into()
            }
        }
    }
}

impl Within {
    const fn advice(self) -> &'static str {
        match self {
            Self::Compensation => {
                "raise the tolerance, shorten the movement in the program, or compensate there"
            }
            Self::Thread => "raise the tolerance or shorten the thread",
            Self::Profile => "raise the tolerance or shorten the movements of the profile",
            Self::InverseTime => "program the feed by G94, or shorten the movement",
            Self::AfterMotion => "put what acts after the movement into a block of its own",
            Self::BeforeMotion => {
                "put the codes that say how words count into a block of their own"
            }
        }
    }
}
