"""Whose headset sits elsewhere, or whose height is wrong: what minutes of wearing tell of it, and what a body that believes them gains.

`npm run train -- --mocap DIR --noticed` calls this and renews the table of docs/accuracy.md. Each group of people is held out in turn: what reads
them, their IK and their network are made of the others.
"""

import zlib
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from . import fitted_kinematics, leave_one_out, notice_hand_tilts, quaternion, solve_ik, splits, train_learned
from .accuracy_tables import renew, table
from .features import frame_features
from .fit_ik import FitIkConfig
from .model import CorrectionNetwork
from .prepared_corpus import PreparedCorpus
from .residual import network_input, residual
from .simulate_trackers import TrackerConfig, Wearer, draw_wearer, simulate
from .skeleton import Body, body_from_calibration
from .train_learned import HeldOut, TrainLearnedConfig
from .train_paper import predict

Array = NDArray[np.float64]

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs/accuracy.md"


@dataclass(frozen=True)
class Fault:
    """A headset that sits so far up and back of where it is believed to [m], and by how much of itself the calibrated eye height is wrong."""

    up: float = 0.0
    back: float = 0.0
    eye_height: float = 0.0

    def worn(self, wearer: Wearer) -> Wearer:
        """By this wearer."""
        return replace(wearer, eyes_in_head=wearer.eyes_in_head + np.array([0.0, self.up, self.back]))


FAULTS = {
    "nothing": Fault(),
    "headset 3 cm up": Fault(up=0.03),
    "headset 3 cm down": Fault(up=-0.03),
    "headset 3 cm back": Fault(back=0.03),
    "headset 3 cm forward": Fault(back=-0.03),
    "eye height −5 %": Fault(eye_height=-0.05),
    "eye height +5 %": Fault(eye_height=0.05),
}
COLUMNS = ("IK", "corrected", "ours", "corrected", "ours, another laboratory", "corrected")


@dataclass(frozen=True)
class NoticedWearConfig:
    """Who is worn long enough, when figures are taken, and on what wearers they are learned to be read."""

    # So many groups are held out in turn.
    groups: int = 4
    fewest_minutes: float = 1.3
    # Of the recordings at 60 Hz, for the signs, and of judged frames.
    stride: int = 6
    judged_stride: int = 24
    # A gaze is level within this sine, an arm hangs with this much of its length downward.
    level: float = 0.2
    hanging: float = 0.8
    # Of each person; faults have these standard deviations [m], and the eye height's as a part of itself.
    wearers: int = 12
    offset: float = 0.03
    height: float = 0.05
    # Weighs as much as so many wearers without any fault.
    ridge: float = 10.0
    # Of each clip, as in all figures of the page [s].
    longest_clip: float = 15.0
    seed: int = 77


def signs(positions: Array, rotations: Array, body: Body, config: NoticedWearConfig) -> Array:
    """Three figures [3] of what trackers saw of a person for minutes.

    The median height of the headset while its wearer looks ahead [eye heights]; how far hands get from IK's shoulders (95th percentile), and how far
    those get that hang (90th), both [arm lengths], mean of both sides.
    """
    local, turns, _, _ = solve_ik.to_heading(positions, rotations)
    joints = solve_ik.solve(local, turns, body)
    ahead = np.abs(quaternion.to_matrix(turns[:, 0])[:, 1, 2]) < config.level
    reach = (local[:, 1:] - joints[:, 2:4]) / body.arm
    distance = np.linalg.norm(reach, axis=-1)
    hanging = reach[..., 1] < -config.hanging * distance
    height = np.median((local[:, 0, 1] / body.eye_height)[ahead if ahead.any() else slice(None)])
    farthest = [np.quantile(distance[:, side], 0.95) for side in (0, 1)]
    hung = [np.quantile(distance[hanging[:, side], side], 0.9) for side in (0, 1) if hanging[:, side].any()]
    return np.array([height, np.mean(farthest), np.mean(hung) if hung else np.nan])


class Reader:
    """From signs to faults: ridge regression."""

    def __init__(self, seen: Array, faults: Array, ridge: float) -> None:
        self._mean, self._deviation = np.nanmean(seen, axis=0), np.nanstd(seen, axis=0)
        standardised = self._standardised(seen)
        self._usual = faults.mean(axis=0)
        normal = standardised.T @ standardised + ridge * np.eye(seen.shape[1])
        self._weights = np.linalg.solve(normal, standardised.T @ (faults - self._usual))

    def __call__(self, seen: Array) -> Fault:
        return Fault(*(self._standardised(seen) @ self._weights + self._usual).tolist())

    def _standardised(self, seen: Array) -> Array:
        """A sign that was not seen says nothing."""
        return np.nan_to_num((seen - self._mean) / self._deviation)


def main(
    corpus: PreparedCorpus,
    recipe: TrainLearnedConfig,
    ik: FitIkConfig,
    config: NoticedWearConfig = NoticedWearConfig(),
    report: Callable[[str], None] = lambda _: None,
) -> list[list[str]]:
    """Rows of the table: errors in cm of people held out, as worn and with what was noticed corrected; people alike.

    People who only measure have columns of their own, by what is made of all the others.
    """
    trainable, elsewhere = splits.trainable(tuple(corpus.people)), splits.measured_only(tuple(corpus.people))

    def judged(group: tuple[str, ...]) -> Array:
        report(", ".join(group))
        return _judged(corpus, group, recipe, ik, config)

    home = [judged(group) for group in leave_one_out.groups_of(trainable, config.groups)]
    away = judged(elsewhere) if elsewhere else np.full((1, len(FAULTS), 2, 2), np.nan)
    rows = []
    for label, at_home, another in zip(FAULTS, np.concatenate(home).mean(axis=0), away.mean(axis=0), strict=True):
        rows.append([label, *(f"{value:.2f}" for value in (*at_home[0], *at_home[1], *another[1]))])
    return rows


@dataclass(frozen=True)
class _Worn:
    """By whom, with what wrong, and what of it is taken back."""

    wearer: Wearer
    fault: Fault
    noticed: Fault


@dataclass(frozen=True)
class _Network:
    """Ours, and how far back it looks [s]."""

    network: CorrectionNetwork
    window_seconds: tuple[float, ...]


def _judged(corpus: PreparedCorpus, group: tuple[str, ...], recipe: TrainLearnedConfig, ik: FitIkConfig, config: NoticedWearConfig) -> Array:
    """By what is made of the others, of each of a group who is worn long enough: errors [P, faults, 2, 2] of IK and ours, as worn and corrected, in cm."""
    others = tuple(name for name in splits.trainable(tuple(corpus.people)) if name not in group)
    with fitted_kinematics.used(fitted_kinematics.fit(corpus, others, ik)):
        made = _Network(train_learned.train(corpus, others, recipe), recipe.window_seconds)
        worn = [_wearers(corpus, name, config) for name in others if _is_worn_long(corpus, name, config)]
        reader = Reader(*(np.concatenate(column) for column in zip(*worn, strict=True)), config.ridge)
        found = []
        for name in group:
            if not _is_worn_long(corpus, name, config):
                continue
            found.append(np.zeros((len(FAULTS), 2, 2)))
            for row, fault in zip(found[-1], FAULTS.values(), strict=True):
                wearer = fault.worn(draw_wearer(TrackerConfig(), np.random.default_rng([config.seed, 1, _key(name)])))
                noticed = reader(_signs_of(corpus, name, wearer, fault.eye_height, config))
                for column, believed in enumerate((Fault(), noticed)):
                    row[:, column] = _errors(corpus, name, _Worn(wearer, fault, believed), made, config)
    return np.array(found).reshape(-1, len(FAULTS), 2, 2)


def _key(name: str) -> int:
    """Of a person, for chance."""
    return zlib.crc32(name.encode())


def _is_worn_long(corpus: PreparedCorpus, name: str, config: NoticedWearConfig) -> bool:
    frames = sum(each.stop - each.start for each in map(corpus.clip_slice, corpus.clips_of({name})))
    return frames / corpus.rate_hz >= 60 * config.fewest_minutes


def _signs_of(corpus: PreparedCorpus, name: str, wearer: Wearer, height_error: float, config: NoticedWearConfig) -> Array:
    frames = np.concatenate([np.arange(each.start, each.stop, config.stride) for each in map(corpus.clip_slice, corpus.clips_of({name}))])
    tracked = simulate(corpus.positions[frames], corpus.rotations[frames], wearer, TrackerConfig(), np.random.default_rng(config.seed))
    person = corpus.people[name]
    return signs(*tracked, body_from_calibration(np.array(person.eye_height * (1 + height_error)), np.array(person.arm_span)), config)


def _wearers(corpus: PreparedCorpus, name: str, config: NoticedWearConfig) -> tuple[Array, Array]:
    """Signs [W, 3] and faults [W, 3] of one person with headsets and heights as they come: a third each with both, one, or the other wrong."""
    seen, faults = [], []
    for number in range(config.wearers):
        random = np.random.default_rng([config.seed, _key(name), number])
        up, back, height = random.normal(size=3) * [config.offset, config.offset, config.height] * [[1, 1, 1], [0, 0, 1], [1, 1, 0]][number % 3]
        wearer = Fault(up, back).worn(draw_wearer(TrackerConfig(), random))
        seen.append(_signs_of(corpus, name, wearer, height, config))
        faults.append([up, back, height])
    return np.array(seen), np.array(faults)


def _errors(corpus: PreparedCorpus, name: str, worn: _Worn, made: _Network, config: NoticedWearConfig) -> Array:
    """Mean errors of IK and of the network [2], where so much was noticed and is taken back."""
    person, noticed = corpus.people[name], worn.noticed
    eye_height = person.eye_height * (1 + worn.fault.eye_height) / (1 + noticed.eye_height)
    body = body_from_calibration(np.array(eye_height), np.array(person.arm_span))
    found = []
    for clip in corpus.clips_of({name}):
        whole = corpus.clip_slice(clip)
        frames = slice(whole.start, min(whole.stop, whole.start + round(config.longest_clip * corpus.rate_hz)))
        positions, rotations = simulate(
            corpus.positions[frames], corpus.rotations[frames], worn.wearer, TrackerConfig(), np.random.default_rng([config.seed, clip])
        )
        believed = np.broadcast_to([0.0, noticed.up, noticed.back], (len(positions), 3))
        positions[:, 0] -= quaternion.rotate(rotations[:, 0], believed)
        times = np.arange(len(positions)) / corpus.rate_hz
        worn_by = notice_hand_tilts.with_noticed_hands(body, positions, rotations, np.diff(times, prepend=0.0))
        vector, _ = frame_features(positions, rotations, worn_by)
        chosen = slice(None, None, config.judged_stride)
        inputs = network_input(vector, times, made.window_seconds)[chosen]
        truth = residual(corpus.truth(frames).astype(np.float64), positions, rotations, worn_by, vector)[chosen]
        count = len(truth)
        seen = HeldOut(
            inputs.astype(np.float32), truth.astype(np.float32), np.full(count, eye_height), np.full(count, name), np.full(count, clip)
        )
        found.append(np.stack([train_learned.ik_errors_cm(seen), train_learned.fitted_errors_cm(predict(made.network, seen.inputs), seen)], axis=1))
    return np.concatenate(found).mean(axis=(0, 2))


def write(rows: list[list[str]], page: Path = PAGE) -> None:
    """Renews the page's table."""
    page.write_text(renew(page.read_text(), {"noticed": table(["wrong, and not told [cm]", *COLUMNS], rows)}))
