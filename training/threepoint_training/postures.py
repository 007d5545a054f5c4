"""Which frames are active: those in which a body does something other than stand or walk with hanging arms."""

import numpy as np
from numpy.typing import NDArray

from .features import HANDS, HEAD_AXES, HEADSET_HEIGHT


def active(inputs: NDArray[np.float32]) -> NDArray[np.bool_]:
    """Which frames [F] are active: a wrist higher than 0.75 arm lengths below the headset, the head under 0.9 of the
    eye height, or tilted by over 30°. Standing and walking with hanging arms is none of these.
    """
    hand_heights = inputs[:, [hand.start + 1 for hand in HANDS]]
    return (
        (hand_heights.max(axis=1) > -0.75)
        | (inputs[:, HEADSET_HEIGHT] < 0.9)
        | (inputs[:, HEAD_AXES.start + 4] < np.cos(np.radians(30.0)))
    )
