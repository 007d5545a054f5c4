"""Postures in which the network may err more than on average, for tables of errors by posture."""

import numpy as np
from numpy.typing import NDArray

from .chest_features import CHEST_FEATURES, REACH_LENGTHS
from .features import HANDS, HEAD_AXES, HEADSET_HEIGHT
from .model import CorrectionNetwork

UPRIGHT = "head up, hands below it, an arm stretched"


def of_frames(inputs: NDArray[np.float32]) -> dict[str, NDArray[np.bool_]]:
    """Which frames [F] are of each posture, from the network's inputs [F, T·46 + 38]; a frame may be of several, and is of one at least."""
    hand_heights = inputs[:, [hand.start + 1 for hand in HANDS]]
    reaches = inputs[:, -CHEST_FEATURES:][:, REACH_LENGTHS]
    special = {
        "head under 0.9 of the eye height": inputs[:, HEADSET_HEIGHT] < 0.9,
        # The y axis is the second of the two; its y is how far up it points.
        "head tilted by over 45°": inputs[:, HEAD_AXES.start + 4] < np.cos(np.pi / 4),
        "a hand above the headset": hand_heights.max(axis=1) > 0,
        "both arms bent, reach under 0.65": reaches.max(axis=1) < 0.65,
    }
    return {UPRIGHT: ~np.any(list(special.values()), axis=0)} | special


def active(inputs: NDArray[np.float32]) -> NDArray[np.bool_]:
    """Which frames [F] are active: a wrist higher than 0.75 arm lengths below the headset, the head under 0.9 of the eye height, or tilted by over
    30°. Standing and walking with hanging arms is none of these."""
    hand_heights = inputs[:, [hand.start + 1 for hand in HANDS]]
    return (hand_heights.max(axis=1) > -0.75) | (inputs[:, HEADSET_HEIGHT] < 0.9) | (inputs[:, HEAD_AXES.start + 4] < np.cos(np.radians(30.0)))


def distance(network: CorrectionNetwork, inputs: NDArray[np.float32]) -> NDArray[np.float32]:
    """How far each frame [F] is from the mean of the motion trained on: root mean square of its chest-frame features in standard deviations."""
    chest = slice(-CHEST_FEATURES, None)
    mean, scale = (getattr(network, f"trunk_input_{key}").numpy()[:, chest] for key in ("mean", "scale"))
    return np.sqrt((((inputs[:, chest] - mean) / scale) ** 2).mean(axis=1))
