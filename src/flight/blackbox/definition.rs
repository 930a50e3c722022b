//! The frames that a header declares: fields in order, and how each is predicted and packed.

use super::bytes::FrameBytes;
use super::encoding::Encoding;
use super::header::Header;
use super::predictor::{Past, Predictor};

/// A frame of more fields, or more bytes, is none of a flight controller.
const MOST_FIELDS: usize = 256;
const MOST_BYTES: usize = 256;

/// A kind of frame. Its fields are empty where the header does not declare it.
#[derive(Default)]
pub struct FrameDefinition {
    pub names: Vec<String>,
    pub signed: Vec<bool>,
    predictors: Vec<Predictor>,
    encodings: Vec<Encoding>,
}

/// Kinds of frames by their letters: whole main frames, differences to those before, GPS, GPS home, slow.
pub struct Definitions {
    pub intra: FrameDefinition,
    pub inter: FrameDefinition,
    pub gps: FrameDefinition,
    pub home: FrameDefinition,
    pub slow: FrameDefinition,
}

impl Definitions {
    /// Fails where the header lacks what is needed to read any frame.
    pub fn of(header: &Header) -> Result<Self, String> {
        let main = header.list("Field I name");
        let home = header.list("Field H name");
        let read = |kind: char, names: &[&str]| FrameDefinition::of(header, kind, names, &home);
        if main.is_empty() {
            return Err("no header line `Field I name`".into());
        }
        let optional = |kind: char| read(kind, &header.list(&format!("Field {kind} name")));
        Ok(Self {
            intra: read('I', &main)?,
            inter: read('P', &main)?,
            gps: optional('G')?,
            home: optional('H')?,
            slow: optional('S')?,
        })
    }
}

impl FrameDefinition {
    fn of(header: &Header, kind: char, names: &[&str], home: &[&str]) -> Result<Self, String> {
        if names.len() > MOST_FIELDS {
            return Err(format!("{} fields in a frame, where {MOST_FIELDS} are the most", names.len()));
        }
        let numbers = |what: &str| {
            let key = format!("Field {kind} {what}");
            let numbers: Option<Vec<u32>> = header.list(&key).iter().map(|number| number.parse().ok()).collect();
            match numbers {
                Some(numbers) if numbers.len() == names.len() => Ok(numbers),
                _ => Err(format!("a header line `{key}` that does not have {} numbers", names.len())),
            }
        };
        let codes = numbers("predictor")?;
        let pair = |i: usize| i > 0 && codes[i - 1] == 7;
        let predictors = (0..codes.len()).map(|i| Predictor::of(codes[i], pair(i), header, names, home));
        let encoding = |number: u32| Encoding::of(number).ok_or_else(|| format!("the unknown encoding {number}"));
        // Differences have the signs of the whole frames; old firmware leaves signs out.
        let signs = if kind == 'P' { 'I' } else { kind };
        let mut signed: Vec<bool> = header.list(&format!("Field {signs} signed")).iter().map(|s| *s != "0").collect();
        signed.resize(names.len(), false);
        Ok(Self {
            names: names.iter().map(ToString::to_string).collect(),
            signed,
            predictors: predictors.collect::<Result<_, _>>()?,
            encodings: numbers("encoding")?.into_iter().map(encoding).collect::<Result<_, _>>()?,
        })
    }

    /// Reads a frame into `current`; `None` where the bytes end first or are too many for a frame.
    pub fn read(&self, bytes: &mut FrameBytes, current: &mut [i64], past: &Past) -> Option<()> {
        let (start, count) = (bytes.at, self.names.len());
        let mut values = [0; 8];
        let mut i = 0;
        while i < count {
            if self.predictors[i] == Predictor::Increment {
                current[i] = self.predictors[i].predict(i, current, past);
                i += 1;
                continue;
            }
            let encoding = self.encodings[i];
            let alike = self.encodings[i..].iter().take(8).take_while(|other| **other == encoding).count();
            let read = encoding.read(bytes, alike, &mut values)?;
            if bytes.at - start >= MOST_BYTES {
                return None;
            }
            for &value in values.iter().take(read.min(count - i)) {
                let sum = value.wrapping_add(self.predictors[i].predict(i, current, past));
                current[i] = if encoding.groups() { sum } else { self.number(i, sum) };
                i += 1;
            }
        }
        Some(())
    }

    /// What of a value fits its field of 32 bits.
    pub fn number(&self, index: usize, value: i64) -> i64 {
        if self.signed[index] { i64::from(value as i32) } else { i64::from(value as u32) }
    }
}
