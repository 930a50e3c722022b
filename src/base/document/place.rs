//! Which line of a TOML text sets a key.

use toml::de::{DeTable, DeValue};

/// Where a key, or the innermost part of it that exists, is written.
pub struct Found {
    /// Counted from 1.
    pub line: usize,
    /// Whether all of the key was found.
    pub whole: bool,
}

/// The line of a dotted key such as `env.reward.gate` or `gates[3].radius_m`; `None` where not even its first part
/// exists.
pub fn find(text: &str, key: &str) -> Option<Found> {
    let root = DeTable::parse(text).ok()?.into_inner();
    let root = DeValue::Table(root);
    let (mut value, mut start, mut whole) = (&root, None, true);
    for step in steps(key) {
        let next = match (&step, value) {
            (PathStep::Key(name), DeValue::Table(table)) => {
                table.iter().find(|(key, _)| key.get_ref() == name).map(|(key, value)| (key.span().start, value))
            }
            (PathStep::Index(index), DeValue::Array(array)) => {
                array.get(*index).map(|value| (value.span().start, value))
            }
            _ => None,
        };
        match next {
            Some((at, inner)) => (start, value) = (Some(at), inner.get_ref()),
            None => {
                whole = false;
                break;
            }
        }
    }
    Some(Found { line: line_at(text, start?), whole })
}

/// The line that holds byte `offset`, counted from 1.
pub fn line_at(text: &str, offset: usize) -> usize {
    text.bytes().take(offset).filter(|&byte| byte == b'\n').count() + 1
}

enum PathStep<'a> {
    Key(&'a str),
    Index(usize),
}

fn steps(key: &str) -> Vec<PathStep<'_>> {
    let mut steps = Vec::new();
    for part in key.split('.') {
        let mut pieces = part.split('[');
        steps.extend(pieces.next().filter(|name| !name.is_empty()).map(PathStep::Key));
        steps.extend(pieces.filter_map(|piece| piece.trim_end_matches(']').parse().ok().map(PathStep::Index)));
    }
    steps
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "a = 1\n\n[b.c]\nd = 2\n[[e]]\nf = 3\n[[e]]\nf = 4\ng = [\n 1,\n 2]\n";

    #[test]
    fn lines_of_keys() {
        for (key, line) in [("a", 1), ("b.c", 3), ("b.c.d", 4), ("e[1].f", 8), ("e[1].g[1]", 11)] {
            let found = find(TEXT, key).unwrap();
            assert_eq!((found.line, found.whole), (line, true), "{key}");
        }
    }

    #[test]
    fn a_missing_key_is_placed_at_the_table_around_it() {
        let found = find(TEXT, "b.c.missing").unwrap();
        assert_eq!((found.line, found.whole), (3, false));
        assert!(find(TEXT, "missing").is_none());
    }
}
