"""Runs an exported ONNX model over the self-test of the JSON export, and prints how far it is off, as JSON.

    python3 tests/python/onnx_policy.py policy.onnx policy.json
"""

import json
import sys

import numpy as np
import onnx
import onnxruntime

model = onnx.load(sys.argv[1])
onnx.checker.check_model(model, full_check=True)
with open(sys.argv[2], encoding="utf-8") as file:
    document = json.load(file)
properties = {p.key: p.value for p in model.metadata_props}


def table(name):
    tensor = document["tensors"][f"self_test.{name}"]
    return np.array(tensor["values"], np.float32).reshape(tensor["shape"])


session = onnxruntime.InferenceSession(sys.argv[1], providers=["CPUExecutionProvider"])
found, = session.run(None, {"observation": table("observation")})
one, = session.run(None, {"observation": table("observation")[:1]})
print(json.dumps({
    "off": float(np.abs(found - table("action")).max()),
    "one": float(np.abs(one - found[:1]).max()),
    "same": json.loads(properties["flying"]) == document["flying"] and properties["sha256"] == document["sha256"],
    "size": len(model.SerializeToString()),
}))
