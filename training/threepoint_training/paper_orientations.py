"""The body by section 3.5 of the paper; the twin of src/threepoint/core/estimation/methods/paper-orientations.ts."""

import numpy as np

from . import quaternion
from .arrays import Array
from .shared_constants import LIMB
from .skeleton import Body, rest_offsets
from .solve_ik import normalise, two_bone_elbow

# The drawn joints, in the order of `paper_body`.
DRAWN_JOINTS = (
    "hips", "chest", "neck", "head",
    "leftUpperArm", "leftLowerArm", "leftHand", "rightUpperArm", "rightLowerArm", "rightHand",
)  # fmt: skip


def _align(q: Array, own: Array, along: Array) -> Array:
    """Rotations q [F, 4], turned by the smallest angle that takes their own direction `own` [3] to `along` [F, 3]."""
    present, wanted = normalise(quaternion.rotate(q, np.broadcast_to(own, along.shape))), normalise(along)
    axis, cosine = np.cross(present, wanted), np.sum(present * wanted, axis=-1, keepdims=True)
    between = np.concatenate([axis, 1 + cosine], axis=-1)
    return quaternion.multiply(between / np.linalg.norm(between, axis=-1, keepdims=True), q)


def paper_body(estimated: Array, positions: Array, rotations: Array, body: Body) -> Array:
    """DRAWN_JOINTS [F, 10, 3] of one body from the six estimated joints [F, 6, 3] and the trackers, floor frame [m]."""
    rest = {joint: np.array(offset) for joint, offset in rest_offsets(body).items()}
    lower_back, thorax = rest["spine"] + rest["chest"], rest["upperChest"] + rest["neck"]

    def turned(q: Array, offset: Array) -> Array:
        return quaternion.rotate(q, np.broadcast_to(offset, (len(q), 3)))

    middle, line = estimated[:, 2:4].mean(axis=1), estimated[:, 3] - estimated[:, 2]
    spine, pelvis = estimated[:, 4], estimated[:, 5]
    head_joint = positions[:, 0] - turned(rotations[:, 0], rest["eyesInHead"])
    neck_turn = _align(rotations[:, 0], rest["head"], head_joint - middle)
    shoulders_turn = _align(neck_turn, np.array([1.0, 0.0, 0.0]), line)
    spine_turn = _align(shoulders_turn, thorax, middle - spine)
    chest = pelvis + turned(_align(shoulders_turn, lower_back, spine - pelvis), lower_back)
    neck = chest + turned(spine_turn, thorax)
    joints = [pelvis, chest, neck, neck + turned(neck_turn, rest["head"])]
    upper_arm, forearm = (float(np.linalg.norm(rest[f"right{part}"])) for part in ("LowerArm", "Hand"))
    longest, shortest = (upper_arm + forearm) * LIMB["straightest"], abs(upper_arm - forearm) + LIMB["maxBent"]
    for number, side in enumerate(("left", "right")):
        root = neck + turned(spine_turn, rest[f"{side}Shoulder"] - rest["neck"])
        shoulder, wrist = root + turned(shoulders_turn, rest[f"{side}UpperArm"]), positions[:, 1 + number]
        lengths = np.full((len(wrist), 1), upper_arm), np.full((len(wrist), 1), forearm)
        towards = estimated[:, number] - shoulder
        elbow = two_bone_elbow(shoulder, wrist, *lengths, towards, thorax=np.broadcast_to(np.eye(3), (len(wrist), 3, 3)))
        reach = np.clip(np.linalg.norm(wrist - shoulder, axis=-1, keepdims=True), shortest, longest)
        joints += [shoulder, elbow, shoulder + reach * normalise(wrist - shoulder)]
    return np.stack(joints, axis=1)
