"""Fits body proportions and IK parameters without the people held out, so that errors are those of new people."""

import json
import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import numpy as np

from . import fit_ik, hand_tilt, mirror, quaternion, skeleton, solve_ik
from .fit_ik import FitIkConfig
from .prepare import EYES_FROM_HEAD_JOINT
from .prepared_corpus import JOINTS, PreparedCorpus, chest_axes_of, joints_of


@dataclass(frozen=True)
class Kinematics:
    """Body proportions and IK parameters, with the keys of their files in src/threepoint/core."""

    proportions: dict[str, Any]
    parameters: dict[str, Any]


def fit(
    corpus: PreparedCorpus, people: tuple[str, ...], config: FitIkConfig, report: Callable[[int], None] = lambda _: None
) -> Kinematics:
    """Fitted on these people; report(iterations done)."""
    proportions = fit_proportions(corpus, people)
    sample = fit_ik.sample(corpus, people, proportions, config.frames_per_person, config.seed)
    return Kinematics(proportions, fit_ik.fit(sample, config, lambda iteration, _: report(iteration + 1)))


@contextmanager
def used(fitted: Kinematics) -> Iterator[None]:
    """A context in which skeletons and IK use these instead of the page's."""
    saved = skeleton.load_proportions, solve_ik.load_parameters
    skeleton.load_proportions, solve_ik.load_parameters = (lambda: fitted.proportions), (lambda: fitted.parameters)
    try:
        yield
    finally:
        skeleton.load_proportions, solve_ik.load_parameters = saved


def write(fitted: Kinematics) -> None:
    """Replaces the page's body proportions and IK parameters."""
    skeleton.PROPORTIONS_FILE.write_text(_compact_json(fitted.proportions))
    solve_ik.PARAMETERS_FILE.write_text(_compact_json(fitted.parameters))


def _compact_json(content: Any) -> str:
    """JSON with a line per innermost list."""

    def on_one_line(match: re.Match[str]) -> str:
        return f"[{' '.join(match[1].split())}]"

    return re.sub(r"\[\s+([^\[\]{}]*?)\s+\]", on_one_line, json.dumps(content, indent=2)) + "\n"


def fit_proportions(corpus: PreparedCorpus, people: tuple[str, ...]) -> dict[str, Any]:
    """The proportions of the average of these people; left and right averaged."""
    rows = []
    for name in people:
        person = corpus.people[name]
        positions = corpus.positions[corpus.frames_of({name})].astype(np.float64)
        joint = joints_of(positions)
        # Rows are the axes: chest @ v is v in the chest frame.
        chest = np.stack(chest_axes_of(joint), axis=1)

        def mean_in_chest(v: np.ndarray, chest: np.ndarray = chest) -> np.ndarray:
            return np.einsum("fij,fj->fi", chest, v).mean(axis=0)

        def length(a: str, b: str, joint: dict[str, np.ndarray] = joint) -> float:
            return float(np.linalg.norm(joint[a] - joint[b], axis=-1).mean())

        left = mean_in_chest(joint["leftUpperArm"] - joint["neck"]) * mirror.POSITION
        right = mean_in_chest(joint["rightUpperArm"] - joint["neck"])
        shoulder = (left + right) / 2
        shoulder *= (length("neck", "leftUpperArm") + length("neck", "rightUpperArm")) / 2 / np.linalg.norm(shoulder)
        neck_to_head = mean_in_chest(joint["head"] - joint["neck"])
        neck_to_head[0] = 0.0
        neck_to_head *= length("neck", "head") / np.linalg.norm(neck_to_head)
        upper = length("leftUpperArm", "leftLowerArm") + length("rightUpperArm", "rightLowerArm")
        fore = length("leftLowerArm", "leftHand") + length("rightLowerArm", "rightHand")
        trunk = length("hips", "spine") + length("spine", "chest") + length("chest", "neck")
        tilts = _standing_tilts(corpus, name)
        eyes = person.eye_height - (trunk + neck_to_head[1] + EYES_FROM_HEAD_JOINT[1])
        rows.append(
            np.array(
                [eyes, length("hips", "spine"), length("spine", "chest"), length("chest", "neck"),
                 neck_to_head[1], -neck_to_head[2], shoulder[0], shoulder[1], -shoulder[2]]
            ) / person.eye_height
        )  # fmt: skip
        left_hand, right_hand = hand_tilt.ForearmMeans(corpus, (name,)).of(name)
        hand = (left_hand * mirror.TILT + right_hand) / 2
        rows[-1] = np.concatenate(
            [
                rows[-1],
                [
                    upper / (upper + fore),
                    EYES_FROM_HEAD_JOINT[1] / person.eye_height,
                    -EYES_FROM_HEAD_JOINT[2] / person.eye_height,
                    *tilts,
                    *hand,
                ],
            ]
        )
    mean = [round(float(value), 5) for value in np.mean(rows, axis=0)]
    root = 0.012  # The clavicle starts two centimetres beside the breastbone's middle.
    return {
        "hipsHeight": mean[0],
        "hipsToSpine": mean[1],
        "spineToChest": mean[2],
        "chestToNeck": mean[3],
        "neckToHead": [mean[4], mean[5]],
        "clavicleRoot": root,
        "clavicle": [round(mean[6] - root, 5), mean[7], mean[8]],
        "upperArmShare": mean[9],
        "eyesInHead": [mean[10], mean[11]],
        "thoraxTilt": mean[12],
        "lowerBackTilt": mean[13],
        "handTilt": mean[14:16],
    }


def _standing_tilts(corpus: PreparedCorpus, name: str) -> tuple[float, float]:
    """How far [rad] thorax and lower back lean forward when this person stands upright: the shape of the spine, not a
    posture.
    """
    frames = corpus.frames_of({name})
    positions = corpus.positions[frames].astype(np.float64)
    head_height = positions[:, JOINTS.index("head"), 1] + EYES_FROM_HEAD_JOINT[1]
    standing = np.abs(head_height / corpus.people[name].eye_height - 1) < 0.04
    if not standing.any():
        standing[:] = True
    yaw = quaternion.conjugate(quaternion.heading(corpus.rotations[frames][standing, 0].astype(np.float64)))

    def tilt(lower: str, upper: str) -> float:
        segment = quaternion.rotate(
            yaw, positions[standing][:, JOINTS.index(upper)] - positions[standing][:, JOINTS.index(lower)]
        )
        return float(np.median(np.arctan2(-segment[:, 2], segment[:, 1])))

    return tilt("chest", "neck"), tilt("hips", "chest")
