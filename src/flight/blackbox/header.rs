//! The text header of a flight: lines `H name:value`, which declare what the frames behind them hold.

use std::collections::HashMap;

pub struct Header<'a> {
    values: HashMap<&'a str, &'a str>,
    /// Where the frames begin.
    pub end: usize,
    /// Lines that are damaged, and were left out.
    pub damaged: usize,
}

impl<'a> Header<'a> {
    /// Of a flight that starts where `bytes` do.
    pub fn of(bytes: &'a [u8]) -> Self {
        let mut header = Self { values: HashMap::new(), end: 0, damaged: 0 };
        while let Some(length) = bytes[header.end..].iter().position(|&byte| byte == b'\n') {
            let [here, next] = [header.end, header.end + length + 1];
            match pair(&bytes[here..next - 1]) {
                Some((name, value)) => _ = header.values.insert(name, value),
                // Frames would hardly be followed by a line of the header.
                None if first_pair(&bytes[next..]).is_some() => header.damaged += 1,
                None => break,
            }
            header.end = next;
        }
        header
    }

    pub fn text(&self, name: &str) -> Option<&'a str> {
        self.values.get(name).copied()
    }

    /// What commas separate; nothing where there is no such line.
    pub fn list(&self, name: &str) -> Vec<&'a str> {
        self.text(name).filter(|text| !text.is_empty()).map(|text| text.split(',').collect()).unwrap_or_default()
    }

    /// The first number of a line.
    pub fn integer(&self, name: &str) -> Option<i64> {
        self.list(name).first()?.trim().parse::<i32>().ok().map(i64::from)
    }

    /// Such as `Betaflight`; empty where it is not said.
    pub fn firmware(&self) -> &'a str {
        let revision = self.text("Firmware revision").unwrap_or_default();
        revision.split(' ').next().unwrap_or_default()
    }

    /// Main and minor version of a Betaflight, `[2025, 12]` since it counts years.
    pub fn betaflight(&self) -> Option<[u32; 2]> {
        let version = self.text("Firmware revision")?.strip_prefix("Betaflight ")?.split([' ', '-']).next()?;
        let mut numbers = version.split('.').map(|number| number.parse().ok());
        Some([numbers.next()??, numbers.next()??])
    }

    pub fn inav(&self) -> bool {
        self.firmware() == "INAV"
    }

    /// What stops a motor.
    pub fn least_motor_output(&self) -> Option<i64> {
        self.integer("motorOutput").or_else(|| self.integer("minthrottle"))
    }
}

fn first_pair(bytes: &[u8]) -> Option<(&str, &str)> {
    pair(bytes.split(|&byte| byte == b'\n').next()?)
}

/// Name and value of a line without its end.
fn pair(line: &[u8]) -> Option<(&str, &str)> {
    /// No firmware comes near.
    const MOST_BYTES: usize = 4096;
    let text = std::str::from_utf8(line.get(..line.len().min(MOST_BYTES + 1))?.strip_prefix(b"H ")?).ok()?;
    let text = text.strip_suffix('\r').unwrap_or(text);
    if line.len() > MOST_BYTES || text.chars().any(char::is_control) { None } else { text.split_once(':') }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_lists_and_where_frames_begin() {
        let bytes =
            b"H Product:Blackbox\nH a:1,-2,x\nH Firmware revision:INAV 7.1.2 (abc) X\n? b:3\nH b:4\nI\n\nH c:5\n";
        let header = Header::of(bytes);
        assert_eq!((header.list("a"), header.integer("a"), header.list("c").len()), (vec!["1", "-2", "x"], Some(1), 0));
        assert_eq!(
            (header.inav(), header.integer("b"), header.damaged, &bytes[header.end..][..1]),
            (true, Some(4), 1, &b"I"[..])
        );
        assert_eq!(Header::of(b"").end, 0);
    }
}
