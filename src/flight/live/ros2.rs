//! ROS 2, over DDS without an installation of ROS: the topics of a mavros node, or others with the same names.
//!
//! What arrives is one byte, the topic's place in [`RosTopic::ALL`], and a message as CDR with its header.

use super::answer::Answer;
use super::duty::Duty;
use super::heard::{Heard, Sight};
use super::phase::Phase;
use super::protocol::Protocol;
use super::switch::Switch;
use crate::flight::mcap::cdr_input::Input;
use crate::flight::number::Number;
use crate::flight::write::cdr::Cdr;
use crate::flight::write::message::{BODY, attitude_target};
use crate::model::attitude::{body_axes, in_world};
use crate::race::onboard::Estimate;

/// A topic below the namespace.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RosTopic {
    Odometry,
    Battery,
    Mode,
    Channels,
    Joystick,
    Target,
}

impl RosTopic {
    pub const ALL: [RosTopic; 6] = [
        RosTopic::Odometry,
        RosTopic::Battery,
        RosTopic::Mode,
        RosTopic::Channels,
        RosTopic::Joystick,
        RosTopic::Target,
    ];

    /// Its name below the namespace, and its type as DDS has it.
    #[cfg(feature = "ros2")]
    pub fn names(self) -> [&'static str; 2] {
        match self {
            RosTopic::Odometry => ["local_position/odom", "nav_msgs::msg::dds_::Odometry_"],
            RosTopic::Battery => ["battery", "sensor_msgs::msg::dds_::BatteryState_"],
            RosTopic::Mode => ["state", "mavros_msgs::msg::dds_::State_"],
            RosTopic::Channels => ["rc/in", "mavros_msgs::msg::dds_::RCIn_"],
            RosTopic::Joystick => ["joy", "sensor_msgs::msg::dds_::Joy_"],
            RosTopic::Target => ["setpoint_raw/attitude", "mavros_msgs::msg::dds_::AttitudeTarget_"],
        }
    }

    /// The topics to listen to.
    pub fn heard(switch: Option<Switch>, duty: Duty) -> Vec<RosTopic> {
        let states = [RosTopic::Odometry, RosTopic::Battery].into_iter().filter(|_| duty.source);
        states.chain(switch.map(RosTopic::of_switch)).collect()
    }

    fn of_switch(switch: Switch) -> Self {
        match switch {
            Switch::Channel(_) => RosTopic::Channels,
            Switch::Button(_) => RosTopic::Joystick,
            Switch::Offboard => RosTopic::Mode,
        }
    }
}

/// One vehicle behind its topics.
#[derive(Clone, Copy, Debug)]
pub struct Ros2 {
    switch: Option<Switch>,
    duty: Duty,
}

impl Ros2 {
    /// `switch` is what to take for the dead man's, if it is to come over this link.
    pub fn new(switch: Option<Switch>, duty: Duty) -> Self {
        Self { switch, duty }
    }

    fn message(&self, topic: RosTopic, input: &mut Serialized) -> Option<Heard> {
        let time_us = input.header()?;
        match (topic, self.switch) {
            (RosTopic::Odometry, _) => odometry(input).map(|estimate| Heard::State(Sight { time_us, estimate })),
            (RosTopic::Battery, _) => input.number(Number::F32).map(|volts| Heard::Voltage(volts as f32)),
            (RosTopic::Mode, Some(switch)) => {
                let [_, armed, _, _] = input.numbers(Number::U8)?;
                let mode = input.text()?;
                switch.of_mode(armed != 0.0 && mode == b"OFFBOARD\0")
            }
            (RosTopic::Channels, Some(switch)) => {
                input.number(Number::U8)?;
                let channels = input.list(Number::U16)?;
                switch.of_channels(&channels.iter().map(|us| *us as u16).collect::<Vec<_>>())
            }
            (RosTopic::Joystick, Some(switch)) => {
                input.list(Number::F32)?;
                let buttons = input.list(Number::I32)?;
                let bits = buttons.iter().take(16).enumerate();
                switch.of_buttons(bits.fold(0, |all, (i, button)| all | u16::from(*button != 0.0) << i))
            }
            _ => None,
        }
    }
}

impl Protocol for Ros2 {
    fn hear(&mut self, bytes: &[u8], _: f64) -> Vec<Heard> {
        let heard = bytes.split_first().and_then(|(place, message)| {
            let topic = *RosTopic::ALL.get(usize::from(*place))?;
            self.message(topic, &mut Serialized::of(message)?)
        });
        vec![heard.unwrap_or(Heard::Foreign)]
    }

    /// A setpoint; on the pad one without thrust, as PX4 wants some before it takes the mode for them.
    fn say(&mut self, answer: &Answer, now_s: f64) -> Vec<u8> {
        let row = match (answer.setpoint, answer.phase) {
            (Some(s), _) => [s.body_rates[0], s.body_rates[1], s.body_rates[2], s.throttle].map(f64::from),
            (None, Phase::Ready) => [0.0; 4],
            _ => return Vec::new(),
        };
        if !self.duty.sink {
            return Vec::new();
        }
        let mut cdr = Cdr::new((now_s * 1e9) as u64, BODY);
        attitude_target(&mut cdr, row);
        cdr.bytes().to_vec()
    }
}

/// Position, then orientation x y z w, and velocities along the body's axes, between covariances.
fn odometry(input: &mut Serialized) -> Option<Estimate> {
    input.text()?;
    let [x, y, z, qx, qy, qz, qw] = input.numbers(Number::F64)?;
    input.numbers::<36>(Number::F64)?;
    let [u, v, w, p, q, r] = input.numbers(Number::F64)?;
    let attitude = [qw, qx, qy, qz];
    let velocity = in_world(&body_axes(attitude), [u, v, w]).map(|x| x as f32);
    Some(Estimate {
        position: [x, y, z].map(|x| x as f32),
        velocity,
        attitude: attitude.map(|x| x as f32),
        body_rates: [p, q, r].map(|x| x as f32),
        voltage: f32::NAN,
    })
}

/// A message in CDR, read from its front.
struct Serialized<'a>(Input<'a>);

/// Longest list that is read: channels and buttons.
const LIST: usize = 64;

impl<'a> Serialized<'a> {
    /// Behind the four bytes that say how it is encoded.
    fn of(bytes: &'a [u8]) -> Option<Self> {
        let ([_, big, _, _], rest) = bytes.split_first_chunk()?;
        (*big <= 1).then(|| Self(Input::new(rest, *big == 0)))
    }

    /// Time, us, of a `std_msgs/Header`.
    fn header(&mut self) -> Option<u64> {
        let [seconds, nanoseconds] = self.numbers(Number::U32)?;
        self.text()?;
        Some(seconds as u64 * 1_000_000 + nanoseconds as u64 / 1000)
    }

    fn number(&mut self, number: Number) -> Option<f64> {
        self.0.number(number)
    }

    fn numbers<const N: usize>(&mut self, number: Number) -> Option<[f64; N]> {
        let mut out = [0.0; N];
        for x in &mut out {
            *x = self.number(number)?;
        }
        Some(out)
    }

    fn list(&mut self, number: Number) -> Option<Vec<f64>> {
        let length = self.0.length().filter(|length| *length <= LIST)?;
        (0..length).map(|_| self.number(number)).collect()
    }

    fn text(&mut self) -> Option<&'a [u8]> {
        let length = self.0.length()?;
        self.0.rest.take(length)
    }
}
