//! A CSV file as a log: its own table, called "", and those of the files beside it that the mapping names.

use super::{choose, header, table};
use crate::base::check::BadInput;
use crate::flight::format::{Content, Format, LogFile};
use crate::flight::mapping::Mapping;
use crate::flight::table::Tables;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Comma-separated values with a line of names, plain or gzipped.
pub struct Csv;

impl Format for Csv {
    fn name(&self) -> &'static str {
        "CSV (also .csv.gz)"
    }

    fn recognises(&self, file: &LogFile) -> bool {
        let packed = file.bytes.starts_with(&[0x1f, 0x8b]);
        packed || file.ends(&[".csv", ".tsv", ".txt"]) || std::str::from_utf8(file.start()).is_ok()
    }

    fn mapping(&self, file: &LogFile) -> Result<(&'static str, Option<String>), BadInput> {
        let called = choose::for_columns(&header(file.bytes, file.name)?, file.name)?;
        Ok((called, Some(format!("its columns fit the built-in mapping `{called}`"))))
    }

    fn tables(&self, file: &LogFile, mapping: &Mapping) -> Result<Content, BadInput> {
        let columns = mapping.columns();
        let wanted =
            |table: &str| columns.iter().filter(|(source, _)| *source == table).map(|(_, column)| *column).collect();
        let (own, readable) = table(file.bytes, file.name, &wanted(""))?;
        let mut tables = Tables { tables: BTreeMap::from([(String::new(), own)]), readable, ..Tables::default() };
        for source in mapping.sources() {
            if let Some(path) = beside(file.path, source) {
                let name = path.display().to_string();
                let bytes = std::fs::read(&path).map_err(|error| BadInput::new(&name, error, "a CSV file", ""))?;
                tables.tables.insert(source.into(), table(&bytes, &name, &wanted(source))?.0);
            }
        }
        Ok(tables.into())
    }
}

/// The file beside a CSV file that a source such as `_gps` stands for, where there is one.
fn beside(path: &Path, source: &str) -> Option<PathBuf> {
    let name = path.file_name()?.to_str()?;
    let (stem, extension) = [".csv.gz", ".csv"].iter().find_map(|end| Some((name.strip_suffix(end)?, *end)))?;
    let other = if extension == ".csv" { ".csv.gz" } else { ".csv" };
    let file = |extension| path.with_file_name(format!("{stem}{source}{extension}"));
    [extension, other].map(file).into_iter().find(|file| source.starts_with('_') && file.is_file())
}
