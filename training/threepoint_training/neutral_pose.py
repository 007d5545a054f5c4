"""Does a neutral pose predict its person's error? Regression from where the wrists hang to the mean error of IK and of ours.

`npm run train -- --mocap DIR --ablate` calls this and renews the table of docs/training.md. Each person is predicted from the others.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from . import mirror, splits, train_learned
from .accuracy_tables import renew, table
from .features import ARM_LENGTH, HEADSET_HEIGHT, hand_positions
from .model import CorrectionNetwork
from .prepared_corpus import JOINTS, PreparedCorpus
from .residual import OUTPUTS
from .train_learned import HeldOut, TrainLearnedConfig
from .train_paper import predict as predict_joints
from .training_page import PAGE

Array = NDArray[np.float64]

COLUMNS = ("mean", "elbows", "shoulders", "spine", "pelvis")


@dataclass(frozen=True)
class NeutralPoseConfig:
    """Thresholds for a frame to be a neutral pose, and the regularisation of a regression over few people."""

    # The trunk's lean as a cosine, the height of the headset and of both wrists below it in eye heights, the wrists' speed [m/s].
    upright: float = 0.97
    head_height: float = 0.93
    hands_below: float = 0.37
    hand_speed: float = 1.0
    fewest_frames: int = 60
    # Ridge over standardised measures: counts as much as this many people whose bias is zero.
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
    return np.concatenate(standing) & hanging & (seen.inputs[:, HEADSET_HEIGHT] > config.head_height)


def _wrists(seen: HeldOut) -> tuple[Array, Array]:
    """Left and right wrist [F, 3] from the headset, heading frame [eye heights]."""
    left, right = np.moveaxis(hand_positions(seen.inputs) * seen.inputs[:, ARM_LENGTH, None, None].astype(np.float64), 1, 0)
    return left, right


def measure(seen: HeldOut, frames: NDArray[np.bool_]) -> Array:
    """What a calibration would measure [3]: where the wrists hang from the headset, both sides averaged, median over frames: out, up, back [eye
    heights]."""
    left, right = _wrists(seen)
    return np.median((left[frames] * mirror.POSITION + right[frames]) / 2, axis=0)


def bias(seen: HeldOut, output: NDArray[np.float32] | None = None) -> Array:
    """The mean error [6, 3] of IK's joints, or of this output: true minus estimated, left and right averaged, chest frame [eye heights]."""
    residual = (seen.targets - (0 if output is None else output)).reshape(-1, 6, 3).mean(axis=0)
    return (residual + mirror.joints(residual)) / 2


def predict(measures: Array, biases: Array, measured: Array, config: NeutralPoseConfig) -> Array:
    """The predicted bias [...] of a person with the measures `measured` [3], by ridge regression on others' measures [N, 3] and biases [N, ...].

    Only deviations from the others' mean measures count: a person of mean measures is predicted no bias.
    """
    mean, deviation = measures.mean(axis=0), np.maximum(measures.std(axis=0), 1e-6)
    others = (measures - mean) / deviation
    own = np.clip((measured - mean) / deviation, -config.furthest, config.furthest)
    flat = biases.reshape(len(biases), -1)
    weights = np.linalg.solve(others.T @ others + config.ridge * np.eye(others.shape[1]), others.T @ (flat - flat.mean(axis=0)))
    return (own @ weights).reshape(biases.shape[1:])


@dataclass(frozen=True)
class Standing:
    """A person who is seen in a neutral pose: all their frames, the measures [3] of that pose, and their bias [6, 3] under IK."""

    seen: HeldOut
    measured: Array
    bias: Array


def standing_people(corpus: PreparedCorpus, window_seconds: tuple[float, ...], config: NeutralPoseConfig) -> dict[str, Standing]:
    """The people of the training side who are seen in a neutral pose for long enough."""
    names = splits.training_people("A", tuple(corpus.people))
    people = train_learned.held_out(corpus, names, window_seconds)
    found = {}
    for name in names:
        person = people.subset(np.flatnonzero(people.people == name))
        frames = neutral_frames(corpus, name, person, config)
        if frames.sum() >= config.fewest_frames:
            found[name] = Standing(person, measure(person, frames), bias(person))
    if len(found) < 3:
        raise ValueError(f"neutral poses of three people are needed, {len(found)} of {len(names)} stand in one")
    return found


def main(
    corpus: PreparedCorpus,
    recipe: TrainLearnedConfig,
    networks: dict[tuple[str, ...], CorrectionNetwork],
    config: NeutralPoseConfig = NeutralPoseConfig(),
) -> list[list[str]]:
    """Rows of the table: MPJPE [cm], all people counted alike. networks: ours, by the people held out of each."""
    standing = standing_people(corpus, recipe.window_seconds, config)
    rows: dict[str, list[Array]] = {}

    def predicted(name: str, unknown: tuple[str, ...]) -> Array:
        others = [person for other, person in standing.items() if other not in unknown]
        return predict(np.stack([o.measured for o in others]), np.stack([o.bias for o in others]), standing[name].measured, config)

    def add(label: str, name: str, output: NDArray[np.float32], correction: Array) -> None:
        corrected = (output + correction.reshape(1, 18)).astype(np.float32)
        rows.setdefault(label, []).append(train_learned.fitted_errors_cm(corrected, standing[name].seen).mean(axis=0))

    for name, person in standing.items():
        solved = np.zeros((1, OUTPUTS), np.float32)
        add("IK", name, solved, np.zeros(18))
        add("IK, and what the neutral pose tells", name, solved, predicted(name, (name,)))
        add("IK, and the mean error of the others", name, solved, np.mean([p.bias for other, p in standing.items() if other != name], axis=0))
        add("IK, and one's own mean error (bound)", name, solved, person.bias)
    for unknown, network in networks.items():
        for name in sorted(set(unknown) & set(standing)):
            output = predict_joints(network, standing[name].seen.inputs)
            add("ours", name, output, np.zeros(18))
            # The network has made its share of the correction; the pose speaks for the rest.
            add("ours, and what the neutral pose tells", name, output, (1 - recipe.shrinkage) * predicted(name, unknown))
            add("ours, and one's own mean error (bound)", name, output, bias(standing[name].seen, output))
    shown = []
    for label, errors in rows.items():
        mean = np.mean(errors, axis=0)
        groups = (mean, mean[:2], mean[2:4], mean[4:5], mean[5:6])
        shown.append([f"{label} ({len(errors)} people)" if "," not in label else label, *(f"{group.mean():.2f}" for group in groups)])
    return shown


def write(rows: list[list[str]], page: Path = PAGE) -> None:
    """Renews the page's table."""
    page.write_text(renew(page.read_text(), {"neutral": table(["cm", *COLUMNS], rows)}))
