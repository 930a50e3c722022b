"""Writes a canonical log with the MCAP and ROS 2 packages: write.py SCHEMAS.json OUT.mcap."""

import json
import sys

from mcap_ros2.writer import Writer

with open(sys.argv[1]) as file:
    schemas = json.load(file)


def header(ns):
    return {"stamp": {"sec": ns // 10**9, "nanosec": ns % 10**9}, "frame_id": "base_link"}


def vector(x, y, z):
    return {"x": x, "y": y, "z": z}


def message(topic, i):
    ns = 1_700_000_000 * 10**9 + i * 10_000_000
    level = {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0}
    body = {
        "/setpoint": lambda: {
            "type_mask": 128,
            "orientation": level,
            "body_rate": vector(0.5 * i, -1.0, 2.0),
            "thrust": 0.25,
        },
        "/imu": lambda: {
            "orientation": level,
            "orientation_covariance": [-1.0] + [0.0] * 8,
            "angular_velocity": vector(0.1 * i, 0.2, 0.3),
            "angular_velocity_covariance": [0.0] * 9,
            "linear_acceleration": vector(0.0, -0.5, 9.75),
            "linear_acceleration_covariance": [0.0] * 9,
        },
        "/odom": lambda: {
            "child_frame_id": "base_link",
            "pose": {"pose": {"position": vector(i, 1.5, 2.5), "orientation": level}, "covariance": [0.0] * 36},
            "twist": {"twist": {"linear": vector(3.0, i, -1.0), "angular": vector(0, 0, 0)}, "covariance": [0.0] * 36},
        },
        "/battery": lambda: {
            "voltage": 16.5,
            "temperature": float("nan"),
            "current": float("nan"),
            "charge": float("nan"),
            "capacity": float("nan"),
            "design_capacity": float("nan"),
            "percentage": float("nan"),
            "power_supply_status": 2,
            "power_supply_health": 0,
            "power_supply_technology": 3,
            "present": True,
            "cell_voltage": [4.125] * (i % 3),
            "cell_temperature": [],
            "location": "bay",
            "serial_number": "",
        },
        "/rotors": lambda: {
            "name": ["a", "b", "c", "d"],
            "position": [],
            "velocity": [100.0, 200.0, 300.0, 400.0 + i],
            "effort": [],
        },
        "/motors": lambda: {"position": [], "velocity": [], "normalized": [0.1 * i, 0.1 * i]},
        "/state": lambda: {
            "connected": True,
            "armed": True,
            "guided": False,
            "manual_input": False,
            "mode": "OFFBOARD",
            "system_status": 4,
        },
        "/extended_state": lambda: {"vtol_state": 0, "landed_state": 2},
    }[topic]()
    return ns, {"header": header(ns), **body}


with open(sys.argv[2], "wb") as out:
    writer = Writer(out)
    writer.add_metadata(
        "racer.vehicle",
        {"mass_kg": "0.75", "max_rate_rad_s": "[11.5, 11.5, 7.0]", "thrust_map": "0..1 -> -1..1"},
    )
    known = {topic: writer.register_msgdef(of["type"], of["definition"]) for topic, of in schemas.items()}
    for i in range(10):
        for topic, schema in known.items():
            ns, content = message(topic, i)
            writer.write_message(topic, schema, content, log_time=ns)
    writer.finish()
