"""One frame's features for the learned network, and their window in time; the twin of
src/threepoint/core/estimation/networks/frame-features.ts.

The one function for training and for golden vectors; docs/estimation.md lists the columns.
"""

import numpy as np

from . import hand_tilt, quaternion, solve_ik
from .arrays import Array
from .skeleton import Body

# Columns of a frame's features, heading frame: a position has three, a rotation six, its x and its y axis.
HEADSET_HEIGHT = 0
HEAD_AXES = slice(1, 7)
# Left, then right: position and rotation.
HANDS = (slice(7, 16), slice(16, 25))
SEEN = slice(25, 27)
IK_JOINTS = slice(27, 45)
ARM_LENGTH = 45
FEATURES = 46


def frame_features(positions: Array, rotations: Array, body: Body, seen: Array | None = None) -> tuple[Array, Array]:
    """Features [F, 46] of tracked points in the floor frame ([F, 3, 3], [F, 3, 4]) and the IK joints [F, 6, 3], heading
    frame [m].

    seen [F, 2]: whether each hand is seen in this frame; all, when None.
    """
    local, turns, _, _ = solve_ik.to_heading(positions, hand_tilt.normalised(rotations, body.hand_tilts))
    joints = solve_ik.solve(local, turns, body)
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
    """The input [F, T·46]: the features at each frame's time minus each age [s]; the oldest frame stands in before the
    start.
    """
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
