"""A vehicle on its pad behind ROS 2, spoken by Eclipse Cyclone DDS: what a mavros node would say and hear.

    python3 tests/python/ros2_peer.py state.json

The file has position, attitude (w, x, y, z) and voltage on the pad. The mode turns to OFFBOARD a second after the first
setpoint arrives. Prints, as JSON, how many setpoints came before and after that, and the last of each.
"""

import json
import sys
import time
from dataclasses import dataclass

from cyclonedds.core import Policy, Qos
from cyclonedds.domain import DomainParticipant
from cyclonedds.idl import IdlStruct
from cyclonedds.idl.types import array, float32, float64, int32, uint8, uint32
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from cyclonedds.util import duration


@dataclass
class Header(IdlStruct, typename="std_msgs::msg::dds_::Header_"):
    sec: int32
    nanosec: uint32
    frame_id: str


@dataclass
class Odometry(IdlStruct, typename="nav_msgs::msg::dds_::Odometry_"):
    header: Header
    child_frame_id: str
    position: array[float64, 3]
    orientation: array[float64, 4]
    pose_covariance: array[float64, 36]
    linear: array[float64, 3]
    angular: array[float64, 3]
    twist_covariance: array[float64, 36]


@dataclass
class Battery(IdlStruct, typename="sensor_msgs::msg::dds_::BatteryState_"):
    header: Header
    voltage: float32


@dataclass
class State(IdlStruct, typename="mavros_msgs::msg::dds_::State_"):
    header: Header
    connected: bool
    armed: bool
    guided: bool
    manual_input: bool
    mode: str
    system_status: uint8


@dataclass
class AttitudeTarget(IdlStruct, typename="mavros_msgs::msg::dds_::AttitudeTarget_"):
    header: Header
    type_mask: uint8
    orientation: array[float64, 4]
    body_rate: array[float64, 3]
    thrust: float32


def main():
    pad = json.load(open(sys.argv[1]))
    participant = DomainParticipant()
    # As sensors are sent.
    sensor = Qos(Policy.Reliability.BestEffort, Policy.History.KeepLast(5))
    reliable = Qos(Policy.Reliability.Reliable(duration(seconds=1)), Policy.History.KeepLast(5))
    topic = lambda name, kind: Topic(participant, "rt/mavros/" + name, kind)  # noqa: E731
    odometry = DataWriter(participant, topic("local_position/odom", Odometry), sensor)
    battery = DataWriter(participant, topic("battery", Battery), sensor)
    state = DataWriter(participant, topic("state", State), reliable)
    target = DataReader(participant, topic("setpoint_raw/attitude", AttitudeTarget), reliable)
    w, x, y, z = pad["attitude"]
    begun, first, last, counts = time.monotonic(), None, time.monotonic(), [0, 0]
    setpoints = [None, None]
    while time.monotonic() - begun < 90 and (first is None or time.monotonic() - last < 3):
        now = time.time_ns()
        header = Header(now // 10**9, now % 10**9, "map")
        flying = first is not None and time.monotonic() - first > 1
        state.write(State(header, True, True, False, False, "OFFBOARD" if flying else "POSCTL", 4))
        battery.write(Battery(header, pad["voltage"]))
        odometry.write(Odometry(header, "base_link", pad["position"], [x, y, z, w], [0.0] * 36, [0.0] * 3, [0.0] * 3,
                                [0.0] * 36))
        # What is no setpoint says that the writer has gone.
        for sample in (s for s in target.take(N=16) if isinstance(s, AttitudeTarget)):
            first, last = first or time.monotonic(), time.monotonic()
            counts[flying] += 1
            setpoints[flying] = [sample.type_mask, *sample.body_rate, sample.thrust]
        time.sleep(0.01)
    print(json.dumps({"counts": counts, "setpoints": setpoints}))


if __name__ == "__main__":
    main()
