//! A flight controller's logger: rows of numbers become a blackbox file.

use super::pack;

/// Predictors and encodings by the numbers that headers have.
#[derive(Clone, Copy)]
pub struct Column {
    pub name: &'static str,
    pub signed: bool,
    pub whole: (u32, u32),
    pub difference: (u32, u32),
}

/// Every predictor and encoding there is. Numbers of the header: minthrottle 1070, vbatref 1653, motorOutput 158.
pub const MAIN: [Column; 30] = [
    column("loopIteration", false, (0, 1), (6, 9)),
    column("time", false, (0, 1), (2, 0)),
    column("axisP[0]", true, (0, 0), (1, 0)),
    column("axisI[0]", true, (0, 0), (1, 7)),
    column("axisI[1]", true, (0, 0), (1, 7)),
    column("axisI[2]", true, (0, 0), (1, 7)),
    column("axisD[0]", true, (0, 7), (1, 10)),
    column("axisD[1]", true, (0, 7), (1, 10)),
    column("axisD[2]", true, (0, 7), (1, 10)),
    column("rcCommand[0]", true, (0, 0), (1, 8)),
    column("rcCommand[1]", true, (0, 0), (1, 8)),
    column("rcCommand[2]", true, (0, 0), (1, 8)),
    column("rcCommand[3]", false, (4, 1), (1, 8)),
    column("vbatLatest", false, (9, 3), (1, 6)),
    column("amperageLatest", true, (0, 0), (1, 6)),
    column("rssi", false, (0, 1), (1, 6)),
    column("gyroADC[0]", true, (0, 0), (3, 0)),
    column("gyroADC[1]", true, (0, 10), (3, 0)),
    column("gyroADC[2]", true, (0, 10), (3, 0)),
    column("accSmooth[0]", true, (0, 10), (3, 0)),
    column("motor[0]", false, (11, 1), (3, 0)),
    column("motor[1]", false, (5, 0), (3, 0)),
    column("servo[5]", false, (8, 6), (1, 6)),
    column("held", true, (0, 0), (1, 9)),
    column("eRPM[0]", false, (0, 1), (1, 0)),
    column("debug[0]", true, (0, 8), (2, 6)),
    column("debug[1]", true, (0, 8), (2, 6)),
    column("debug[2]", true, (0, 8), (2, 6)),
    column("debug[3]", true, (0, 8), (2, 6)),
    column("surfaceRaw", true, (0, 0), (3, 1)),
];

const fn column(name: &'static str, signed: bool, whole: (u32, u32), difference: (u32, u32)) -> Column {
    Column { name, signed, whole, difference }
}

pub const GPS: [Column; 4] = [
    column("time", false, (10, 1), (0, 0)),
    column("GPS_numSat", false, (0, 1), (0, 0)),
    column("GPS_coord[0]", true, (7, 0), (0, 0)),
    column("GPS_coord[1]", true, (7, 0), (0, 0)),
];
pub const HOME: [Column; 2] =
    [column("GPS_home[0]", true, (0, 0), (0, 0)), column("GPS_home[1]", true, (0, 0), (0, 0))];
pub const SLOW: [Column; 4] = [
    column("flightModeFlags", false, (0, 1), (0, 0)),
    column("failsafePhase", false, (0, 7), (0, 0)),
    column("rxSignalReceived", false, (0, 7), (0, 0)),
    column("rxFlightChannelsValid", false, (0, 7), (0, 0)),
];

/// The text before the frames.
pub fn header(firmware: &str, interval: &str) -> String {
    let join = |columns: &[Column], part: fn(&Column) -> String| columns.iter().map(part).collect::<Vec<_>>().join(",");
    let mut text = "H Product:Blackbox flight data recorder by Nicholas Sherlock\nH Data version:2\n".to_string();
    for (kind, columns) in [('I', &MAIN[..]), ('G', &GPS), ('H', &HOME), ('S', &SLOW)] {
        text += &format!("H Field {kind} name:{}\n", join(columns, |c| c.name.into()));
        text += &format!("H Field {kind} signed:{}\n", join(columns, |c| u8::from(c.signed).to_string()));
        text += &format!("H Field {kind} predictor:{}\n", join(columns, |c| c.whole.0.to_string()));
        text += &format!("H Field {kind} encoding:{}\n", join(columns, |c| c.whole.1.to_string()));
    }
    text += &format!("H Field P predictor:{}\n", join(&MAIN, |c| c.difference.0.to_string()));
    text += &format!("H Field P encoding:{}\n", join(&MAIN, |c| c.difference.1.to_string()));
    text + &format!(
        "H Firmware revision:{firmware}\nH I interval:16\nH P interval:{interval}\nH minthrottle:1070\nH vbatref:1653\n\
         H motorOutput:158,2047\nH motor_poles:14\nH acc_1G:2048\nH gyro_scale:0x3f800000\n"
    )
}

/// What was logged before.
#[derive(Default)]
pub struct Logger {
    pub bytes: Vec<u8>,
    /// The last frame and the one before it.
    last: Option<[Vec<i64>; 2]>,
    home: [i64; 2],
}

impl Logger {
    pub fn new(header: &str) -> Self {
        Self { bytes: header.as_bytes().to_vec(), ..Self::default() }
    }

    /// A whole frame, or the difference to those before.
    pub fn main(&mut self, whole: bool, row: &[i64]) {
        self.bytes.push(if whole { b'I' } else { b'P' });
        let codes = |column: &Column| if whole { column.whole } else { column.difference };
        let residuals: Vec<i32> =
            (0..row.len()).map(|i| row[i].wrapping_sub(self.prediction(codes(&MAIN[i]).0, i, row)) as i32).collect();
        let encodings: Vec<u32> = MAIN.iter().map(|column| codes(column).1).collect();
        pack_all(&mut self.bytes, &encodings, &residuals);
        self.last = Some(match self.last.take() {
            Some([last, _]) if !whole => [row.to_vec(), last],
            _ => [row.to_vec(), row.to_vec()],
        });
    }

    fn prediction(&self, predictor: u32, i: usize, row: &[i64]) -> i64 {
        let [last, before] = self.last.as_ref().map_or([0, 0], |frames| [frames[0][i], frames[1][i]]);
        match predictor {
            0 => 0,
            1 => last,
            2 => 2 * last - before,
            3 => (last + before) / 2,
            4 => 1070,
            5 => row[20],
            // Not written at all.
            6 => row[i],
            8 => 1500,
            9 => 1653,
            11 => 158,
            other => panic!("{other}"),
        }
    }

    pub fn home(&mut self, home: [i64; 2]) {
        self.bytes.push(b'H');
        home.iter().for_each(|&value| pack::signed(&mut self.bytes, value as i32));
        self.home = home;
    }

    pub fn gps(&mut self, row: [i64; 4]) {
        let time = self.last.as_ref().map_or(0, |frames| frames[0][1]);
        self.bytes.push(b'G');
        pack::unsigned(&mut self.bytes, (row[0] - time) as u32);
        pack::unsigned(&mut self.bytes, row[1] as u32);
        (0..2).for_each(|i| pack::signed(&mut self.bytes, (row[2 + i] - self.home[i]) as i32));
    }

    pub fn slow(&mut self, row: [i64; 4]) {
        self.bytes.push(b'S');
        pack::unsigned(&mut self.bytes, row[0] as u32);
        pack::tag2_3s32(&mut self.bytes, [row[1], row[2], row[3]].map(|value| value as i32));
    }

    pub fn event(&mut self, kind: u8, payload: &[u8]) {
        self.bytes.extend([b'E', kind]);
        self.bytes.extend(payload);
    }

    pub fn end(&mut self) {
        self.event(255, b"End of log\0");
    }
}

/// Packs values that follow each other, in groups where their encoding has groups.
fn pack_all(out: &mut Vec<u8>, encodings: &[u32], values: &[i32]) {
    let mut i = 0;
    while i < values.len() {
        let rest = &values[i..];
        i += match encodings[i] {
            7 => (pack::tag2_3s32(out, [rest[0], rest[1], rest[2]]), 3).1,
            10 => (pack::tag2_3svariable(out, [rest[0], rest[1], rest[2]]), 3).1,
            8 => (pack::tag8_4s16(out, [rest[0], rest[1], rest[2], rest[3]]), 4).1,
            6 => {
                let count = encodings[i..].iter().take(8).take_while(|&&encoding| encoding == 6).count();
                (pack::tag8_8svb(out, &rest[..count]), count).1
            }
            0 => (pack::signed(out, rest[0]), 1).1,
            1 => (pack::unsigned(out, rest[0] as u32), 1).1,
            3 => (pack::unsigned(out, rest[0].wrapping_neg() as u32 & 0x3fff), 1).1,
            9 => 1,
            other => panic!("{other}"),
        };
    }
}
