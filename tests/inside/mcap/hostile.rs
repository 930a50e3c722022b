//! Files cut short, damaged, or made to harm.

use super::foreign;
use mcap::records::MessageHeader;
use mcap::{Compression, MAGIC, WriteOptions};
use proptest::prelude::*;
use racer::flight::mcap::{tables, topics};
use racer::flight::{Readable, write};
use std::collections::BTreeMap;
use std::io::{Cursor, Read};

fn prefix(bytes: &[u8]) -> (usize, u64, String) {
    let read = tables(bytes, &|_| true).unwrap();
    let rows = read.tables.values().map(|table| table.rows()).sum();
    match read.readable {
        Readable::Prefix { bytes: good, of, why } => {
            assert!(good <= of && of == bytes.len() as u64 && !why.is_empty());
            (rows, good, why)
        }
        Readable::Whole => panic!("{} bytes are not the whole file", bytes.len()),
    }
}

#[test]
fn every_cut_leaves_a_prefix() {
    let log = super::log(400);
    let whole = write::mcap(&log).unwrap();
    let mut least = 0;
    for end in (MAGIC.len()..whole.len()).step_by(97) {
        let (rows, ..) = prefix(&whole[..end]);
        assert!(rows >= least, "{rows} rows in {end} bytes");
        least = rows;
        if end > 400 {
            assert_eq!(tables(&whole[..end], &|_| true).unwrap().vehicle, log.vehicle);
        }
    }
    let (rows, _, why) = prefix(&whole[..whole.len() - 1]);
    let all = tables(&whole, &|_| true).unwrap().tables.values().map(|table| table.rows()).sum::<usize>();
    assert_eq!(rows, all, "{why}");
    for end in 0..MAGIC.len() {
        assert!(tables(&whole[..end], &|_| true).is_err());
    }
}

#[test]
fn a_cut_compressed_chunk_gives_its_beginning() {
    for compression in [None, Some(Compression::Zstd), Some(Compression::Lz4)] {
        let mut file = WriteOptions::new().compression(compression).create(Cursor::new(Vec::new())).unwrap();
        let channel_id = file.add_channel(0, "/t", "json", &BTreeMap::new()).unwrap();
        for i in 0..20_000_u64 {
            let header = MessageHeader { channel_id, sequence: 0, log_time: i, publish_time: i };
            let data = format!("{{\"x\":{}}}", (i * 7919) as f64 * 0.618 % 1.0);
            file.write_to_known_channel(&header, data.as_bytes()).unwrap();
        }
        file.finish().unwrap();
        let bytes = file.into_inner().into_inner();
        assert_eq!(tables(&bytes, &|_| true).unwrap().readable, Readable::Whole);
        let (rows, ..) = prefix(&bytes[..bytes.len() / 2]);
        assert!((2_000..20_000).contains(&rows), "{compression:?}: {rows}");
    }
}

#[test]
fn a_flipped_bit_is_found() {
    let mut bytes = write::mcap(&super::log(400)).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    let (_, good, _) = prefix(&bytes);
    assert!((good as usize) < middle);
}

fn record(opcode: u8, length: u64, body: &[u8]) -> Vec<u8> {
    [MAGIC, &[opcode], &length.to_le_bytes(), body].concat()
}

fn chunk(uncompressed: u64, compression: &str, compressed: u64, body: &[u8]) -> Vec<u8> {
    let mut chunk = [[0; 16].as_slice(), &uncompressed.to_le_bytes(), &[0; 4]].concat();
    chunk.extend((compression.len() as u32).to_le_bytes());
    chunk.extend(compression.as_bytes());
    chunk.extend(compressed.to_le_bytes());
    chunk.extend(body);
    record(6, chunk.len() as u64, &chunk)
}

#[test]
fn absurd_lengths_end_the_prefix() {
    let zeros = zstd::encode_all(std::io::repeat(0).take((1 << 30) + 1), 1).unwrap();
    assert!(zeros.len() < 1 << 20);
    let records = [
        record(5, u64::MAX, &[]),
        record(6, u64::MAX, &[]),
        record(1, 1 << 40, b"x"),
        record(3, 8, &[1, 0, 255, 255, 255, 255, 0, 0]),
        record(4, 8, &[1, 0, 0, 0, 255, 255, 255, 255]),
        record(12, 4, &[255; 4]),
        record(9, 0, &[]),
        record(15, 0, &[]),
        record(0, 0, &[]),
        chunk(u64::MAX, "", u64::MAX, &[]),
        chunk(u64::MAX, "zstd", 4, b"zstd"),
        chunk(1 << 62, "lz4", 3, b"lz4"),
        chunk(u64::MAX, "zstd", zeros.len() as u64, &zeros),
        chunk(9, "", 9, &[5, 255, 255, 255, 255, 255, 255, 255, 255]),
        chunk(9, "gzip", 9, &[0; 9]),
    ];
    for bytes in records {
        assert_eq!(prefix(&bytes).0, 0);
    }
}

#[test]
fn sequences_and_types_without_end_are_errors() {
    let length = |n: u32| [[0, 1, 0, 0], n.to_le_bytes()].concat();
    let cases: [(&str, Vec<u8>); 7] = [
        ("float64[] a", length(u32::MAX)),
        ("string[] a", length(u32::MAX)),
        ("string a", length(u32::MAX)),
        ("uint8[18446744073709551615] a", length(0)),
        ("E[4000000000] a\n===\nMSG: p/E\nuint8 X=1", length(0)),
        ("Root[] a", length(1)),
        ("A[64] a\n===\nMSG: p/A\nB[64] b\n===\nMSG: p/B\nint8[64] c", vec![0; 1 << 19]),
    ];
    for (schema, message) in cases {
        let file = foreign::file("cdr", Some(("p/msg/Root", "ros2msg", schema.as_bytes())), &[message]);
        assert!(tables(&file, &|_| true).is_err(), "{schema}");
    }
    // Types that double thirty times.
    let mut doubling = "T0 a\nT0 b".to_string();
    for i in 0..30 {
        doubling += &format!("\n===\nMSG: p/T{i}\nT{} a\nT{} b", i + 1, i + 1);
    }
    doubling += "\n===\nMSG: p/T30\nstring s";
    let file = foreign::file("cdr", Some(("p/msg/Root", "ros2msg", doubling.as_bytes())), &[vec![0, 1, 0, 0]]);
    assert!(tables(&file, &|_| true).is_err());
    let deep = foreign::file("json", None, &[[b"{\"a\":".to_vec(), vec![b'['; 100_000]].concat()]);
    assert!(tables(&deep, &|_| true).is_err());
    let many: String = (0..5000).map(|i| format!("\"k{i}\":1,")).collect();
    let many = foreign::file("json", None, &[format!("{{{many}\"z\":1}}").into_bytes()]);
    assert!(tables(&many, &|_| true).is_err());
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    /// Without chunks and checksums, so that the damage reaches every decoder.
    #[test]
    fn no_bytes_make_it_panic(
        which in 0_usize..4,
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..8),
        end in any::<prop::sample::Index>(),
    ) {
        static FILES: std::sync::LazyLock<[Vec<u8>; 4]> = std::sync::LazyLock::new(|| {
            [foreign::json(), foreign::idl(), foreign::protobuf(), write::mcap(&super::log(100)).unwrap()]
        });
        let mut bytes = FILES[which].clone();
        for (at, value) in changes {
            let at = at.index(bytes.len());
            bytes[at] = value;
        }
        let _ = topics(&bytes);
        let _ = tables(&bytes, &|_| true);
        let _ = tables(&bytes[..end.index(bytes.len())], &|_| true);
    }
}
