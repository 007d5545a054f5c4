"""Left and right exchanged, in any frame whose x axis points to one side of the body: what is true of a person is true
of their mirror image.
"""

import numpy as np

from .arrays import Array

# What a mirror multiplies: the components of a position or direction (x, y, z), of a quaternion (x, y, z, w) and of a
# hand's tilt (pitch, yaw).
POSITION = np.array([-1.0, 1.0, 1.0])
ROTATION = np.array([1.0, -1.0, -1.0, 1.0])
TILT = np.array([1.0, -1.0])
# Which of the tracked points (head, left hand, right hand), and which of ESTIMATED_JOINTS, a mirror shows in the place
# of each.
TRACKED = [0, 2, 1]
JOINTS = [1, 0, 3, 2, 4, 5]


def trackers(positions: Array, rotations: Array) -> tuple[Array, Array]:
    """Tracked points [..., 3, 3] and rotations [..., 3, 4] of head, left and right hand, mirrored."""
    return positions[..., TRACKED, :] * POSITION, rotations[..., TRACKED, :] * ROTATION


def joints(estimated: Array) -> Array:
    """The six estimated joints [..., 6, 3], mirrored."""
    return estimated[..., JOINTS, :] * POSITION


def tilts(hands: Array) -> Array:
    """Tilts [..., 2, 2] of the left and the right hand, mirrored."""
    return hands[..., ::-1, :] * TILT
