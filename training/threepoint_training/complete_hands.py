"""Estimates positions of unseen hands: held at their last tracked position, then moved to rest at the hip.

The twin of src/threepoint/core/estimation/complete-hands.ts for hands that stay lost.
"""

import numpy as np

from . import quaternion
from .arrays import Array
from .shared_constants import LOST_HAND, TRAPEZOIDAL_RAMP
from .skeleton import load_proportions


def carry_with_head(
    hand: Array, turn: Array, head: tuple[Array, Array], head_now: tuple[Array, Array]
) -> tuple[Array, Array]:
    """A hand [F, 3] and its rotation, seen last under a head (position [F, 3], rotation [F, 4]), carried along to where
    that head is now.
    """
    (place, way), (place_now, way_now) = head, head_now
    turned = quaternion.multiply(quaternion.heading(way_now), quaternion.conjugate(quaternion.heading(way)))
    return place_now + quaternion.rotate(turned, hand - place), quaternion.multiply(turned, turn)


def complete_hands(
    positions: Array, rotations: Array, unseen: Array, eye_height: Array, arm: Array
) -> tuple[Array, Array]:
    """Headset and hands [F, 3, 3] as estimators get them; hands come carried along, unseen for so long [F, 2] in
    seconds (0: seen).
    """
    share = _trapezoidal_easing((unseen - LOST_HAND["holdSeconds"]) / LOST_HAND["restSeconds"])
    positions, rotations = positions.copy(), rotations.copy()
    for hand, (place, turn) in enumerate(_rest(positions[:, 0], rotations[:, 0], eye_height, arm)):
        sunk = share[:, hand]
        positions[:, 1 + hand] += sunk[:, None] * (place - positions[:, 1 + hand])
        rotations[:, 1 + hand] = np.where(
            sunk[:, None] > 0, quaternion.slerp(rotations[:, 1 + hand], turn, sunk), rotations[:, 1 + hand]
        )
    return positions, rotations


def _trapezoidal_easing(share: Array) -> Array:
    """From 0 to 1: constant acceleration for a fifth of the time, constant speed, constant deceleration
    (src/threepoint/core/math/damper.ts).
    """
    ramp, t = TRAPEZOIDAL_RAMP, np.clip(share, 0.0, 1.0)
    slow, fast = 2 * ramp * (1 - ramp), (t - ramp / 2) / (1 - ramp)
    return np.where(t < ramp, t**2 / slow, np.where(t > 1 - ramp, 1 - (1 - t) ** 2 / slow, fast))


def _rest(headset: Array, gaze: Array, eye_height: Array, arm: Array) -> list[tuple[Array, Array]]:
    """Positions [F, 3] and rotations [F, 4] of the left and the right wrist at rest beside the hips, floor frame."""
    p, hanging = load_proportions(), LOST_HAND["hanging"]
    yaw = quaternion.heading(gaze)
    eyes = eye_height[:, None] * np.array([0.0, p["eyesInHead"][0], -p["eyesInHead"][1]])
    head_joint = headset - quaternion.rotate(gaze, eyes)
    shoulder = head_joint[:, 1] + (p["clavicle"][1] - p["neckToHead"][0]) * eye_height
    hands = []
    for sign in (-1.0, 1.0):
        local = np.stack(
            [
                sign * ((p["clavicleRoot"] + p["clavicle"][0]) * eye_height + hanging["outward"] * arm),
                np.maximum(shoulder + hanging["up"] * arm, LOST_HAND["lowestRest"] * eye_height),
                (p["neckToHead"][1] - p["clavicle"][2]) * eye_height - hanging["forward"] * arm,
            ],
            axis=-1,
        )
        axes = np.array([[0.0, sign, 0.0], [0.0, 0.0, 1.0], [sign, 0.0, 0.0]])
        turn = quaternion.multiply(yaw, np.broadcast_to(quaternion.from_matrix(axes), yaw.shape))
        hands.append((quaternion.rotate(yaw, local) + head_joint * np.array([1.0, 0.0, 1.0]), turn))
    return hands
