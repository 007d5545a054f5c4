"""The networks of the board: their outputs, trainings that are kept and go on, and input that is refused."""

import json
from dataclasses import replace

import numpy as np
import pytest

pytestmark = pytest.mark.training

HELD_OUT = ("005",)
VALIDATION = ("006",)


@pytest.fixture(scope="module", autouse=True)
def one_thread():
    """Limits torch to one thread, as the pipeline does."""
    import torch

    before = torch.get_num_threads()
    torch.set_num_threads(1)
    yield
    torch.set_num_threads(before)


@pytest.fixture(scope="module")
def corpus():
    from threepoint_training.generated_motion import generate_corpus

    return generate_corpus(people=6, clips=2, frames=200, seed=3)


@pytest.fixture
def board(monkeypatch, tmp_path):
    """A short run of one network, on the generated people."""
    from threepoint_training import splits, train_board

    monkeypatch.setitem(splits.FOLDS, "board", HELD_OUT)
    short = {"steps": 6, "batch": 4, "watch_every": 2, "watched_windows": 16}
    return replace(train_board.BoardConfig(), out=tmp_path, networks=("memory",), validation=VALIDATION, **short)


def run(corpus, config):
    from threepoint_training import train_board

    printed = []
    return train_board.main(corpus, config, printed.append), printed


def figures(folder):
    return json.loads((folder / "memory.json").read_text())["figures"]


def weights(folder):
    import onnx

    graph = onnx.load(folder / "memory.onnx").graph
    return np.concatenate([onnx.numpy_helper.to_array(each).astype(float).ravel() for each in graph.initializer])


@pytest.mark.parametrize("name", ["transformer", "memory"])
def test_a_network_puts_joints_on_the_bones_of_the_calibrated_body(name):
    import torch
    from threepoint_training.board_networks import NETWORKS
    from threepoint_training.skeleton import body_from_calibration
    from threepoint_training.window_features import INPUTS, window_features

    random = np.random.default_rng(4)
    body = body_from_calibration(np.array([1.6, 1.2]), np.array([1.5, 1.3]))
    rotations = random.normal(size=(2, 41, 3, 4))
    rotations /= np.linalg.norm(rotations, axis=-1, keepdims=True)
    inputs = window_features(random.normal(size=(2, 41, 3, 3)), rotations, body)
    assert inputs.shape == (2, INPUTS)
    torch.manual_seed(1)
    network = NETWORKS[name]().eval()
    with torch.no_grad():
        joints = network.joints(torch.from_numpy(inputs)).numpy() * body.eye_height[:, None]
        assert network(torch.from_numpy(inputs)).shape == (2, 18)
    elbows, shoulders, wrists = joints[:, :2], joints[:, 2:4], joints[:, 6:8]
    np.testing.assert_allclose(np.linalg.norm(elbows - shoulders, axis=-1), body.upper_arm, rtol=1e-4)
    np.testing.assert_allclose(np.linalg.norm(wrists - elbows, axis=-1), body.forearm, rtol=1e-4)


def test_the_transformer_is_as_large_as_published_and_skips_what_no_output_needs():
    import torch
    from threepoint_training import train_board

    sizes = train_board.sizes()
    assert sizes["transformer"]["parameters"] == pytest.approx(4.12e6, rel=0.005)
    counted = torch.nn.Sequential(torch.nn.Linear(30, 20), torch.nn.Linear(20, 10))
    assert train_board.multiply_adds(counted, torch.ones(1, 30)) == 30 * 20 + 20 * 10


def test_windows_are_of_the_bodies_that_our_network_is_trained_on(corpus):
    from threepoint_training.augment import AugmentConfig, draw_batch, draw_windows
    from threepoint_training.body_parts import BodyParts
    from threepoint_training.residual import residual
    from threepoint_training.features import frame_features

    parts = BodyParts(corpus, tuple(corpus.people))
    config = AugmentConfig(window_frames=(0,), lost_hand=0.0)
    batch, windows = (draw(parts, 32, config, np.random.default_rng(9)) for draw in (draw_batch, draw_windows))
    positions, rotations = windows.positions[:, -1], windows.rotations[:, -1]
    vector, _ = frame_features(positions, rotations, windows.body)
    targets = residual(windows.truth, positions, rotations, windows.body, vector)
    np.testing.assert_allclose(targets, batch.targets, atol=1e-6)


def test_an_ended_training_goes_on_to_the_weights_of_one_that_ran_through(corpus, board, tmp_path):
    through, _ = run(corpus, replace(board, out=tmp_path / "through"))
    half, _ = run(corpus, replace(board, steps=4))
    assert figures(half)["steps"] == 4
    whole, printed = run(corpus, board)
    assert any("goes on from step 4" in line for line in printed)
    assert figures(whole)["curve"] == figures(through)["curve"]
    np.testing.assert_array_equal(weights(whole), weights(through))


def test_a_finished_training_is_not_run_again_and_states_its_budget(corpus, board):
    folder, _ = run(corpus, board)
    written = (folder / "memory.onnx").stat().st_mtime_ns
    _, printed = run(corpus, board)
    assert printed == ["memory: finished before"]
    assert (folder / "memory.onnx").stat().st_mtime_ns == written
    found = figures(folder)
    assert (found["steps"], found["windows"]) == (6, 24)
    assert found["validationCm"] == min(cm for _, cm in found["curve"])


def test_a_training_ends_when_its_error_stops_falling(corpus, board):
    folder, _ = run(corpus, replace(board, steps=400, patience=1, learning_rate=0.0, watch_every=2))
    found = figures(folder)
    assert found["stoppedFalling"]
    assert found["steps"] < 400


def test_motion_without_people_of_the_board_is_refused_in_a_sentence(corpus, board):
    from threepoint_training.motion_files import MocapError

    with pytest.raises(MocapError, match="the board needs people that are missing in this motion: 044, 045"):
        run(corpus, replace(board, validation=("006", "044", "045")))


def test_a_damaged_checkpoint_is_refused_and_finished_trainings_stay(corpus, board):
    from threepoint_training.motion_files import MocapError

    folder, _ = run(corpus, board)
    checkpoint = folder / "memory.checkpoint"
    checkpoint.write_bytes(checkpoint.read_bytes()[:1000])
    with pytest.raises(MocapError, match="Remove it, and this network is trained again"):
        run(corpus, replace(board, steps=8))
    assert figures(folder)["steps"] == 6
