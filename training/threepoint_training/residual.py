"""The learned network's input and target, and the share of its output that counts; the twin of
src/threepoint/core/estimation/methods/residual.ts.
"""

import numpy as np

from . import quaternion
from .arrays import Array
from .chest_features import chest_axes, chest_features
from .features import HEAD_AXES, HEADSET_HEIGHT, IK_JOINTS, windowed
from .shared_constants import HIPS_DOUBT, IK
from .skeleton import Body

# Three coordinates of each of the six joints.
OUTPUTS = 18


def network_input(vector: Array, times: Array, window: tuple[float, ...]) -> Array:
    """The network's input [F, T·46 + 38]: the window of features, and the chest-frame features of the newest frame."""
    return np.concatenate([windowed(vector, times, window), chest_features(vector)], axis=-1)


def residual(truth: Array, positions: Array, rotations: Array, body: Body, vector: Array) -> Array:
    """The target [F, 18]: the six true joints [F, 6, 3] (floor frame) minus those of IK that the features `vector` [F,
    46] carry, chest frame, in eye heights.
    """
    yaw = quaternion.heading(rotations[:, 0])
    inverse = np.broadcast_to(quaternion.conjugate(yaw)[:, None], (*truth.shape[:-1], 4))
    joints = quaternion.rotate(inverse, truth - positions[:, :1]) / body.eye_height[..., None]
    correction = joints - vector[:, IK_JOINTS].reshape(-1, 6, 3)
    return (correction @ np.swapaxes(chest_axes(vector), 1, 2)).reshape(len(truth), -1)


def correction_share(inputs: Array) -> Array:
    """The share [F] of the network's correction that counts, by its inputs [F, …]; the twin of
    src/threepoint/core/estimation/networks/correction-share.ts.
    """
    height, head_up = inputs[:, HEADSET_HEIGHT], inputs[:, HEAD_AXES.start + 4]
    hanging = np.maximum(height - HIPS_DOUBT["headsetToHips"], IK["lowestHips"])
    continued = height - HIPS_DOUBT["headsetToHips"] * head_up
    doubt = (continued - hanging - HIPS_DOUBT["none"]) / (HIPS_DOUBT["full"] - HIPS_DOUBT["none"])
    doubt = np.clip(doubt, 0.0, 1.0)
    return 1 - doubt**2 * (3 - 2 * doubt)
