//! Triggers as people write them.

use std::str::FromStr;

use leadscrew::scope::{Side, Signal, Slope, Trigger};
use leadscrew::supervisor::Fault;
use leadscrew_client::Scale;

use crate::fault_names::{FAULT_NAMES, fault_name};

const FORMS: &str = "now, fault, fault:NAME, warning, motion, SIGNAL>LEVEL, SIGNAL<LEVEL, \
                     `SIGNAL rising LEVEL`, `SIGNAL falling LEVEL` or `SIGNAL through LEVEL`";

/// A trigger with its level in the unit of people.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TriggerText {
    what: WhatTrigger,
    signal: Signal,
    level: f64,
}

/// Kinds of triggers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WhatTrigger {
    /// The first tick.
    Now,
    /// A fault, or any.
    Fault(Option<Fault>),
    /// A warning.
    Warning,
    /// A motion begins.
    Motion,
    /// A signal is beyond its level.
    Beyond(Side),
    /// A signal goes through its level.
    Through(Slope),
}

impl TriggerText {
    /// One without a level.
    #[must_use]
    pub const fn of(what: WhatTrigger) -> Self {
        Self {
            what,
            signal: Signal::Tick,
            level: 0.0,
        }
    }

    /// What kind it is.
    #[must_use]
    pub const fn what(&self) -> WhatTrigger {
        self.what
    }

    /// The trigger on an axis of that scale.
    #[must_use]
    pub fn at(&self, scale: Scale) -> Trigger {
        let Self { signal, level, .. } = *self;
        let level = scale.of(signal).bits(level);
        match self.what {
            WhatTrigger::Now => Trigger::Now,
            WhatTrigger::Fault(fault) => Trigger::Fault(fault),
            WhatTrigger::Warning => Trigger::Warning,
            WhatTrigger::Motion => Trigger::Command,
            WhatTrigger::Beyond(side) => Trigger::Level {
                signal,
                level,
                side,
            },
            WhatTrigger::Through(slope) => Trigger::Edge {
                signal,
                level,
                slope,
            },
        }
    }
}

impl FromStr for TriggerText {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let text = text.trim();
        let plain = match text {
            "now" => Some(WhatTrigger::Now),
            "fault" => Some(WhatTrigger::Fault(None)),
            "warning" => Some(WhatTrigger::Warning),
            "motion" => Some(WhatTrigger::Motion),
            _ => None,
        };
        if let Some(what) = plain {
            return Ok(Self::of(what));
        }
        if let Some(name) = text.strip_prefix("fault:") {
            return fault(name).map(|fault| Self::of(WhatTrigger::Fault(Some(fault))));
        }
        let forms = [
            (">", WhatTrigger::Beyond(Side::Above)),
            ("<", WhatTrigger::Beyond(Side::Below)),
            (" rising ", WhatTrigger::Through(Slope::Rising)),
            (" falling ", WhatTrigger::Through(Slope::Falling)),
            (" through ", WhatTrigger::Through(Slope::Either)),
        ];
        let found = forms.into_iter().find_map(|(sign, what)| {
            let (signal, level) = text.split_once(sign)?;
            Some((what, signal.trim(), level.trim()))
        });
        let (what, name, level) = found.ok_or_else(|| format!("expected {FORMS}"))?;
        Ok(Self {
            what,
            signal: signal(name)?,
            level: level
                .parse()
                .ok()
                .filter(|level: &f64| level.is_finite())
                .ok_or_else(|| format!("the level `{level}` is no number"))?,
        })
    }
}

/// The signal of that name; the error names the nearest one.
///
/// # Errors
/// There is none.
pub fn signal(name: &str) -> Result<Signal, String> {
    Signal::from_name(name).ok_or_else(|| {
        let nearest = nearest(name, Signal::ALL.iter().map(|signal| signal.name()));
        format!("there is no signal `{name}`{nearest}: docs/scope.md lists them")
    })
}

fn fault(name: &str) -> Result<Fault, String> {
    let found = Fault::ALL.iter().find(|fault| fault_name(**fault) == name);
    found.copied().ok_or_else(|| {
        let nearest = nearest(name, FAULT_NAMES.into_iter());
        format!("there is no fault `{name}`{nearest}: docs/faults.md lists them")
    })
}

fn nearest(name: &str, known: impl Iterator<Item = &'static str>) -> String {
    let alike = |other: &&str| (strsim::jaro_winkler(name, other) * 1e6) as u32;
    let nearest = known.max_by_key(alike);
    nearest.map_or_else(String::new, |nearest| format!(", is it `{nearest}`?"))
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCALE: Scale = Scale {
        tick_hz: 1000.0,
        counts_per_mm: 1000.0,
    };

    fn trigger(text: &str) -> Trigger {
        text.parse::<TriggerText>().unwrap().at(SCALE)
    }

    #[test]
    fn levels_are_in_the_units_of_people() {
        assert_eq!(
            trigger("following_error>0.05"),
            Trigger::Level {
                signal: Signal::FollowingError,
                level: 50 << 16,
                side: Side::Above
            }
        );
        assert_eq!(
            trigger("velocity falling -60"),
            Trigger::Edge {
                signal: Signal::Velocity,
                level: -1 << 20,
                slope: Slope::Falling
            }
        );
        assert_eq!(
            trigger("fault:encoder-loss"),
            Trigger::Fault(Some(Fault::EncoderLoss))
        );
        assert_eq!(trigger("motion"), Trigger::Command);
    }

    #[test]
    fn what_is_no_trigger_is_told_what_would_be_one() {
        let error = |text: &str| text.parse::<TriggerText>().unwrap_err();
        assert!(error("postion>3").contains("`position`"));
        assert!(error("fault:encoder-los").contains("`encoder-loss`"));
        assert!(error("velocity>fast").contains("no number"));
        assert!(error("later").contains("SIGNAL>LEVEL"));
    }
}
