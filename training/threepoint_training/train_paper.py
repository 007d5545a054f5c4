"""Trains the paper's network as its section 3.3 says: MSE, Adam 1e-3, five epochs, in-between poses as augmentation."""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
import torch
from numpy.typing import NDArray

from .arrays import Array
from .model import PaperNetwork
from .paper_features import floor_under_head, paper_features
from .prepared_corpus import PreparedCorpus
from .simulate_trackers import TrackerConfig, draw_wearer, simulate


@dataclass(frozen=True)
class TrainPaperConfig:
    """The paper's settings; the batch size is ours, the paper states none."""

    epochs: int = 5
    learning_rate: float = 1e-3
    batch: int = 128
    seed: int = 2023
    # Points of the learning curve in each epoch.
    watches_per_epoch: int = 4


@dataclass(frozen=True)
class LearningCurve:
    """Mean squared error per coordinate [cm²] on people trained on and on people held out, after so many epochs."""

    epochs: list[float] = field(default_factory=list)
    train: list[float] = field(default_factory=list)
    test: list[float] = field(default_factory=list)


@dataclass(frozen=True)
class PaperFrames:
    """Inputs [F, 2, 3, 3], targets [F, 18] from the floor under the head, room axes [m]; the clip of each frame."""

    inputs: NDArray[np.float32]
    targets: NDArray[np.float32]
    clips: NDArray[np.int64]


def frames_of(corpus: PreparedCorpus, people: tuple[str, ...], seed: int) -> PaperFrames:
    """All frames of these people as trackers would see them."""
    trackers = TrackerConfig()
    inputs, targets, clips = [], [], []
    for number, name in enumerate(people):
        wearer = draw_wearer(trackers, np.random.default_rng([seed, number]))
        for clip in corpus.clips_of({name}):
            frames = corpus.clip_slice(clip)
            random = np.random.default_rng([seed, 1, clip])
            positions, rotations = simulate(
                corpus.positions[frames], corpus.rotations[frames], wearer, trackers, random
            )
            inputs.append(paper_features(positions, rotations).astype(np.float32))
            targets.append(
                (corpus.truth(frames) - floor_under_head(positions)).reshape(len(positions), -1).astype(np.float32)
            )
            clips.append(np.full(len(positions), clip))
    return PaperFrames(np.concatenate(inputs), np.concatenate(targets), np.concatenate(clips))


def train(
    frames: PaperFrames,
    chosen: NDArray[np.int64],
    config: TrainPaperConfig,
    report: Callable[[int, int, float], None] = lambda *_: None,
    watch: Callable[[float, PaperNetwork], None] = lambda *_: None,
) -> PaperNetwork:
    """Trains on the chosen frames and the poses half-way to each one's successor.

    report(epoch, iteration, MSE) gets the loss of batches; watch(epochs, network) sees the network as it would be used.
    """
    torch.manual_seed(config.seed)
    random = np.random.default_rng(config.seed)
    network = PaperNetwork()
    # In-between poses only between neighbours that both train: none may come from a test frame.
    following = chosen[:-1][(np.diff(chosen) == 1) & (frames.clips[chosen[:-1]] == frames.clips[chosen[1:]])]
    inputs = np.concatenate([frames.inputs[chosen], _midway(frames.inputs, following)])
    targets = np.concatenate([frames.targets[chosen], (frames.targets[following] + frames.targets[following + 1]) / 2])
    x, y = torch.from_numpy(inputs), torch.from_numpy(targets)
    network.normalise(x, y)
    standardised = (y - network.output_mean) / network.output_scale
    optimiser = torch.optim.Adam(network.parameters(), lr=config.learning_rate)
    batches = max(1, len(x) // config.batch)
    watched = {round(batches * part / config.watches_per_epoch) - 1 for part in range(1, config.watches_per_epoch + 1)}
    network.train()
    for epoch in range(config.epochs):
        order = torch.from_numpy(random.permutation(len(x)))
        for iteration in range(batches):
            batch = order[iteration * config.batch : (iteration + 1) * config.batch]
            loss = torch.nn.functional.mse_loss(network.standardised(x[batch]), standardised[batch])
            optimiser.zero_grad()
            loss.backward()
            optimiser.step()
            if iteration % 50 == 0 or iteration == batches - 1:
                report(epoch, iteration, float(loss.detach()))
            if iteration in watched:
                watch(epoch + (iteration + 1) / batches, network.eval())
                network.train()
    return network.eval()


def follow_learning(
    train: PaperFrames, test: PaperFrames, every: int = 16
) -> tuple[LearningCurve, Callable[[float, PaperNetwork], None]]:
    """A curve and the watch that fills it, from one frame in `every` of each side; it changes nothing of the training.
    """
    curve = LearningCurve()

    def error(network: PaperNetwork, frames: PaperFrames) -> float:
        difference = predict(network, frames.inputs[::every]) - frames.targets[::every]
        return float(np.mean(np.square(difference, dtype=np.float64))) * 1e4

    def watch(epochs: float, network: PaperNetwork) -> None:
        curve.epochs.append(round(epochs, 3))
        curve.train.append(round(error(network, train), 3))
        curve.test.append(round(error(network, test), 3))

    return curve, watch


def _midway(inputs: NDArray[np.float32], following: NDArray[np.int64]) -> NDArray[np.float32]:
    """Linear interpolation of positions and of angles, each angle along its shorter way."""
    first, second = inputs[following], inputs[following + 1]
    middle = (first + second) / 2
    turn = np.mod(second[:, 1] - first[:, 1] + np.pi, 2 * np.pi) - np.pi
    middle[:, 1] = np.mod(first[:, 1] + turn / 2 + np.pi, 2 * np.pi) - np.pi
    return middle


def predict(network: torch.nn.Module, inputs: NDArray[np.float32], batch: int = 8192) -> NDArray[np.float32]:
    """The network's output, no gradients."""
    with torch.no_grad():
        return np.concatenate(
            [network(torch.from_numpy(inputs[i : i + batch])).numpy() for i in range(0, len(inputs), batch)]
        )


def errors_cm(network: torch.nn.Module, frames: PaperFrames, chosen: NDArray[np.int64] | slice = slice(None)) -> Array:
    """Distances [F, 6] in centimetres of the network's joints from the true ones, over the chosen frames."""
    difference = predict(network, frames.inputs[chosen]) - frames.targets[chosen]
    return np.linalg.norm(difference.reshape(-1, 6, 3), axis=-1) * 100
