//! What the documents count, counted again; and whether what they point to is there.

use crate::{files, read, shown, top};

/// The number before `what` in the README, which has to name it.
fn claimed(what: &str) -> usize {
    let text = read(&top().join("README.md")).replace('\n', " ");
    let before = text.split(&format!(" {what}")).next().filter(|b| b.len() < text.len());
    let word = before.and_then(|b| b.rsplit(' ').next()).unwrap_or_default();
    word.parse().unwrap_or_else(|_| panic!("README.md should say how many {what} there are, and says {word:?}"))
}

#[test]
fn the_readme_counts_effects_and_mappings_as_they_are() {
    let effects = files("src/model/effects", "rs").iter().filter(|p| read(p).contains("const CARD: Card")).count();
    assert_eq!(claimed("effects"), effects);
    assert_eq!(claimed("mappings"), files("configs/mappings", "toml").len());
}

#[test]
fn every_link_and_every_file_that_is_named_is_there() {
    let mut missing = Vec::new();
    let pages =
        files("docs", "md").into_iter().chain(["README.md", "ARCHITECTURE.md", "RESULTS.md"].map(|p| top().join(p)));
    for page in pages {
        let text = read(&page);
        let folder = page.parent().expect("in a folder");
        for link in text.split("](").skip(1).filter_map(|rest| rest.split(')').next()) {
            let path = link.split('#').next().unwrap_or_default();
            if !path.contains("://") && !path.is_empty() && !folder.join(path).exists() {
                missing.push(format!("{}: {link}", shown(&page)));
            }
        }
        for name in text.split('`').skip(1).step_by(2).filter(|name| !name.contains([' ', '{', '*', '<', '\n'])) {
            let source = name.ends_with(".rs") || name.ends_with('/') && name.contains('/') && !name.starts_with('.');
            let roots = ["", "src", "src/learn", "src/race", "src/model", "src/model/vehicle"];
            let generated = ["runs/", "target/", ".work/"].iter().any(|made| name.starts_with(made));
            if source && !generated && !roots.iter().any(|root| top().join(root).join(name).exists()) {
                missing.push(format!("{}: `{name}`", shown(&page)));
            }
        }
    }
    assert!(missing.is_empty(), "named, but not there:\n{}", missing.join("\n"));
}
