//! The blackbox reader against an encoder that packs as the firmware does, against damage, and on real flights.

mod channels;
mod encoder;
mod pack;

use encoder::{Logger, MAIN, header};
use proptest::prelude::*;
use racer::flight::blackbox::decoder::{DecodedFrame, FrameDecoder};
use racer::flight::blackbox::definition::{Definitions, FrameDefinition};
use racer::flight::blackbox::header::Header;
use racer::flight::blackbox::{split, tally::ByteTally};
use std::fmt::Write;
use std::time::Instant;

const BETAFLIGHT: &str = "Betaflight 4.5.1 (77d01ba3b) STM32F405";

/// Everything that a flight holds, in order: a letter, the time, and numbers.
type Rows = Vec<(char, i64, Vec<i64>)>;

fn decode(bytes: &[u8]) -> Result<(Rows, ByteTally), String> {
    let header = Header::of(bytes);
    let definitions = Definitions::of(&header)?;
    let mut rows = Vec::new();
    let numbers = |definition: &FrameDefinition, frame: &[i64]| -> Vec<i64> {
        frame.iter().enumerate().map(|(i, value)| definition.number(i, *value)).collect()
    };
    let tally = FrameDecoder::new(bytes, &header, &definitions)?.run(header.end, |time, frame| {
        rows.push(match frame {
            DecodedFrame::Main(frame) => ('I', time, numbers(&definitions.intra, frame)),
            DecodedFrame::Gps(frame) => ('G', time, numbers(&definitions.gps, frame)),
            DecodedFrame::Slow(frame) => ('S', time, numbers(&definitions.slow, frame)),
            DecodedFrame::Event(event) => ('E', time, vec![event.kind.into(), event.first as i64, event.second as i64]),
        });
    });
    Ok((rows, tally))
}

/// What a test has a flight controller log next: of main frames whether it is a whole one.
#[derive(Clone, Debug)]
enum Step {
    Main(bool, Vec<i32>),
    Gps(Vec<i32>),
    Home(Vec<i32>),
    Slow(Vec<i32>),
    Event(u8, Vec<i32>),
}

/// Numbers that need few bits, and many.
fn number() -> impl Strategy<Value = i32> {
    prop_oneof![-2..2, -9..9, -40..40, -300..300, -40_000..40_000, -(1 << 28)..1 << 28]
}

fn step() -> impl Strategy<Value = Step> {
    let numbers = |count| prop::collection::vec(number(), count);
    prop_oneof![
        16 => numbers(MAIN.len()).prop_map(|row| Step::Main(false, row)),
        3 => numbers(MAIN.len()).prop_map(|row| Step::Main(true, row)),
        1 => numbers(4).prop_map(Step::Gps),
        1 => numbers(2).prop_map(Step::Home),
        1 => numbers(4).prop_map(Step::Slow),
        1 => (prop::sample::select(vec![0, 13, 15, 30]), numbers(2)).prop_map(|(kind, row)| Step::Event(kind, row)),
    ]
}

/// What the columns of a main frame can hold.
fn row(numbers: &[i32], iteration: i64, time: i64, held: i64) -> Vec<i64> {
    let fit = |i: usize, value: i64| match MAIN[i].name {
        "loopIteration" => iteration,
        "time" => time,
        "held" => held,
        "vbatLatest" => value.abs() % 9000,
        name if name.starts_with("rcCommand") || name.starts_with("debug") => value % 16_000,
        _ => value,
    };
    let signed = |i: usize, value: i64| if MAIN[i].signed { value } else { value.abs() };
    numbers.iter().enumerate().map(|(i, &value)| signed(i, fit(i, value.into()))).collect()
}

/// Logs the steps behind a whole frame; the file, what is in it, and where each frame ends.
fn log(steps: &[Step], start_us: i64) -> (Vec<u8>, Rows, Vec<usize>) {
    let mut logger = Logger::new(&header(BETAFLIGHT, "1/1"));
    let first = Step::Main(true, vec![5; MAIN.len()]);
    let (mut iteration, mut time, mut held, mut home, mut rows, mut ends) =
        (-1, start_us, 0, false, Vec::new(), Vec::new());
    for step in [&first].into_iter().chain(steps) {
        match step {
            Step::Main(whole, numbers) => {
                (iteration, time) = (iteration + 1, time + i64::from(numbers[1].rem_euclid(3000)));
                held = if *whole { numbers[23].into() } else { held };
                let row = row(numbers, iteration, time, held);
                logger.main(*whole, &row);
                let recorded = row.iter().enumerate().map(|(i, x)| if i == 1 { i64::from(*x as u32) } else { *x });
                rows.push(('I', time, recorded.collect()));
            }
            Step::Gps(numbers) => {
                let row = [time + 7, numbers[1].abs().into(), numbers[2].into(), numbers[3].into()];
                logger.gps(row);
                if home {
                    rows.push(('G', time + 7, vec![i64::from(row[0] as u32), row[1], row[2], row[3]]));
                }
            }
            Step::Home(numbers) => {
                logger.home([numbers[0].into(), numbers[1].into()]);
                home = true;
            }
            Step::Slow(numbers) => {
                let row = [0, 1, 2, 3].map(|i: usize| i64::from(numbers[i]).abs());
                logger.slow(row);
                rows.push(('S', time, row.to_vec()));
            }
            Step::Event(kind, numbers) => rows.push(event(&mut logger, *kind, numbers, time)),
        }
        ends.push(logger.bytes.len());
    }
    logger.end();
    rows.push(('E', time, vec![255, 0, 0]));
    (logger.bytes, rows, ends)
}

/// A flight of every kind of frame.
pub fn flight() -> Vec<u8> {
    let frame = |i: i32| Step::Main(i % 16 == 0, (0..MAIN.len() as i32).map(|k| (i * 37 + k * 11) % 300).collect());
    let others = [
        Step::Home(vec![480_000_000, 90_000_000]),
        Step::Gps(vec![0, 9, 480_000_500, 90_000_100]),
        Step::Slow(vec![1, 0, 1, 1]),
        Step::Event(13, vec![3, -7]),
        Step::Event(30, vec![1, 2]),
    ];
    log(&[(1..40).map(frame).collect(), others.to_vec(), (41..90).map(frame).collect()].concat(), 1_000_000).0
}

fn event(logger: &mut Logger, kind: u8, numbers: &[i32], time: i64) -> (char, i64, Vec<i64>) {
    let [first, second] = [numbers[0].unsigned_abs(), numbers[1].unsigned_abs()];
    let mut payload = Vec::new();
    let said = match kind {
        13 => {
            payload.push(first as u8 & 0x7f);
            pack::signed(&mut payload, numbers[1]);
            [(first & 0x7f).into(), numbers[1].into()]
        }
        30 => {
            pack::unsigned(&mut payload, first);
            pack::unsigned(&mut payload, second);
            [first.into(), second.into()]
        }
        _ => {
            pack::unsigned(&mut payload, first);
            [first.into(), 0]
        }
    };
    logger.event(kind, &payload);
    ('E', time, [vec![kind.into()], said.to_vec()].concat())
}

fn steps(most: usize) -> impl Strategy<Value = Vec<Step>> {
    prop::collection::vec(step(), 0..most)
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(400) })]

    /// Every predictor and encoding gives back the numbers that were logged, also where 32 bits of time overflow.
    #[test]
    fn what_was_logged_is_read(steps in steps(60), start in prop_oneof![Just(0), Just((1i64 << 32) - 20_000)]) {
        let (bytes, rows, _) = log(&steps, start);
        let (read, tally) = decode(&bytes).unwrap();
        prop_assert_eq!(&read, &rows);
        prop_assert!(tally.closed && tally.lost_bytes == 0 && tally.end == bytes.len(), "{:?}", tally);
    }

    /// A cut file gives the main frames before the cut, whether nothing follows or the padding of flash memory does.
    #[test]
    fn a_cut_leaves_what_was_before(steps in steps(30), at in any::<prop::sample::Index>(), padding in 0usize..300) {
        let (bytes, rows, ends) = log(&steps, 0);
        let cut = ends[0] + at.index(bytes.len() - ends[0]);
        let padded = [&bytes[..cut], &vec![0xff; padding]].concat();
        let (read, tally) = decode(&padded).unwrap();
        let main = |rows: Rows| rows.into_iter().filter(|row| row.0 == 'I').collect::<Rows>();
        let (rows, read) = (main(rows), main(read));
        prop_assert!(tally.end <= cut && !tally.closed && tally.frames == read.len());
        // The last frame before the cut counts only with the letter of the next, or where the cut is right behind it.
        let behind = steps.iter().zip(&ends[1..]).filter(|(step, end)| matches!(step, Step::Main(..)) && **end < cut);
        let whole = behind.count() + usize::from(ends[0] < cut);
        prop_assert_eq!(&read[..whole], &rows[..whole]);
    }

    /// Damage neither ends the reading nor touches the rows before it.
    #[test]
    fn damage_stays_where_it_is(
        steps in steps(60),
        bits in prop::collection::vec((any::<prop::sample::Index>(), 0u8..8), 1..6),
        cut in prop::option::of(any::<prop::sample::Index>()),
    ) {
        let (mut bytes, rows, ends) = log(&steps, 0);
        let start = Header::of(&bytes).end;
        let mut first = bytes.len();
        for (at, bit) in bits {
            let at = start + at.index(bytes.len() - start);
            bytes[at] ^= 1 << bit;
            first = first.min(at);
        }
        if let Some(cut) = cut {
            let cut = start + cut.index(bytes.len() - start);
            bytes.remove(cut);
            first = first.min(cut);
        }
        let began = Instant::now();
        let (read, tally) = decode(&bytes).unwrap();
        prop_assert!(began.elapsed().as_secs() < 5);
        // The frame before the damage may be taken for damaged as well: its follower is gone.
        let intact = ends.iter().filter(|&&end| end < first).count();
        let sure = rows.iter().zip(&read).take_while(|(a, b)| a == b).count();
        let rowless = steps.iter().filter(|step| matches!(step, Step::Home(_) | Step::Gps(_))).count();
        prop_assert!(sure + rowless + 1 >= intact, "{sure} of {intact}, {tally:?}");
        prop_assert!(read.len() <= bytes.len() / 4 + 1024);
    }

    /// No header and no frames make the reader panic, hang, or fill the memory.
    #[test]
    fn hostile_headers(
        lines in prop::collection::vec((0usize..24, any::<prop::sample::Index>(), any::<i32>()), 0..6),
        frames in prop::collection::vec(prop_oneof![prop::sample::select(b"IPGHS\xff".to_vec()), any::<u8>()], 0..3000),
    ) {
        let text = header(BETAFLIGHT, "1/2");
        let mut text: Vec<String> = text.lines().map(String::from).collect();
        for (line, at, number) in lines {
            let Some((name, value)) = text.get(line).and_then(|line| line.split_once(':')) else { continue };
            let mut values: Vec<String> = value.split(',').map(String::from).collect();
            let at = at.index(values.len());
            values[at] = if number % 2 == 0 { (number % 14).to_string() } else { number.to_string() };
            text[line] = format!("{name}:{}", values.join(","));
        }
        let bytes = [text.join("\n").as_bytes(), b"\n", &frames].concat();
        let began = Instant::now();
        if let Ok((rows, _)) = decode(&bytes) {
            prop_assert!(rows.len() <= bytes.len() / 4 + 1024);
        }
        prop_assert!(began.elapsed().as_secs() < 5);
    }
}

/// Between the frames of a flight that logs three of eight iterations, those that were left out are counted.
#[test]
fn iterations_that_were_left_out_are_counted() {
    for interval in ["3/8", "1/3", "2/5"] {
        let (share, of) = interval.split_once('/').unwrap();
        let [share, of]: [i64; 2] = [share, of].map(|number| number.parse().unwrap());
        let mut logger = Logger::new(&header(BETAFLIGHT, interval));
        let logged: Vec<i64> = (0..100).filter(|i| (i % 16 + share - 1) % of < share).collect();
        for &iteration in &logged {
            logger.main(iteration % 16 == 0, &row(&vec![3; MAIN.len()], iteration, 100 * iteration, 3));
        }
        logger.end();
        let (rows, _) = decode(&logger.bytes).unwrap();
        let read: Vec<i64> = rows.iter().filter(|row| row.0 == 'I').map(|row| row.2[0]).collect();
        assert_eq!(read, logged, "{interval}");
    }
}

/// After a pause the clock and the iterations jump, which only the event makes credible.
#[test]
fn a_pause_is_no_damage() {
    let frame = |iteration: i64, time| row(&vec![3; MAIN.len()], iteration, time, 3);
    let record = |said: bool| {
        let mut logger = Logger::new(&header(BETAFLIGHT, "1/1"));
        logger.main(true, &frame(0, 0));
        if said {
            let mut payload = Vec::new();
            pack::unsigned(&mut payload, 900_000);
            pack::unsigned(&mut payload, 60_000_000);
            logger.event(14, &payload);
        }
        logger.main(true, &frame(900_001, 60_000_100));
        logger.main(false, &frame(900_002, 60_000_200));
        logger.end();
        decode(&logger.bytes).unwrap().1
    };
    assert_eq!((record(true).frames, record(true).lost), (3, 0));
    assert_eq!((record(false).frames, record(false).lost), (1, 2));
}

/// Nothing in a header is refused by the name of the firmware; what cannot be read is named.
#[test]
fn headers_of_any_firmware_and_broken_ones() {
    for firmware in
        ["Betaflight 2026.6.0 (x) A", "INAV 7.1.2 (x) A", "EmuFlight 0.4.1 (x) A", "Rotorflight 4.3.0 (x) A", "?"]
    {
        let mut logger = Logger::new(&header(firmware, "1/1"));
        logger.main(true, &row(&vec![3; MAIN.len()], 0, 0, 3));
        assert_eq!(decode(&logger.bytes).unwrap().1.frames, 1, "{firmware}");
    }
    let text = header(BETAFLIGHT, "1/1");
    for (line, other, expected) in [
        ("H Field P encoding:9", "H Field P encoding:4", "encoding 4"),
        ("H Field I predictor:0", "H Field I predictor:12", "predictor 12"),
        ("H Field P predictor:6,", "H Field P predictor:", "30 numbers"),
        ("GPS_home[1]", "elsewhere", "GPS_home[1]"),
        ("H Field S predictor:0", "H Field S predictor:5", "motor[0]"),
        ("loopIteration,", "first,", "loopIteration"),
        ("H Field I name", "H Field J name", "Field I name"),
    ] {
        assert!(text.contains(line), "{line}");
        let error = decode(text.replace(line, other).as_bytes()).unwrap_err();
        assert!(error.contains(expected), "{error}");
    }
}

/// Real flights that blackbox_decode reads to the same numbers, in every field and row: main frames, those lost to
/// damage, and CRC-32 of all rows of the flight that has most.
const REAL: [(&str, usize, usize, u32); 10] = [
    ("betaflight_3.0.1_damaged.bfl", 26587, 13592, 1137204736),
    ("betaflight_4.0.0.bfl", 5, 0, 3499672245),
    ("ar8_LOG00037.bfl", 16774, 0, 2248227718),
    ("gecko_btfl_002.bbl", 66640, 0, 4213023581),
    ("roma_f5_btfl_001.bbl", 32387, 0, 3009530860),
    ("betaflight_4.3.1.bbl", 137390, 0, 837747233),
    ("betaflight_4.4.2.bbl", 24060, 0, 2671670326),
    ("betaflight_4.5.1.bfl", 35915, 0, 2148048995),
    ("atflight_4.3.4.bbl", 74898, 51, 1267933862),
    ("cleanflight_2.5.0.bbl", 8080, 0, 4178616735),
];

#[test]
fn real_flights_keep_their_numbers() {
    for (file, frames, lost, expected) in REAL {
        let Some(path) = crate::support::flight_data(&format!("betaflight/{file}")) else { continue };
        let bytes = std::fs::read(path).unwrap();
        let flights = split(&bytes).into_iter().filter_map(|flight| decode(flight).ok());
        let (rows, tally) = flights.max_by_key(|(_, tally)| tally.frames).unwrap();
        let mut hash = crc32fast::Hasher::new();
        let mut line = String::new();
        for (kind, time, values) in &rows {
            line.clear();
            write!(line, "{kind}{time}{values:?}").unwrap();
            hash.update(line.as_bytes());
        }
        assert_eq!((tally.frames, tally.lost, hash.finalize()), (frames, lost, expected), "{file}");
    }
}
