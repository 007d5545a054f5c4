"""The committed golden vectors and models are those that this code makes."""

import hashlib
import json
import re

import numpy as np
import onnx
import onnxruntime
import pytest
from golden_file import assert_as_committed, committed
from threepoint_training import golden
from threepoint_training.chest_features import CHEST_FEATURES
from threepoint_training.features import FEATURES
from threepoint_training.flat_weights import flat_file
from threepoint_training.residual import OUTPUTS
from threepoint_training.splits import LOCKBOX

MODELS = golden.GOLDEN.parents[1] / "public/models"
LARGEST = {"paper": 1_700_000, "learned": 300_000}


def contract(name):
    return json.loads((MODELS / f"{name}.json").read_text())


def test_golden_features_are_what_the_features_are_now():
    assert_as_committed("features.json", golden.feature_vectors(), atol=1e-7)


def test_golden_shares_are_what_the_shares_are_now():
    shares = golden.correction_share_vectors()
    assert_as_committed("correction-share.json", shares, atol=1e-9)
    assert {0.0, 1.0} < {each["share"] for each in shares}


def test_golden_windows_are_what_the_boards_inputs_are_now():
    assert_as_committed("windows.json", golden.window_vectors(), atol=1e-6)


def test_golden_mocap_makes_the_recordings_that_it_made():
    now, before = golden.mocap_vectors(), committed("mocap.json")
    assert [case["files"] for case in before] == [case["files"] for case in now]
    names = [["11_07"], ["7_02"], ["someone_walks#1", "someone_walks#2"], ["folded_1"], ["sideways_1"]]
    assert [[clip["name"] for clip in case["clips"]] for case in before] == names
    assert_as_committed("mocap.json", now, atol=1e-5)


def test_golden_frames_start_turned_and_away_from_the_origin():
    for case in committed("features.json"):
        first = case["frames"][0]
        assert np.linalg.norm(np.array(first["positions"][0])[[0, 2]]) > 0.1
        assert abs(first["rotations"][0][1]) > 0.1


@pytest.mark.parametrize("name", ["paper", "learned"])
def test_the_runtime_gives_the_golden_outputs(name):
    case = committed("models.json")[name]
    session = onnxruntime.InferenceSession(MODELS / f"{name}.onnx")
    shape = contract(name)["inputs"][0]["shape"]
    assert len(case["cases"]) >= 10
    for pair in case["cases"]:
        given = np.array(pair["input"], np.float32).reshape(shape)
        (output,) = session.run(None, {session.get_inputs()[0].name: given})
        np.testing.assert_allclose(output[0], pair["output"], atol=case["tolerance"])


@pytest.mark.parametrize("name", ["paper", "learned"])
def test_the_contract_speaks_of_the_file_beside_it(name):
    stated = contract(name)
    content = (MODELS / stated["file"]).read_bytes()
    assert stated["name"] == name
    assert stated["bytes"] == len(content) <= LARGEST[name]
    assert stated["sha256"] == hashlib.sha256(content).hexdigest()
    assert stated["sha256"] == committed("models.json")[name]["sha256"]
    session = onnxruntime.InferenceSession(content)
    for tensors, stated_tensors in (
        (session.get_inputs(), stated["inputs"]),
        (session.get_outputs(), stated["outputs"]),
    ):
        assert [(t.name, t.shape) for t in tensors] == [(t["name"], t["shape"]) for t in stated_tensors]
    assert stated["outputs"][0]["shape"] == [1, OUTPUTS]
    if name == "learned":
        assert stated["inputs"][0]["shape"] == [1, FEATURES * len(stated["windowSeconds"]) + CHEST_FEATURES]
        assert stated["windowSeconds"][0] == 0
        assert stated["windowSeconds"] == sorted(stated["windowSeconds"])


@pytest.mark.parametrize("name", ["paper", "learned"])
def test_errors_are_claimed_for_people_held_out_of_them(name):
    """The contracts state errors on the shipping path: the learned network's on the lockbox, the paper's on others."""
    stated = contract(name)
    known, errors = set(stated["trainedOn"]["people"]), stated["errors"]
    stated_of = [re.fullmatch(rf"{name}, (?:lockbox|people held out) \((.+)\), shipping path", row) for row in errors]
    (held_out,) = [set(row[1].split(", ")) for row in stated_of if row]
    assert (held_out == set(LOCKBOX)) == (name == "learned")
    assert not held_out & known
    (seen,) = (row for row in errors if row.endswith("trained on"))
    assert seen.startswith(f"{name}, all subjects")


@pytest.mark.parametrize("name", ["paper", "learned"])
def test_weights_are_eight_bits_and_activations_are_not(name):
    model = onnx.load(MODELS / f"{name}.onnx")
    assert max(entry.version for entry in model.opset_import if entry.domain in ("", "ai.onnx")) <= 17
    large = [tensor for tensor in model.graph.initializer if np.prod(tensor.dims) >= 1024]
    assert large
    assert all(tensor.data_type == onnx.TensorProto.INT8 for tensor in large)
    assert not {"QuantizeLinear", "DynamicQuantizeLinear"} & {node.op_type for node in model.graph.node}


def test_the_flat_weights_are_those_of_the_graph_beside_them():
    stated = contract("learned")["weights"]
    content, made = flat_file(onnx.load(MODELS / "learned.onnx"), "learned.bin")
    assert (MODELS / stated["file"]).read_bytes() == content
    assert stated == made
