//! Writes what a blackbox file holds as it was recorded, without units, for comparison with other decoders:
//!
//! ```sh
//! cargo run --release --example blackbox_csv -- LOG.BFL FOLDER
//! ```
//!
//! `FOLDER/1.main.csv` has the main frames of the first flight, each with the slow frame before it, `FOLDER/1.gps.csv`
//! its GPS frames. A line a flight is printed: number, firmware, rows, and flight-mode and disarm events.

use racer::flight::blackbox::decoder::{DecodedFrame, FrameDecoder};
use racer::flight::blackbox::definition::{Definitions, FrameDefinition};
use racer::flight::blackbox::header::Header;
use racer::flight::blackbox::split;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

type Failure = Box<dyn std::error::Error>;

fn main() -> Result<(), Failure> {
    let arguments: Vec<PathBuf> = std::env::args_os().skip(1).map(PathBuf::from).collect();
    let [log, folder] = arguments.as_slice() else { return Err("expected a log and a folder".into()) };
    let bytes = std::fs::read(log)?;
    for (index, flight) in split(&bytes).into_iter().enumerate() {
        if let Err(error) = write(flight, index + 1, folder) {
            println!("{}\tunreadable: {error}\t0\t0", index + 1);
        }
    }
    Ok(())
}

fn write(bytes: &[u8], number: usize, folder: &Path) -> Result<(), Failure> {
    let header = Header::of(bytes);
    let definitions = Definitions::of(&header)?;
    let decoder = FrameDecoder::new(bytes, &header, &definitions)?;
    let create = |name: &str| File::create(folder.join(format!("{number}.{name}.csv"))).map(BufWriter::new);
    let (mut main, mut gps) = (create("main")?, create("gps")?);
    let Definitions { intra, gps: of_gps, slow: of_slow, .. } = &definitions;
    writeln!(main, "{}", [&intra.names[..], &of_slow.names].concat().join(","))?;
    writeln!(
        gps,
        "time,{}",
        of_gps.names.iter().filter(|name| *name != "time").cloned().collect::<Vec<_>>().join(",")
    )?;
    let mut slow = vec![",0".to_string(); of_slow.names.len()].concat();
    let (mut failed, mut events) = (None, 0);
    let tally = decoder.run(header.end, |time, frame| {
        let written = match frame {
            DecodedFrame::Main(frame) => writeln!(main, "{}{slow}", &line(intra, frame, time)[1..]),
            DecodedFrame::Gps(frame) => {
                let rest: Vec<_> = (0..frame.len()).filter(|&i| of_gps.names[i] != "time").collect();
                let cells: String = rest.iter().map(|&i| format!(",{}", of_gps.number(i, frame[i]))).collect();
                writeln!(gps, "{time}{cells}")
            }
            DecodedFrame::Slow(frame) => {
                slow = line(of_slow, frame, time);
                Ok(())
            }
            DecodedFrame::Event(event) => {
                events += usize::from([15, 30].contains(&event.kind));
                Ok(())
            }
        };
        failed = failed.take().or(written.err());
    });
    println!("{number}\t{}\t{}\t{events}", header.text("Firmware revision").unwrap_or_default(), tally.frames);
    failed.map_or(Ok(()), |error| Err(error.into()))
}

/// The numbers of a frame, a comma before each. The time is the one without overflow.
fn line(definition: &FrameDefinition, frame: &[i64], time: i64) -> String {
    let number = |i: usize| if definition.names[i] == "time" { time } else { definition.number(i, frame[i]) };
    (0..frame.len()).map(|i| format!(",{}", number(i))).collect()
}
