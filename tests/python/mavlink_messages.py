"""MAVLink as pymavlink has it, against racer's: what racer sent is read, and what racer is to read is written.

    python3 tests/python/mavlink_messages.py from_racer.bin to_racer.bin

Prints, as JSON, the messages in the first file, and writes the second.
"""

import json
import os
import sys

os.environ["MAVLINK20"] = "1"
os.environ["MAVLINK_DIALECT"] = "common"
from pymavlink.dialects.v20 import common as mavlink  # noqa: E402


class Sink:
    def __init__(self):
        self.data = b""

    def write(self, data):
        self.data += data


def plain(value):
    if isinstance(value, (list, tuple)):
        return [plain(v) for v in value]
    return value.decode("ascii") if isinstance(value, bytes) else value


def received(path):
    reader, out = mavlink.MAVLink(None), []
    for message in reader.parse_buffer(open(path, "rb").read()) or []:
        fields = {name: plain(getattr(message, name)) for name in message.get_fieldnames()}
        out.append({"type": message.get_type(), "system": message.get_srcSystem(),
                    "component": message.get_srcComponent(), "sequence": message.get_seq(), "fields": fields})
    return out


def written(path):
    sink = Sink()
    link = mavlink.MAVLink(sink, srcSystem=3, srcComponent=1)
    nothing = [float("nan")] * 21
    link.heartbeat_send(mavlink.MAV_TYPE_QUADROTOR, mavlink.MAV_AUTOPILOT_PX4, 128 | 81, 6 << 16, 4)
    link.param_value_send(b"COM_OF_LOSS_T", 1.0, mavlink.MAV_PARAM_TYPE_REAL32, 1, 0)
    link.sys_status_send(0, 0, 0, 100, 23456, 100, 50, 0, 0, 0, 0, 0, 0)
    link.rc_channels_send(9, 18, *range(1001, 1019), 200)
    link.manual_control_send(3, 1, 2, 3, 4, 0b100100)
    link.local_position_ned_send(1000, 1, 2, 3, 4, 5, 6)
    link.attitude_quaternion_send(1004, 0.5, 0.5, -0.5, 0.5, 0.25, 0.5, 0.75)
    link.battery_status_send(0, 0, 3, 2000, [4001] * 6 + [65535] * 4, 100, 5, 6, 80)
    link.odometry_send(7_000_001, mavlink.MAV_FRAME_LOCAL_FRD, mavlink.MAV_FRAME_BODY_FRD, 1, 2, 3, [1, 0, 0, 0],
                       4, 5, 6, 0.25, 0.5, 0.75, nothing, nothing, 0, mavlink.MAV_ESTIMATOR_TYPE_VISION, 0)
    link.odometry_send(7_010_001, mavlink.MAV_FRAME_LOCAL_NED, mavlink.MAV_FRAME_LOCAL_NED, 1, 2, 3, [1, 0, 0, 0],
                       4, 5, 6, 0.25, 0.5, 0.75, nothing, nothing, 0, mavlink.MAV_ESTIMATOR_TYPE_AUTOPILOT, 100)
    link.odometry_send(7_020_001, mavlink.MAV_FRAME_LOCAL_NED, mavlink.MAV_FRAME_BODY_FRD, 1, 2, 3, [1, 0, 0, 0],
                       4, 5, 6, 0.25, 0.5, 0.75, nothing, nothing, 0, mavlink.MAV_ESTIMATOR_TYPE_AUTOPILOT, -1)
    open(path, "wb").write(sink.data)


if __name__ == "__main__":
    written(sys.argv[2])
    print(json.dumps(received(sys.argv[1])))
