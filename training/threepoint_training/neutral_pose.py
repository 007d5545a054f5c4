"""What a neutral pose tells of its person: is their error under IK known from where they stand and let their hands hang?

`npm run train -- --mocap DIR --ablate` calls this and renews the table of docs/training.md. Everybody is predicted from the others.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from . import people, train_learned
from .accuracy_tables import renew, table
from .features import IK_JOINTS
from .prepared_corpus import JOINTS, PreparedCorpus
from .train_learned import HeldOut

Array = NDArray[np.float64]

PAGE = Path(__file__).parents[2] / "docs/training.md"

COLUMNS = ("mean", "elbows", "shoulders", "spine", "pelvis")

_MIRROR = np.array([-1.0, 1.0, 1.0])
_SWAP = [1, 0, 3, 2, 4, 5]


@dataclass(frozen=True)
class NeutralPoseConfig:
    """When somebody stands in a neutral pose, and how firmly the few people are believed."""

    # The trunk's lean as a cosine, the height of the headset and of both wrists below it in eye heights, the wrists' speed [m/s].
    upright: float = 0.97
    head_height: float = 0.93
    hands_below: float = 0.37
    hand_speed: float = 1.0
    fewest_frames: int = 60
    # Ridge over standardised measures: as many people as this speak for nothing.
    ridge: float = 4.0
    # No measure counts as further from the mean than this many deviations.
    furthest: float = 2.0


def neutral_frames(corpus: PreparedCorpus, name: str, seen: HeldOut, config: NeutralPoseConfig) -> NDArray[np.bool_]:
    """Which of this person's frames, in the order of `held_out`, are neutral poses."""
    standing = []
    for clip in corpus.clips_of({name}):
        positions = corpus.positions[corpus.clip_slice(clip)].astype(np.float64)
        trunk = positions[:, JOINTS.index("neck")] - positions[:, JOINTS.index("hips")]
        hands = positions[:, [JOINTS.index("leftHand"), JOINTS.index("rightHand")]]
        speed = np.linalg.norm(np.gradient(hands, 1 / corpus.rate_hz, axis=0), axis=-1).max(axis=1)
        standing.append((trunk[:, 1] > config.upright * np.linalg.norm(trunk, axis=-1)) & (speed < config.hand_speed))
    left, right = _wrists(seen)
    hanging = np.maximum(left[:, 1], right[:, 1]) < -config.hands_below
    return np.concatenate(standing) & hanging & (seen.inputs[:, 0] > config.head_height)


def _wrists(seen: HeldOut) -> tuple[Array, Array]:
    """From the headset, heading frame, eye heights."""
    arm = seen.inputs[:, 45:46].astype(np.float64)
    return seen.inputs[:, 7:10] * arm, seen.inputs[:, 16:19] * arm


def measure(seen: HeldOut, frames: NDArray[np.bool_]) -> Array:
    """What a calibration would write down [3]: where the wrists hang from the headset, mean of both sides: out, up, back [eye heights]."""
    left, right = _wrists(seen)
    return np.median((left[frames] * _MIRROR + right[frames]) / 2, axis=0)


def bias(seen: HeldOut) -> Array:
    """The mean of what is true minus what IK says [6, 3], the same for both sides [eye heights]."""
    residual = (seen.targets - seen.inputs[:, IK_JOINTS]).reshape(-1, 6, 3).mean(axis=0)
    return (residual + residual[_SWAP] * _MIRROR) / 2


def predict(measures: Array, biases: Array, measured: Array, config: NeutralPoseConfig) -> Array:
    """The bias of somebody measured so, from others' measures [N, 3] and biases [N, ...]: ridge around no bias at all."""
    mean, deviation = measures.mean(axis=0), np.maximum(measures.std(axis=0), 1e-6)
    others = (measures - mean) / deviation
    own = np.clip((measured - mean) / deviation, -config.furthest, config.furthest)
    flat = biases.reshape(len(biases), -1)
    weights = np.linalg.solve(others.T @ others + config.ridge * np.eye(others.shape[1]), others.T @ (flat - flat.mean(axis=0)))
    return (own @ weights).reshape(biases.shape[1:])


def run(corpus: PreparedCorpus, config: NeutralPoseConfig = NeutralPoseConfig()) -> list[list[str]]:
    """Rows of the table: MPJPE [cm] on people of the training side who are seen in a neutral pose, everybody counted alike."""
    names = tuple(sorted(set(corpus.people) - set(people.FOLDS["A"])))
    everybody = train_learned.held_out(corpus, names, (0.0,))
    seen, measures, biases = [], [], []
    for name in names:
        person = everybody.subset(np.flatnonzero(everybody.people == name))
        frames = neutral_frames(corpus, name, person, config)
        if frames.sum() >= config.fewest_frames:
            seen.append(person)
            measures.append(measure(person, frames))
            biases.append(bias(person))
    if len(seen) < 3:
        raise ValueError(f"neutral poses of three people are needed, {len(seen)} of {len(names)} stand in one")
    m, b = np.stack(measures), np.stack(biases)
    rows: dict[str, list[Array]] = {}
    for number, person in enumerate(seen):
        others = np.arange(len(seen)) != number
        corrections = {
            "IK": np.zeros((6, 3)),
            "+ the mean error of the others": b[others].mean(axis=0),
            "+ what the neutral pose tells": predict(m[others], b[others], m[number], config),
            "+ one's own mean error (bound)": b[number],
        }
        for label, correction in corrections.items():
            output = (person.inputs[:, IK_JOINTS] + correction.reshape(1, 18)).astype(np.float32)
            rows.setdefault(label, []).append(train_learned.errors_cm(output, person).mean(axis=0))
    shown = []
    for label, errors in rows.items():
        mean = np.mean(errors, axis=0)
        groups = (mean, mean[:2], mean[2:4], mean[4:5], mean[5:6])
        shown.append([f"{label}, {len(seen)} people" if label == "IK" else label, *(f"{group.mean():.2f}" for group in groups)])
    return shown


def write(rows: list[list[str]], page: Path = PAGE) -> None:
    """Renews the page's table."""
    page.write_text(renew(page.read_text(), {"neutral": table(["cm", *COLUMNS], rows)}))
