//! A walk over the records of a file, chunks unpacked, up to where it breaks off.

use super::bytes::Bytes;
use super::chunk;
use super::record::{self, McapRecord};
use crate::base::check::BadInput;
use crate::flight::Readable;
use ::mcap::{MAGIC, records::op};

/// Why a walk ends early.
pub enum Stop {
    /// The file turns bad here; what came before is good.
    Broken(String),
    /// Nothing of the file is of use before this is mended.
    Useless(BadInput),
}

impl From<String> for Stop {
    fn from(why: String) -> Self {
        Self::Broken(why)
    }
}

impl From<&str> for Stop {
    fn from(why: &str) -> Self {
        Self::Broken(why.into())
    }
}

type Visit<'v> = &'v mut dyn FnMut(McapRecord) -> Result<(), Stop>;

/// Shows `visit` the records of the data section, in the order of the file.
pub fn walk(bytes: &[u8], visit: Visit) -> Result<Readable, BadInput> {
    let Some(records) = bytes.strip_prefix(MAGIC) else {
        return Err(BadInput::new(
            "MCAP",
            "other bytes at its start",
            "an MCAP file",
            "name a file that a recorder wrote",
        ));
    };
    let mut rest = Bytes(records);
    match data(bytes, &mut rest, visit).and_then(|()| summary(&mut rest)) {
        Ok(()) => Ok(Readable::Whole),
        Err(Stop::Useless(bad)) => Err(bad),
        Err(Stop::Broken(why)) => {
            let of = bytes.len();
            Ok(Readable::Prefix { bytes: (of - rest.0.len()) as u64, of: of as u64, why })
        }
    }
}

/// On an error `rest` begins with the record that caused it.
fn data<'a>(file: &'a [u8], rest: &mut Bytes<'a>, visit: Visit) -> Result<(), Stop> {
    loop {
        let mut after = *rest;
        let Some((opcode, body)) = record::next(&mut after) else {
            return Err(last(rest, visit).err().unwrap_or("the file ends within a record".into()));
        };
        match opcode {
            0 => return Err("what follows is not a record".into()),
            op::CHUNK => all(&chunk::records(body, false)?, visit)?,
            op::FOOTER => return Ok(()),
            op::DATA_END => {
                let saved = Bytes(body).u32().unwrap_or(0);
                let section = &file[..file.len() - rest.0.len()];
                if saved != 0 && saved != crc32fast::hash(section) {
                    return Err("the checksum of the data does not match: some of it is wrong".into());
                }
                *rest = after;
                return Ok(());
            }
            _ => visit(parse(opcode, body)?)?,
        }
        *rest = after;
    }
}

/// What can be had of a chunk that the end of the file cuts short.
fn last<'a>(rest: &mut Bytes<'a>, visit: Visit) -> Result<(), Stop> {
    let mut body = *rest;
    if body.u8() == Some(op::CHUNK) && body.u64().is_some() {
        let records = chunk::records(body.0, true)?;
        rest.0 = &[];
        whole(&mut Bytes(&records), visit)?;
        return Err("the file ends within a chunk".into());
    }
    if rest.0.is_empty() { Err("the file ends without its closing records".into()) } else { Ok(()) }
}

fn all(records: &[u8], visit: Visit) -> Result<(), Stop> {
    let mut rest = Bytes(records);
    whole(&mut rest, visit)?;
    if rest.0.is_empty() { Ok(()) } else { Err("a chunk ends within a record".into()) }
}

/// Visits the records that are not cut short.
fn whole(rest: &mut Bytes, visit: Visit) -> Result<(), Stop> {
    while let Some((opcode, body)) = record::next(rest) {
        visit(parse(opcode, body)?)?;
    }
    Ok(())
}

fn parse(opcode: u8, body: &[u8]) -> Result<McapRecord<'_>, Stop> {
    McapRecord::parse(opcode, body).ok_or(Stop::Broken(format!("a record with opcode {opcode} is damaged")))
}

fn summary(rest: &mut Bytes) -> Result<(), Stop> {
    while let Some((opcode, _)) = record::next(rest) {
        if opcode == op::FOOTER {
            return if rest.0 == MAGIC { Ok(()) } else { Err("the file ends without its closing mark".into()) };
        }
    }
    Err("the file ends within its summary; every message was read".into())
}
