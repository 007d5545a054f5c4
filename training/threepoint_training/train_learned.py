"""Trains our network, which predicts the residual of IK's joints, on recombined bodies; its weights are averaged over steps, then shrunk."""

import functools
import zlib
from collections.abc import Callable
from dataclasses import dataclass, field, fields, replace

import numpy as np
import torch
from numpy.typing import NDArray

from . import hand_tilt, notice_hand_tilts, quaternion
from .augment import AugmentConfig, BodyParts, draw_batch
from .chest_features import CHEST_FEATURES
from .complete_hands import carry_with_head, complete_hands
from .differentiable_kinematics import DifferentiableKinematics
from .features import FEATURES, frame_features
from .model import CorrectionNetwork
from .notice_hand_tilts import NOTHING_TOLD, ToldTilts
from .prepared_corpus import PreparedCorpus
from .residual import OUTPUTS, network_input, residual
from .simulate_trackers import FOREARM_ERROR, TrackerConfig, Wearer, draw_wearer, measured_tilts, simulate
from .skeleton import Body, body_from_calibration

Array = NDArray[np.float64]


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
    # What corrections of trunk and arm are multiplied by after training: what is learned of the people trained on holds for others in part.
    shrinkage: float = 0.92
    arm_shrinkage: float = 1.0
    # Weights in the loss of errors after torso and arm fitting, and of raw joints: these keep small what fitting would undo.
    fitted_loss_weight: float = 1.0
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
    """Frames of people as trackers report them, one clip after the other: inputs [F, T·46 + 38] and targets [F, 18] of the network, targets in
    eye heights (times `eye_height` [F] they are metres), and each frame's person and clip [F].
    """

    inputs: NDArray[np.float32]
    targets: NDArray[np.float32]
    eye_height: NDArray[np.float64]
    people: NDArray[np.str_]
    clips: NDArray[np.int64]

    def subset(self, frames: NDArray[np.int64]) -> "HeldOut":
        """These frames alone."""
        return HeldOut(*(getattr(self, each.name)[frames] for each in fields(self)))


@dataclass(frozen=True)
class Condition:
    """How people held out are tracked, where that differs from a well calibrated headset."""

    # Headset and wrists sit this far from where they are believed to be [m], as worn all the time.
    offset: float = 0.0
    # The calibrated eye height over the true one.
    eye_height: float = 1.0
    # One hand of each clip is not seen for 2 s of every 4 s.
    lost_hand: bool = False
    # Trackers report what was so many frames before.
    late: int = 0
    # Everything is lower by this part of the eye height: the calibration knows people who stand.
    seated: float = 0.0
    # The headset looks down by so much when its wearer looks straight ahead [rad].
    tilt: float = 0.0
    # The guided calibration has measured the hands' tilts; and its wearer bent the wrists inwards by so much meanwhile [rad].
    hands_measured: bool = True
    bent_wrists: float = 0.0
    # The page notices how hands stand to their forearms while they move; False: they stay turned as they were told or usually are.
    hands_noticed: bool = True
    # The wearer has typed how long the forearm is.
    forearm_typed: bool = False


# One for all tests, so that errors of different networks and conditions are compared on the same wearers and noise.
_HELD_OUT_SEED = 1
_TRACKERS = TrackerConfig()


def held_out(
    corpus: PreparedCorpus, people: tuple[str, ...], window_seconds: tuple[float, ...], condition: Condition = Condition()
) -> HeldOut:
    """All frames of these people as trackers report them under this condition, with the calibration that they would have.

    Hand tilts are measured on the true forearms of the same person's other clips (of a single clip: on its own), with the calibration's error.
    """
    forearms = hand_tilt.ForearmMeans(corpus, people)
    rows = []
    for name in people:
        wearer, body = _worn(name, condition), _calibrated(corpus, name, condition)
        for clip in corpus.clips_of({name}):
            tracked = _disturb(corpus, clip, wearer, body, condition)
            metres = notice_hand_tilts.travel(tracked.positions) * condition.hands_noticed
            told = _told_tilts(forearms.elsewhere(clip), wearer, name, condition)
            turned = notice_hand_tilts.with_noticed_hands(body, tracked.positions, tracked.rotations, metres, told=told, seen=tracked.seen)
            count = len(tracked.times)
            rows.append((*_rows(tracked, turned, window_seconds), np.full(count, body.eye_height), np.full(count, name), np.full(count, clip)))
    return HeldOut(*(np.concatenate(column) for column in zip(*rows, strict=True)))


def _random_of(name: str, *stream: int) -> np.random.Generator:
    """Keyed by the name: a person wears the same in every selection of people, and not what another person does."""
    return np.random.default_rng([_HELD_OUT_SEED, *stream, zlib.crc32(name.encode())])


def _worn(name: str, condition: Condition) -> Wearer:
    """How this person wears headset and hands."""
    worn = draw_wearer(_TRACKERS, _random_of(name))
    aside = condition.offset * np.array([0.0, 0.0, 1.0])
    tilt = quaternion.from_rotation_vector(np.array([-condition.tilt, 0.0, 0.0]))
    return replace(
        worn,
        eyes_in_head=worn.eyes_in_head + aside,
        wrist_offsets=worn.wrist_offsets + np.roll(aside, 2),
        head_turn=quaternion.multiply(worn.head_turn, tilt),
    )


def _calibrated(corpus: PreparedCorpus, name: str, condition: Condition) -> Body:
    """The body that this person's calibration finds, hands as they come."""
    person = corpus.people[name]
    body = body_from_calibration(np.array(person.eye_height * condition.eye_height), np.array(person.arm_span))
    if condition.forearm_typed:
        body = body.with_forearms(corpus.forearm(name) + _random_of(name, 3).normal(size=1) * FOREARM_ERROR)
    return body


@dataclass(frozen=True)
class _Tracked:
    """A clip as trackers report it, floor frame: points [F, 3, 3], rotations [F, 3, 4] and which hands are seen [F, 2]; and the six true joints
    [F, 6, 3]. times [F] since its beginning [s]."""

    positions: Array
    rotations: Array
    seen: NDArray[np.bool_]
    truth: Array
    times: Array


def _disturb(corpus: PreparedCorpus, clip: int, wearer: Wearer, body: Body, condition: Condition) -> _Tracked:
    """A clip as this wearer's trackers report it: late, seated and with lost hands as the condition has it."""
    frames = corpus.clip_slice(clip)
    random = np.random.default_rng([_HELD_OUT_SEED, 1, clip])
    positions, rotations = simulate(corpus.positions[frames], corpus.rotations[frames], wearer, _TRACKERS, random)
    truth = corpus.truth(frames).astype(np.float64)
    count = len(truth)
    reported = np.maximum(np.arange(count) - condition.late, 0)
    drop = condition.seated * corpus.people[corpus.clip_people[clip]].eye_height * np.array([0.0, 1.0, 0.0])
    positions, rotations, truth = positions[reported] - drop, rotations[reported], truth - drop
    lost = np.zeros((count, 2), bool)
    if condition.lost_hand:
        positions, rotations, lost = _lose_hand(positions, rotations, clip % 2, corpus.rate_hz, body)
    return _Tracked(positions, rotations, ~lost, truth, np.arange(count) / corpus.rate_hz)


def _rows(
    tracked: _Tracked, body: Body, window_seconds: tuple[float, ...]
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Inputs [F, T·46 + 38] and targets [F, 18] of a clip."""
    vector, _ = frame_features(tracked.positions, tracked.rotations, body, tracked.seen)
    inputs = network_input(vector, tracked.times, window_seconds)
    targets = residual(tracked.truth, tracked.positions, tracked.rotations, body, vector)
    return inputs.astype(np.float32), targets.astype(np.float32)


def _told_tilts(tilts: Array, wearer: Wearer, name: str, condition: Condition) -> ToldTilts:
    """What the guided calibration measures of hands with these tilts [2, 2], as far as it is believed; one error for all clips of a person."""
    if not condition.hands_measured:
        return NOTHING_TOLD
    measured = measured_tilts(tilts, wearer.hand_turns, _TRACKERS, _random_of(name, 2)) + np.array([condition.bent_wrists, 0.0])
    return ToldTilts(measured, hand_tilt.believed(measured))


def _lose_hand(positions: Array, rotations: Array, hand: int, rate_hz: int, body: Body) -> tuple[Array, Array, NDArray[np.bool_]]:
    """The same trackers, this hand seen for 2 s, lost for 2 s, and so on; and which hands are lost [F, 2]."""
    frames, half = np.arange(len(positions)), 2 * rate_hz
    ago = np.maximum(frames % (2 * half) - half + 1, 0)
    last, column = frames - ago, 1 + hand
    positions, rotations = positions.copy(), rotations.copy()
    positions[:, column], rotations[:, column] = carry_with_head(
        positions[last, column], rotations[last, column], (positions[last, 0], rotations[last, 0]), (positions[:, 0], rotations[:, 0])
    )
    unseen = np.zeros((len(frames), 2))
    unseen[:, hand] = ago / rate_hz
    sizes = (np.full(len(frames), size.item()) for size in (body.eye_height, body.arm))
    return *complete_hands(positions, rotations, unseen, *sizes), unseen > 0


def fitted_errors_cm(output: NDArray[np.float32], people: HeldOut) -> NDArray[np.float64]:
    """Distances [F, 6] in centimetres of a network's output, after torso and arm fitting."""
    raw = np.broadcast_to(output, people.targets.shape).reshape(-1, 6, 3).astype(np.float32)
    fitted = DifferentiableKinematics()(torch.from_numpy(raw), torch.from_numpy(people.inputs))
    return raw_errors_cm(fitted.numpy().reshape(-1, OUTPUTS), people)


def raw_errors_cm(output: NDArray[np.float32], people: HeldOut) -> NDArray[np.float64]:
    """Distances [F, 6] in centimetres of a network's output, before torso and arm fitting."""
    difference = (output - people.targets).reshape(-1, 6, 3)
    return np.linalg.norm(difference, axis=-1) * people.eye_height[:, None] * 100


def ik_errors_cm(people: HeldOut) -> NDArray[np.float64]:
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
    optimiser = torch.optim.AdamW(network.parameters(), lr=config.learning_rate, weight_decay=config.weight_decay)
    schedule = torch.optim.lr_scheduler.OneCycleLR(optimiser, config.learning_rate, total_steps=config.steps, pct_start=0.1)
    keep = 0.5 ** (1 / config.average_half_life_steps)
    network.train()
    for step in range(config.steps):
        current = draw_batch(parts, config.batch, config.augment, random)
        x, y = torch.from_numpy(current.inputs), torch.from_numpy(current.targets)
        corrections = network(x).view(-1, 6, 3)
        distance = functools.partial(mean_distances, truth=y.view(-1, 6, 3), elbow_share=config.elbow_share)
        loss = config.auxiliary_loss_weight * distance(corrections).mean()
        loss = loss + config.fitted_loss_weight * distance(kinematics(corrections, x)).mean()
        loss = loss / _RESIDUAL
        optimiser.zero_grad()
        loss.backward()
        torch.nn.utils.clip_grad_norm_(network.parameters(), 1.0)
        optimiser.step()
        schedule.step()
        with torch.no_grad():
            weight = min(keep, (1 + step) / (10 + step))
            for average, value in zip(averaged.parameters(), network.parameters(), strict=True):
                average.lerp_(value, 1 - weight)
        report(step, float(loss.detach()))
    averaged.shrink(config.shrinkage, config.arm_shrinkage)
    return averaged


@dataclass(frozen=True)
class TrainFrameRandomConfig:
    """Our network under the paper's protocol, which trains on the neighbours of every test frame: wider, trained longer, without augmentation."""

    width: int = 512
    hidden_layers: int = 3
    steps: int = 12_000
    batch: int = 1024
    learning_rate: float = 2e-3
    weight_decay: float = 1e-4
    seed: int = 2460


def train_frame_random(
    frames: HeldOut, chosen: NDArray[np.int64], config: TrainFrameRandomConfig, report: Callable[[int, float], None] = lambda *_: None
) -> CorrectionNetwork:
    """Trains on the chosen frames as they are; report(step, loss)."""
    torch.manual_seed(config.seed)
    x, y = torch.from_numpy(frames.inputs[chosen]), torch.from_numpy(frames.targets[chosen])
    network = CorrectionNetwork((x.shape[1] - CHEST_FEATURES) // FEATURES, config.width, 0.0, config.hidden_layers)
    network.normalise(x, y)
    optimiser = torch.optim.AdamW(network.parameters(), lr=config.learning_rate, weight_decay=config.weight_decay)
    schedule = torch.optim.lr_scheduler.OneCycleLR(optimiser, config.learning_rate, total_steps=config.steps, pct_start=0.1)
    network.train()
    for step in range(config.steps):
        batch = torch.randint(len(x), (config.batch,))
        loss = mean_distances(network(x[batch]).view(-1, 6, 3), y[batch].view(-1, 6, 3)).mean() / _RESIDUAL
        optimiser.zero_grad()
        loss.backward()
        optimiser.step()
        schedule.step()
        report(step, float(loss.detach()))
    return network.eval()


# A typical residual [eye heights]; divides the loss, which so stays near one.
_RESIDUAL = 0.025


def mean_distances(corrections: torch.Tensor, truth: torch.Tensor, elbow_share: float = 1 / 3) -> torch.Tensor:
    """Mean distance [N] of the joints [N, 6, 3] (ESTIMATED_JOINTS), both elbows together counting for so much; a third: every joint alike.

    Not its square: MPJPE counts distances, and the large errors of people who climb and tumble would outweigh all others.
    """
    distance = (corrections - truth).norm(dim=-1)
    return elbow_share * distance[:, :2].mean(dim=-1) + (1 - elbow_share) * distance[:, 2:].mean(dim=-1)
