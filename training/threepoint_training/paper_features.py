"""The input of the paper's network; the twin of src/threepoint/core/estimation/methods/paper.ts."""

import numpy as np

from . import quaternion
from .arrays import Array


def euler_yxz(q: Array) -> Array:
    """Angles [rad] about x, y, z of R = Ry·Rx·Rz."""
    m = quaternion.to_matrix(q)
    x = np.arcsin(np.clip(-m[..., 1, 2], -1, 1))
    return np.stack([x, np.arctan2(m[..., 0, 2], m[..., 2, 2]), np.arctan2(m[..., 1, 0], m[..., 1, 1])], -1)


def floor_under_head(positions: Array) -> Array:
    """The point [F, 1, 3] on the floor under the headset: where the paper's local positions begin."""
    return positions[:, :1] * np.array([1.0, 0.0, 1.0])


def paper_features(positions: Array, rotations: Array) -> Array:
    """The paper's input [F, 2, 3, 3]: depth (local position [m], Euler angles [rad]), row (x, y, z), column (head,
    left, right).
    """
    local = positions - floor_under_head(positions)
    return np.stack([np.swapaxes(local, 1, 2), np.swapaxes(euler_yxz(rotations), 1, 2)], axis=1)


def forearm_rotations(tracked: Array, truth: Array) -> Array:
    """The rotations [F, 2, 4] of both forearms by the paper's section 3.5, from tracked points [F, 3, 3] and the six
    joints [F, 6, 3]: y from elbow to wrist, x the normal of the plane of shoulder, elbow and wrist, z = x × y.
    """
    elbows, shoulders, wrists = truth[:, :2], truth[:, 2:4], tracked[:, 1:]
    y = _unit(wrists - elbows)
    x = _unit(np.cross(shoulders - elbows, y))
    return quaternion.from_matrix(np.stack([x, y, np.cross(x, y)], axis=-1))


def _unit(v: Array) -> Array:
    return v / np.maximum(np.linalg.norm(v, axis=-1, keepdims=True), 1e-9)
