//! Files that a command is to write, each by its option: new, writable, and no two of one path.

use crate::base::check::BadInput;
use crate::base::fsio::{Reserved, real};
use std::path::Path;

/// An option and the path that it was given.
pub type Output<'a> = (&'static str, Option<&'a Path>);

/// The files that were asked for, in the order of the options. Fails before anything is done where one cannot be
/// written.
pub fn reserve<const N: usize>(asked: [Output; N]) -> Result<[Option<Reserved>; N], BadInput> {
    distinct(&asked)?;
    let mut files = [const { None }; N];
    for (file, (option, path)) in files.iter_mut().zip(asked) {
        *file = path.map(|path| Reserved::new(path, option)).transpose()?;
    }
    Ok(files)
}

/// Fails where two options name one path.
pub fn distinct(asked: &[Output]) -> Result<(), BadInput> {
    let given: Vec<_> = asked.iter().filter_map(|(option, path)| Some((*option, (*path)?))).collect();
    for (i, (option, path)) in given.iter().enumerate() {
        if let Some((other, _)) = given[..i].iter().find(|(_, other)| real(other) == real(path)) {
            let (found, advice) = (format!("the path of {other}"), format!("choose another path ({option})"));
            return Err(BadInput::new(path.display(), found, &format!("a path of its own for {option}"), advice));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_path_is_one_however_it_is_written() {
        let folder = tempfile::tempdir().unwrap();
        let [a, same, b] = ["a", "./a", "b"].map(|name| folder.path().join(name));
        assert!(reserve([("--json", Some(&a)), ("--out", None), ("--report", Some(&b))]).is_ok());
        let error = reserve([("--json", Some(&a)), ("--report", Some(&same))]).unwrap_err().to_string();
        assert!(error.contains("the path of --json") && error.contains("(--report)"), "{error}");
        let relative: [Output; 2] = [("--json", Some(Path::new("./a"))), ("--report", Some(Path::new("a")))];
        assert!(distinct(&relative).is_err());
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    }
}
