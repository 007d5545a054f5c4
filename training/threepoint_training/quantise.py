"""8-bit weights for ONNX graphs.

Weights are stored as int8 per output channel with a DequantizeLinear before the layer; activations stay in floating
point. Eight-bit activations make the same mean error but two to five times the jerk, because their steps show between
frames.
"""

import numpy as np
import onnx
import onnxruntime
from numpy.typing import NDArray
from onnx import numpy_helper

# Smaller matrices and kernels [numbers] stay in 32 bits: they would save nothing.
_SMALLEST = 256


def quantise_weights(model: onnx.ModelProto) -> onnx.ModelProto:
    """int8 weights, symmetric per output channel, for every layer's matrix or kernel of at least 256 numbers."""
    quantised = onnx.ModelProto()
    quantised.CopyFrom(model)
    graph = quantised.graph
    weights = {
        node.input[1]: 0 if node.op_type == "Conv" or any(a.name == "transB" and a.i for a in node.attribute) else 1
        for node in graph.node
        # Plain matrix products are geometry, exact as it is.
        if node.op_type in ("Conv", "Gemm")
    }
    dequantisers = []
    for initialiser in list(graph.initializer):
        if initialiser.name not in weights:
            continue
        values = numpy_helper.to_array(initialiser)
        if values.size < _SMALLEST:
            continue
        axis = weights[initialiser.name]
        others = tuple(a for a in range(values.ndim) if a != axis)
        scale = np.maximum(np.abs(values).max(axis=others) / 127, 1e-12).astype(np.float32)
        shape = [-1 if a == axis else 1 for a in range(values.ndim)]
        levels = np.clip(np.round(values / scale.reshape(shape)), -127, 127).astype(np.int8)
        name = initialiser.name
        graph.initializer.remove(initialiser)
        graph.initializer.extend(
            [
                numpy_helper.from_array(levels, f"{name}.int8"),
                numpy_helper.from_array(scale, f"{name}.scale"),
                numpy_helper.from_array(np.zeros(len(scale), np.int8), f"{name}.zero"),
            ]
        )
        dequantisers.append(
            onnx.helper.make_node(
                "DequantizeLinear", [f"{name}.int8", f"{name}.scale", f"{name}.zero"], [name], axis=axis
            )
        )
    for node in reversed(dequantisers):
        graph.node.insert(0, node)
    onnx.checker.check_model(quantised)
    return quantised


def run(model: onnx.ModelProto, inputs: NDArray[np.float32]) -> NDArray[np.float32]:
    """The model's outputs, one run per row."""
    session = onnxruntime.InferenceSession(model.SerializeToString())
    name = session.get_inputs()[0].name
    return np.concatenate([session.run(None, {name: row[None]})[0] for row in inputs])
