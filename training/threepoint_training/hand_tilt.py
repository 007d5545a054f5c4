"""How a hand's frame is turned against its forearm, as a calibration measures it once: arms stretched ahead, wrists
straight.

A tilt is two numbers [rad]: how far up (pitch) and to the left (yaw) of the hand's −Z its forearm points, elbow to
wrist, as the rotation vector (pitch, yaw, 0). A hand whose tilt is known is turned by it, so that its −Z continues the
forearm; the twin of src/threepoint/core/body/hand-tilt.ts.
"""

import numpy as np
from numpy.typing import NDArray

from . import mirror, quaternion, skeleton
from .arrays import Array
from .prepared_corpus import JOINTS, PreparedCorpus
from .shared_constants import LIMB

_ALONG_HAND = np.array([0.0, 0.0, -1.0])
_ELBOWS, _WRISTS = ([JOINTS.index(f"{side}{part}") for side in ("left", "right")] for part in ("LowerArm", "Hand"))


def turn_of(tilts: Array) -> Array:
    """The rotations [..., 4] that take −Z to forearms of these tilts [..., 2]."""
    return quaternion.from_rotation_vector(np.concatenate([tilts, np.zeros_like(tilts[..., :1])], axis=-1))


def direction_of(tilts: Array) -> Array:
    """The directions [..., 3] of forearms of these tilts [..., 2], in the frames of their hands."""
    return quaternion.rotate(turn_of(tilts), np.broadcast_to(_ALONG_HAND, (*tilts.shape[:-1], 3)))


def usual() -> Array:
    """The tilts [2, 2] of an average left and right hand, by the proportions in use."""
    right = np.array(skeleton.load_proportions()["handTilt"])
    return np.stack([right * mirror.TILT, right])


def tilt_of(forearms: Array) -> Array:
    """The tilts [..., 2] of forearms in these directions [..., 3], in the frames of their hands."""
    x, y, z = np.moveaxis(forearms, -1, 0)
    across = np.hypot(x, y)
    return np.stack([y, -x], axis=-1) * (np.arctan2(across, -z) / np.maximum(across, 1e-12))[..., None]


def turned(tilts: Array, worn: Array) -> Array:
    """The tilts [..., 2] as trackers see them that are turned by `worn` [..., 4] against their hands."""
    return tilt_of(quaternion.rotate(quaternion.conjugate(worn), direction_of(tilts)))


def normalised(rotations: Array, tilts: Array | None) -> Array:
    """Head and hands [F, 3, 4], the hands turned so that their −Z continues forearms of these tilts [..., 2, 2]; None:
    as they are.
    """
    if tilts is None:
        return rotations
    hands = rotations[:, 1:]
    return np.concatenate(
        [rotations[:, :1], quaternion.multiply(hands, np.broadcast_to(turn_of(tilts), hands.shape))], axis=1
    )


def plausible(tilts: Array) -> NDArray[np.bool_]:
    """Which measured tilts [..., 2] are plausible [...]: no steeper than hands are held; beyond that the wrist was
    bent.
    """
    return np.linalg.norm(tilts, axis=-1) <= LIMB["steepestHandTilt"]


class ForearmMeans:
    """Mean directions of people's forearms in the frames of their hands, by the true joints, clip by clip."""

    def __init__(self, corpus: PreparedCorpus, people: tuple[str, ...]) -> None:
        self._people = corpus.clip_people
        self._sums: dict[int, Array] = {}
        for clip in corpus.clips_of(people):
            frames = corpus.clip_slice(clip)
            positions = corpus.positions[frames].astype(np.float64)
            forearms = positions[:, _WRISTS] - positions[:, _ELBOWS]
            forearms /= np.maximum(np.linalg.norm(forearms, axis=-1, keepdims=True), 1e-9)
            hands = corpus.rotations[frames, 1:].astype(np.float64)
            self._sums[clip] = quaternion.rotate(quaternion.conjugate(hands), forearms).sum(axis=0)

    def of(self, person: str) -> Array:
        """Tilts [2, 2] of the left and the right hand over all frames of a person."""
        return self._mean([clip for clip in self._sums if self._people[clip] == person])

    def elsewhere(self, clip: int) -> Array:
        """Tilts [2, 2] over the other clips of this clip's person; a person of one clip has none but its own."""
        own = [each for each in self._sums if self._people[each] == self._people[clip]]
        return self._mean([each for each in own if each != clip] or own)

    def _mean(self, clips: list[int]) -> Array:
        return tilt_of(np.sum([self._sums[clip] for clip in clips], axis=0))
