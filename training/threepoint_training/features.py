"""The learned network's features (docs/estimation.md), the one function for training and for the golden vectors."""

import numpy as np
from numpy.typing import NDArray

from . import ik, quaternion
from .skeleton import Body

Array = NDArray[np.float64]

# Of a frame, and of what IK's chest sees of the newest one.
FEATURES = 46
CHEST_FEATURES = 38
OUTPUTS = 18
IK_JOINTS = slice(27, 45)


def frame_features(positions: Array, rotations: Array, body: Body, seen: Array | None = None) -> tuple[Array, Array]:
    """Features [F, 46] of tracked points in the floor frame ([F, 3, 3], [F, 3, 4]) and the IK joints [F, 6, 3], heading frame [m].

    seen [F, 2]: whether each hand is seen in this frame; all, when None.
    """
    local, turns, _, _ = ik.to_heading(positions, rotations)
    joints = ik.solve(local, turns, body)
    matrices = quaternion.to_matrix(turns)
    headset = local[:, 0]
    e, a = body.eye_height, body.arm
    columns = [headset[:, 1:2] / e, *_two_columns(matrices[:, 0])]
    for hand in (1, 2):
        columns += [(local[:, hand] - headset) / a, *_two_columns(matrices[:, hand])]
    columns.append(np.ones((len(local), 2)) if seen is None else np.asarray(seen, np.float64))
    columns.append(((joints - headset[:, None]) / e[..., None]).reshape(len(local), -1))
    columns.append(np.broadcast_to(a / e, (len(local), 1)))
    return np.concatenate(columns, axis=-1), joints


def _two_columns(matrix: Array) -> tuple[Array, Array]:
    return matrix[..., :, 0], matrix[..., :, 1]


def windowed(features: Array, times: Array, window: tuple[float, ...]) -> Array:
    """The input [F, T·46]: the features at each frame's time minus each age [s]; the oldest frame stands in before the start."""
    parts = []
    for age in window:
        wanted = np.maximum(times - age, times[0])
        after = np.clip(np.searchsorted(times, wanted, side="right"), 1, max(len(times) - 1, 1))
        before = after - 1
        if len(times) == 1:
            parts.append(features)
            continue
        share = np.clip((wanted - times[before]) / (times[after] - times[before]), 0.0, 1.0)[:, None]
        parts.append(features[before] * (1 - share) + features[after] * share)
    return np.concatenate(parts, axis=-1)


def chest_axes(vector: Array) -> Array:
    """The axes of IK's chest as rows [F, 3, 3], heading frame, from features [F, 46]: x from shoulder to shoulder, y up the spine, z backward."""
    _, _, left, right, chest, _ = _ik_joints(vector)
    x = ik.normalise(right - left)
    up = (left + right) / 2 - chest
    up = ik.normalise(up - np.sum(up * x, -1, keepdims=True) * x)
    return np.stack([x, up, np.cross(x, up)], axis=1)


def seen_from_chest(vector: Array) -> Array:
    """What IK's chest sees of a frame [F, 38], from its features [F, 46].

    Left, then right arm: reach from IK's shoulder to the wrist in arm lengths, x and y axes of the hand, IK's elbow from its shoulder; x and y
    axes of the head, the chest joint from the headset; the room's up; the lengths of both reaches. Joints in eye heights.
    """
    axes, arm = chest_axes(vector), vector[:, 45:46]
    joints = _ik_joints(vector)
    arms = []
    for hand, elbow, shoulder in ((7, joints[0], joints[2]), (16, joints[1], joints[3])):
        reach = vector[:, hand : hand + 3] - shoulder / arm
        arms += [reach, vector[:, hand + 3 : hand + 6], vector[:, hand + 6 : hand + 9], elbow - shoulder]
    seen = np.stack([*arms, vector[:, 1:4], vector[:, 4:7], joints[4]], axis=1) @ np.swapaxes(axes, 1, 2)
    lengths = np.linalg.norm(seen[:, [0, 4]], axis=-1)
    return np.concatenate([seen.reshape(len(vector), -1), axes[:, :, 1], lengths], axis=-1)


def network_input(vector: Array, times: Array, window: tuple[float, ...]) -> Array:
    """The network's input [F, T·46 + 38]: the window of features, and what IK's chest sees of the newest frame."""
    return np.concatenate([windowed(vector, times, window), seen_from_chest(vector)], axis=-1)


def target(truth: Array, positions: Array, rotations: Array, body: Body, vector: Array) -> Array:
    """The output [F, 18] that would be right: the six joints − those of IK, which these features carry, seen from its chest, in eye heights."""
    yaw = quaternion.heading(rotations[:, 0])
    inverse = np.broadcast_to(quaternion.conjugate(yaw)[:, None], (*truth.shape[:-1], 4))
    joints = quaternion.rotate(inverse, truth - positions[:, :1]) / body.eye_height[..., None]
    correction = joints - vector[:, IK_JOINTS].reshape(-1, 6, 3)
    return (correction @ np.swapaxes(chest_axes(vector), 1, 2)).reshape(len(truth), -1)


def _ik_joints(vector: Array) -> list[Array]:
    """The six joints [F, 3] from the headset, heading frame, eye heights."""
    return list(np.moveaxis(vector[:, IK_JOINTS].reshape(-1, 6, 3), 1, 0))


def euler_yxz(q: Array) -> Array:
    """Angles [rad] about x, y, z of R = Ry·Rx·Rz."""
    m = quaternion.to_matrix(q)
    x = np.arcsin(np.clip(-m[..., 1, 2], -1, 1))
    return np.stack([x, np.arctan2(m[..., 0, 2], m[..., 2, 2]), np.arctan2(m[..., 1, 0], m[..., 1, 1])], -1)


def floor_under_head(positions: Array) -> Array:
    """The point [F, 1, 3] on the floor under the headset: where the paper's local positions begin."""
    return positions[:, :1] * np.array([1.0, 0.0, 1.0])


def paper_input(positions: Array, rotations: Array) -> Array:
    """The paper's input [F, 2, 3, 3]: depth (local position [m], Euler angles [rad]), row (x, y, z), column (head, left, right)."""
    local = positions - floor_under_head(positions)
    return np.stack([np.swapaxes(local, 1, 2), np.swapaxes(euler_yxz(rotations), 1, 2)], axis=1)
