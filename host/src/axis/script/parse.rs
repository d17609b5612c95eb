//! From lines to steps.

use super::expect;
use super::{Action, Motion, Step};
use crate::axis::values::number_in;
use crate::toml_file::suggestion;

/// Most passes of a loop.
const MOST_PASSES: f64 = 1e6;
/// What a step may begin with.
const WORDS: [&str; 20] = [
    "enable", "disable", "home", "hold", "resume", "stop", "clear", "save", "restart", "move",
    "start", "jog", "override", "wait", "expect", "set", "print", "repeat", "end", "#",
];

/// Line and what is wrong there.
pub type Complaint = (usize, String);

/// Makes steps of a text.
///
/// # Errors
/// The first line that is not understood, with what was expected.
pub fn parse(text: &str) -> Result<Vec<Step>, Complaint> {
    /// Steps of a loop that is open, with its line and its passes.
    struct Open {
        line: usize,
        text: String,
        passes: u32,
        steps: Vec<Step>,
    }
    let mut steps = Vec::new();
    let mut open: Vec<Open> = Vec::new();
    for (index, line) in text.lines().enumerate() {
        let number = index + 1;
        let line = line.split('#').next().unwrap_or_default().trim();
        let words: Vec<&str> = line.split_whitespace().collect();
        let Some((first, rest)) = words.split_first() else {
            continue;
        };
        let wrong = |message: String| (number, message);
        let step = match (*first, rest) {
            ("repeat", [times]) => {
                open.push(Open {
                    line: number,
                    text: line.to_owned(),
                    passes: passes(times).map_err(wrong)?,
                    steps: std::mem::take(&mut steps),
                });
                continue;
            }
            ("end", []) => {
                let Some(done) = open.pop() else {
                    return Err(wrong(
                        "`end` without a `repeat` before it: delete it".to_owned(),
                    ));
                };
                let inner = std::mem::replace(&mut steps, done.steps);
                Step {
                    line: done.line,
                    text: done.text,
                    action: Action::Repeat(done.passes, inner),
                }
            }
            _ => Step {
                line: number,
                text: line.to_owned(),
                action: action(first, rest, line).map_err(wrong)?,
            },
        };
        steps.push(step);
    }
    match open.pop() {
        None => Ok(steps),
        Some(open) => Err((
            open.line,
            "this `repeat` has no `end`: write it behind the last step of the loop".to_owned(),
        )),
    }
}

fn passes(text: &str) -> Result<u32, String> {
    let passes = number_in("repeat", text, "")?;
    if (1.0..=MOST_PASSES).contains(&passes) && passes.fract() == 0.0 {
        Ok(passes as u32)
    } else {
        Err(format!(
            "repeat {text}: a loop has 1 to {MOST_PASSES} passes"
        ))
    }
}

/// A step that is no loop.
fn action(first: &str, rest: &[&str], line: &str) -> Result<Action, String> {
    Ok(match (first, rest) {
        ("enable", []) => Action::Enable,
        ("disable", []) => Action::Disable,
        ("home", []) => Action::Home,
        ("hold", []) => Action::Hold,
        ("resume", []) => Action::Resume,
        ("stop", []) => Action::Stop,
        ("clear", []) => Action::Clear,
        ("save", []) => Action::Save,
        ("restart", []) => Action::Restart,
        ("move" | "start", rest) => Action::Move(motion(first, rest)?),
        ("jog", [feed]) => Action::Jog {
            feed_mm_per_min: number_in("jog", feed, "mm/min")?,
            seconds: None,
        },
        ("jog", [feed, "for", time]) => Action::Jog {
            feed_mm_per_min: number_in("jog", feed, "mm/min")?,
            seconds: Some(seconds(time)?),
        },
        ("override", [percent]) => Action::Override(percentage(percent)?),
        ("wait", ["rest"]) => Action::WaitRest,
        ("wait", [time]) => Action::Wait(seconds(time)?),
        ("expect", rest) => Action::Expect(expect::parse(rest)?),
        ("set", rest) => Action::Set(assignments(rest)?),
        ("print", _) => {
            let said = line.strip_prefix("print").unwrap_or_default().trim();
            Action::Print(said.to_owned())
        }
        _ => return Err(not_understood(first, line)),
    })
}

/// What a step of that first word looks like.
fn form(first: &str) -> &'static str {
    match first {
        "move" | "start" => {
            "`move MM feed MM_PER_MIN` or `move by MM feed MM_PER_MIN`; `start` in place of `move` does not wait"
        }
        "jog" => "`jog MM_PER_MIN for TIME`, or without a time, as `jog -600 for 2s`",
        "override" => "`override PERCENT`, as `override 50`",
        "wait" => "`wait TIME`, as `wait 0.5s`, or `wait rest`",
        "set" => "`set NAME VALUE`, or `set NAME=VALUE …`",
        "repeat" => "`repeat TIMES`, steps, `end`",
        _ => "the word alone",
    }
}

fn not_understood(first: &str, line: &str) -> String {
    if WORDS.contains(&first) {
        let form = form(first);
        format!("`{line}` is not understood: expected {form}")
    } else {
        let hint = suggestion(first, WORDS);
        format!("there is no step `{first}`{hint}")
    }
}

fn motion(first: &str, rest: &[&str]) -> Result<Motion, String> {
    let (mm, feed, is_by) = match rest {
        [mm, "feed", feed] => (mm, feed, false),
        ["by", mm, "feed", feed] => (mm, feed, true),
        _ => {
            let line = [&[first], rest].concat().join(" ");
            return Err(not_understood(first, &line));
        }
    };
    let feed_mm_per_min = number_in("feed", feed, "mm/min")?;
    if feed_mm_per_min <= 0.0 || !feed_mm_per_min.is_finite() {
        return Err(format!(
            "feed {feed}: a feed is above 0; the direction is that of the target"
        ));
    }
    Ok(Motion {
        mm: number_in(first, mm, "mm")?,
        is_by,
        feed_mm_per_min,
        is_awaited: first == "move",
    })
}

/// A time in s, written with s or ms behind it, or with nothing.
fn seconds(text: &str) -> Result<f64, String> {
    let seconds = match text.strip_suffix("ms") {
        Some(ms) => number_in("time", ms, "ms")? / 1000.0,
        None => number_in("time", text, "s")?,
    };
    if (0.0..=86_400.0).contains(&seconds) {
        Ok(seconds)
    } else {
        Err(format!("{text}: a time is 0 to 86400 s"))
    }
}

fn percentage(text: &str) -> Result<u16, String> {
    let percent = number_in("override", text, "%")?;
    if (0.0..=200.0).contains(&percent) && percent.fract() == 0.0 {
        Ok(percent as u16)
    } else {
        Err(format!("override {text}: an override is 0 to 200 %"))
    }
}

/// `NAME VALUE`, or `NAME=VALUE …`.
///
/// # Errors
/// What was expected.
pub fn assignments(words: &[&str]) -> Result<Vec<(String, String)>, String> {
    if let [name, value] = words
        && !name.contains('=')
    {
        return Ok(vec![((*name).to_owned(), (*value).to_owned())]);
    }
    let pair = |word: &&str| match word.split_once('=') {
        Some((name, value)) if !name.is_empty() && !value.is_empty() => {
            Ok((name.to_owned(), value.to_owned()))
        }
        _ => Err(format!(
            "`{word}`: expected NAME=VALUE, or NAME VALUE for one alone"
        )),
    };
    if words.is_empty() {
        return Err("what is to be set? Write NAME=VALUE".to_owned());
    }
    words.iter().map(pair).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn loops_hold_their_steps() {
        let steps = parse("enable # on\n\nrepeat 2\nrepeat 3\nhome\nend\nstop\nend\ndisable\n");
        let steps = steps.expect("a script");
        assert_eq!(steps.len(), 3);
        let Action::Repeat(2, outer) = &steps[1].action else {
            panic!("{steps:?}");
        };
        assert!(matches!(&outer[0].action, Action::Repeat(3, inner) if inner.len() == 1));
        assert_eq!(outer[1].line, 7);
    }

    #[test]
    fn what_is_not_understood_is_told_with_its_line() {
        for (text, line, part) in [
            ("enabel", 1, "did you mean `enable`?"),
            ("\nmove 100", 2, "move MM feed MM_PER_MIN"),
            ("move 100 feed 50mm/s", 1, "its unit is mm/min, not mm/s"),
            ("move 10 feed 0", 1, "above 0"),
            ("wait", 1, "wait rest"),
            ("wait 5min", 1, "its unit is s, not min"),
            ("repeat 2\nhome", 1, "no `end`"),
            ("home\nend", 2, "without a `repeat`"),
            ("repeat 0", 1, "1 to 1000000 passes"),
            ("override 300", 1, "0 to 200 %"),
            ("set motion.x", 1, "NAME=VALUE"),
            ("expect position 3", 1, "expect position MM within MM"),
            ("expect state redy", 1, "did you mean `ready`?"),
            (
                "expect fault folowing-error",
                1,
                "did you mean `following-error`?",
            ),
            ("expect posision 3 within 1", 1, "did you mean `position`?"),
            ("enable now", 1, "the word alone"),
        ] {
            let (at, message) = parse(text).expect_err(text);
            assert_eq!(at, line, "{text}");
            assert!(message.contains(part), "{text}: {message}");
        }
    }
}
