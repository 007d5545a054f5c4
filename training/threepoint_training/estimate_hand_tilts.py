"""Hand tilts (hand_tilt) estimated while hands move; the twin of src/threepoint/core/estimation/online-calibration/estimate-hand-tilts.ts.

Inverse kinematics without tilts estimates where forearms point. The mean of these directions in the frames of their
hands is the tilt, for errors of single postures average out.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from . import hand_tilt, quaternion, solve_ik
from .arrays import Array
from .shared_constants import HAND_TILTS, LIMB
from .skeleton import Body


@dataclass(frozen=True)
class CalibratedTilts:
    """What a calibration measured: tilts [2, 2] of the left and the right hand, and of which hands [2] it is known."""

    tilts: Array
    known: NDArray[np.bool_]


NO_CALIBRATED_TILTS = CalibratedTilts(np.zeros((2, 2)), np.zeros(2, bool))


def ik_forearms(positions: Array, rotations: Array, body: Body) -> Array:
    """Returns IK's forearm directions [F, 2, 3], elbow to wrist, in the hands' frames, from tracked points in the floor
    frame.
    """
    local, turns, _, _ = solve_ik.to_heading(positions, rotations)
    joints = solve_ik.solve(local, turns, replace(body, hand_tilts=None, hands_turned=None))
    forearms = solve_ik.normalise(local[:, 1:] - joints[:, :2])
    return quaternion.rotate(quaternion.conjugate(turns[:, 1:]), forearms)


def travel(positions: Array) -> Array:
    """How far each hand moves about the head [F, 2] since the frame before [m], of tracked points [F, 3, 3]; 0 in the
    first.
    """
    from_head = positions[:, 1:] - positions[:, :1]
    return np.linalg.norm(np.diff(from_head, axis=0, prepend=from_head[:1]), axis=-1)


def estimated_tilts(
    forearms: Array,
    metres: Array,
    calibrated: CalibratedTilts = NO_CALIBRATED_TILTS,
    seen: NDArray[np.bool_] | None = None,
) -> Array:
    """The tilts [F, 2, 2] by which hands are turned in each frame, estimated from the frames before it.

    forearms [F, 2, 3] in the frames of the hands; metres [F, 2] that each hand travelled since the frame before
    (`travel`); seen [F, 2]: which hands are, all when None.
    """
    prior = hand_tilt.direction_of(np.where(calibrated.known[:, None], calibrated.tilts, hand_tilt.usual()))
    total = np.zeros_like(prior)
    sums = np.empty_like(forearms)
    weight = metres[:, :, None] * (1.0 if seen is None else seen[:, :, None])
    kept = np.exp(-weight / HAND_TILTS["memoryMetres"])
    for frame, forearm in enumerate(forearms):
        sums[frame] = _prior_metres(prior, calibrated.known, total)[:, None] * prior + total
        total = total * kept[frame] + forearm * weight[frame]
    tilts = hand_tilt.tilt_of(sums)
    return tilts * np.minimum(
        1.0, LIMB["steepestHandTilt"] / np.maximum(np.linalg.norm(tilts, axis=-1, keepdims=True), 1e-12)
    )


def _prior_metres(prior: Array, calibrated: NDArray[np.bool_], total: Array) -> Array:
    """Returns the weight of each hand's prior direction [2, 3] in metres of travel [2].

    total [2, 3]: the sum of observed directions times metres; calibrated: whether the prior is a measured tilt.
    """
    angle = np.arctan2(np.linalg.norm(np.cross(prior, total), axis=-1), np.sum(prior * total, axis=-1))
    doubted = np.minimum(1.0, (HAND_TILTS["doubtAngle"] / np.maximum(angle, 1e-9)) ** 2)
    return np.where(calibrated, HAND_TILTS["calibratedMetres"] * doubted, HAND_TILTS["usualMetres"])


def with_estimated_hands(
    body: Body,
    positions: Array,
    rotations: Array,
    metres: Array,
    *,
    calibrated: CalibratedTilts = NO_CALIBRATED_TILTS,
    seen: NDArray[np.bool_] | None = None,
) -> Body:
    """Returns the body with the estimated hand tilts of each frame, for one clip from its start.

    positions [F, 3, 3] and rotations [F, 3, 4] of the tracked points, floor frame; metres, calibrated and seen as for
    `estimated_tilts`.
    """
    return body.with_hands(estimated_tilts(ik_forearms(positions, rotations, body), metres, calibrated, seen))
