"""The pose that rotations are counted from: taken from a frame, brought to face forward, and refused where it is no
T-pose.
"""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from . import quaternion
from .mocap_rules import RULES
from .motion import MocapError, Motion

Points = Mapping[str, NDArray[np.float64]]

_UP = np.array([0.0, 1.0, 0.0])
_RIGHT = np.array([1.0, 0.0, 0.0])
_HOW = (
    "Where only the axes differ, give “up” and “forward” in a skeleton map; where the bones lie otherwise, “restFrame” (a frame in T-pose) or "
    "“restPose” (its angles): docs/accuracy.md"
)


def take_as_rest(motion: Motion, positions: NDArray[np.float64], rotations: NDArray[np.float64]) -> Motion:
    """Returns the motion relative to a rest pose: its joints [joints, 3] and global rotations [joints, 4] in the file's
    axes.
    """
    back = np.broadcast_to(quaternion.conjugate(rotations), motion.rotations.shape)
    return replace(
        motion, rest_positions=positions - positions[0], rotations=quaternion.multiply(motion.rotations, back)
    )


def rest_from_frame(motion: Motion, frame: int, source: Motion, where: str) -> Motion:
    """Returns the motion relative to a frame of a source with the same joints; frames count from 1."""
    if not 1 <= frame <= len(source.positions):
        raise MocapError(f"{where}: restFrame {frame}, but there are {len(source.positions)} frames")
    missing = [name for name in motion.names if name not in source.names]
    if missing:
        raise MocapError(f"{where}: no joint “{missing[0]}”, so its restFrame is of another skeleton")
    order = [source.index(name) for name in motion.names]
    return take_as_rest(motion, source.positions[frame - 1, order], source.rotations[frame - 1, order])


def face_forward(motion: Motion, joints: Mapping[str, str], floor_from_file: NDArray[np.float64]) -> Motion:
    """Rotates the rest pose to face forward: a pose taken from a frame has the yaw of the person in it."""
    left, right = (motion.rest_positions[motion.index(joints[f"{side}UpperArm"])] for side in ("left", "right"))
    across = floor_from_file @ (right - left)
    yaw = np.arctan2(-across[2], across[0])
    ours = quaternion.from_axis_angle(_UP, np.array(-yaw))
    turn = quaternion.multiply(
        quaternion.conjugate(quaternion.from_matrix(floor_from_file)),
        quaternion.multiply(ours, quaternion.from_matrix(floor_from_file)),
    )
    rest = quaternion.rotate(np.broadcast_to(turn, (*motion.rest_positions.shape[:-1], 4)), motion.rest_positions)
    back = np.broadcast_to(quaternion.conjugate(turn), motion.rotations.shape)
    return replace(motion, rest_positions=rest, rotations=quaternion.multiply(motion.rotations, back))


def _direction(v: NDArray[np.float64]) -> NDArray[np.float64]:
    return v / max(float(np.linalg.norm(v)), 1e-12)


def _described(v: NDArray[np.float64]) -> str:
    """A direction of a body that faces forward, in a word."""
    axis = int(np.argmax(np.abs(v)))
    return (("to the left", "to the right"), ("down", "up"), ("forward", "backward"))[axis][int(v[axis] > 0)]


def check_rest(rest: Points, joints: Mapping[str, str], where: str) -> None:
    """
    Raises MocapError where joints at rest [m], +Y up, facing −Z, are no person in T-pose, with arms anywhere between
    level and hanging: a bone of no length, a trunk that lies, shoulders that are not left and right, raised or folded
    arms, legs that do not stand.
    """
    for near, far in (("hips", "chest"), ("chest", "neck"), ("neck", "head")):
        if np.linalg.norm(rest[far] - rest[near]) < RULES["shortestBone"]:
            raise MocapError(
                f"{where}: {joints[far]} ({far}) lies on {joints[near]} ({near}) in the rest pose: the file lost a bone of the trunk, and head and "
                "shoulders would be too low. Take the original (ASF/AMC), or name other joints in a skeleton map: docs/accuracy.md"
            )

    def refuse(what: str, should: str) -> MocapError:
        return MocapError(f"{where}: the rest pose is no T-pose: {what} instead of {should}. {_HOW}")

    trunk = _direction(rest["neck"] - rest["hips"])
    if trunk @ _UP < 0.7:
        raise refuse(f"the trunk, {joints['hips']} to {joints['neck']}, points {_described(trunk)}", "up")
    across = rest["rightUpperArm"] - rest["leftUpperArm"]
    if _direction(across) @ _RIGHT < 0.7 or np.linalg.norm(across) < 0.1:
        is_so = "lie on each other" if np.linalg.norm(across) < 0.02 else f"lie {_described(across)} of each other"
        raise refuse(
            f"the shoulders, {joints['leftUpperArm']} and {joints['rightUpperArm']}, {is_so}", "left and right"
        )
    for side, outward in (("left", -_RIGHT), ("right", _RIGHT)):
        shoulder, elbow, hand = (rest[f"{side}{part}"] for part in ("UpperArm", "LowerArm", "Hand"))
        for near, far in (("UpperArm", "LowerArm"), ("LowerArm", "Hand")):
            if np.linalg.norm(rest[f"{side}{far}"] - rest[f"{side}{near}"]) < RULES["shortestBone"]:
                raise MocapError(
                    f"{where}: {joints[side + far]} ({side}{far}) lies on {joints[side + near]} ({side}{near}) in the rest pose: the file lost a "
                    f"bone of the {side} arm. Take the original, or name other joints in a skeleton map: docs/accuracy.md"
                )
        arm = _direction(hand - shoulder)
        if arm @ _UP > 0.5 or arm @ outward < -0.3:
            raise refuse(
                f"the {side} arm, {joints[f'{side}UpperArm']} to {joints[f'{side}Hand']}, points {_described(arm)}",
                "sideways",
            )
        if _direction(elbow - shoulder) @ _direction(hand - elbow) < 0:
            raise refuse(f"the {side} arm is folded at {joints[f'{side}LowerArm']}", "straight")
        if f"{side}UpperLeg" in rest and f"{side}Foot" in rest:
            leg = _direction(rest[f"{side}Foot"] - rest[f"{side}UpperLeg"])
            if leg @ _UP > -0.7:
                raise refuse(
                    f"the {side} leg, {joints[f'{side}UpperLeg']} to {joints[f'{side}Foot']}, points {_described(leg)}",
                    "down",
                )
