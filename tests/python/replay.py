"""Reads a replay with the MCAP package, holds every message against its schema, and prints what is in it, as JSON."""

import json
import sys

from jsonschema import Draft202012Validator
from mcap.reader import make_reader


def unknown(schema, value, path):
    """Fields that the schema does not describe."""
    if isinstance(value, dict):
        for name, inner in value.items():
            known = schema.get("properties", {})
            if name in known:
                yield from unknown(known[name], inner, f"{path}.{name}")
            else:
                yield f"{path}.{name} is not described"
    elif isinstance(value, list):
        for inner in value[:3]:
            yield from unknown(schema.get("items", {}), inner, f"{path}[]")


topics, invalid, gates, last = {}, set(), 0, 0
with open(sys.argv[1], "rb") as file:
    for schema, channel, message in make_reader(file).iter_messages():
        assert schema.encoding == "jsonschema" and channel.message_encoding == "json"
        assert message.log_time >= last, "messages are to be in the order of time"
        last = message.log_time
        described, content = json.loads(schema.data), json.loads(message.data)
        invalid |= {f"{channel.topic}: {error.message}" for error in Draft202012Validator(described).iter_errors(content)}
        invalid |= set(unknown(described, content, channel.topic))
        topics[channel.topic] = schema.name
        if channel.topic == "/track":
            gates = sum(entity["id"].startswith("gate") for entity in content["entities"])
print(json.dumps({"topics": topics, "invalid": sorted(invalid), "gates": gates}))
