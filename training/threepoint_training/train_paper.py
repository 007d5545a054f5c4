"""Trains the paper's network as its section 3.3 says: MSE, Adam 1e-3, five epochs, in-between poses as augmentation."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Literal

import numpy as np
import torch
from numpy.typing import NDArray

from . import quaternion
from .arrays import Array
from .model import PaperNetwork, PaperShape, RepeatedPaperNetwork
from .paper_features import floor_under_head, forearm_rotations, paper_features
from .prepared_corpus import TRACKED_COLUMNS, PreparedCorpus
from .simulate_trackers import TrackerConfig, draw_wearer, simulate
from .solve_ik import to_heading

AnyPaperNetwork = PaperNetwork | RepeatedPaperNetwork


@dataclass(frozen=True)
class TrainPaperConfig:
    """The paper's settings. The batch size is ours unless `iterations` states the batches of an epoch, as the paper
    does.
    """

    epochs: int = 5
    learning_rate: float = 1e-3
    batch: int = 128
    iterations: int | None = None
    seed: int = 2023
    # Calls of `watch` in each epoch.
    watches_per_epoch: int = 4
    shape: PaperShape = PaperShape()


@dataclass(frozen=True)
class PaperInputs:
    """What section 3.2 of the paper leaves open about its samples; the defaults are those of the page's network.

    points: simulated trackers, or the joints as recorded. axes: of the room, or turned with the head. hands: their
    angles in these axes, or relative to the true forearm, which no headset reports. share_kept: the share of frames
    that remains when similar poses are left out; 1: all.
    """

    points: Literal["trackers", "joints"] = "trackers"
    axes: Literal["room", "heading"] = "heading"
    hands: Literal["axes", "parent"] = "axes"
    share_kept: float = 1.0


@dataclass(frozen=True)
class PaperFrames:
    """Inputs [F, 2, 3, 3], targets [F, 18] from the floor under the head [m]; the clip of each frame."""

    inputs: NDArray[np.float32]
    targets: NDArray[np.float32]
    clips: NDArray[np.int64]


def tracked_clips(
    corpus: PreparedCorpus, people: tuple[str, ...], seed: int
) -> Iterator[tuple[str, int, tuple[Array, Array]]]:
    """Each clip of these people with its person, and the positions [F, 3, 3] and rotations [F, 3, 4] that trackers
    would report.
    """
    trackers = TrackerConfig()
    for number, name in enumerate(people):
        wearer = draw_wearer(trackers, np.random.default_rng([seed, number]))
        for clip in corpus.clips_of({name}):
            frames = corpus.clip_slice(clip)
            random = np.random.default_rng([seed, 1, clip])
            yield name, clip, simulate(corpus.positions[frames], corpus.rotations[frames], wearer, trackers, random)


def frames_of(
    corpus: PreparedCorpus, people: tuple[str, ...], seed: int, options: PaperInputs = PaperInputs()
) -> PaperFrames:
    """All frames of these people as trackers would see them, or as the options say."""
    inputs, targets, clips = [], [], []
    for _, clip, (positions, rotations) in tracked_clips(corpus, people, seed):
        frames = corpus.clip_slice(clip)
        truth = corpus.truth(frames).astype(np.float64)
        if options.points == "joints":
            positions = corpus.positions[frames][:, TRACKED_COLUMNS].astype(np.float64)
            rotations = corpus.rotations[frames].astype(np.float64)
        truth = truth - floor_under_head(positions)
        if options.hands == "parent":
            forearms = forearm_rotations(positions - floor_under_head(positions), truth)
            hands = quaternion.multiply(quaternion.conjugate(forearms), rotations[:, 1:])
        if options.axes == "heading":
            positions, rotations, yaw, _ = to_heading(positions, rotations)
            truth = quaternion.rotate(np.broadcast_to(quaternion.conjugate(yaw)[:, None], (*truth.shape[:2], 4)), truth)
        if options.hands == "parent":
            rotations = np.concatenate([rotations[:, :1], hands], axis=1)
        inputs.append(paper_features(positions, rotations).astype(np.float32))
        targets.append(truth.reshape(len(truth), -1).astype(np.float32))
        clips.append(np.full(len(truth), clip))
    everything = PaperFrames(np.concatenate(inputs), np.concatenate(targets), np.concatenate(clips))
    if options.share_kept == 1:
        return everything
    kept = different_poses(everything, options.share_kept)
    return PaperFrames(everything.inputs[kept], everything.targets[kept], everything.clips[kept])


def different_poses(frames: PaperFrames, share: float) -> NDArray[np.int64]:
    """The frames that remain when similar poses are left out: a frame is kept when a joint is further from its place in
    the last kept frame than a distance by which about this share of the frames remains.
    """
    tracked = np.swapaxes(frames.inputs[:, 0], 1, 2)
    joints = np.concatenate([tracked, frames.targets.reshape(-1, 6, 3)], axis=1)

    def kept(distance: float) -> list[int]:
        frames = [0]
        for frame in range(1, len(joints)):
            if np.max(np.sum((joints[frame] - joints[frames[-1]]) ** 2, axis=-1)) > distance**2:
                frames.append(frame)
        return frames

    least, most = 0.0, 1.0
    for _ in range(8):
        middle = (least + most) / 2
        least, most = (middle, most) if len(kept(middle)) > share * len(joints) else (least, middle)
    return np.array(kept(most))


def train(
    frames: PaperFrames,
    chosen: NDArray[np.int64],
    config: TrainPaperConfig,
    report: Callable[[int, int, float], None] = lambda *_: None,
    watch: Callable[[float, AnyPaperNetwork], None] = lambda *_: None,
) -> AnyPaperNetwork:
    """Trains on the chosen frames and the poses half-way to each one's successor.

    report(epoch, iteration, MSE) gets the loss of each batch, of standardised targets; watch(epochs, network) sees the
    network as it would be used.
    """
    torch.manual_seed(config.seed)
    random = np.random.default_rng(config.seed)
    network = PaperNetwork(config.shape) if config.shape.networks == 1 else RepeatedPaperNetwork(config.shape)
    # In-between poses only between neighbours that both train: none may come from a test frame.
    following = chosen[:-1][(np.diff(chosen) == 1) & (frames.clips[chosen[:-1]] == frames.clips[chosen[1:]])]
    inputs = np.concatenate([frames.inputs[chosen], _midway(frames.inputs, following)])
    targets = np.concatenate([frames.targets[chosen], (frames.targets[following] + frames.targets[following + 1]) / 2])
    x, y = torch.from_numpy(inputs), torch.from_numpy(targets)
    network.normalise(x, y)
    standardised = (y - network.output_mean) / network.output_scale
    optimiser = torch.optim.Adam(network.parameters(), lr=config.learning_rate)
    size = config.batch if config.iterations is None else max(1, len(x) // config.iterations)
    batches = max(1, len(x) // size)
    watched = {round(batches * part / config.watches_per_epoch) - 1 for part in range(1, config.watches_per_epoch + 1)}
    network.train()
    for epoch in range(config.epochs):
        order = torch.from_numpy(random.permutation(len(x)))
        for iteration in range(batches):
            batch = order[iteration * size : (iteration + 1) * size]
            loss = torch.nn.functional.mse_loss(network.standardised(x[batch]), standardised[batch])
            optimiser.zero_grad()
            loss.backward()
            optimiser.step()
            report(epoch, iteration, float(loss.detach()))
            if iteration in watched:
                watch(epoch + (iteration + 1) / batches, network.eval())
                network.train()
    return network.eval()


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
