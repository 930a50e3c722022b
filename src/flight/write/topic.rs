//! The canonical topics and the definitions of their messages.

/// A topic, its message, and the definitions of all types that the message uses.
pub struct CanonicalTopic {
    pub name: &'static str,
    pub message: &'static str,
    definition: &'static str,
    uses: &'static [(&'static str, &'static str)],
}

macro_rules! definition {
    ($package:literal, $name:literal) => {
        (concat!($package, "/", $name), include_str!(concat!("../ros/", $name, ".msg")))
    };
}

const TIME: (&str, &str) = definition!("builtin_interfaces", "Time");
const HEADER: (&str, &str) = definition!("std_msgs", "Header");
const VECTOR3: (&str, &str) = definition!("geometry_msgs", "Vector3");
const QUATERNION: (&str, &str) = definition!("geometry_msgs", "Quaternion");

pub const SETPOINT: CanonicalTopic = CanonicalTopic {
    name: "/setpoint",
    message: "mavros_msgs/msg/AttitudeTarget",
    definition: include_str!("../ros/AttitudeTarget.msg"),
    uses: &[HEADER, TIME, QUATERNION, VECTOR3],
};

pub const IMU: CanonicalTopic = CanonicalTopic {
    name: "/imu",
    message: "sensor_msgs/msg/Imu",
    definition: include_str!("../ros/Imu.msg"),
    uses: &[HEADER, TIME, QUATERNION, VECTOR3],
};

pub const ODOMETRY: CanonicalTopic = CanonicalTopic {
    name: "/odom",
    message: "nav_msgs/msg/Odometry",
    definition: include_str!("../ros/Odometry.msg"),
    uses: &[
        HEADER,
        TIME,
        definition!("geometry_msgs", "PoseWithCovariance"),
        definition!("geometry_msgs", "Pose"),
        definition!("geometry_msgs", "Point"),
        QUATERNION,
        definition!("geometry_msgs", "TwistWithCovariance"),
        definition!("geometry_msgs", "Twist"),
        VECTOR3,
    ],
};

pub const BATTERY: CanonicalTopic = CanonicalTopic {
    name: "/battery",
    message: "sensor_msgs/msg/BatteryState",
    definition: include_str!("../ros/BatteryState.msg"),
    uses: &[HEADER, TIME],
};

pub const ROTORS: CanonicalTopic = CanonicalTopic {
    name: "/rotors",
    message: "sensor_msgs/msg/JointState",
    definition: include_str!("../ros/JointState.msg"),
    uses: &[HEADER, TIME],
};

pub const MOTORS: CanonicalTopic = CanonicalTopic {
    name: "/motors",
    message: "actuator_msgs/msg/Actuators",
    definition: include_str!("../ros/Actuators.msg"),
    uses: &[HEADER, TIME],
};

pub const STATE: CanonicalTopic = CanonicalTopic {
    name: "/state",
    message: "mavros_msgs/msg/State",
    definition: include_str!("../ros/State.msg"),
    uses: &[HEADER, TIME],
};

pub const EXTENDED_STATE: CanonicalTopic = CanonicalTopic {
    name: "/extended_state",
    message: "mavros_msgs/msg/ExtendedState",
    definition: include_str!("../ros/ExtendedState.msg"),
    uses: &[HEADER, TIME],
};

impl CanonicalTopic {
    /// The `ros2msg` schema.
    pub fn schema(&self) -> String {
        let separator = "=".repeat(80);
        let mut schema = self.definition.to_string();
        for (name, definition) in self.uses {
            schema += &format!("{separator}\nMSG: {name}\n{definition}");
        }
        schema
    }
}
