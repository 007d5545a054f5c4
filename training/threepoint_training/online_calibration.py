"""Errors under a misplaced headset or a wrong calibration, as worn and after correcting the headset's rise that the
page estimates over minutes.

`npm run tool -- train --mocap DIR --online-calibration` calls this and renews the table of docs/accuracy.md. Each group of
people is held out in turn, with usual reach, IK and network from everyone else.
"""

import zlib
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from . import estimate_headset_rise, fitted_kinematics, quaternion, splits, train_learned
from .accuracy_tables import renew, table
from .arrays import Array
from .fit_ik import FitIkConfig
from .model import CorrectionNetwork
from .prepared_corpus import PreparedCorpus
from .shared_constants import HEADSET_RISE, REPOSITORY
from .simulate_trackers import TrackerConfig, Wearer, draw_wearer, simulate
from .skeleton import Body, body_from_calibration
from .train_learned import TrainLearnedConfig

PAGE = REPOSITORY / "docs/accuracy.md"


@dataclass(frozen=True)
class Fault:
    """A headset that sits `up` above its assumed place [m], or a calibrated arm span with this relative error."""

    up: float = 0.0
    arm_span: float = 0.0

    def worn(self, wearer: Wearer) -> Wearer:
        """This wearer with the headset so misplaced."""
        return replace(wearer, eyes_in_head=wearer.eyes_in_head + np.array([0.0, self.up, 0.0]))


FAULTS = {
    "nothing": Fault(),
    "headset 3 cm up": Fault(up=0.03),
    "headset 3 cm down": Fault(up=-0.03),
    "arm span −5 %": Fault(arm_span=-0.05),
    "arm span +5 %": Fault(arm_span=0.05),
}
COLUMNS = ("IK", "corrected", "learned", "corrected", "learned, another laboratory", "corrected")


@dataclass(frozen=True)
class OnlineCalibrationConfig:
    """Groups that are held out, who has enough recording time, and which frames and simulated wearers are used."""

    # The number of groups that are held out in turn.
    groups: int = 4
    # People with less recording time are left out: an estimate takes minutes of motion.
    fewest_minutes: float = 1.3
    # Every how many-th frame (of 60 a second) is used for reaches, and for errors.
    stride: int = 6
    judged_stride: int = 24
    # Simulated wearers of each person, for the usual reach.
    wearers: int = 3
    # No more of each clip is used for errors, as in all figures of the page [s].
    longest_clip: float = 15.0
    seed: int = 77


def usual_reach(
    corpus: PreparedCorpus, people: tuple[str, ...], config: OnlineCalibrationConfig = OnlineCalibrationConfig()
) -> float:
    """Mean distance from IK's shoulders to the wrists while arms hang [arm lengths], over these people's simulated
    wearers; without people of enough recording time that of headset-rise.json.
    """
    known = [name for name in people if corpus.minutes_of({name}) >= config.fewest_minutes]
    worn = [_draw_worn(name, Fault(), number, config) for name in known for number in range(1, 1 + config.wearers)]
    reaches = [_hanging_reach(corpus, each, HEADSET_RISE["usualReach"], config).mean() for each in worn]
    return float(np.mean(reaches)) if reaches else HEADSET_RISE["usualReach"]


def main(
    corpus: PreparedCorpus,
    recipe: TrainLearnedConfig,
    ik: FitIkConfig,
    config: OnlineCalibrationConfig = OnlineCalibrationConfig(),
    report: Callable[[str], None] = lambda _: None,
) -> list[list[str]]:
    """Rows of the table: mean errors in cm on people held out, as worn and corrected, each person weighing the same.

    Evaluation-only subjects (never trained on) have columns of their own, with IK and network trained on everyone else.
    """
    trainable, elsewhere = splits.trainable(tuple(corpus.people)), splits.evaluation_only(tuple(corpus.people))

    def judged(group: tuple[str, ...]) -> Array:
        report(f"held out: {', '.join(group)}")
        return _judged(corpus, group, recipe, ik, config)

    reach = usual_reach(corpus, trainable, config)
    report(
        f"usual reach of the people that the page's IK is fitted on: {reach:.3f} (headset-rise.json: {HEADSET_RISE['usualReach']})"
    )
    home = [judged(group) for group in splits.groups_in_turn(trainable, config.groups)]
    away = judged(elsewhere) if elsewhere else np.full((1, len(FAULTS), 2, 2), np.nan)
    rows = []
    for label, at_home, another in zip(FAULTS, np.concatenate(home).mean(axis=0), away.mean(axis=0), strict=True):
        rows.append([label, *(f"{value:.2f}" for value in (*at_home[0], *at_home[1], *another[1]))])
    return rows


@dataclass(frozen=True)
class _Worn:
    """A simulated wearer of a person, with a fault; rise: how far above its usual place the headset is taken to sit
    [m].
    """

    name: str
    wearer: Wearer
    fault: Fault
    rise: float = 0.0


@dataclass(frozen=True)
class _Network:
    """Our network, and the ages of the frames in its input [s]."""

    network: CorrectionNetwork
    window_seconds: tuple[float, ...]


def _judged(
    corpus: PreparedCorpus,
    group: tuple[str, ...],
    recipe: TrainLearnedConfig,
    ik: FitIkConfig,
    config: OnlineCalibrationConfig,
) -> Array:
    """Errors [P, faults, 2, 2] in cm for each person of `group` with enough recording time, with IK and network trained
    on everyone else; last axes: (IK, learned), (as worn, corrected).
    """
    others = tuple(name for name in splits.trainable(tuple(corpus.people)) if name not in group)
    with fitted_kinematics.used(fitted_kinematics.fit(corpus, others, ik)):
        made = _Network(train_learned.train(corpus, others, recipe), recipe.window_seconds)
        usual = usual_reach(corpus, others, config)
        found = []
        for name in group:
            if corpus.minutes_of({name}) < config.fewest_minutes:
                continue
            found.append(np.zeros((len(FAULTS), 2, 2)))
            for row, fault in zip(found[-1], FAULTS.values(), strict=True):
                worn = _draw_worn(name, fault, 0, config)
                reach = _hanging_reach(corpus, worn, usual, config)
                rise = estimate_headset_rise.rise(reach, _body(corpus, name, fault).arm, usual)
                for column, each in enumerate((worn, replace(worn, rise=rise.item()))):
                    row[:, column] = _errors(corpus, each, made, config)
    return np.array(found).reshape(-1, len(FAULTS), 2, 2)


def _key(name: str) -> int:
    """A number that a person's generators are seeded with."""
    return zlib.crc32(name.encode())


def _draw_worn(name: str, fault: Fault, number: int, config: OnlineCalibrationConfig) -> _Worn:
    """The person's simulated wearer of this number, with this fault."""
    return _Worn(
        name, fault.worn(draw_wearer(TrackerConfig(), np.random.default_rng([config.seed, _key(name), number]))), fault
    )


def _hanging_reach(corpus: PreparedCorpus, worn: _Worn, usual: float, config: OnlineCalibrationConfig) -> Array:
    """The reach [2] of the left and the right hanging arm estimated after all clips of a person [arm lengths]."""
    frames = corpus.frames_of({worn.name}, config.stride)
    tracked = simulate(
        corpus.positions[frames],
        corpus.rotations[frames],
        worn.wearer,
        TrackerConfig(),
        np.random.default_rng(config.seed),
    )
    reaches = estimate_headset_rise.reaches(*tracked, _body(corpus, worn.name, worn.fault))
    return estimate_headset_rise.hanging_reach(reaches, np.full(len(frames), config.stride / corpus.rate_hz), usual)[-1]


def _body(corpus: PreparedCorpus, name: str, fault: Fault) -> Body:
    person = corpus.people[name]
    return body_from_calibration(np.array(person.eye_height), np.array(person.arm_span * (1 + fault.arm_span)))


def _errors(corpus: PreparedCorpus, worn: _Worn, made: _Network, config: OnlineCalibrationConfig) -> Array:
    """Mean errors [2] in cm of IK and of the network over all clips of the person."""
    name, body = worn.name, _body(corpus, worn.name, worn.fault)
    found = []
    for clip in corpus.clips_of({name}):
        whole = corpus.clip_slice(clip)
        frames = slice(whole.start, min(whole.stop, whole.start + round(config.longest_clip * corpus.rate_hz)))
        positions, rotations = simulate(
            corpus.positions[frames],
            corpus.rotations[frames],
            worn.wearer,
            TrackerConfig(),
            np.random.default_rng([config.seed, clip]),
        )
        positions[:, 0] -= quaternion.rotate(
            rotations[:, 0], np.broadcast_to([0.0, worn.rise, 0.0], (len(positions), 3))
        )
        whole_clip = train_learned.clip_frames(corpus, clip, (positions, rotations), body, made.window_seconds)
        seen = whole_clip.subset(slice(None, None, config.judged_stride))
        errors = train_learned.ik_errors_cm(seen), train_learned.errors_cm(made.network, seen)
        found.append(np.stack(errors, axis=1))
    return np.concatenate(found).mean(axis=(0, 2))


def write(rows: list[list[str]], page: Path = PAGE) -> None:
    """Renews the page's table."""
    page.write_text(renew(page.read_text(), {"online-calibration": table(["unknown error [cm]", *COLUMNS], rows)}))
