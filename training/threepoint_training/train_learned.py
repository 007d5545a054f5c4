"""Trains our network, which predicts the residual of IK's joints, on recombined bodies; its weights are averaged over
steps, then shrunk.
"""

import functools
import zlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, fields

import numpy as np
import torch
from numpy.typing import NDArray

from . import estimate_hand_tilts, hand_tilt
from .arrays import Array
from .augment import AugmentConfig, draw_batch
from .body_parts import BodyParts
from .differentiable_kinematics import DifferentiableKinematics
from .estimate_hand_tilts import NO_CALIBRATED_TILTS, CalibratedTilts
from .features import frame_features
from .model import CorrectionNetwork
from .prepared_corpus import PreparedCorpus
from .residual import OUTPUTS, correction_share, network_input, residual
from .simulate_trackers import TrackerConfig, Wearer, draw_wearer, measured_tilts, simulate
from .skeleton import Body, body_from_calibration
from .train_paper import predict


@dataclass(frozen=True)
class TrainLearnedConfig:
    """Chosen by cross-validation over training people (docs/training.md)."""

    width: int = 192
    dropout: float = 0.2
    hidden_layers: int = 2
    steps: int = 3000
    batch: int = 1024
    learning_rate: float = 5e-3
    weight_decay: float = 1e-2
    average_half_life_steps: float = 300.0
    # The trunk's correction is multiplied by this after training: part of what is learned of some people does not hold
    # for others.
    shrinkage: float = 0.92
    # The weight of the raw joints' errors, which keeps small what fitting would undo, relative to that of errors after
    # torso and arm fitting.
    auxiliary_loss_weight: float = 0.1
    # The elbows' share of both losses; a third would be every joint alike.
    elbow_share: float = 1 / 2
    seed: int = 2460
    augment: AugmentConfig = field(default_factory=AugmentConfig)

    @property
    def window_seconds(self) -> tuple[float, ...]:
        """Ages of the frames in the input [s]."""
        return tuple(round(frames / 60, 6) for frames in self.augment.window_frames)


@dataclass(frozen=True)
class HeldOut:
    """Frames of people as trackers report them, one clip after the other: inputs [F, T·46 + 38] and targets [F, 18] of
    the network, targets in eye heights (times `eye_height` [F] they are metres), and each frame's person and clip [F].
    """

    inputs: NDArray[np.float32]
    targets: NDArray[np.float32]
    eye_height: Array
    people: NDArray[np.str_]
    clips: NDArray[np.int64]

    def subset(self, frames: NDArray[np.int64] | slice) -> "HeldOut":
        """These frames alone."""
        return HeldOut(*(getattr(self, each.name)[frames] for each in fields(self)))


# One for all evaluations, so that errors of different networks are compared on the same wearers and noise.
_HELD_OUT_SEED = 1
_TRACKERS = TrackerConfig()


def held_out(
    corpus: PreparedCorpus, people: tuple[str, ...], window_seconds: tuple[float, ...], hands_measured: bool = True
) -> HeldOut:
    """All frames of these people as trackers report them, with the calibration that they would have; without
    hands_measured no hand tilt is in it.

    Hand tilts are measured on the true forearms of the same person's other clips (of a single clip: on its own), with
    the calibration's error.
    """
    forearms = hand_tilt.ForearmMeans(corpus, people)
    rows = []
    for name in people:
        person, wearer = corpus.people[name], draw_wearer(_TRACKERS, _random_of(name))
        body = body_from_calibration(np.array(person.eye_height), np.array(person.arm_span))
        for clip in corpus.clips_of({name}):
            frames = corpus.clip_slice(clip)
            random = np.random.default_rng([_HELD_OUT_SEED, 1, clip])
            positions, rotations = simulate(
                corpus.positions[frames], corpus.rotations[frames], wearer, _TRACKERS, random
            )
            calibrated = _measured(forearms.elsewhere(clip), wearer, name) if hands_measured else NO_CALIBRATED_TILTS
            rows.append(clip_frames(corpus, clip, (positions, rotations), body, window_seconds, calibrated))
    columns = (np.concatenate([getattr(row, each.name) for row in rows]) for each in fields(HeldOut))
    return HeldOut(*columns)


def clip_frames(
    corpus: PreparedCorpus,
    clip: int,
    tracked: tuple[Array, Array],
    body: Body,
    window_seconds: tuple[float, ...],
    calibrated: CalibratedTilts = NO_CALIBRATED_TILTS,
) -> HeldOut:
    """The first frames of a clip, as many as are tracked: positions [F, 3, 3] and rotations [F, 3, 4]. Hand tilts are
    estimated on the way, from the calibrated ones.
    """
    positions, rotations = tracked
    count, start = len(positions), corpus.clip_slice(clip).start
    seconds = np.full(count, 1 / corpus.rate_hz)
    turned = estimate_hand_tilts.with_estimated_hands(body, positions, rotations, seconds, calibrated=calibrated)
    vector, _ = frame_features(positions, rotations, turned)
    truth = corpus.truth(slice(start, start + count)).astype(np.float64)
    return HeldOut(
        network_input(vector, np.arange(count) / corpus.rate_hz, window_seconds).astype(np.float32),
        residual(truth, positions, rotations, turned, vector).astype(np.float32),
        np.full(count, body.eye_height),
        np.full(count, corpus.clip_people[clip]),
        np.full(count, clip),
    )


def _random_of(name: str, *stream: int) -> np.random.Generator:
    """Keyed by the name: a person wears the same in every selection of people, and not what another person does."""
    return np.random.default_rng([_HELD_OUT_SEED, *stream, zlib.crc32(name.encode())])


def _measured(tilts: Array, wearer: Wearer, name: str) -> CalibratedTilts:
    """The calibration's measurement of hands with these tilts [2, 2], where it is plausible; one error for all clips of
    a person.
    """
    measured = measured_tilts(tilts, wearer.hand_turns, _TRACKERS, _random_of(name, 2))
    return CalibratedTilts(measured, hand_tilt.plausible(measured))


def fitted_errors_cm(output: NDArray[np.float32], people: HeldOut) -> Array:
    """Distances [F, 6] in centimetres of a network's output, as far as it counts, after torso and arm fitting."""
    counted = (output * correction_share(people.inputs)[:, None]).reshape(-1, 6, 3).astype(np.float32)
    fitted = DifferentiableKinematics()(torch.from_numpy(counted), torch.from_numpy(people.inputs))
    return raw_errors_cm(fitted.numpy().reshape(-1, OUTPUTS), people)


def errors_cm(network: torch.nn.Module, people: HeldOut) -> Array:
    """Distances [F, 6] in centimetres of the network's joints from the true ones, after torso and arm fitting."""
    return fitted_errors_cm(predict(network, people.inputs), people)


def raw_errors_cm(output: NDArray[np.float32], people: HeldOut) -> Array:
    """Distances [F, 6] in centimetres of a network's output, before torso and arm fitting."""
    difference = (output - people.targets).reshape(-1, 6, 3)
    return np.linalg.norm(difference, axis=-1) * people.eye_height[:, None] * 100


def ik_errors_cm(people: HeldOut) -> Array:
    """Distances [F, 6] in centimetres of IK's joints after torso and arm fitting."""
    return fitted_errors_cm(np.zeros((1, OUTPUTS), np.float32), people)


def train(
    corpus: PreparedCorpus,
    people: tuple[str, ...],
    config: TrainLearnedConfig,
    report: Callable[[int, float], None] = lambda *_: None,
) -> CorrectionNetwork:
    """Trains on these people; report(step, loss)."""
    torch.manual_seed(config.seed)
    random = np.random.default_rng(config.seed)
    parts = BodyParts(corpus, people, config.augment.balance)
    kinematics = DifferentiableKinematics()
    network = CorrectionNetwork(len(config.augment.window_frames), config.width, config.dropout, config.hidden_layers)
    first = [draw_batch(parts, config.batch, config.augment, random) for _ in range(8)]
    inputs = torch.from_numpy(np.concatenate([b.inputs for b in first]))
    network.normalise(inputs, torch.from_numpy(np.concatenate([b.targets for b in first])))
    averaged = CorrectionNetwork(len(config.augment.window_frames), config.width, config.dropout, config.hidden_layers)
    averaged.load_state_dict(network.state_dict())
    averaged.eval()
    keep = 0.5 ** (1 / config.average_half_life_steps)

    def loss_of_batch() -> torch.Tensor:
        current = draw_batch(parts, config.batch, config.augment, random)
        x, y = torch.from_numpy(current.inputs), torch.from_numpy(current.targets)
        corrections = network(x).view(-1, 6, 3)
        distance = functools.partial(mean_distances, truth=y.view(-1, 6, 3), elbow_share=config.elbow_share)
        raw = config.auxiliary_loss_weight * distance(corrections).mean()
        return raw + distance(kinematics(corrections, x)).mean()

    for step, loss in _descend(network, config, loss_of_batch):
        with torch.no_grad():
            weight = min(keep, (1 + step) / (10 + step))
            for average, value in zip(averaged.parameters(), network.parameters(), strict=True):
                average.lerp_(value, 1 - weight)
        report(step, loss)
    averaged.shrink_trunk(config.shrinkage)
    return averaged


# A typical residual [eye heights]; divides the loss, which so stays near one.
_RESIDUAL = 0.025


def _descend(
    network: CorrectionNetwork,
    config: TrainLearnedConfig,
    loss_of_batch: Callable[[], torch.Tensor],
) -> Iterator[tuple[int, float]]:
    """Trains the network by AdamW with one cycle of the learning rate; yields each step and its loss. Gradients longer
    than 1 are shortened to it.
    """
    optimiser = torch.optim.AdamW(network.parameters(), lr=config.learning_rate, weight_decay=config.weight_decay)
    schedule = torch.optim.lr_scheduler.OneCycleLR(
        optimiser, config.learning_rate, total_steps=config.steps, pct_start=0.1
    )
    network.train()
    for step in range(config.steps):
        loss = loss_of_batch() / _RESIDUAL
        optimiser.zero_grad()
        loss.backward()
        torch.nn.utils.clip_grad_norm_(network.parameters(), 1.0)
        optimiser.step()
        schedule.step()
        yield step, float(loss.detach())


def mean_distances(corrections: torch.Tensor, truth: torch.Tensor, elbow_share: float = 1 / 3) -> torch.Tensor:
    """Mean distance [N] of the joints [N, 6, 3] (ESTIMATED_JOINTS), both elbows together counting for so much; a third:
    every joint alike.

    Not its square: MPJPE counts distances, and the large errors of people who climb and tumble would outweigh all
    others.
    """
    distance = (corrections - truth).norm(dim=-1)
    return elbow_share * distance[:, :2].mean(dim=-1) + (1 - elbow_share) * distance[:, 2:].mean(dim=-1)
