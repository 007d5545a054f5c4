"""Where a hand is taken to be that is not seen, as src/core/tracking/hand-continuity.ts has it: held, then sinking to rest beside the hip."""

import numpy as np
from numpy.typing import NDArray

from . import quaternion
from .skeleton import load_proportions

Array = NDArray[np.float64]

# Held for so long, then at rest after so much more [s].
HOLD_SECONDS = 0.1
SINK_SECONDS = 2.5


def carry(hand: Array, turn: Array, head: tuple[Array, Array], head_now: tuple[Array, Array]) -> tuple[Array, Array]:
    """A hand [F, 3] and its turn, seen last under a head (place [F, 3], turn [F, 4]), carried along to where that head is now."""
    (place, way), (place_now, way_now) = head, head_now
    turned = quaternion.multiply(quaternion.heading(way_now), quaternion.conjugate(quaternion.heading(way)))
    return place_now + quaternion.rotate(turned, hand - place), quaternion.multiply(turned, turn)


def sink(positions: Array, rotations: Array, unseen: Array, eye_height: Array, arm: Array) -> tuple[Array, Array]:
    """Hands that were carried along, unseen for so long [F, 2] in seconds (0: seen), on their way to rest; positions [F, 3, 3] of headset and hands."""
    share = _even_step((unseen - HOLD_SECONDS) / SINK_SECONDS)
    positions, rotations = positions.copy(), rotations.copy()
    for hand, (place, turn) in enumerate(_rest(positions[:, 0], rotations[:, 0], eye_height, arm)):
        sunk = share[:, hand]
        positions[:, 1 + hand] += sunk[:, None] * (place - positions[:, 1 + hand])
        rotations[:, 1 + hand] = np.where(sunk[:, None] > 0, quaternion.slerp(rotations[:, 1 + hand], turn, sunk), rotations[:, 1 + hand])
    return positions, rotations


def _even_step(share: Array) -> Array:
    """evenStep of src/core/math/damper.ts: up to an even speed in a fifth of the time, and down again."""
    ramp, t = 0.2, np.clip(share, 0.0, 1.0)
    slow, fast = 2 * ramp * (1 - ramp), (t - ramp / 2) / (1 - ramp)
    return np.where(t < ramp, t**2 / slow, np.where(t > 1 - ramp, 1 - (1 - t) ** 2 / slow, fast))


def _rest(headset: Array, gaze: Array, eye_height: Array, arm: Array) -> list[tuple[Array, Array]]:
    """Left and right wrist beside the hips and how they are turned."""
    p = load_proportions()
    yaw = quaternion.heading(gaze)
    eyes = eye_height[:, None] * np.array([0.0, p["eyesInHead"][0], -p["eyesInHead"][1]])
    head_joint = headset - quaternion.rotate(gaze, eyes)
    shoulder = head_joint[:, 1] + (p["clavicle"][1] - p["neckToHead"][0]) * eye_height
    hands = []
    for sign in (-1.0, 1.0):
        local = np.stack(
            [
                sign * ((p["clavicleRoot"] + p["clavicle"][0]) * eye_height + 0.1 * arm),
                np.maximum(shoulder - 0.93 * arm, 0.06 * eye_height),
                (p["neckToHead"][1] - p["clavicle"][2]) * eye_height - 0.06 * arm,
            ],
            axis=-1,
        )
        axes = np.array([[0.0, sign, 0.0], [0.0, 0.0, 1.0], [sign, 0.0, 0.0]])
        turn = quaternion.multiply(yaw, np.broadcast_to(quaternion.from_matrix(axes), yaw.shape))
        hands.append((quaternion.rotate(yaw, local) + head_joint * np.array([1.0, 0.0, 1.0]), turn))
    return hands
