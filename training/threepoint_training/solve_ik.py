"""Inverse kinematics as docs/estimation.md states it, vectorised over frames; the twin of src/core/estimation/solve-ik.ts."""

import json
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import quaternion
from .kinematic_limits import IK as LIMITS
from .kinematic_limits import LIMB
from .skeleton import Body

Array = NDArray[np.float64]

PARAMETERS_FILE = Path(__file__).parents[2] / "src/core/estimation/ik-parameters.json"


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
    """Tracked points [F, 3, 3] and rotations [F, 3, 4] in the heading frame, with the heading's yaw (xyzw) and floor origin."""
    yaw = quaternion.heading(rotations[:, 0])
    origin = positions[:, 0] * np.array([1.0, 0.0, 1.0])
    inverse = np.broadcast_to(quaternion.conjugate(yaw)[:, None], rotations.shape)
    return quaternion.rotate(inverse, positions - origin[:, None]), quaternion.multiply(inverse, rotations), yaw, origin


def solve(positions: Array, rotations: Array, body: Body, parameters: dict[str, Any] | None = None) -> Array:
    """The six estimated joints [F, 6, 3] from tracked points in the heading frame, hands turned by their tilts; body: one for all, or one per frame."""
    k = parameters or load_parameters()
    e, a = body.eye_height, body.arm
    headset, wrists = positions[:, 0], positions[:, 1:]
    head = quaternion.to_matrix(rotations[:, 0])
    gaze, right_axis, = -head[..., :, 2], head[..., :, 0]
    head_joint = headset - _apply(head, np.broadcast_to(body.eyes_in_head, headset.shape))
    left, right = (wrists[:, 0] - head_joint) / a, (wrists[:, 1] - head_joint) / a
    middle, across = (left + right) / 2, right - left

    forward_x = k["yaw"][0] * across[:, 2] + k["yaw"][1] * middle[:, 0]
    forward_z = -1 - k["yaw"][0] * across[:, 0] + k["yaw"][1] * middle[:, 2]
    saturation = LIMITS["yawSaturation"]
    yaw = saturation * np.tanh(np.arctan2(-forward_x, np.maximum(-forward_z, LIMITS["leastAhead"])) / saturation)

    crouch = _within(1 - headset[:, 1] / e[..., 0], LIMITS["crouch"])
    looking_down = -gaze[:, 1]
    sagittal = np.stack([np.ones_like(crouch), looking_down, crouch, -middle[:, 2], -middle[:, 1], looking_down * crouch], -1)
    lateral = np.stack([right_axis[:, 1], middle[:, 0], right[:, 1] - left[:, 1]], -1)
    turn = _yaw_matrix(yaw)

    def up(segment: dict[str, list[float]]) -> Array:
        alpha = _within(sagittal @ np.array(segment["forward"]), LIMITS["leanForward"])
        beta = _within(lateral @ np.array(segment["sideways"]), LIMITS["leanSideways"])
        return _apply(turn, np.stack([np.sin(beta), np.cos(alpha) * np.cos(beta), -np.sin(alpha) * np.cos(beta)], -1))

    upper, lower = up(k["upper"]), up(k["lower"])
    chest_x = normalise(np.cross(upper, turn[..., :, 2]))
    chest = np.stack([chest_x, upper, np.cross(chest_x, upper)], -1)

    neck_length = np.linalg.norm(body.neck_to_head, axis=-1, keepdims=True)
    neck_rest = np.broadcast_to(body.neck_to_head / neck_length, headset.shape)
    neck = head_joint - neck_length * normalise((1 - k["neck"]) * _apply(chest, neck_rest) + k["neck"] * _apply(head, neck_rest))
    chest_joint = neck - body.thorax * upper
    hips = chest_joint - body.lower_back * lower
    hips = np.concatenate([hips[:, :1], np.maximum(hips[:, 1:2], LIMITS["lowestHips"] * e), hips[:, 2:]], -1)

    rest = body.shoulder - body.clavicle_root
    clavicle_length = np.linalg.norm(rest, axis=-1, keepdims=True)
    clavicle, untold_pole, pole = (np.array(k[name]) for name in ("clavicle", "untoldPole", "pole"))
    turned = np.zeros(2, bool) if body.hands_turned is None else body.hands_turned
    one = np.ones_like(neck[:, :1])
    elbows, shoulders = [], []
    for side, sign in ((0, -1.0), (1, 1.0)):
        mirror = np.array([sign, 1.0, 1.0])
        wrist = wrists[:, side]

        def in_chest(v: Array, mirror: Array = mirror) -> Array:
            return np.einsum("...ji,...j->...i", chest, v) * mirror

        reach = in_chest(wrist - neck) - body.shoulder
        q = reach / a
        shift = e * (np.concatenate([one, q], -1) @ clavicle.T)
        length = np.linalg.norm(shift, axis=-1, keepdims=True)
        shift = shift * np.minimum(1, LIMITS["clavicleShift"] * clavicle_length / np.maximum(length, 1e-12))
        shoulder = neck + _apply(chest, (body.clavicle_root + clavicle_length * normalise(rest + shift)) * mirror)

        hand = quaternion.to_matrix(rotations[:, 1 + side])
        q = in_chest(wrist - shoulder) / a
        columns = np.concatenate([one, q, in_chest(hand[..., :, 1]), in_chest(hand[..., :, 2])], -1)
        direction = np.where(turned[..., side, None], columns @ pole.T, columns @ untold_pole.T)
        direction = _apply(chest, direction * mirror)
        bones = body.upper_arm[..., side, None], body.forearm[..., side, None]
        elbows.append(two_bone_elbow(shoulder, wrist, *bones, direction, chest=chest))
        shoulders.append(shoulder)
    return np.stack([*elbows, *shoulders, chest_joint, hips], axis=1)


def two_bone_elbow(shoulder: Array, wrist: Array, upper_arm: Array, forearm: Array, pole: Array, *, chest: Array) -> Array:
    """The elbow [F, 3] on the side of `pole`, or where that is along the arm, below or behind the chest's axes; out of reach: on the straight arm."""
    axis = wrist - shoulder
    distance = np.linalg.norm(axis, axis=-1, keepdims=True)
    axis = np.where(distance > 1e-9, axis / np.maximum(distance, 1e-9), -chest[..., :, 1])
    across = pole - _dot(pole, axis) * axis
    for substitute in (-chest[..., :, 1], chest[..., :, 2]):
        short = np.linalg.norm(across, axis=-1, keepdims=True) < LIMB["undefinedPole"]
        across = np.where(short, substitute - _dot(substitute, axis) * axis, across)
    across = normalise(across)
    reach = np.clip(distance, np.abs(upper_arm - forearm) + LIMB["mostBent"], (upper_arm + forearm) * LIMB["straightest"])
    along = (upper_arm**2 - forearm**2 + reach**2) / (2 * reach)
    return shoulder + along * axis + np.sqrt(np.maximum(upper_arm**2 - along**2, 0)) * across
