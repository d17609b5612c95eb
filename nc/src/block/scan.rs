//! From bytes to words.

use super::{Block, Lexis, Number, NumberError, OWords, Value, Word, body_len};

/// What is no word, and where.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Flaw {
    /// Its first byte in the block.
    pub byte: usize,
    /// What is wrong.
    pub what: FlawKind,
}

/// What is wrong with a text that should be words.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FlawKind {
    /// A character that begins nothing.
    Character(u8),
    /// A comment that nothing ends.
    OpenComment,
    /// A bracket that nothing closes.
    OpenBracket,
    /// Something that reads like a number and is none.
    Number(String, Option<NumberError>),
    /// A parameter that is not set as `#1 = 2` is.
    Parameter,
    /// A `/` behind the first word.
    Delete,
}

impl std::fmt::Display for FlawKind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Character(byte) if byte.is_ascii_graphic() => {
                write!(f, "the character `{}` begins no word", char::from(*byte))
            }
            Self::Character(byte) => write!(f, "the byte 0x{byte:02X} begins no word"),
            Self::OpenComment => f.write_str("the comment is not ended by `)`"),
            Self::OpenBracket => f.write_str("the bracket is not closed"),
            Self::Number(text, None) => write!(f, "`{text}` is no number"),
            Self::Number(text, Some(error)) => write!(f, "`{text}` is no number: {error}"),
            Self::Parameter => f.write_str("a parameter is set like `#1 = 2`"),
            Self::Delete => f.write_str("a block delete `/` stands before the first word"),
        }
    }
}

pub(super) fn scan(bytes: &[u8], lexis: &Lexis, block: &mut Block) -> Result<(), Flaw> {
    let end = body_len(bytes);
    block.clear(end);
    let mut scanner = Scanner {
        text: &bytes[..end],
        at: 0,
        lexis,
    };
    while let Some(&byte) = scanner.text.get(scanner.at) {
        match byte {
            b' ' | b'\t' => scanner.at += 1,
            b'A'..=b'Z' | b'a'..=b'z' | b'@' | b'^' | b'$' | b':' => scanner.word(byte, block)?,
            b'(' if lexis.round_comments => scanner.round_comment(block)?,
            b';' if lexis.semicolon_comments => {
                block.comments.push(scanner.at..end);
                scanner.at = end;
            }
            b'/' => scanner.delete(block)?,
            b'%' if block.words.is_empty() => {
                block.percent = Some(scanner.at);
                scanner.at = end;
            }
            b'#' if lexis.expressions => scanner.assignment(block)?,
            _ => return Err(scanner.flaw(scanner.at, FlawKind::Character(byte))),
        }
    }
    Ok(())
}

struct Scanner<'a> {
    text: &'a [u8],
    at: usize,
    lexis: &'a Lexis,
}

/// Signs, digits and points that stand together.
fn numeric(byte: u8) -> bool {
    byte.is_ascii_digit() || matches!(byte, b'+' | b'-' | b'.')
}

impl Scanner<'_> {
    #[cold]
    fn flaw(&self, byte: usize, what: FlawKind) -> Flaw {
        Flaw { byte, what }
    }

    fn peek(&self) -> Option<u8> {
        self.text.get(self.at).copied()
    }

    fn skip_blanks(&mut self) {
        while matches!(self.peek(), Some(b' ' | b'\t')) {
            self.at += 1;
        }
    }

    fn word(&mut self, byte: u8, block: &mut Block) -> Result<(), Flaw> {
        let start = self.at;
        let letter = match byte {
            b':' => b'O',
            _ => byte.to_ascii_uppercase(),
        };
        let extra = !byte.is_ascii_alphabetic();
        if extra && (byte == b':') != (self.lexis.o_words == OWords::ProgramNumber) {
            return Err(self.flaw(start, FlawKind::Character(byte)));
        }
        if letter == b'O' && self.lexis.o_words == OWords::Flow {
            block.flow = Some(start..self.text.len());
            self.at = self.text.len();
            return Ok(());
        }
        self.at += 1;
        let letter_end = self.at;
        self.skip_blanks();
        let value_start = self.at;
        let value = self.value(start)?;
        if value == Value::None {
            self.at = letter_end;
        }
        block.words.push(Word {
            letter,
            value,
            start: start as u32,
            value_start: value_start.min(self.at) as u32,
            end: self.at as u32,
        });
        Ok(())
    }

    /// The value that stands here, of the word or parameter that begins at `start`.
    fn value(&mut self, start: usize) -> Result<Value, Flaw> {
        match self.peek() {
            Some(b'+' | b'-') if self.lexis.expressions && self.signed_expression() => {
                self.at += 1;
                self.skip_blanks();
                self.expression()
            }
            Some(byte) if numeric(byte) => self.number(start),
            Some(b'[' | b'#') if self.lexis.expressions => self.expression(),
            Some(byte) if self.lexis.expressions && byte.is_ascii_alphabetic() => {
                if self.function_len().is_some() {
                    self.expression()
                } else {
                    Ok(Value::None)
                }
            }
            _ => Ok(Value::None),
        }
    }

    /// True where a sign stands before something that is no number.
    fn signed_expression(&self) -> bool {
        let rest = &self.text[self.at + 1..];
        let next = rest.iter().find(|byte| !matches!(byte, b' ' | b'\t'));
        matches!(next, Some(b'[' | b'#')) || next.is_some_and(u8::is_ascii_alphabetic)
    }

    fn number(&mut self, start: usize) -> Result<Value, Flaw> {
        let first = self.at;
        let read = Number::read(&self.text[first..], self.lexis.blanks_in_numbers);
        let after = read.map_or(first, |(_, len)| first + len);
        match read {
            Ok((number, _)) if !self.text.get(after).copied().is_some_and(numeric) => {
                self.at = after;
                Ok(Value::Number(number))
            }
            read => {
                let run = self.text[first..].iter().take_while(|byte| numeric(**byte));
                let end = first + run.count();
                let text = String::from_utf8_lossy(&self.text[start..end]).into_owned();
                Err(self.flaw(start, FlawKind::Number(text, read.err())))
            }
        }
    }

    /// `[…]`, `#…` or a function of them; nothing nests without a bracket or a `#` of its own, so there is no recursion.
    fn expression(&mut self) -> Result<Value, Flaw> {
        let start = self.at;
        while self.peek() == Some(b'#') {
            self.at += 1;
            self.skip_blanks();
        }
        match self.peek() {
            Some(b'[') => self.brackets()?,
            Some(b'<') => self.named()?,
            Some(byte) if numeric(byte) => {
                self.number(start)?;
            }
            Some(byte) if byte.is_ascii_alphabetic() => {
                let Some(len) = self.function_len() else {
                    return Err(self.flaw(start, FlawKind::Character(self.text[start])));
                };
                self.at += len;
                self.skip_blanks();
                self.brackets()?;
                self.quotient()?;
            }
            _ => return Err(self.flaw(start, FlawKind::Character(self.text[start]))),
        }
        Ok(Value::Expression)
    }

    /// The `/[…]` of `ATAN[…]/[…]`.
    fn quotient(&mut self) -> Result<(), Flaw> {
        let rest: &[u8] = &self.text[self.at..];
        let mut visible = rest.iter().enumerate();
        let mut next = || visible.find(|(_, byte)| !matches!(byte, b' ' | b'\t'));
        if next().is_some_and(|(_, byte)| *byte == b'/')
            && let Some((bracket, b'[')) = next()
        {
            self.at += bracket;
            return self.brackets();
        }
        Ok(())
    }

    /// Length of the name of a function that stands here with its bracket.
    fn function_len(&self) -> Option<usize> {
        const NAMES: [&[u8]; 13] = [
            b"ABS", b"ACOS", b"ASIN", b"ATAN", b"COS", b"EXP", b"FIX", b"FUP", b"ROUND", b"LN",
            b"SIN", b"SQRT", b"TAN",
        ];
        let rest = &self.text[self.at..];
        let exists = [&b"EXISTS"[..]];
        NAMES
            .iter()
            .chain(&exists)
            .find(|name| {
                rest.len() > name.len()
                    && rest[..name.len()].eq_ignore_ascii_case(name)
                    && rest[name.len()..]
                        .iter()
                        .find(|byte| !matches!(byte, b' ' | b'\t'))
                        == Some(&b'[')
            })
            .map(|name| name.len())
    }

    fn brackets(&mut self) -> Result<(), Flaw> {
        let start = self.at;
        let mut depth = 0_u32;
        while let Some(byte) = self.peek() {
            self.at += 1;
            match byte {
                b'[' => depth += 1,
                b']' if depth <= 1 => return Ok(()),
                b']' => depth -= 1,
                _ if depth == 0 => break,
                _ => {}
            }
        }
        Err(self.flaw(start, FlawKind::OpenBracket))
    }

    fn named(&mut self) -> Result<(), Flaw> {
        let start = self.at;
        let Some(len) = self.text[start..].iter().position(|byte| *byte == b'>') else {
            return Err(self.flaw(start, FlawKind::OpenBracket));
        };
        self.at = start + len + 1;
        Ok(())
    }

    fn assignment(&mut self, block: &mut Block) -> Result<(), Flaw> {
        let start = self.at;
        self.expression()?;
        self.skip_blanks();
        if self.peek() != Some(b'=') {
            return Err(self.flaw(start, FlawKind::Parameter));
        }
        self.at += 1;
        self.skip_blanks();
        if self.value(start)? == Value::None {
            return Err(self.flaw(start, FlawKind::Parameter));
        }
        block.assignments.push(start..self.at);
        Ok(())
    }

    fn round_comment(&mut self, block: &mut Block) -> Result<(), Flaw> {
        let start = self.at;
        let Some(len) = self.text[start..].iter().position(|byte| *byte == b')') else {
            return Err(self.flaw(start, FlawKind::OpenComment));
        };
        self.at = start + len + 1;
        block.comments.push(start..self.at);
        Ok(())
    }

    fn delete(&mut self, block: &mut Block) -> Result<(), Flaw> {
        if block.delete.is_some() || !block.words.is_empty() {
            return Err(self.flaw(self.at, FlawKind::Delete));
        }
        block.delete = Some(self.at);
        self.at += 1;
        // The number of the switch.
        if matches!(self.peek(), Some(b'1'..=b'9')) {
            self.at += 1;
        }
        Ok(())
    }
}
