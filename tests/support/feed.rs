//! Any bytes to each of racer's readers, as the fuzz targets and the test of their corpus do.

use racer::base::document::Document;
use racer::flight::blackbox::decoder::FrameDecoder;
use racer::flight::blackbox::definition::Definitions;
use racer::flight::blackbox::header::Header;
use racer::flight::blackbox::split;
use racer::flight::live::answer::Answer;
use racer::flight::live::duty::Duty;
use racer::flight::live::heard::Heard;
use racer::flight::live::mavlink::Mavlink;
use racer::flight::live::msp::Msp;
use racer::flight::live::packets::Packets;
use racer::flight::live::phase::Phase;
use racer::flight::live::protocol::Protocol;
use racer::flight::live::ros2::Ros2;
use racer::flight::live::switch::Switch;
use racer::flight::mapping::Mapping;
use racer::flight::open::{Options, open_bytes};
use racer::flight::sensors::SensorConfig;
use racer::insight::quality;
use racer::model::track::Track;
use racer::model::vehicle::Vehicle;
use racer::present::run::evaluated::Evaluated;
use racer::present::study::file::Study;
use racer::present::study::result::RunResult;
use racer::race::config::Config;
use racer::race::snapshot::Snapshot;
use std::path::Path;

/// A name for each reader: a fuzz target, and the folder of its corpus.
pub const READERS: [&str; 8] = ["mcap", "ulog", "blackbox", "csv", "policy", "settings", "results", "links"];

/// Whether the reader takes `bytes`.
///
/// # Panics
///
/// Where the reader does, or gives what cannot be.
pub fn feed(reader: &str, bytes: &[u8]) -> bool {
    match reader {
        "mcap" => racer::flight::mcap::tables(bytes, &|_| true).is_ok() | log("a.mcap", bytes),
        "ulog" => log("a.ulg", bytes),
        "blackbox" => frames(bytes) | log("a.bbl", bytes),
        "csv" => log("a.csv", bytes),
        "policy" => Snapshot::from_bytes(bytes).is_ok(),
        "settings" => std::str::from_utf8(bytes).is_ok_and(settings),
        "results" => {
            serde_json::from_slice::<Vec<Evaluated>>(bytes).is_ok()
                || serde_json::from_slice::<RunResult>(bytes).is_ok()
        }
        "links" => links(bytes),
        other => panic!("no reader {other}"),
    }
}

/// Whether a link that hears the bytes, whole and in pieces, hears a state or a reply in them. It never hears more than
/// they can hold.
fn links(bytes: &[u8]) -> bool {
    let duty = Duty { source: true, sink: true };
    let switch = Some(Switch::Channel(8));
    let mut all: [Box<dyn Protocol>; 4] = [
        Box::new(Packets::new(true, true)),
        Box::new(Mavlink::new(switch, duty)),
        Box::new(Msp::new(switch, [10.0; 3], Some(5))),
        Box::new(Ros2::new(Some(Switch::Offboard), duty)),
    ];
    let mut read = false;
    for protocol in &mut all {
        for (i, piece) in bytes.chunks(bytes.len().max(1)).chain(bytes.chunks(7)).enumerate() {
            let now_s = 0.01 * i as f64;
            let heard = protocol.hear(piece, now_s);
            assert!(heard.len() <= 600 + 2 * piece.len(), "{} of {}", heard.len(), piece.len());
            read |= heard.iter().any(|heard| !matches!(heard, Heard::Foreign | Heard::Lost(_)));
            let answer = Answer { phase: Phase::Ready, reason: None, armed: false, time_us: 0, setpoint: None };
            assert!(protocol.say(&answer, now_s).len() < 1024);
        }
    }
    read
}

/// Whether any flight in the file decodes, to no more rows than so many bytes can have.
fn frames(bytes: &[u8]) -> bool {
    let mut read = false;
    for flight in split(bytes) {
        let header = Header::of(flight);
        let Ok(definitions) = Definitions::of(&header) else { continue };
        let Ok(decoder) = FrameDecoder::new(flight, &header, &definitions) else { continue };
        let mut rows = 0;
        let tally = decoder.run(header.end, |_, _| rows += 1);
        assert!(rows <= flight.len() / 4 + 1024 && tally.end <= flight.len(), "{tally:?}");
        assert!(tally.lost_bytes <= flight.len(), "{tally:?}");
        read |= rows > 0;
    }
    read
}

/// A log is read and checked, whatever it holds.
fn log(name: &str, bytes: &[u8]) -> bool {
    let mut read = false;
    for mapping in [None, Some("canonical"), Some("px4"), Some("nanobench")] {
        let Ok(opened) = open_bytes(Path::new(name), bytes, Options { mapping, ..Options::default() }) else {
            continue;
        };
        let quality = quality::check(&opened.log);
        assert!(quality.usable.iter().all(|span| span[0] <= span[1]), "{:?}", quality.usable);
        read = true;
    }
    read
}

/// A TOML file of any kind.
fn settings(text: &str) -> bool {
    let Ok(document) = Document::parse("a.toml", text) else { return false };
    document.decode::<Track>().is_ok()
        | document.decode::<Vehicle>().is_ok()
        | document.decode::<Config>().is_ok()
        | document.decode::<Mapping>().is_ok()
        | document.decode::<SensorConfig>().is_ok()
        | document.decode::<Study>().is_ok()
}
