"""
The gait network: where feet are expected, and which stand, from a second of hips, head and hands. `npm run tool -- train:gait`
calls this.

The page makes the inputs (bench/evaluate/legs/gait-frames.ts): a row has those of a frame, those of the mirrored
person and the true feet.
"""

import argparse
import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray
from torch import nn

from .model import MOST_DEVIATIONS
from .shared_constants import CORE
from .splits import trainable

Array = NDArray[np.float32]

# Left and right foot's place (x, z), which stand, sine and cosine of their yaw, and their lift; of the mirrored person
# each is at:
_MIRROR = [2, 3, 0, 1, 5, 4, 8, 9, 6, 7, 11, 10]
_MIRROR_SIGN = np.array([-1, 1, -1, 1, 1, 1, -1, 1, -1, 1, 1, 1], np.float32)
_STANDING = slice(4, 6)
_OTHERS = [0, 1, 2, 3, 6, 7, 8, 9, 10, 11]


@dataclass(frozen=True)
class GaitConfig:
    """frames: the folder that gait-frames wrote. out: the page's network. held_out: the folder for networks trained
    without each group of people.
    """

    frames: Path
    out: Path = CORE / "estimation/gait/gait-network.json"
    held_out: Path | None = None
    groups: int = 4
    steps: int = 2000
    batch: int = 1024
    width: int = 64
    dropout: float = 0.2
    noise: float = 0.02
    standing_weight: float = 0.5
    seed: int = 2460


@dataclass(frozen=True)
class _Data:
    """Inputs [R, …] and targets [R, 12] of people and of their mirror images; drawn [R]: the cumulative probability of
    drawing rows, its last 1.
    """

    inputs: Array
    targets: Array
    drawn: NDArray[np.float64]


def _load(config: GaitConfig, index: dict[str, Any], people: tuple[str, ...]) -> _Data:
    inputs, targets, weights = [], [], []
    for person in people:
        rows = np.fromfile(config.frames / f"{person}.f32", "<f4").reshape(-1, 2 * index["inputs"] + index["outputs"])
        plain, mirrored, feet = np.split(rows, [index["inputs"], 2 * index["inputs"]], axis=1)
        inputs += [plain, mirrored]
        targets += [feet, feet[:, _MIRROR] * _MIRROR_SIGN]
        # A person's weight grows with the root of their frames: between each frame, and each person, weighing the same.
        weights.append(np.full(2 * len(rows), len(rows) ** -0.5))
    sums = np.cumsum(np.concatenate(weights))
    return _Data(np.concatenate(inputs), np.concatenate(targets), sums / sums[-1])


@dataclass(frozen=True)
class GaitWeights:
    """Normalisation of the inputs, and each layer's weights [rows, inputs] and bias; outputs in the units of the
    targets.
    """

    mean: Array
    scale: Array
    layers: tuple[tuple[Array, Array], ...]


def train(config: GaitConfig, data: _Data) -> GaitWeights:
    """Fits one network; the same seed gives the same weights on any number of cores."""
    torch.manual_seed(config.seed)
    torch.set_num_threads(1)
    random = np.random.default_rng(config.seed)
    mean, scale = data.inputs.mean(0), data.inputs.std(0) + 1e-4
    centre, spread = data.targets.mean(0), data.targets.std(0) + 1e-4
    centre[_STANDING], spread[_STANDING] = 0, 1
    sizes = [data.inputs.shape[1], config.width, config.width, data.targets.shape[1]]
    linear = [nn.Linear(a, b) for a, b in zip(sizes[:-1], sizes[1:], strict=True)]
    between = [layer for one in linear[:-1] for layer in (one, nn.ELU(), nn.Dropout(config.dropout))]
    network = nn.Sequential(*between, linear[-1])
    optimiser = torch.optim.AdamW(network.parameters(), 1e-3, weight_decay=1e-2)
    schedule = torch.optim.lr_scheduler.CosineAnnealingLR(optimiser, config.steps)
    average = [parameter.detach().clone() for parameter in network.parameters()]
    for _ in range(config.steps):
        rows = np.minimum(np.searchsorted(data.drawn, random.random(config.batch)), len(data.drawn) - 1)
        x = np.clip((data.inputs[rows] - mean) / scale, -MOST_DEVIATIONS, MOST_DEVIATIONS)
        x = torch.from_numpy((x + config.noise * random.standard_normal(x.shape)).astype(np.float32))
        y = torch.from_numpy((data.targets[rows] - centre) / spread)
        predicted = network(x)
        loss = nn.functional.smooth_l1_loss(predicted[:, _OTHERS], y[:, _OTHERS], beta=0.5)
        loss = loss + config.standing_weight * nn.functional.binary_cross_entropy_with_logits(
            predicted[:, _STANDING], y[:, _STANDING]
        )
        optimiser.zero_grad()
        loss.backward()
        optimiser.step()
        schedule.step()
        with torch.no_grad():
            for kept, parameter in zip(average, network.parameters(), strict=True):
                kept.lerp_(parameter, 0.01)
    matrices = [(average[2 * i].numpy(), average[2 * i + 1].numpy()) for i in range(len(linear))]
    last, bias = matrices[-1]
    matrices[-1] = (last * spread[:, None], bias * spread + centre)
    return GaitWeights(mean, scale, tuple(matrices))


def tensors_of(weights: GaitWeights) -> dict[str, dict[str, Any]]:
    """Weights as the page reads them: matrices as 8-bit levels with a scale for each row, other numbers to six digits.
    """

    def tensor(values: Array) -> dict[str, Any]:
        return {"shape": list(values.shape), "numbers": [float(f"{value:.6g}") for value in values.ravel()]}

    tensors = {"gait.inputMean": tensor(weights.mean), "gait.inputScale": tensor(weights.scale)}
    for number, (matrix, bias) in enumerate(weights.layers):
        step = np.maximum(np.abs(matrix).max(axis=1) / 127, 1e-12)
        levels = np.round(matrix / step[:, None]).astype(int)
        tensors[f"gait.{number}.levels"] = {"shape": list(levels.shape), "numbers": levels.ravel().tolist()}
        tensors[f"gait.{number}.scale"] = tensor(step)
        tensors[f"gait.{number}.bias"] = tensor(bias)
    return tensors


def _write(path: Path, weights: GaitWeights, people: tuple[str, ...], corpus_hash: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    content = {"trainedOn": list(people), "corpusHash": corpus_hash, "tensors": tensors_of(weights)}
    path.write_text(json.dumps(content, separators=(",", ":")) + "\n")


def main(config: GaitConfig) -> None:
    """Trains without each group of people, then on all trainable people."""
    index = json.loads((config.frames / "index.json").read_text())
    people = trainable(list(index["people"]))
    if config.held_out:
        for number in range(config.groups):
            rest = tuple(person for place, person in enumerate(people) if place % config.groups != number)
            _write(
                config.held_out / f"{number}.json", train(config, _load(config, index, rest)), rest, index["corpusHash"]
            )
            print(f"without {', '.join(people[number :: config.groups])}: {len(rest)} people", flush=True)
    _write(config.out, train(config, _load(config, index, people)), people, index["corpusHash"])
    print(f"{config.out}: {len(people)} people")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description="The gait network.")
    parser.add_argument("--frames", type=Path, required=True)
    parser.add_argument("--out", type=Path, default=GaitConfig.out)
    parser.add_argument("--held-out", type=Path)
    parser.add_argument("--steps", type=int, default=GaitConfig.steps)
    parser.add_argument("--seed", type=int, default=GaitConfig.seed)
    given = parser.parse_args()
    main(GaitConfig(frames=given.frames, out=given.out, held_out=given.held_out, steps=given.steps, seed=given.seed))
