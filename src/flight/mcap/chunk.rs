//! The records within a chunk.

use super::bytes::Bytes;
use std::borrow::Cow;
use std::io::Read;

/// What a chunk may decompress to. Recorders write chunks of about a megabyte.
const UNCOMPRESSED: u64 = 1 << 30;

/// The records of the chunk with this body. One that the end of the file has `cut` short gives what of them can be had.
pub fn records(body: &[u8], cut: bool) -> Result<Cow<'_, [u8]>, String> {
    let (header, rest) = ChunkHeader::parse(body).ok_or("a chunk has no header")?;
    match rest.get(..usize::try_from(header.compressed_size).unwrap_or(usize::MAX)) {
        Some(compressed) => {
            let records = header.decompress(compressed, header.uncompressed_size)?;
            header.verify(&records)?;
            Ok(records)
        }
        // A recorder that died has not come back to write the sizes.
        None if cut => header.decompress(rest, u64::MAX),
        None => Err("a chunk claims more bytes than it has".into()),
    }
}

struct ChunkHeader<'a> {
    uncompressed_size: u64,
    uncompressed_crc: u32,
    compression: &'a str,
    compressed_size: u64,
}

impl<'a> ChunkHeader<'a> {
    fn parse(body: &'a [u8]) -> Option<(Self, &'a [u8])> {
        let b = &mut Bytes(body);
        let (_start_time, _end_time) = (b.u64()?, b.u64()?);
        let header = Self {
            uncompressed_size: b.u64()?,
            uncompressed_crc: b.u32()?,
            compression: b.text()?,
            compressed_size: b.u64()?,
        };
        Some((header, b.0))
    }

    /// As many of the uncompressed bytes as `compressed` gives, `size` at most.
    fn decompress<'b>(&self, compressed: &'b [u8], size: u64) -> Result<Cow<'b, [u8]>, String> {
        let broken = |error: std::io::Error| format!("a chunk cannot be decompressed: {error}");
        let decoder: Box<dyn Read> = match self.compression {
            "" => return Ok(Cow::Borrowed(compressed)),
            "zstd" => Box::new(zstd::stream::read::Decoder::with_buffer(compressed).map_err(broken)?),
            "lz4" => Box::new(lz4::Decoder::new(compressed).map_err(broken)?),
            other => return Err(format!("a chunk is compressed with {other:?}; zstd and lz4 can be read")),
        };
        let mut records = Vec::new();
        // Where the compressed bytes end early, the error comes after all that they held.
        let ended = decoder.take(size.min(UNCOMPRESSED + 1)).read_to_end(&mut records);
        if records.len() as u64 > UNCOMPRESSED {
            return Err(format!("a chunk holds more than {UNCOMPRESSED} bytes"));
        }
        match ended {
            Err(error) if error.kind() != std::io::ErrorKind::UnexpectedEof => Err(broken(error)),
            _ => Ok(Cow::Owned(records)),
        }
    }

    fn verify(&self, records: &[u8]) -> Result<(), String> {
        if records.len() as u64 != self.uncompressed_size {
            return Err(format!("a chunk of {} bytes gives only {}", self.uncompressed_size, records.len()));
        }
        if self.uncompressed_crc != 0 && self.uncompressed_crc != crc32fast::hash(records) {
            return Err("the checksum of a chunk does not match".into());
        }
        Ok(())
    }
}
