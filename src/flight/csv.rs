//! Comma-separated values, plain or gzipped, into one table.

mod choose;
pub mod files;

use super::Readable;
use super::table::Table;
use crate::base::check::BadInput;
use csv::{ByteRecord, ErrorKind};
use flate2::bufread::MultiGzDecoder;
use std::collections::BTreeSet;
use std::io::Read;

/// A gzipped file that unpacks to more is not read.
const MOST_BYTES: u64 = 1 << 30;

/// A text, packed or not, counting what of the file is read.
enum TextSource<'a> {
    Plain(&'a [u8]),
    Packed(std::io::Take<MultiGzDecoder<&'a [u8]>>),
}

impl<'a> TextSource<'a> {
    fn new(bytes: &'a [u8]) -> Self {
        if bytes.starts_with(&[0x1f, 0x8b]) {
            TextSource::Packed(MultiGzDecoder::new(bytes).take(MOST_BYTES))
        } else {
            TextSource::Plain(bytes)
        }
    }

    /// Bytes of the file that are not read yet.
    fn left(&self) -> usize {
        match self {
            TextSource::Plain(rest) => rest.len(),
            TextSource::Packed(rest) => rest.get_ref().get_ref().len(),
        }
    }
}

impl Read for TextSource<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        match self {
            TextSource::Plain(rest) => rest.read(buffer),
            TextSource::Packed(rest) => rest.read(buffer),
        }
    }
}

type CsvReader<'a> = csv::Reader<TextSource<'a>>;

/// The columns that the file `name` has.
pub fn header(bytes: &[u8], name: &str) -> Result<Vec<String>, BadInput> {
    Ok(open(bytes, name)?.1)
}

/// Reads a file: the first line names the columns, an empty cell is NaN. In the columns that are `wanted` everything
/// else has to be a number; in others it is NaN. A file that breaks off gives the rows before.
pub fn table(bytes: &[u8], name: &str, wanted: &BTreeSet<&str>) -> Result<(Table, Readable), BadInput> {
    let (mut reader, header) = open(bytes, name)?;
    let wanted: Vec<bool> = header.iter().map(|column| wanted.contains(column.as_str())).collect();
    let mut columns: Vec<Vec<f64>> = vec![Vec::new(); header.len()];
    let mut record = ByteRecord::new();
    let readable = loop {
        match reader.read_byte_record(&mut record) {
            Ok(false) => break Readable::Whole,
            Ok(true) => {
                for (k, cell) in record.iter().enumerate().take(header.len()) {
                    let number = number(cell);
                    if wanted[k] && number.is_none() {
                        return Err(not_a_number(name, &record, &header[k], cell));
                    }
                    columns[k].push(number.unwrap_or(f64::NAN));
                }
            }
            Err(error) => break broken(error, &mut reader, bytes, name)?,
        }
    };
    if let TextSource::Packed(rest) = reader.get_ref()
        && rest.limit() == 0
    {
        let advice = "unpack it yourself, and give a part of it";
        return Err(BadInput::new(name, "a larger one", "a file that unpacks to 1 GiB at the most", advice));
    }
    // Trailing commas make a column without a name.
    let columns = header.into_iter().zip(columns).filter(|(column, _)| !column.is_empty()).collect();
    Ok((Table { columns }, readable))
}

fn open<'a>(bytes: &'a [u8], name: &str) -> Result<(CsvReader<'a>, Vec<String>), BadInput> {
    let delimiter = delimiter(bytes);
    let mut builder = csv::ReaderBuilder::new();
    let mut reader = builder.trim(csv::Trim::All).delimiter(delimiter).from_reader(TextSource::new(bytes));
    let bad = |found: String| BadInput::new(name, found, "a first line that names the columns", "is it a CSV file?");
    let record = reader.byte_headers().map_err(|error| bad(error.to_string()))?;
    let header: Vec<String> = record.iter().map(|cell| String::from_utf8_lossy(cell).into_owned()).collect();
    if header.iter().all(String::is_empty) {
        return Err(bad("an empty one".into()));
    }
    if header.iter().flat_map(|column| column.chars()).any(char::is_control) {
        return Err(bad("one that is no text".into()));
    }
    let mut seen = BTreeSet::new();
    match header.iter().find(|column| !column.is_empty() && !seen.insert(*column)) {
        Some(twice) => Err(bad(format!("`{twice}` twice"))),
        None => Ok((reader, header)),
    }
}

/// The one of comma, semicolon and tab that the first line has most of.
fn delimiter(bytes: &[u8]) -> u8 {
    let mut start = Vec::new();
    // What cannot be unpacked is reported by the reading that follows.
    let _ = TextSource::new(bytes).take(1 << 16).read_to_end(&mut start);
    let line = start.split(|&byte| byte == b'\n').next().unwrap_or_default();
    let count = |delimiter: u8| line.iter().filter(|&&byte| byte == delimiter).count();
    // Of equals `max_by_key` takes the last.
    [b'\t', b';', b','].into_iter().max_by_key(|&delimiter| count(delimiter)).unwrap_or(b',')
}

/// `None` where it is none.
fn number(cell: &[u8]) -> Option<f64> {
    match cell {
        b"" => Some(f64::NAN),
        cell => std::str::from_utf8(cell).ok()?.parse().ok(),
    }
}

fn not_a_number(name: &str, record: &ByteRecord, column: &str, cell: &[u8]) -> BadInput {
    let line = record.position().map_or(0, csv::Position::line);
    let mut cell = String::from_utf8_lossy(cell).into_owned();
    if let Some((end, _)) = cell.char_indices().nth(40) {
        cell.truncate(end);
        cell += "...";
    }
    BadInput::new(format!("{name}:{line}"), format!("`{cell}` in column `{column}`"), "a number, or nothing", "")
}

/// A file that breaks off was read up to there; anything else is an error.
fn broken(error: csv::Error, reader: &mut CsvReader, bytes: &[u8], name: &str) -> Result<Readable, BadInput> {
    let of = bytes.len() as u64;
    let line = error.position().map_or(0, csv::Position::line);
    let prefix = |reader: &CsvReader, why| Ok(Readable::Prefix { bytes: of - reader.get_ref().left() as u64, of, why });
    match error.kind() {
        ErrorKind::Io(error) => prefix(reader, format!("the gzip stream breaks off: {error}")),
        ErrorKind::UnequalLengths { expected_len, len, .. } => {
            if len < expected_len && matches!(reader.read_byte_record(&mut ByteRecord::new()), Ok(false)) {
                return prefix(reader, "the last row breaks off".into());
            }
            let expected = format!("{expected_len}, as the first line has");
            Err(BadInput::new(format!("{name}:{line}"), format!("{len} cells"), &expected, "mend or remove the row"))
        }
        _ => Err(BadInput::new(format!("{name}:{line}"), error, "a CSV file", "")),
    }
}
