//! What a field was predicted to be; a frame has the difference.

use super::header::Header;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Predictor {
    /// Nothing, or a number of the header.
    Constant(i64),
    Previous,
    StraightLine,
    /// Of the two frames before.
    Average,
    /// Another field of the same frame.
    Field(usize),
    /// One more than before, and what the logging rate skips; takes no room in the frame.
    Increment,
    /// A field of the last GPS home frame.
    Home(usize),
    MainTime,
}

/// What predictions are made from. Without frames before, those that need them predict 0.
#[derive(Clone, Copy)]
pub struct Past<'a> {
    pub previous: Option<&'a [i64]>,
    pub before: Option<&'a [i64]>,
    pub home: &'a [i64],
    pub main_time: i64,
    /// Iterations that were not logged by intention since the frame before.
    pub skipped: i64,
}

impl Predictor {
    /// `number` as header lines such as `Field I predictor` have it, `pair` where the field before predicts from home
    /// as well, `own` and `home` the names of the fields of this frame and of GPS home frames.
    pub fn of(number: u32, pair: bool, header: &Header, own: &[&str], home: &[&str]) -> Result<Self, String> {
        let place = |names: &[&str], name: &str| {
            let found = names.iter().position(|known| *known == name);
            found.ok_or_else(|| format!("a prediction from `{name}`, which its header does not declare"))
        };
        Ok(match number {
            0 => Predictor::Constant(0),
            1 => Predictor::Previous,
            2 => Predictor::StraightLine,
            3 => Predictor::Average,
            4 => Predictor::Constant(header.integer("minthrottle").unwrap_or(1150)),
            5 => Predictor::Field(place(own, "motor[0]")?),
            6 => Predictor::Increment,
            7 => Predictor::Home(place(home, if pair { "GPS_home[1]" } else { "GPS_home[0]" })?),
            8 => Predictor::Constant(1500),
            9 => Predictor::Constant(header.integer("vbatref").unwrap_or(4095)),
            10 => Predictor::MainTime,
            11 => Predictor::Constant(header.least_motor_output().unwrap_or(1150)),
            other => return Err(format!("the unknown predictor {other}")),
        })
    }

    /// For field `index` of a frame of which `current` is read so far.
    pub fn predict(self, index: usize, current: &[i64], past: &Past) -> i64 {
        let [previous, before] = [past.previous, past.before].map(|frame| frame.map_or(0, |frame| frame[index]));
        match self {
            Predictor::Constant(number) => number,
            Predictor::Previous => previous,
            Predictor::StraightLine => previous.wrapping_mul(2).wrapping_sub(before),
            Predictor::Average => previous.wrapping_add(before) / 2,
            Predictor::Field(other) => current[other],
            Predictor::Increment => previous.wrapping_add(past.skipped + 1),
            Predictor::Home(other) => past.home[other],
            Predictor::MainTime => past.main_time,
        }
    }
}
