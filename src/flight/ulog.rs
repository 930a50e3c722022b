//! PX4 ULog files: one table a topic, `topic#1` for its second instance. Read by ourselves: the library for it panics
//! on damaged files, and unfolds a small hostile one into gigabytes.

mod format;
mod vehicle;

use super::Readable;
use super::format::{Content, Format, LogFile};
use super::mapping::Mapping;
use super::table::{LOG_TIME, Table, Tables};
use crate::base::check::BadInput;
use format::{Formats, Leaf};
use std::collections::{BTreeMap, HashMap};

const MAGIC: &[u8] = b"ULog\x01\x12\x35";
const HEADER_BYTES: usize = 16;

/// A topic whose records are read.
struct TopicColumns {
    leaves: Vec<Leaf>,
    columns: Vec<Vec<f64>>,
}

#[derive(Default)]
struct LogReader<'a> {
    formats: Formats<'a>,
    /// Topics by the number under which records name them.
    ids: HashMap<u16, String>,
    topics: HashMap<String, TopicColumns>,
    parameters: vehicle::Px4Parameters,
}

/// Logs of PX4.
pub struct ULog;

impl Format for ULog {
    fn name(&self) -> &'static str {
        "PX4 ULog"
    }

    fn recognises(&self, file: &LogFile) -> bool {
        file.bytes.starts_with(b"ULog")
    }

    fn mapping(&self, _: &LogFile) -> Result<(&'static str, Option<String>), BadInput> {
        Ok(("px4", None))
    }

    fn tables(&self, file: &LogFile, mapping: &Mapping) -> Result<Content, BadInput> {
        let made = mapping.wanted("motors") || mapping.wanted("rotors") || mapping.wanted("vehicle_status");
        let wanted = |topic: &str| mapping.wanted(topic) || made && vehicle::SOURCES.contains(&topic);
        let (mut tables, parameters) = read(file.bytes, file.name, &wanted)?;
        let remark = vehicle::complete(&mut tables, &parameters);
        Ok(Content { tables, remarks: remark.into_iter().collect(), flights: Vec::new() })
    }
}

/// The topics that are `wanted`, as they were recorded.
#[cfg(feature = "internals")]
pub fn tables(bytes: &[u8], name: &str, wanted: &dyn Fn(&str) -> bool) -> Result<Tables, BadInput> {
    Ok(read(bytes, name, wanted)?.0)
}

/// How reading ended early.
enum EarlyEnd {
    BreaksOff,
    Bad(String),
}

/// Reads the topics that are `wanted`; of others the name alone, as an empty table. Times are in s since the vehicle's
/// start. A file that breaks off, or turns bad, gives what came before.
fn read(bytes: &[u8], name: &str, wanted: &dyn Fn(&str) -> bool) -> Result<(Tables, vehicle::Px4Parameters), BadInput> {
    if bytes.len() < HEADER_BYTES || !bytes.starts_with(MAGIC) {
        return Err(BadInput::new(name, "no ULog header", "a PX4 ULog file", ""));
    }
    let mut ends = appended(bytes).map_err(|why| BadInput::new(name, why, "a ULog file of a known kind", ""))?;
    ends.push(bytes.len());
    let mut reader = LogReader::default();
    let (mut position, mut readable) = (HEADER_BYTES, Readable::Whole);
    for end in ends {
        match reader.section(&bytes[..end], &mut position, wanted) {
            Ok(()) => {}
            // What was appended after a crash starts anew, wherever the crash cut off what was before.
            Err(EarlyEnd::BreaksOff) if end < bytes.len() => position = end,
            Err(stop) => {
                let why = match stop {
                    EarlyEnd::BreaksOff => "the last message breaks off".into(),
                    EarlyEnd::Bad(why) => why,
                };
                readable = Readable::Prefix { bytes: position as u64, of: bytes.len() as u64, why };
                break;
            }
        }
    }
    match readable {
        Readable::Prefix { why, .. } if reader.ids.is_empty() => {
            let found = format!("no topic before byte {position}: {why}");
            Err(BadInput::new(name, found, "a PX4 ULog file with data", ""))
        }
        readable => {
            let parameters = std::mem::take(&mut reader.parameters);
            Ok((Tables { tables: reader.tables(), readable, ..Tables::default() }, parameters))
        }
    }
}

/// Where data was appended, in order, out of the flags that follow the header. Fails on flags that we do not know.
fn appended(bytes: &[u8]) -> Result<Vec<usize>, String> {
    let Some([_, _, b'B', flags @ ..]) = bytes.get(HEADER_BYTES..) else { return Ok(Vec::new()) };
    let Some((flags, _)) = flags.split_first_chunk::<40>() else { return Ok(Vec::new()) };
    if flags[8] & !1 != 0 || flags[9..16] != [0; 7] {
        return Err(format!("incompatible flags {:?}", &flags[8..16]));
    }
    let offsets = flags[16..].chunks_exact(8).map(|chunk| u64::from_le_bytes(std::array::from_fn(|i| chunk[i])));
    let within = HEADER_BYTES as u64 + 1..bytes.len() as u64;
    let mut starts: Vec<usize> =
        offsets.filter(|offset| within.contains(offset)).map(|offset| offset as usize).collect();
    starts.sort_unstable();
    Ok(starts)
}

impl<'a> LogReader<'a> {
    /// Reads messages to the end of `bytes`; `position` is left at the first one that cannot be read.
    fn section(
        &mut self,
        bytes: &'a [u8],
        position: &mut usize,
        wanted: &dyn Fn(&str) -> bool,
    ) -> Result<(), EarlyEnd> {
        while *position < bytes.len() {
            let [low, high, kind, rest @ ..] = &bytes[*position..] else { return Err(EarlyEnd::BreaksOff) };
            let size = usize::from(u16::from_le_bytes([*low, *high]));
            let payload = rest.get(..size).ok_or(EarlyEnd::BreaksOff)?;
            self.message(*kind, payload, wanted).map_err(EarlyEnd::Bad)?;
            *position += 3 + size;
        }
        Ok(())
    }

    fn message(&mut self, kind: u8, payload: &'a [u8], wanted: &dyn Fn(&str) -> bool) -> Result<(), String> {
        match kind {
            b'F' => self.formats.add(payload),
            b'A' => self.subscribe(payload, wanted),
            b'D' => self.record(payload),
            b'P' => {
                vehicle::parameter(&mut self.parameters, payload);
                Ok(())
            }
            // Text, marks; and what later versions add.
            other if other.is_ascii_uppercase() => Ok(()),
            other => Err(format!("a message of the unknown kind {other}")),
        }
    }

    fn subscribe(&mut self, payload: &'a [u8], wanted: &dyn Fn(&str) -> bool) -> Result<(), String> {
        let [instance, low, high, name @ ..] = payload else { return Err("a topic without a name".into()) };
        let name = std::str::from_utf8(name).map_err(|_| "a topic's name that is no text".to_string())?;
        let topic = if *instance == 0 { name.to_string() } else { format!("{name}#{instance}") };
        if wanted(&topic) && !self.topics.contains_key(&topic) {
            let leaves = self.formats.leaves(name)?;
            let columns = vec![Vec::new(); leaves.len()];
            self.topics.insert(topic.clone(), TopicColumns { leaves, columns });
        }
        self.ids.insert(u16::from_le_bytes([*low, *high]), topic);
        Ok(())
    }

    fn record(&mut self, payload: &[u8]) -> Result<(), String> {
        let [low, high, data @ ..] = payload else { return Err("a record without a topic".into()) };
        let id = u16::from_le_bytes([*low, *high]);
        let name = self.ids.get(&id).ok_or_else(|| format!("a record of the undeclared topic {id}"))?;
        let Some(topic) = self.topics.get_mut(name) else { return Ok(()) };
        let size = topic.leaves.last().map_or(0, Leaf::end);
        if data.len() < size {
            return Err(format!("a record of `{name}` with {} bytes in place of {size}", data.len()));
        }
        for (column, leaf) in topic.columns.iter_mut().zip(&topic.leaves) {
            column.push(leaf.value(data));
        }
        Ok(())
    }

    fn tables(self) -> BTreeMap<String, Table> {
        let mut tables: BTreeMap<_, _> = self.ids.into_values().map(|name| (name, Table::default())).collect();
        for (name, topic) in self.topics {
            let names = topic.leaves.into_iter().map(|leaf| leaf.name);
            let mut columns: BTreeMap<String, Vec<f64>> = names.zip(topic.columns).collect();
            if let Some(stamps) = columns.get("timestamp") {
                let seconds = stamps.iter().map(|microseconds| microseconds * 1e-6).collect();
                columns.insert(LOG_TIME.into(), seconds);
            }
            tables.insert(name, Table { columns });
        }
        tables
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(kind: u8, payload: &[u8]) -> Vec<u8> {
        [&(payload.len() as u16).to_le_bytes()[..], &[kind], payload].concat()
    }

    fn file() -> Vec<u8> {
        let mut bytes = [MAGIC, &[1], &0u64.to_le_bytes()[..]].concat();
        bytes.extend(message(b'B', &[0; 40]));
        bytes.extend(message(b'F', b"inner:float v;uint8_t[3] _padding0;"));
        bytes.extend(message(b'F', b"t:uint64_t timestamp;inner[2] a;int16_t b;uint8_t[6] _padding0;"));
        bytes.extend(message(b'A', b"\x00\x07\x00t"));
        bytes.extend(message(b'A', b"\x01\x08\x00t"));
        for (time, b) in [(1_000_000u64, -1i16), (2_000_000, -2)] {
            let pad = [0; 3];
            let data = [
                &7u16.to_le_bytes()[..],
                &time.to_le_bytes(),
                &1.5f32.to_le_bytes(),
                &pad,
                &2.5f32.to_le_bytes(),
                &pad,
                &b.to_le_bytes(),
            ];
            bytes.extend(message(b'D', &data.concat()));
        }
        bytes
    }

    #[test]
    fn nested_fields_padding_and_instances() {
        let tables = tables(&file(), "t", &|topic| topic == "t").unwrap();
        assert_eq!(tables.readable, Readable::Whole);
        let columns = &tables.tables["t"].columns;
        assert_eq!(columns.keys().collect::<Vec<_>>(), ["@log_time", "a[0].v", "a[1].v", "b", "timestamp"]);
        assert_eq!((&columns["@log_time"][..], &columns["b"][..]), (&[1.0, 2.0][..], &[-1.0, -2.0][..]));
        assert_eq!(columns["a[1].v"], [2.5, 2.5]);
        assert!(tables.tables["t#1"].columns.is_empty(), "not wanted: its name alone");
    }

    #[test]
    fn what_breaks_off_leaves_what_was_before() {
        let bytes = file();
        let cut = tables(&bytes[..bytes.len() - 5], "t", &|topic| topic == "t").unwrap();
        assert_eq!(cut.tables["t"].columns["b"], [-1.0]);
        assert!(matches!(cut.readable, Readable::Prefix { bytes: at, .. } if at < bytes.len() as u64 - 5));
        let stray = [&bytes[..], &message(b'D', &[99, 0])].concat();
        let Readable::Prefix { why, .. } = tables(&stray, "t", &|_| true).unwrap().readable else { panic!() };
        assert!(why.contains("undeclared topic 99"), "{why}");
        assert!(tables(&bytes[..40], "t", &|_| true).is_err());
    }

    #[test]
    fn hostile_formats_do_not_unfold() {
        for formats in [
            vec!["t:t x;"],
            vec!["t:a[30000] x;", "a:b[30000] x;", "b:c[30000] x;", "c:"],
            vec!["t:float[30000] x;uint8_t[30000] y;"],
            vec!["t:unknown x;"],
            vec!["t:float[-3] x;"],
        ] {
            let mut bytes = [MAGIC, &[1; 9]].concat();
            for format in formats {
                bytes.extend(message(b'F', format.as_bytes()));
            }
            bytes.extend(message(b'A', b"\x00\x07\x00t"));
            assert!(tables(&bytes, "t", &|_| true).is_err());
        }
    }
}
