//! Words of a block, read apart from the reader under test.

/// A letter, its number, and whether that has a point.
pub type Word = (char, f64, bool);

/// Letters and numbers; comments in brackets are left out. None where there is anything else.
pub fn words(block: &str) -> Option<Vec<Word>> {
    let mut text = String::new();
    let mut in_comment = false;
    for c in block.chars() {
        match c {
            '(' => in_comment = true,
            ')' => in_comment = false,
            c if !in_comment && !c.is_whitespace() => text.push(c.to_ascii_uppercase()),
            _ => {}
        }
    }
    let mut words = Vec::new();
    let mut rest = text.as_str();
    while let Some(letter) = rest.chars().next() {
        let body = &rest[letter.len_utf8()..];
        let end = body
            .find(|c: char| !(c.is_ascii_digit() || "+-.".contains(c)))
            .unwrap_or(body.len());
        let number = body[..end].parse().ok()?;
        if !letter.is_ascii_uppercase() {
            return None;
        }
        words.push((letter, number, body[..end].contains('.')));
        rest = &body[end..];
    }
    Some(words)
}
