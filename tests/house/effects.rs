//! Everything about an effect stands in its file: its identifier is nowhere else in the program.

use crate::{files, read, shown, top};

#[test]
fn an_effect_is_named_in_its_file_and_in_the_list_only() {
    let folder = top().join("src/model/effects");
    let identifiers: Vec<String> = files("src/model/effects", "rs")
        .iter()
        .map(|path| path.file_stem().expect("a name").to_string_lossy().into_owned())
        .filter(|name| read(&folder.join(format!("{name}.rs"))).contains(&format!("\"{name}\"")))
        .collect();
    assert!(identifiers.len() >= 42, "cards are found at all: {identifiers:?}");
    let mut found = Vec::new();
    for path in files("src", "rs") {
        let inside = path.starts_with(&folder);
        for (i, line) in read(&path).lines().enumerate() {
            let line = line.split("//").next().unwrap_or_default();
            for id in identifiers.iter().filter(|id| line.contains(&format!("\"{id}\""))) {
                // A card names its rivals; a log format has names of its own.
                if !inside && !path.starts_with(top().join("src/flight")) {
                    found.push(format!("{}:{}: {id}", shown(&path), i + 1));
                }
            }
        }
    }
    assert!(found.is_empty(), "effects are named outside their files:\n{}", found.join("\n"));
}
