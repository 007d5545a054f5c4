"""Facts about 8-bit weights."""

import numpy as np
import onnx
import pytest
from onnx import TensorProto, helper, numpy_helper
from threepoint_training.quantise import quantise_weights, run

RANDOM = np.random.default_rng(1)


def dense(weights, transposed):
    node = helper.make_node("Gemm", ["x", "w", "b"], ["y"], transB=int(transposed))
    inputs, outputs = (weights.shape[1], weights.shape[0]) if transposed else weights.shape
    bias = RANDOM.normal(size=outputs).astype(np.float32)
    graph = helper.make_graph(
        [node],
        "dense",
        [helper.make_tensor_value_info("x", TensorProto.FLOAT, [1, inputs])],
        [helper.make_tensor_value_info("y", TensorProto.FLOAT, [1, outputs])],
        [numpy_helper.from_array(weights, "w"), numpy_helper.from_array(bias, "b")],
    )
    return helper.make_model(graph, opset_imports=[helper.make_opsetid("", 17)], ir_version=8)


def int8_of(model):
    return {
        t.name: numpy_helper.to_array(t) for t in model.graph.initializer if t.data_type == TensorProto.INT8 and t.dims
    }


@pytest.mark.parametrize("transposed", [True, False])
def test_each_output_channel_has_its_own_scale(transposed):
    """One channel a thousand times the other keeps both exact to half a step of their own."""
    weights = RANDOM.normal(size=(2, 200)).astype(np.float32) * np.array([[1.0], [1000.0]], np.float32)
    model = dense(weights if transposed else weights.T.copy(), transposed)
    x = RANDOM.normal(size=(20, 200)).astype(np.float32)
    error = np.abs(run(quantise_weights(model), x) - run(model, x))
    bound = np.abs(weights).max(axis=1) / 127 / 2 * np.abs(x).sum(axis=1, keepdims=True)
    assert (error <= bound * 1.001).all()
    assert error.max() > 0


def test_weights_that_are_levels_already_lose_nothing():
    levels = RANDOM.integers(-127, 128, (8, 64)).astype(np.float32)
    levels[:, 0] = 127
    model = dense(levels / 256, transposed=True)
    x = RANDOM.normal(size=(5, 64)).astype(np.float32)
    np.testing.assert_allclose(run(quantise_weights(model), x), run(model, x), rtol=1e-5, atol=1e-4)


def test_the_file_shrinks_to_a_quarter_and_biases_stay_as_they_are():
    model = dense(RANDOM.normal(size=(128, 512)).astype(np.float32), transposed=True)
    quantised = quantise_weights(model)
    assert len(quantised.SerializeToString()) < 0.27 * len(model.SerializeToString())
    kept = {t.name: t for t in quantised.graph.initializer}
    np.testing.assert_array_equal(numpy_helper.to_array(kept["b"]), numpy_helper.to_array(model.graph.initializer[1]))
    assert int8_of(quantised)["w.int8"].dtype == np.int8


def test_small_matrices_are_left_alone():
    model = dense(RANDOM.normal(size=(4, 8)).astype(np.float32), transposed=True)
    assert quantise_weights(model).SerializeToString() == model.SerializeToString()


def test_a_channel_of_zeros_stays_zero():
    weights = RANDOM.normal(size=(3, 128)).astype(np.float32)
    weights[1] = 0
    quantised = quantise_weights(dense(weights, transposed=True))
    onnx.checker.check_model(quantised)
    assert not int8_of(quantised)["w.int8"][1].any()
