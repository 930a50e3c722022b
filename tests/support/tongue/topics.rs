//! Messages of ROS 2 as mavros sends them, and takes them.

use super::Told;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use racer::flight::live::ros2::RosTopic;

/// CDR, little-endian, behind the place of its topic.
struct Serialized(Vec<u8>);

impl Serialized {
    fn new(topic: RosTopic, time_us: u64) -> Self {
        let mut out = Self(vec![topic as u8, 0, 1, 0, 0]);
        out.word((time_us / 1_000_000) as u32);
        out.word((time_us % 1_000_000 * 1000) as u32);
        out.text("map");
        out
    }

    fn put(&mut self, bytes: &[u8]) {
        let at = self.0.len() - 5;
        self.0.resize(5 + at.next_multiple_of(bytes.len()), 0);
        self.0.extend(bytes);
    }

    fn word(&mut self, word: u32) {
        self.put(&word.to_le_bytes());
    }

    fn text(&mut self, text: &str) {
        self.word(text.len() as u32 + 1);
        self.0.extend(text.as_bytes());
        self.0.push(0);
    }

    fn doubles(&mut self, numbers: &[f32]) {
        numbers.iter().for_each(|x| self.put(&f64::from(*x).to_le_bytes()));
    }
}

/// Battery, mode, and odometry.
pub fn messages(told: &Told) -> Vec<Vec<u8>> {
    let e = &told.estimate;
    let mut battery = Serialized::new(RosTopic::Battery, told.time_us);
    battery.put(&e.voltage.to_le_bytes());
    let mut mode = Serialized::new(RosTopic::Mode, told.time_us);
    mode.0.extend([1, 1, 0, 0]);
    mode.text(if told.switch { "OFFBOARD" } else { "POSCTL" });
    mode.0.push(4);
    let mut odometry = Serialized::new(RosTopic::Odometry, told.time_us);
    odometry.text("base_link");
    let [w, x, y, z] = e.attitude;
    odometry.doubles(&e.position);
    odometry.doubles(&[x, y, z, w]);
    odometry.doubles(&[0.0; 36]);
    let turn = UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z));
    odometry.doubles((turn.inverse() * Vector3::from(e.velocity)).as_slice());
    odometry.doubles(&e.body_rates);
    odometry.doubles(&[0.0; 36]);
    vec![battery.0, mode.0, odometry.0]
}

/// Body rates and thrust of a `mavros_msgs/AttitudeTarget` in the frame `base_link`; none of no message.
pub fn target(bytes: &[u8]) -> Option<([f32; 3], f32)> {
    let double = |at: usize| f64::from_le_bytes(std::array::from_fn(|i| bytes[at + i])) as f32;
    if bytes.is_empty() {
        return None;
    }
    assert_eq!((bytes.len(), &bytes[16..26], bytes[26]), (88, b"base_link\0".as_slice(), 128));
    let thrust = f32::from_le_bytes([bytes[84], bytes[85], bytes[86], bytes[87]]);
    Some(([double(60), double(68), double(76)], thrust))
}
