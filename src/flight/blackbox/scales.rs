//! What the counts of a flight mean by its header: scales, and what a full stick asks for.

use super::header::Header;
use crate::base::check::BadInput;
use std::f64::consts::TAU;

/// The output that stops a motor which idles at this one: digital protocols command from 48 to 2047, others by pulses
/// of 1000 to 2000 us.
pub fn motor_stop(idle: f64) -> f64 {
    if idle < 900.0 { 48.0 } else { 1000.0 }
}

impl Header<'_> {
    fn numbers<const N: usize>(&self, key: &str) -> Option<[f64; N]> {
        let mut numbers = self.text(key)?.split(',').map(|number| number.trim().parse().ok());
        let mut read = [0.0; N];
        for value in &mut read {
            *value = numbers.next()??;
        }
        Some(read)
    }

    /// rad/s a count.
    pub fn gyro_scale_rad_s(&self, place: &str) -> Result<f64, BadInput> {
        let text = self.text("gyro_scale").or_else(|| self.text("gyro.scale"));
        let bits = text.and_then(|text| u32::from_str_radix(text.strip_prefix("0x")?, 16).ok());
        // Degrees a second, the bits of a float.
        self.positive("gyro_scale", bits.map(|bits| f64::from(f32::from_bits(bits)).to_radians()), place)
    }

    /// m/s2 a count; `None` where gravity is no count, as of a flight without an accelerometer.
    pub fn acceleration_scale_m_s2(&self, place: &str) -> Result<Option<f64>, BadInput> {
        match self.numbers::<1>("acc_1G") {
            Some([0.0]) => Ok(None),
            one_g => self.positive("acc_1G", one_g.map(|[one_g]| 9.80665 / one_g), place).map(Some),
        }
    }

    /// Outputs that stop a motor and that drive it fully. The header has the one at which it idles, above the stop.
    pub fn motor_range(&self) -> Option<[f64; 2]> {
        let throttle = || Some([self.numbers::<1>("minthrottle")?[0], self.numbers::<1>("maxthrottle")?[0]]);
        let [idle, full] = self.numbers("motorOutput").or_else(throttle)?;
        let stop = motor_stop(idle);
        (full > idle && full > stop).then_some([stop, full])
    }

    /// V a count: 0.01, or 0.1 in old Betaflight, which the limits of a cell tell; before that what the converter gave.
    pub fn voltage_scale_v(&self) -> f64 {
        let converter = self.numbers::<1>("vbatscale").map(|[scale]| 3.3 * scale / 10.0 / 4095.0);
        let tenths = self.numbers::<3>("vbatcellvoltage").is_some_and(|[.., highest]| highest < 100.0);
        converter.unwrap_or(if tenths && !self.inav() { 0.1 } else { 0.01 })
    }

    /// rad/s of the rotor a count, which is a hundred electrical revolutions a minute.
    pub fn rotor_speed_scale_rad_s(&self) -> Option<f64> {
        let [poles] = self.numbers::<1>("motor_poles").filter(|[poles]| *poles > 0.0)?;
        Some(100.0 * TAU / 60.0 / (poles / 2.0))
    }

    /// m a count. Betaflight logs decimetres, INAV metres.
    pub fn altitude_scale_m(&self) -> f64 {
        if self.inav() { 1.0 } else { 0.1 }
    }

    fn positive(&self, key: &str, value: Option<f64>, place: &str) -> Result<f64, BadInput> {
        value.filter(|value| value.is_finite() && *value > 0.0).ok_or_else(|| {
            let found = self.text(key).map_or("nothing".into(), |value| format!("`{value}`"));
            BadInput::new(format!("{place}, header `{key}`"), found, "the scale of a recorded field", "")
        })
    }

    /// Rates that full sticks ask for, roll, pitch, yaw; `None` for rate types whose formula we do not know.
    pub fn max_rates_rad_s(&self) -> Option<[f64; 3]> {
        if self.inav() {
            return None;
        }
        let [kind] = self.numbers::<1>("rates_type")?;
        let (rc, rates): ([f64; 3], [f64; 3]) = (self.numbers("rc_rates")?, self.numbers("rates")?);
        let limits = self.numbers("rate_limits").unwrap_or([1998.0; 3]);
        let mut full = [0.0; 3];
        for (axis, full) in full.iter_mut().enumerate() {
            let deg_s = match kind {
                // Betaflight: the super rate is a share, the rc rate grows faster above 2.
                0.0 if rates[axis] < 100.0 => {
                    let rc = rc[axis] / 100.0;
                    let rc = if rc > 2.0 { rc + 14.54 * (rc - 2.0) } else { rc };
                    200.0 * rc / (1.0 - rates[axis] / 100.0)
                }
                // Actual, quick: tens of degrees a second.
                3.0 => 10.0 * rates[axis].max(rc[axis]),
                4.0 => 10.0 * rates[axis],
                _ => return None,
            };
            *full = deg_s.min(limits[axis]).to_radians();
        }
        full.iter().all(|rate| rate.is_finite() && *rate > 0.0).then_some(full)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rates(kind: u8, rc: u8, rates: u8) -> Option<[f64; 3]> {
        let text = format!("H rates_type:{kind}\nH rc_rates:{rc},{rc},{rc}\nH rates:{rates},{rates},{rates}\nI");
        Some(Header::of(text.as_bytes()).max_rates_rad_s()?.map(|rate| rate.to_degrees().round()))
    }

    #[test]
    fn full_stick() {
        assert_eq!(rates(0, 100, 70), Some([667.0; 3]));
        assert_eq!(rates(3, 10, 70), Some([700.0; 3]));
        assert_eq!(rates(0, 100, 100), None, "no finite rate");
        assert_eq!(rates(2, 100, 70), None, "KISS");
    }

    #[test]
    fn scales_that_are_missing_are_named() {
        let header = Header::of(b"H acc_1G:0\nH gyro_scale:0x3f800000\nH motor_poles:14\nI");
        assert_eq!(header.gyro_scale_rad_s("f").unwrap(), 1f64.to_radians());
        assert_eq!(header.acceleration_scale_m_s2("f").unwrap(), None);
        let broken = Header::of(b"H acc_1G:-1\nI");
        assert!(broken.acceleration_scale_m_s2("f").unwrap_err().to_string().contains("acc_1G"));
        assert_eq!(header.motor_range(), None);
        assert_eq!(Header::of(b"H motorOutput:158,2047\n").motor_range(), Some([48.0, 2047.0]));
        assert_eq!(Header::of(b"H minthrottle:1070\nH maxthrottle:2000\n").motor_range(), Some([1000.0, 2000.0]));
        // 7 pairs of poles: 60 000 electrical revolutions a minute are 8571 of the rotor.
        assert!((600.0 * header.rotor_speed_scale_rad_s().unwrap() - 897.6).abs() < 0.1);
    }

    #[test]
    fn voltage_by_what_the_header_says_of_a_cell() {
        let scale = |text: &str| Header::of(text.as_bytes()).voltage_scale_v();
        assert_eq!(scale("H vbatcellvoltage:330,350,430\n"), 0.01);
        assert_eq!(scale("H vbatcellvoltage:33,35,43\n"), 0.1);
        // 1840 counts of a 12-bit converter behind a divider of 11.
        let volts = 1840.0 * scale("H vbatscale:110\nH vbatcellvoltage:33,35,43\n");
        assert!((volts - 16.31).abs() < 0.01, "{volts}");
    }
}
