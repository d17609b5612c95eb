//! VCD (value change dump, IEEE 1364), by the `vcd` crate. Its header parser recurses into scopes
//! and forgets where a signal stood, so the header is taken command by command.

use std::io::{self, BufRead};

use ::vcd::{Command, IdCode, ParseError, ParseErrorKind, Parser, TimescaleUnit, Value, VarType};

use super::channels::{ChannelSelection, Chosen, Offer, choose};
use super::error::{Located, Problem};
use super::timeline::Timeline;
use super::{Recording, Role};

pub(super) fn read(
    input: impl BufRead,
    selection: &ChannelSelection,
) -> Result<Recording, Located> {
    // The crate takes a last line without its line end for a broken-off one.
    let mut commands = Commands {
        parser: Parser::new(input.chain(&b"\n"[..])),
    };
    let header = read_header(&mut commands)?;
    let clock = Clock::from_timescale(header.timescale)?;
    let chosen = choose(selection, &header.offers)?;
    read_changes(&mut commands, clock, &chosen)
}

struct Commands<R: BufRead> {
    parser: Parser<R>,
}

impl<R: BufRead> Commands<R> {
    fn next(&mut self) -> Result<Option<Command>, Located> {
        let next = self.parser.next().transpose();
        next.map_err(|error| self.located(error))
    }

    fn line(&self) -> u64 {
        self.parser.line()
    }

    fn invalid(&self, what: &str, advice: &'static str) -> Located {
        let what = what.to_owned();
        Problem::Vcd { what, advice }.at(self.line())
    }

    /// The end of the file is one line early: the line end that was added to it counts.
    fn ended(&self, what: &str) -> Located {
        let what = what.to_owned();
        Problem::Vcd {
            what,
            advice: EXPORT_AGAIN,
        }
        .at(self.line().saturating_sub(1))
    }

    fn located(&self, error: io::Error) -> Located {
        if error.kind() == io::ErrorKind::UnexpectedEof {
            return self.ended("the file ends inside a command");
        }
        let parse_error = error
            .get_ref()
            .and_then(|inner| inner.downcast_ref::<ParseError>());
        match parse_error.map(ParseError::kind) {
            Some(ParseErrorKind::InvalidUtf8) => Problem::NotUtf8.at(self.line()),
            Some(kind) => self.invalid(&kind.to_string(), advice(kind)),
            None => Problem::Unreadable(error).into(),
        }
    }
}

const EXPORT_AGAIN: &str = "the file is damaged or cut short; export the capture again";

fn advice(kind: &ParseErrorKind) -> &'static str {
    match kind {
        ParseErrorKind::ExpectedEndCommand => {
            "names of signals hold no spaces in VCD; rename the channel before exporting"
        }
        ParseErrorKind::InvalidTimescaleUnit(_) => "expected s, ms, us, ns, ps or fs",
        _ => EXPORT_AGAIN,
    }
}

#[derive(Default)]
struct Header {
    timescale: Option<(u32, TimescaleUnit)>,
    offers: Vec<Offer<IdCode>>,
}

fn read_header<R: BufRead>(commands: &mut Commands<R>) -> Result<Header, Located> {
    let mut header = Header::default();
    let mut scopes: Vec<String> = Vec::new();
    while let Some(command) = commands.next()? {
        match command {
            Command::Enddefinitions => return Ok(header),
            Command::Timescale(quantity, unit) => header.timescale = Some((quantity, unit)),
            Command::ScopeDef(_, name) => scopes.push(name),
            Command::Upscope => {
                scopes.pop();
            }
            Command::VarDef(kind, size, key, reference, index) => {
                let name = match index {
                    Some(index) => format!("{reference}{index}"),
                    None => reference,
                };
                let path = match scopes.is_empty() {
                    true => name.clone(),
                    false => format!("{}.{name}", scopes.join(".")),
                };
                header.offers.push(Offer {
                    path,
                    name,
                    key,
                    obstacle: obstacle(kind, size),
                });
            }
            Command::Comment(_) | Command::Date(_) | Command::Version(_) => {}
            _ => return Err(commands.invalid("data before `$enddefinitions`", EXPORT_AGAIN)),
        }
    }
    Err(commands.ended("the file ends before `$enddefinitions`"))
}

/// Why a variable is not a logic level, if it is not.
fn obstacle(kind: VarType, size: u32) -> Option<String> {
    use VarType::{Event, Integer, Parameter, Real, String, Time};
    match kind {
        Event | Integer | Parameter | Real | String | Time => {
            Some(format!("is of the type {kind}"))
        }
        _ if size != 1 => Some(format!("is {size} bits wide")),
        _ => None,
    }
}

/// How the file's time units become clock ticks.
#[derive(Clone, Copy)]
struct Clock {
    hz: u64,
    /// More than one only for a timescale that is no whole frequency, such as 10 s.
    ticks_per_unit: u64,
}

impl Clock {
    fn from_timescale(timescale: Option<(u32, TimescaleUnit)>) -> Result<Clock, Problem> {
        let (quantity, unit) = match timescale {
            None => {
                return Err(Problem::Timescale {
                    found: "no `$timescale`",
                });
            }
            Some((0, _)) => {
                return Err(Problem::Timescale {
                    found: "a `$timescale` of zero",
                });
            }
            Some((quantity, unit)) => (u64::from(quantity), unit),
        };
        let per_second = unit.divisor();
        Ok(match per_second % quantity {
            0 => Clock {
                hz: per_second / quantity,
                ticks_per_unit: 1,
            },
            _ => Clock {
                hz: per_second,
                ticks_per_unit: quantity,
            },
        })
    }
}

fn read_changes<R: BufRead>(
    commands: &mut Commands<R>,
    clock: Clock,
    chosen: &Chosen<IdCode>,
) -> Result<Recording, Located> {
    let mut timeline = Timeline::new();
    let mut times: Option<Times> = None;
    let mut now = 0;
    while let Some(command) = commands.next()? {
        let (key, value) = match command {
            Command::Timestamp(time) => {
                let times = times.get_or_insert(Times {
                    first: time,
                    last: time,
                });
                now = times
                    .advance(time, clock)
                    .map_err(|problem| problem.at(commands.line()))?;
                timeline.advance(now);
                continue;
            }
            Command::ChangeScalar(key, value) => (key, Some(value)),
            // Some writers put one-bit signals as vectors.
            Command::ChangeVector(key, bits) if bits.len() == 1 => (key, bits.get(0)),
            Command::ChangeVector(key, _)
            | Command::ChangeReal(key, _)
            | Command::ChangeString(key, _) => (key, None),
            _ => continue,
        };
        if let Some(role) = chosen.role_of(key) {
            let level = value.ok_or_else(|| wider(commands, role))?;
            timeline.set(role, known(level), commands.line())?;
        }
    }
    if times.is_none() {
        return Err(Problem::NoSamples.into());
    }
    Ok(timeline.finish(clock.hz, now, chosen.roles())?)
}

fn known(value: Value) -> Option<bool> {
    match value {
        Value::V0 => Some(false),
        Value::V1 => Some(true),
        Value::X | Value::Z => None,
    }
}

fn wider<R: BufRead>(commands: &Commands<R>, role: Role) -> Located {
    commands.invalid(
        &format!("a value of {role} that is not one bit, though it was declared as one"),
        EXPORT_AGAIN,
    )
}

/// Timestamps in the file's units.
struct Times {
    first: u64,
    last: u64,
}

impl Times {
    /// The clock ticks from the first timestamp to this one.
    fn advance(&mut self, time: u64, clock: Clock) -> Result<u64, Problem> {
        if time < self.last {
            let previous = format!("#{}", self.last);
            return Err(Problem::Backwards {
                previous,
                found: format!("#{time}"),
            });
        }
        self.last = time;
        (time - self.first)
            .checked_mul(clock.ticks_per_unit)
            .ok_or(Problem::TooLong)
    }
}
