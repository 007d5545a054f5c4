"""What a headset and two hands would have reported while the motion was recorded."""

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike

from . import hand_tilt, quaternion
from .arrays import Array
from .prepare import EYES_FROM_HEAD_JOINT
from .prepared_corpus import TRACKED_COLUMNS
from .shared_constants import MOCAP_RULES

_TRACKERS: dict[str, Any] = MOCAP_RULES["trackers"]


def _by_tracker(noise: dict[str, float]) -> tuple[float, float, float]:
    """For head, left hand and right hand."""
    return noise["head"], noise["hands"], noise["hands"]


# Standard deviation [m] of a forearm's length that its owner has measured and typed.
FOREARM_ERROR = 0.01


@dataclass(frozen=True)
class TrackerConfig:
    """Standard deviations. Offsets are constant for a wearer: how this headset sits, what the grip table does not know.
    """

    headset_offset: float = _TRACKERS["headsetOffset"]  # [m] per axis
    headset_pitch: float = np.radians(_TRACKERS["headsetPitchDegrees"])  # [rad]
    wrist_offset: float = _TRACKERS["wristOffset"]  # [m] per axis
    hand_turn: float = np.radians(_TRACKERS["handTurnDegrees"])  # [rad] about a random axis
    # Noise of head, left hand and right hand, drawn for each frame: [m] per axis; [rad] about a random axis.
    position_noise: tuple[float, float, float] = _by_tracker(_TRACKERS["positionNoise"])
    rotation_noise: tuple[float, float, float] = tuple(
        np.radians(_by_tracker(_TRACKERS["rotationNoiseDegrees"])).tolist()
    )
    hand_tilt_error: float = np.radians(5.0)  # [rad], of the calibration that measures the hands


@dataclass(frozen=True)
class Wearer:
    """How trackers sit on one person: offsets [m] in the frames of head and hands, and rotations (xyzw) against those.
    """

    eyes_in_head: Array
    head_turn: Array
    wrist_offsets: Array  # [2, 3]
    hand_turns: Array  # [2, 4]


class NormalSource(Protocol):
    """A generator of standard normal numbers: NumPy's, or the page's."""

    def normal(self, *, size: int | tuple[int, ...] = ()) -> Any:
        """An array of this shape."""


_WORD = np.uint64(0xFFFFFFFF)


class NormalNumbers:
    """Seeded normal numbers that the page draws alike (createNormalRandom in src/threepoint/core/math/random.ts).

    Uniform numbers of SplitMix32, whose state is one 32-bit number, two for each normal number of Box and
    Muller.
    """

    def __init__(self, seed: int) -> None:
        self._state = np.uint64(seed & 0xFFFFFFFF)

    def normal(self, *, size: int | tuple[int, ...] = ()) -> Array:
        """An array of this shape; its numbers are drawn in the order in which they lie in memory."""
        uniform = self._uniform(2 * int(np.prod(size))).reshape(*np.atleast_1d(np.array(size, int)), 2)
        return np.sqrt(-2 * np.log(1 - uniform[..., 0])) * np.cos(2 * np.pi * uniform[..., 1])

    def _uniform(self, count: int) -> Array:
        """The next numbers [count] in [0, 1)."""
        mixed = (self._state + np.arange(1, count + 1, dtype=np.uint64) * np.uint64(0x9E3779B9)) & _WORD
        self._state = mixed[-1]
        for shift, factor in ((16, 0x21F0AAAD), (15, 0x735A2D97)):
            mixed = ((mixed ^ (mixed >> np.uint64(shift))) * np.uint64(factor)) & _WORD
        return (mixed ^ (mixed >> np.uint64(15))) / 2**32


def draw_turns(deviation: ArrayLike, shape: tuple[int, ...], random: NormalSource) -> Array:
    """Rotations [*shape, 4] about random axes, by this much (standard deviation, [rad], broadcast to `shape`)."""
    deviation = np.asarray(deviation)[..., None]
    return quaternion.from_rotation_vector(random.normal(size=(*shape, 3)) * deviation / np.sqrt(3))


def draw_wearer(config: TrackerConfig, random: NormalSource) -> Wearer:
    """A wearer with offsets and rotations drawn at random."""
    turns = draw_turns(config.hand_turn, (2,), random)
    return Wearer(
        eyes_in_head=EYES_FROM_HEAD_JOINT + random.normal(size=3) * config.headset_offset,
        head_turn=quaternion.from_rotation_vector(np.array([random.normal() * config.headset_pitch, 0.0, 0.0])),
        wrist_offsets=random.normal(size=(2, 3)) * config.wrist_offset,
        hand_turns=turns,
    )


def measured_tilts(tilts: Array, worn: Array, config: TrackerConfig, random: NormalSource) -> Array:
    """What a calibration measures of hands with these tilts [..., 2], through trackers that are turned by `worn` [...,
    4] against them.
    """
    return hand_tilt.turned(tilts, worn) + random.normal(size=tilts.shape) * config.hand_tilt_error / np.sqrt(2)


def simulate(
    positions: Array, rotations: Array, wearer: Wearer, config: TrackerConfig, random: NormalSource
) -> tuple[Array, Array]:
    """Tracked positions [F, 3, 3] and rotations [F, 3, 4] of headset, left and right wrist, from JOINTS and ROTATIONS
    arrays.
    """
    positions = np.asarray(positions, np.float64)
    rotations = np.asarray(rotations, np.float64)
    frames = len(positions)
    anchors = positions[:, TRACKED_COLUMNS]
    offsets = np.stack([wearer.eyes_in_head, *wearer.wrist_offsets])
    tracked = anchors + quaternion.rotate(rotations, np.broadcast_to(offsets, (frames, 3, 3)))
    tracked = tracked + random.normal(size=tracked.shape) * np.reshape(config.position_noise, (-1, 1))
    turns = np.stack([wearer.head_turn, *wearer.hand_turns])
    turned = quaternion.multiply(rotations, np.broadcast_to(turns, (frames, 3, 4)))
    return tracked, quaternion.multiply(turned, draw_turns(config.rotation_noise, (frames, 3), random))
