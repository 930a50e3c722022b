//! Any bytes as a blackbox file: no panic, no hang, and no more rows than so many bytes can have.
#![no_main]

use racer::flight::blackbox::decoder::Decoder;
use racer::flight::blackbox::definition::Definitions;
use racer::flight::blackbox::header::Header;
use racer::flight::blackbox::split;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    for flight in split(bytes) {
        let header = Header::of(flight);
        let Ok(definitions) = Definitions::of(&header) else { continue };
        let Ok(decoder) = Decoder::new(flight, &header, &definitions) else { continue };
        let mut rows = 0;
        let tally = decoder.run(header.end, |_, _| rows += 1);
        assert!(rows <= flight.len() / 4 + 1024 && tally.end <= flight.len(), "{tally:?}");
        assert!(tally.lost_bytes <= flight.len(), "{tally:?}");
    }
});
