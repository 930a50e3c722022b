"""Prints what the MCAP and ROS 2 packages find in a canonical log, as JSON."""

import json
import sys

from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory


def plain(value):
    if hasattr(value, "__slots__"):
        return {name: plain(getattr(value, name)) for name in value.__slots__}
    if isinstance(value, (list, tuple)):
        return [plain(item) for item in value]
    if isinstance(value, float) and value != value:
        return None
    return value


with open(sys.argv[1], "rb") as file:
    reader = make_reader(file, decoder_factories=[DecoderFactory()])
    messages = [
        {"topic": channel.topic, "type": schema.name, "log_time": message.log_time, "message": plain(decoded)}
        for schema, channel, message, decoded in reader.iter_decoded_messages()
    ]
    print(
        json.dumps(
            {
                "profile": reader.get_header().profile,
                "metadata": {record.name: record.metadata for record in reader.iter_metadata()},
                "messages": messages,
            }
        )
    )
