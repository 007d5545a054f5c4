"""How far above its usual place a headset sits, estimated from hanging arms; the twin of
src/threepoint/core/estimation/online-calibration/estimate-headset-rise.ts.
"""

import numpy as np
from numpy.typing import NDArray

from . import solve_ik
from .arrays import Array
from .shared_constants import HEADSET_RISE
from .skeleton import Body


def reaches(positions: Array, rotations: Array, body: Body) -> Array:
    """From IK's shoulders to the wrists [F, 2, 3], heading frame, in arm lengths, by tracked points in the floor frame.
    """
    local, turns, _, _ = solve_ik.to_heading(positions, rotations)
    joints = solve_ik.solve(local, turns, body)
    return (local[:, 1:] - joints[:, 2:4]) / body.arm[..., None, None]


def hanging_reach(
    reach: Array, seconds: Array, usual: float = HEADSET_RISE["usualReach"], seen: NDArray[np.bool_] | None = None
) -> Array:
    """How far wrists get from their shoulders while the arm hangs [F, 2], in arm lengths, estimated until
    each frame.

    reach [F, 2, 3]; seconds [F] since the frame before; seen [F, 2]: which hands are, all when None. A quantile,
    followed by stochastic approximation (Robbins and Monro, Annals of Mathematical Statistics 22(3), 1951).
    """
    far = np.linalg.norm(reach, axis=-1)
    hangs = (-reach[..., 1] > HEADSET_RISE["hanging"] * far) & (True if seen is None else seen)
    steps = np.where(hangs, HEADSET_RISE["speed"] * seconds[:, None], 0.0)
    followed = np.empty_like(far)
    current = np.full(2, usual)
    for frame, step in enumerate(steps):
        current = current + step * np.where(far[frame] > current, HEADSET_RISE["share"], HEADSET_RISE["share"] - 1)
        followed[frame] = current
    return followed


def rise(followed: Array, arm: Array, usual: float = HEADSET_RISE["usualReach"]) -> Array:
    """How far above its usual place the headset sits [F] in metres, estimated from both arms [F, 2] of this
    length [m].
    """
    further = followed.mean(axis=-1) - usual
    beyond = np.sign(further) * np.maximum(np.abs(further) - HEADSET_RISE["unremarkable"], 0.0)
    return np.clip(arm * beyond, -HEADSET_RISE["furthest"], HEADSET_RISE["furthest"])
