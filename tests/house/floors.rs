//! The floors of ARCHITECTURE.md, read from the imports: floors import downwards only, and no folder has rooms in a
//! circle.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use crate::{files, read, top};

/// From the ground up.
const FLOORS: [&str; 9] = ["base", "model", "learn", "race", "flight", "insight", "present", "api", "cli"];

/// A module's path below the crate, such as `["model", "dynamics", "drag"]`.
type Module = Vec<String>;

/// The code of a file without comments and without its own tests.
fn code(path: &Path) -> String {
    let text = read(path);
    let text = text.split("#[cfg(test)]").next().unwrap_or_default();
    text.lines().map(|line| line.split("//").next().unwrap_or_default()).collect::<Vec<_>>().join("\n")
}

/// Every path that begins at `text`, with the groups in braces written out.
fn paths(text: &str) -> (Vec<Module>, usize) {
    let name = |c: char| c.is_alphanumeric() || c == '_';
    let mut prefix = Module::new();
    let mut at = 0;
    loop {
        let rest = &text[at..];
        let len = rest.find(|c| !name(c)).unwrap_or(rest.len());
        if len > 0 {
            prefix.push(rest[..len].into());
            at += len;
            if text[at..].starts_with("::") {
                at += 2;
                continue;
            }
        } else if rest.starts_with('{') {
            at += 1;
            let mut all = Vec::new();
            while !text[at..].starts_with('}') {
                let (inner, used) = paths(&text[at..]);
                all.extend(inner.into_iter().map(|path| [prefix.clone(), path].concat()));
                let skipped = text[at + used..].find([',', '}', '{']).expect("a closed group");
                at += used + skipped;
                if text[at..].starts_with(',') {
                    at += 1;
                }
                at += text[at..].len() - text[at..].trim_start().len();
            }
            return (all, at + 1);
        }
        return (vec![prefix], at);
    }
}

/// What a module's code names of its own crate, as paths below the crate.
fn named(module: &Module, code: &str) -> Vec<Module> {
    let mut out = Vec::new();
    for root in ["crate::", "super::", "self::"] {
        for (at, _) in code.match_indices(root) {
            let before = code[..at].chars().next_back();
            if before.is_some_and(|c| c.is_alphanumeric() || c == '_' || c == ':' || c == '$') {
                continue;
            }
            for mut path in paths(&code[at..]).0 {
                let mut base = if root == "crate::" { Module::new() } else { module.clone() };
                while path.first().is_some_and(|p| p == "super") {
                    base.pop();
                    path.remove(0);
                }
                path.retain(|p| p != "crate" && p != "self");
                out.push([base, path].concat());
            }
        }
    }
    out
}

/// For each folder, which of its rooms imports which.
fn edges() -> BTreeMap<Module, BTreeMap<String, BTreeSet<String>>> {
    let src = top().join("src");
    let modules: BTreeMap<Module, PathBuf> = files("src", "rs")
        .into_iter()
        .map(|path| {
            let inside = path.strip_prefix(&src).expect("below src").with_extension("");
            (inside.iter().map(|p| p.to_string_lossy().into_owned()).collect(), path)
        })
        .collect();
    let mut out: BTreeMap<Module, BTreeMap<String, BTreeSet<String>>> = BTreeMap::new();
    for (module, path) in &modules {
        for target in named(module, &code(path)) {
            let shared = module.iter().zip(&target).take_while(|(a, b)| a == b).count();
            let (Some(from), Some(to)) = (module.get(shared), target.get(shared)) else { continue };
            let folder = module[..shared].to_vec();
            if modules.contains_key(&[folder.clone(), vec![to.clone()]].concat()) {
                out.entry(folder).or_default().entry(from.clone()).or_default().insert(to.clone());
            }
        }
    }
    out
}

#[test]
fn floors_import_downwards() {
    let all = edges();
    let top = &all[&Module::new()];
    let height = |floor: &str| FLOORS.iter().position(|f| *f == floor);
    for (from, targets) in top.iter().filter(|(from, _)| *from != "lib" && *from != "main") {
        for to in targets {
            assert!(height(to) < height(from) && height(from).is_some(), "{from} imports {to}, which is not below it");
        }
    }
    assert!(top["race"].contains("model") && top["cli"].contains("present"), "imports are found at all");
}

#[test]
fn no_folder_has_rooms_in_a_circle() {
    let mut circles = Vec::new();
    for (folder, rooms) in edges() {
        // Whoever is left after all rooms without imports were taken away again and again is in a circle, or above one.
        let mut left = rooms.clone();
        loop {
            let free: Vec<String> = left
                .iter()
                .filter(|(_, to)| to.iter().all(|to| !left.contains_key(to)))
                .map(|(from, _)| from.clone())
                .collect();
            if free.is_empty() {
                break;
            }
            free.iter().for_each(|room| drop(left.remove(room)));
        }
        for (from, to) in left {
            circles.push(format!("{}/{from} imports {to:?}", folder.join("/")));
        }
    }
    assert!(circles.is_empty(), "in a circle, or above one:\n{}", circles.join("\n"));
}
