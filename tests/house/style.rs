//! Lengths of lines and functions, and words that point outside the repository.

use crate::{files, read, shown};
use std::collections::BTreeMap;

/// Columns of code, and of prose.
const CODE: usize = 120;
const PROSE: usize = 100;
/// Lines of a function, with its signature and its braces.
const FUNCTION: usize = 60;

#[test]
fn no_line_of_code_is_longer_than_120_columns() {
    let mut long = Vec::new();
    for folder in ["src", "tests", "benches", "examples"] {
        for path in files(folder, "rs") {
            for (i, line) in read(&path).lines().enumerate() {
                let columns = line.chars().count();
                if columns > CODE {
                    long.push(format!("{}:{}: {columns} columns", shown(&path), i + 1));
                }
            }
        }
    }
    assert!(long.is_empty(), "{} lines over {CODE} columns:\n{}", long.len(), long.join("\n"));
}

#[test]
fn no_line_of_prose_is_longer_than_100_columns() {
    let mut long = Vec::new();
    let pages =
        files("docs", "md").into_iter().chain(files("", "md").into_iter().filter(|p| shown(p).find('/').is_none()));
    for path in pages {
        for (i, line) in read(&path).lines().enumerate() {
            // Tables, code and pictures cannot be wrapped.
            let exempt = line.starts_with('|') || line.starts_with("    ") || line.starts_with("![");
            let columns = line.chars().count();
            if columns > PROSE && !exempt {
                long.push(format!("{}:{}: {columns} columns", shown(&path), i + 1));
            }
        }
    }
    assert!(long.is_empty(), "{} lines over {PROSE} columns:\n{}", long.len(), long.join("\n"));
}

/// First line and length of every function of a formatted file: it ends at the brace below its `fn`.
fn functions(text: &str) -> Vec<(usize, usize, String)> {
    let lines: Vec<&str> = text.lines().collect();
    let mut out = Vec::new();
    for (i, line) in lines.iter().enumerate() {
        let indent = &line[..line.len() - line.trim_start().len()];
        let mut words = line
            .split_whitespace()
            .skip_while(|w| w.starts_with("pub") || ["const", "unsafe", "async", "extern", "\"C\""].contains(w));
        if words.next() != Some("fn") || line.trim_end().ends_with(';') || line.trim_end().ends_with('}') {
            continue;
        }
        let closing = format!("{indent}}}");
        let ends = |l: &str| {
            l == closing || l.starts_with(indent) && l[indent.len()..].starts_with(") -> ") && l.ends_with(';')
        };
        if let Some(length) = lines[i..].iter().position(|l| ends(l)) {
            out.push((i + 1, length + 1, words.next().unwrap_or_default().to_string()));
        }
    }
    out
}

#[test]
fn no_function_is_longer_than_60_lines() {
    let mut long = Vec::new();
    let mut seen = 0;
    for path in files("src", "rs") {
        for (line, length, name) in functions(&read(&path)) {
            seen += 1;
            if length > FUNCTION {
                long.push(format!("{}:{line}: {name} has {length} lines", shown(&path)));
            }
        }
    }
    assert!(seen > 1000, "functions are found at all: {seen}");
    assert!(long.is_empty(), "over {FUNCTION} lines:\n{}", long.join("\n"));
}

#[test]
fn functions_are_measured_with_signature_and_braces() {
    let text = "fn a() {\n    1\n}\n\nimpl X {\n    pub fn b(\n        c: u8,\n    ) -> u8 {\n        c\n    }\n    \
                fn d();\n}\n";
    let found = functions(text);
    assert_eq!(found.iter().map(|(line, length, _)| (*line, *length)).collect::<Vec<_>>(), [(1, 3), (6, 5)]);
}

/// A type of each command, as `clap` users write it. One letter names a register of one processor.
const OF_EACH_COMMAND: &str = "Args";

#[test]
fn a_type_name_means_one_thing() {
    let mut places: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for path in files("src", "rs") {
        for line in read(&path).lines() {
            // Indented ones belong to a trait, a macro or a function.
            let line = ["pub(crate) ", "pub "].iter().fold(line, |line, word| line.strip_prefix(word).unwrap_or(line));
            let words: Vec<_> = line.split(|c: char| !c.is_alphanumeric() && c != '_').take(2).collect();
            if let ["struct" | "enum" | "trait" | "type", name] = words[..]
                && name != OF_EACH_COMMAND
                && name.len() > 1
            {
                places.entry(name.into()).or_default().push(shown(&path));
            }
        }
    }
    let twice: Vec<_> =
        places.iter().filter(|(_, places)| places.len() > 1).map(|place| format!("{place:?}")).collect();
    assert!(places.len() > 300 && twice.is_empty(), "{} of {}:\n{}", twice.len(), places.len(), twice.join("\n"));
}
