"""Inverse kinematics as docs/estimation.md states it, vectorised over frames; the twin of
src/threepoint/core/estimation/ik/solve-ik.ts.
"""

import json
from dataclasses import dataclass
from typing import Any

import numpy as np

from . import quaternion
from .arrays import Array
from .shared_constants import CORE, LIMB
from .shared_constants import IK as LIMITS
from .skeleton import Body

PARAMETERS_FILE = CORE / "estimation/ik/ik-parameters.json"


def load_parameters() -> dict[str, Any]:
    """The parameters the page uses."""
    return json.loads(PARAMETERS_FILE.read_text())


def normalise(v: Array) -> Array:
    """The vectors [..., 3] at length one; nothing stays nothing."""
    return v / np.maximum(np.linalg.norm(v, axis=-1, keepdims=True), 1e-12)


def _dot(a: Array, b: Array) -> Array:
    return np.sum(a * b, axis=-1, keepdims=True)


def _within(values: Array, limits: dict[str, float]) -> Array:
    return np.clip(values, limits["min"], limits["max"])


def _yaw_matrix(yaw: Array) -> Array:
    c, s = np.cos(yaw), np.sin(yaw)
    zero, one = np.zeros_like(yaw), np.ones_like(yaw)
    return np.stack([np.stack([c, zero, s], -1), np.stack([zero, one, zero], -1), np.stack([-s, zero, c], -1)], -2)


def _apply(m: Array, v: Array) -> Array:
    return np.einsum("...ij,...j->...i", m, v)


def to_heading(positions: Array, rotations: Array) -> tuple[Array, Array, Array, Array]:
    """Tracked points [F, 3, 3] and rotations [F, 3, 4] in the heading frame, with the heading's yaw (xyzw) and floor
    origin.
    """
    yaw = quaternion.heading(rotations[:, 0])
    origin = positions[:, 0] * np.array([1.0, 0.0, 1.0])
    inverse = np.broadcast_to(quaternion.conjugate(yaw)[:, None], rotations.shape)
    return quaternion.rotate(inverse, positions - origin[:, None]), quaternion.multiply(inverse, rotations), yaw, origin


@dataclass(frozen=True)
class _Points:
    """What the steps of one solution are given, heading frame [m]; hands relative to the head joint in arm lengths."""

    headset: Array
    wrists: Array  # [F, 2, 3]
    hands: Array  # rotation matrices [F, 2, 3, 3]
    head: Array  # rotation matrix [F, 3, 3]
    head_joint: Array
    left: Array
    right: Array

    @property
    def middle(self) -> Array:
        """Between the hands [F, 3]."""
        return (self.left + self.right) / 2

    @property
    def across(self) -> Array:
        """From the left to the right hand [F, 3]."""
        return self.right - self.left


def solve(positions: Array, rotations: Array, body: Body, parameters: dict[str, Any] | None = None) -> Array:
    """The six estimated joints [F, 6, 3] from tracked points in the heading frame, hands turned by their tilts; body:
    one for all, or one per frame.

    The numbered steps are those of docs/estimation.md.
    """
    k = parameters or load_parameters()
    points = _points(positions, rotations, body)
    turn = _turn_chest(points, k)
    thorax, lower_back = _lean_trunk(points, turn, body, k)
    neck = _place_neck(points, thorax, body, k)
    chest_joint, hips = _place_trunk(neck, thorax[..., :, 1], lower_back[..., :, 1], body)
    shoulders = [_place_shoulder(side, points, (neck, thorax), body, k) for side in (0, 1)]
    elbows = [_place_elbow(side, points, (shoulder, thorax), body, k) for side, shoulder in enumerate(shoulders)]
    return np.stack([*elbows, *shoulders, chest_joint, hips], axis=1)


def _points(positions: Array, rotations: Array, body: Body) -> _Points:
    headset, wrists = positions[:, 0], positions[:, 1:]
    turns = quaternion.to_matrix(rotations)
    head = turns[:, 0]
    head_joint = headset - _apply(head, np.broadcast_to(body.eyes_in_head, headset.shape))
    left, right = ((wrists[:, side] - head_joint) / body.arm for side in (0, 1))
    return _Points(headset, wrists, turns[:, 1:], head, head_joint, left, right)


def _turn_chest(points: _Points, k: dict[str, Any]) -> Array:
    """1. Chest yaw, turned by the hands: a rotation about +Y [F, 3, 3]."""
    middle, across = points.middle, points.across
    forward_x = k["yaw"][0] * across[:, 2] + k["yaw"][1] * middle[:, 0]
    forward_z = -1 - k["yaw"][0] * across[:, 0] + k["yaw"][1] * middle[:, 2]
    saturation = LIMITS["yawSaturation"]
    return _yaw_matrix(
        saturation * np.tanh(np.arctan2(-forward_x, np.maximum(-forward_z, LIMITS["minAhead"])) / saturation)
    )


def _lean_trunk(points: _Points, turn: Array, body: Body, k: dict[str, Any]) -> tuple[Array, Array]:
    """2. Lean: the frames of thorax and lower back [F, 3, 3], axes as columns."""
    middle, left, right = points.middle, points.left, points.right
    crouch = _within(1 - points.headset[:, 1] / body.eye_height[..., 0], LIMITS["crouch"])
    # The vertical components of the gaze (the head's −Z) and of the head's right axis.
    looking_down, right_up = points.head[..., 1, 2], points.head[..., 1, 0]
    sagittal = np.stack(
        [np.ones_like(crouch), looking_down, crouch, -middle[:, 2], -middle[:, 1], looking_down * crouch], -1
    )
    lateral = np.stack([right_up, middle[:, 0], right[:, 1] - left[:, 1]], -1)

    def frame(segment: dict[str, list[float]]) -> Array:
        alpha = _within(sagittal @ np.array(segment["forward"]), LIMITS["leanForward"])
        beta = _within(lateral @ np.array(segment["sideways"]), LIMITS["leanSideways"])
        sin_a, cos_a, sin_b, cos_b = np.sin(alpha), np.cos(alpha), np.sin(beta), np.cos(beta)
        x = np.stack([cos_b, -sin_b * cos_a, sin_b * sin_a], -1)
        y = np.stack([sin_b, cos_b * cos_a, -cos_b * sin_a], -1)
        z = np.stack([np.zeros_like(alpha), sin_a, cos_a], -1)
        return turn @ np.stack([x, y, z], -1)

    return frame(k["upper"]), frame(k["lower"])


def _place_neck(points: _Points, thorax: Array, body: Body, k: dict[str, Any]) -> Array:
    """4. Neck base [F, 3], below the head joint."""
    length = np.linalg.norm(body.neck_to_head, axis=-1, keepdims=True)
    rest = np.broadcast_to(body.neck_to_head / length, points.headset.shape)
    return points.head_joint - length * normalise(
        (1 - k["neck"]) * _apply(thorax, rest) + k["neck"] * _apply(points.head, rest)
    )


def _place_trunk(neck: Array, thorax_up: Array, lower_back_up: Array, body: Body) -> tuple[Array, Array]:
    """5. Chest joint and hips [F, 3], hips no lower than the floor allows."""
    chest_joint = neck - body.thorax * thorax_up
    hips = chest_joint - body.lower_back * lower_back_up
    return chest_joint, np.concatenate(
        [hips[:, :1], np.maximum(hips[:, 1:2], LIMITS["lowestHips"] * body.eye_height), hips[:, 2:]], -1
    )


def _side_sign(side: int) -> Array:
    """What takes an arm of this side (0: left) to a right one and back: the components of its vectors in the thorax
    frame are multiplied by it.
    """
    return np.array([1.0 if side else -1.0, 1.0, 1.0])


def _in_thorax(thorax: Array, v: Array, side: int) -> Array:
    """Vectors [F, 3] of the heading frame in the thorax frame, those of the left side mirrored."""
    return np.einsum("...ji,...j->...i", thorax, v) * _side_sign(side)


def _place_shoulder(side: int, points: _Points, trunk: tuple[Array, Array], body: Body, k: dict[str, Any]) -> Array:
    """6. Shoulder [F, 3]: the clavicle swings with the hand. trunk: neck base and thorax frame."""
    neck, thorax = trunk
    rest = body.shoulder - body.clavicle_root
    clavicle_length = np.linalg.norm(rest, axis=-1, keepdims=True)
    reach = (_in_thorax(thorax, points.wrists[:, side] - neck, side) - body.shoulder) / body.arm
    shift = body.eye_height * (np.concatenate([np.ones_like(reach[:, :1]), reach], -1) @ np.array(k["clavicle"]).T)
    length = np.linalg.norm(shift, axis=-1, keepdims=True)
    shift = shift * np.minimum(1, LIMITS["clavicleShift"] * clavicle_length / np.maximum(length, 1e-12))
    return neck + _apply(thorax, (body.clavicle_root + clavicle_length * normalise(rest + shift)) * _side_sign(side))


def _place_elbow(side: int, points: _Points, arm: tuple[Array, Array], body: Body, k: dict[str, Any]) -> Array:
    """7. Elbow [F, 3]: the swivel follows where the hand is and how it is turned. arm: shoulder and thorax frame."""
    shoulder, thorax = arm
    wrist, hand = points.wrists[:, side], points.hands[:, side]
    reach = _in_thorax(thorax, wrist - shoulder, side) / body.arm
    axes = (_in_thorax(thorax, hand[..., :, axis], side) for axis in (1, 2))
    columns = np.concatenate([np.ones_like(reach[:, :1]), reach, *axes], -1)
    turned = np.zeros(2, bool) if body.hands_turned is None else body.hands_turned
    pole = np.where(turned[..., side, None], columns @ np.array(k["pole"]).T, columns @ np.array(k["untiltedPole"]).T)
    bones = body.upper_arm[..., side, None], body.forearm[..., side, None]
    return two_bone_elbow(shoulder, wrist, *bones, _apply(thorax, pole * _side_sign(side)), thorax=thorax)


def two_bone_elbow(
    shoulder: Array, wrist: Array, upper_arm: Array, forearm: Array, pole: Array, *, thorax: Array
) -> Array:
    """The elbow [F, 3] on the side of `pole`, or where that is along the arm, below or behind the thorax's axes; out of
    reach: on the straight arm.
    """
    axis = wrist - shoulder
    distance = np.linalg.norm(axis, axis=-1, keepdims=True)
    axis = np.where(distance > 1e-9, axis / np.maximum(distance, 1e-9), -thorax[..., :, 1])
    across = pole - _dot(pole, axis) * axis
    for substitute in (-thorax[..., :, 1], thorax[..., :, 2]):
        short = np.linalg.norm(across, axis=-1, keepdims=True) < LIMB["undefinedPole"]
        across = np.where(short, substitute - _dot(substitute, axis) * axis, across)
    across = normalise(across)
    reach = np.clip(
        distance, np.abs(upper_arm - forearm) + LIMB["maxBent"], (upper_arm + forearm) * LIMB["straightest"]
    )
    along = (upper_arm**2 - forearm**2 + reach**2) / (2 * reach)
    return shoulder + along * axis + np.sqrt(np.maximum(upper_arm**2 - along**2, 0)) * across
