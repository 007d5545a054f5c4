"""Hand tilts (hand_tilt) estimated while hands are seen; the twin of src/threepoint/core/estimation/online-calibration/estimate-hand-tilts.ts.

Inverse kinematics without tilts estimates where forearms point. The tilt is the mean of these directions, low-passed in
the frames of their hands, and of the tilt that is known before.
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


def estimated_tilts(
    forearms: Array,
    seconds: Array,
    calibrated: CalibratedTilts = NO_CALIBRATED_TILTS,
    seen: NDArray[np.bool_] | None = None,
) -> Array:
    """The tilts [F, 2, 2] by which hands are turned in each frame.

    forearms [F, 2, 3] in the frames of the hands; seconds [F] since the frame before; seen [F, 2]: which hands are, all
    when None.
    """
    prior = hand_tilt.direction_of(np.where(calibrated.known[:, None], calibrated.tilts, hand_tilt.usual()))
    weight = np.where(calibrated.known, HAND_TILTS["calibratedWeight"], HAND_TILTS["usualWeight"])[:, None]
    kept = 0.5 ** (seconds / HAND_TILTS["halfLife"])
    observed = np.zeros_like(prior)
    known = np.zeros(2, bool)
    sums = np.empty_like(forearms)
    for frame, forearm in enumerate(forearms):
        passed = np.where(known[:, None], kept[frame] * observed + (1 - kept[frame]) * forearm, forearm)
        tracked = np.ones(2, bool) if seen is None else seen[frame]
        observed = np.where(tracked[:, None], passed, observed)
        known = known | tracked
        sums[frame] = observed + weight * prior
    tilts = hand_tilt.tilt_of(sums)
    return tilts * np.minimum(
        1.0, LIMB["steepestHandTilt"] / np.maximum(np.linalg.norm(tilts, axis=-1, keepdims=True), 1e-12)
    )


def with_estimated_hands(
    body: Body,
    positions: Array,
    rotations: Array,
    seconds: Array,
    *,
    calibrated: CalibratedTilts = NO_CALIBRATED_TILTS,
    seen: NDArray[np.bool_] | None = None,
) -> Body:
    """Returns the body with the estimated hand tilts of each frame, for one clip from its start.

    positions [F, 3, 3] and rotations [F, 3, 4] of the tracked points, floor frame; seconds, calibrated and seen as for
    `estimated_tilts`.
    """
    return body.with_hands(estimated_tilts(ik_forearms(positions, rotations, body), seconds, calibrated, seen))
