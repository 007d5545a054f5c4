"""Facts about the training of the gait network, on feet made of the inputs: it learns, the same from the same seed, and
on no evaluation-only subject.
"""

import json
from pathlib import Path

import numpy as np
import pytest

pytestmark = pytest.mark.training

MIRROR_OF_INPUTS = np.array([1, 0, 2])


def write_frames(folder: Path, people: dict[str, int]) -> None:
    """Three inputs: one of each side and one of both. A foot stands where its input is above 0, and lies aside
    and is lifted by as much.
    """
    folder.mkdir()
    for number, (person, rows) in enumerate(people.items()):
        random = np.random.default_rng(number)
        inputs = random.standard_normal((rows, 3)).astype(np.float32)
        left, right = inputs[:, 0], inputs[:, 1]
        none = np.zeros(rows, np.float32)
        feet = np.stack(
            [
                -0.1 - 0.05 * left,
                0.1 * inputs[:, 2],
                0.1 + 0.05 * right,
                0.1 * inputs[:, 2],
                left > 0,
                right > 0,
                none,
                none + 1,
                none,
                none + 1,
                0.05 * left,
                0.05 * right,
            ],
            1,
        )
        np.concatenate([inputs, inputs[:, MIRROR_OF_INPUTS], feet], 1).astype("<f4").tofile(folder / f"{person}.f32")
    (folder / "index.json").write_text(json.dumps({"people": people, "inputs": 3, "outputs": 12, "corpusHash": "made"}))


def test_it_learns_and_the_same_seed_gives_the_same_file(tmp_path: Path) -> None:
    from threepoint_training.train_gait import GaitConfig, main

    write_frames(tmp_path / "frames", {"002": 800, "003": 400, "004": 400, "901": 400})
    for name in ("one", "two"):
        main(
            GaitConfig(
                tmp_path / "frames",
                tmp_path / f"{name}.json",
                tmp_path / f"held-{name}",
                groups=2,
                steps=800,
                batch=256,
                width=16,
                dropout=0,
            )
        )
    text = (tmp_path / "one.json").read_text()
    assert text == (tmp_path / "two.json").read_text()
    network = json.loads(text)
    assert network["trainedOn"] == ["002", "003", "004"]
    assert json.loads((tmp_path / "held-one/0.json").read_text())["trainedOn"] == ["003"]

    def tensor(name: str) -> np.ndarray:
        return np.array(network["tensors"][name]["numbers"]).reshape(network["tensors"][name]["shape"])

    inputs = np.array([[1.5, -1.5, 0.5]])
    x = (inputs - tensor("gait.inputMean")) / tensor("gait.inputScale")
    for layer in range(3):
        x = x @ (tensor(f"gait.{layer}.levels") * tensor(f"gait.{layer}.scale")[:, None]).T + tensor(
            f"gait.{layer}.bias"
        )
        x = np.where(x > 0, x, np.expm1(np.minimum(x, 0))) if layer < 2 else x
    left_x, left_z, right_x, _, left_stands, right_stands = x[0, :6]
    left_lift, right_lift = x[0, 10:]
    assert left_x == pytest.approx(-0.175, abs=0.03)
    assert right_x == pytest.approx(0.025, abs=0.03)
    assert left_z == pytest.approx(0.05, abs=0.03)
    assert left_lift == pytest.approx(0.075, abs=0.03)
    assert right_lift == pytest.approx(-0.075, abs=0.03)
    assert left_stands > 1
    assert right_stands < -1
