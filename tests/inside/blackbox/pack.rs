//! Numbers packed as the firmware packs them. Written after its encoder, not after our reader.

pub fn unsigned(out: &mut Vec<u8>, mut value: u32) {
    while value > 127 {
        out.push(value as u8 | 0x80);
        value >>= 7;
    }
    out.push(value as u8);
}

pub fn signed(out: &mut Vec<u8>, value: i32) {
    unsigned(out, ((value << 1) ^ (value >> 31)) as u32);
}

fn fits(value: i32, bits: u32) -> bool {
    (-(1i64 << (bits - 1))..1 << (bits - 1)).contains(&i64::from(value))
}

/// Bits from the highest down, filled up to a byte.
struct Bits {
    out: Vec<u8>,
    used: u32,
}

impl Bits {
    fn push(&mut self, value: i32, bits: u32) {
        for i in (0..bits).rev() {
            if self.used.is_multiple_of(8) {
                self.out.push(0);
            }
            let bit = (value >> i & 1) as u8;
            *self.out.last_mut().unwrap() |= bit << (7 - self.used % 8);
            self.used += 1;
        }
    }
}

/// Tag, then fields of `widths` bits; `gaps` unused bits before each field but the first.
fn fields(tag: i32, values: [i32; 3], widths: [u32; 3], gaps: [u32; 3]) -> Vec<u8> {
    let mut bits = Bits { out: Vec::new(), used: 0 };
    bits.push(tag, 2);
    for i in 0..3 {
        bits.push(0, gaps[i]);
        bits.push(values[i], widths[i]);
    }
    bits.out
}

fn bytes_of_three(values: [i32; 3]) -> Vec<u8> {
    let widths = values.map(|value| (1..4).find(|count| fits(value, 8 * count)).unwrap_or(4) as usize);
    let mut out = vec![(3 << 6 | (widths[2] - 1) << 4 | (widths[1] - 1) << 2 | (widths[0] - 1)) as u8];
    for (value, width) in values.iter().zip(widths) {
        out.extend(&value.to_le_bytes()[..width]);
    }
    out
}

pub fn tag2_3s32(out: &mut Vec<u8>, values: [i32; 3]) {
    let all = |bits| values.iter().all(|&value| fits(value, bits));
    out.extend(match () {
        () if all(2) => fields(0, values, [2; 3], [0; 3]),
        () if all(4) => fields(1, values, [4; 3], [2, 0, 0]),
        () if all(6) => fields(2, values, [6; 3], [0, 2, 2]),
        () => bytes_of_three(values),
    });
}

pub fn tag2_3svariable(out: &mut Vec<u8>, values: [i32; 3]) {
    let all = |bits: [u32; 3]| values.iter().zip(bits).all(|(&value, bits)| fits(value, bits));
    out.extend(match () {
        () if all([2; 3]) => fields(0, values, [2; 3], [0; 3]),
        () if all([5, 5, 4]) => fields(1, values, [5, 5, 4], [0; 3]),
        () if all([8, 7, 7]) => fields(2, values, [8, 7, 7], [0; 3]),
        () => bytes_of_three(values),
    });
}

pub fn tag8_4s16(out: &mut Vec<u8>, values: [i32; 4]) {
    let mut tag = 0;
    let mut bits = Bits { out: Vec::new(), used: 0 };
    for (i, &value) in values.iter().enumerate() {
        let width = [0, 4, 8].into_iter().find(|&bits| if bits == 0 { value == 0 } else { fits(value, bits) });
        let width = width.unwrap_or(16);
        tag |= [0, 1, 2, 2, 3][(width / 4) as usize] << (2 * i);
        bits.push(value, width);
    }
    out.push(tag);
    out.extend(bits.out);
}

/// Up to eight values; one alone has no tag.
pub fn tag8_8svb(out: &mut Vec<u8>, values: &[i32]) {
    if values.len() > 1 {
        out.push(values.iter().enumerate().map(|(i, &value)| u8::from(value != 0) << i).sum());
    }
    for &value in values {
        if value != 0 || values.len() == 1 {
            signed(out, value);
        }
    }
}
