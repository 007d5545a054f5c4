"""The newest frame in the frame of IK's chest, where an arm looks the same however its body turns and leans.

The twin of src/threepoint/core/estimation/networks/chest-features.ts.
"""

import numpy as np

from .arrays import Array
from .features import ARM_LENGTH, HANDS, HEAD_AXES, IK_JOINTS
from .solve_ik import normalise

# Columns: of the left, then of the right arm reach, x and y axis of the hand, elbow from shoulder.
ARMS = slice(0, 24)
ARM_COLUMNS = 12
CHEST_HEAD_AXES = slice(24, 30)
CHEST_JOINT = slice(30, 33)
UP = slice(33, 36)
REACH_LENGTHS = slice(36, 38)
CHEST_FEATURES = 38


def chest_axes(vector: Array) -> Array:
    """The axes of IK's chest as rows [F, 3, 3], heading frame, from features [F, 46]: x from shoulder to shoulder, y up
    the spine, z backward.
    """
    _, _, left, right, chest, _ = _ik_joints(vector)
    x = normalise(right - left)
    up = (left + right) / 2 - chest
    up = normalise(up - np.sum(up * x, -1, keepdims=True) * x)
    return np.stack([x, up, np.cross(x, up)], axis=1)


def chest_features(vector: Array) -> Array:
    """The chest-frame features [F, 38] of a frame, from its features [F, 46].

    Left, then right arm: reach from IK's shoulder to the wrist in arm lengths, x and y axes of the hand, IK's elbow
    from its shoulder; x and y axes of the head, the chest joint from the headset; the room's up; the lengths of both
    reaches. Joints in eye heights.
    """
    axes, arm = chest_axes(vector), vector[:, ARM_LENGTH, None]
    joints = _ik_joints(vector)
    arms = []
    for hand, elbow, shoulder in ((HANDS[0], joints[0], joints[2]), (HANDS[1], joints[1], joints[3])):
        position, x_axis, y_axis = np.split(vector[:, hand], 3, axis=1)
        arms += [position - shoulder / arm, x_axis, y_axis, elbow - shoulder]
    vectors = np.stack([*arms, *np.split(vector[:, HEAD_AXES], 2, axis=1), joints[4]], axis=1) @ np.swapaxes(axes, 1, 2)
    reaches = np.linalg.norm(vectors[:, [0, 4]], axis=-1)
    return np.concatenate([vectors.reshape(len(vector), -1), axes[:, :, 1], reaches], axis=-1)


def _ik_joints(vector: Array) -> list[Array]:
    """The six joints [F, 3] from the headset, heading frame, eye heights."""
    return list(np.moveaxis(vector[:, IK_JOINTS].reshape(-1, 6, 3), 1, 0))
