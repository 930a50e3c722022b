//! Words and marks of IDL text, without comments.

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Token<'a> {
    /// A name with its `::`, a number, or a string.
    Word(&'a str),
    Mark(char),
}

impl<'a> Token<'a> {
    pub fn text(self) -> String {
        match self {
            Self::Word(word) => word.into(),
            Self::Mark(mark) => mark.into(),
        }
    }
}

/// The tokens of one or more IDL files, with the lines between them.
pub fn tokens(text: &str) -> Result<Vec<Token<'_>>, String> {
    let mut rest = text;
    let mut tokens = Vec::new();
    loop {
        rest = rest.trim_start();
        let Some(first) = rest.chars().next() else { return Ok(tokens) };
        let end = if rest.starts_with("//") || first == '#' || rest.starts_with("===") || rest.starts_with("IDL:") {
            rest.find('\n').unwrap_or(rest.len())
        } else if let Some(comment) = rest.strip_prefix("/*") {
            comment.find("*/").ok_or("its IDL schema has an open comment")? + "/**/".len()
        } else if first == '"' {
            let end = string(rest).ok_or("its IDL schema has an open string")?;
            tokens.push(Token::Word(&rest[..end]));
            end
        } else {
            let end = rest.find(|c: char| !c.is_alphanumeric() && !"_:.-+".contains(c)).unwrap_or(rest.len());
            let end = end.max(first.len_utf8());
            tokens.push(if "@(){}[]<>,;=".contains(first) { Token::Mark(first) } else { Token::Word(&rest[..end]) });
            end
        };
        rest = &rest[end..];
    }
}

/// Where the string that begins here ends.
fn string(text: &str) -> Option<usize> {
    let mut escaped = true;
    for (i, c) in text.char_indices() {
        match c {
            '"' if !escaped => return Some(i + 1),
            '\\' if !escaped => escaped = true,
            _ => escaped = false,
        }
    }
    None
}
