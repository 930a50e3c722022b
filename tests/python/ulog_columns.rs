//! Writes the columns of a ULog file as racer reads them, for comparison with other readers:
//!
//! ```sh
//! cargo run --release --example ulog_columns -- LOG.ulg FOLDER
//! ```
//!
//! A line a column is printed: topic, column, rows, and the name of a file in `FOLDER` that has its numbers as 64-bit
//! little-endian floats.

use racer::flight::ulog::tables;
use std::path::PathBuf;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<PathBuf> = std::env::args_os().skip(1).map(PathBuf::from).collect();
    let [log, folder] = arguments.as_slice() else { return Err("expected a log and a folder".into()) };
    let read = tables(&std::fs::read(log)?, &log.display().to_string(), &|_| true)?;
    for (topic, table) in &read.tables {
        for (i, (column, values)) in table.columns.iter().enumerate() {
            let name = format!("{topic}.{i}.f64");
            let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
            std::fs::write(folder.join(&name), bytes)?;
            println!("{topic}\t{column}\t{}\t{name}", values.len());
        }
    }
    Ok(())
}
