"""The learned network's numbers as one flat file, for a forward pass that needs no runtime.

The file is what the ONNX graph beside it has: weights (levels of 8 bits with a scale per output channel, or 32-bit
numbers), biases, normalisation, and the columns that make a mirror image and an arm's inputs. Little-endian, tensors
one after the other, in the order of the contract's list: widest numbers first, so that each starts where a typed array
may.
"""

import hashlib
from typing import Any

import numpy as np
import onnx
from numpy.typing import NDArray
from onnx import numpy_helper

TYPES = {np.dtype("<f4"): "float32", np.dtype("<i2"): "int16", np.dtype("i1"): "int8"}
# In the order in which the graph runs them; both have the same number of layers.
PERCEPTRONS = ("trunk", "arm")


def flat_tensors(model: onnx.ModelProto) -> dict[str, NDArray[Any]]:
    """Every number of the learned network's graph by name, widest numbers first. Raises where the graph is another
    network's.
    """
    nodes = model.graph.node
    known = {tensor.name: numpy_helper.to_array(tensor) for tensor in model.graph.initializer}
    known |= {
        node.output[0]: numpy_helper.to_array(node.attribute[0].t) for node in nodes if node.op_type == "Constant"
    }
    dequantised = {node.output[0]: node.input for node in nodes if node.op_type == "DequantizeLinear"}
    layers = [node.input for node in nodes if node.op_type == "Gemm"]
    columns = [known[node.input[1]] for node in nodes if node.op_type == "Gather"]
    if len(layers) % len(PERCEPTRONS) or len(columns) != 2:
        raise ValueError(
            f"expected two perceptrons and two choices of columns; the graph has {len(layers)} layers, {len(columns)} choices"
        )
    mirror, arm = columns
    factors = [known[name] for node in nodes if node.op_type == "Mul" for name in node.input if name in known]
    (signs,) = (factor for factor in factors if factor.shape == mirror.shape)

    tensors: dict[str, NDArray[Any]] = {"mirrorColumns": mirror, "mirrorSigns": signs, "armColumns": arm}
    tensors = {name: _narrowed(values, "i1" if name == "mirrorSigns" else "<i2") for name, values in tensors.items()}
    depth = len(layers) // len(PERCEPTRONS)
    for place, name in enumerate(PERCEPTRONS):
        tensors[f"{name}.inputMean"] = known[f"{name}_input_mean"].ravel()
        tensors[f"{name}.inputScale"] = known[f"{name}_input_scale"].ravel()
        for index, (_, weights, bias) in enumerate(layers[place * depth : (place + 1) * depth]):
            layer = f"{name}.{index}"
            tensors[f"{layer}.bias"] = known[bias]
            if weights in dequantised:
                levels, scale, zero = (known[part] for part in dequantised[weights])
                if zero.any():
                    raise ValueError(f"{weights}: expected weights without a zero point")
                tensors |= {f"{layer}.levels": levels, f"{layer}.scale": scale}
            else:
                tensors[f"{layer}.weights"] = known[weights]
    return dict(sorted(tensors.items(), key=lambda entry: -entry[1].dtype.itemsize))


def _narrowed(values: NDArray[Any], type_name: str) -> NDArray[Any]:
    """Converts values to a smaller type; raises if a value does not fit."""
    narrow = values.astype(type_name)
    np.testing.assert_array_equal(narrow, values)
    return narrow


def flat_file(model: onnx.ModelProto, file: str) -> tuple[bytes, dict[str, Any]]:
    """The file's content and what the contract says of it: each tensor's type and shape, in the order in which they
    lie.
    """
    tensors = {name: values.astype(values.dtype.newbyteorder("<")) for name, values in flat_tensors(model).items()}
    content = b"".join(values.tobytes() for values in tensors.values())
    listed = {name: " ".join([TYPES[values.dtype], *map(str, values.shape)]) for name, values in tensors.items()}
    return content, {
        "file": file,
        "bytes": len(content),
        "sha256": hashlib.sha256(content).hexdigest(),
        "tensors": listed,
    }
