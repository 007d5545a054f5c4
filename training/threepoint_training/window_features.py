"""The inputs of the board's networks: windows of headset and hands."""

import numpy as np
from numpy.typing import NDArray

from . import quaternion
from .arrays import Array
from .skeleton import Body

FRAMES = 40
# Numbers of a rotation: its x and y axes.
ROTATION = 6
# Rotations, angular velocities, positions and velocities of headset and hands.
FRAME_FEATURES = 54
# The columns of a frame with the headset's rotation and position.
HEAD_TURN, HEAD_PLACE = slice(0, ROTATION), slice(36, 39)
# The frames, oldest first, then the length of the calibrated arm.
INPUTS = FRAMES * FRAME_FEATURES + 1


def window_features(positions: Array, rotations: Array, body: Body) -> NDArray[np.float32]:
    """Inputs [N, INPUTS] of windows of FRAMES + 1 frames, oldest first: positions [N, T, 3, 3] [m] and rotations [N, T,
    3, 4] of headset and hands in the floor frame.

    They are in eye heights, in the heading frame of the newest frame. Velocities are differences of neighbouring
    frames, angular velocities rotations from one frame to the next. The first frame serves those alone.
    """
    newest = rotations[:, -1, 0]
    to_heading = quaternion.conjugate(quaternion.heading(newest))
    turn = np.broadcast_to(to_heading[:, None, None], rotations.shape)
    floor = positions[:, -1:, :1] * np.array([1.0, 0.0, 1.0])
    places = quaternion.rotate(turn, positions - floor) / body.eye_height[:, None, None]
    turns = quaternion.multiply(turn, rotations)
    angular = quaternion.multiply(quaternion.conjugate(turns[:, :-1]), turns[:, 1:])
    parts = (_six_numbers(turns[:, 1:]), _six_numbers(angular), places[:, 1:], np.diff(places, axis=1))
    frames = np.concatenate([part.reshape(len(part), FRAMES, -1) for part in parts], axis=-1)
    arm = body.arm / body.eye_height
    return np.concatenate([frames.reshape(len(frames), -1), arm], axis=1).astype(np.float32)


def _six_numbers(rotations: Array) -> Array:
    """The x and y axes [..., 6] of rotations [..., 4]."""
    matrices = quaternion.to_matrix(rotations)
    return np.concatenate([matrices[..., 0], matrices[..., 1]], axis=-1)
