"""Recombined bodies: one person's torso with the arms of two others, put together in the chest frame, as trackers would
report them.

Some dozen people are too few to learn how arms and torsos go together; their recombinations are many.
"""

from collections.abc import Callable
from dataclasses import dataclass, fields, replace

import numpy as np
from numpy.typing import NDArray

from . import hand_tilt, mirror, quaternion
from .arrays import Array
from .body_parts import TORSO, BalanceConfig, BodyParts
from .chest_features import chest_features
from .complete_hands import carry_with_head, complete_hands
from .features import frame_features
from .prepare import EYES_FROM_HEAD_JOINT, RATE_HZ
from .residual import residual
from .simulate_trackers import FOREARM_ERROR, TrackerConfig, draw_turns, measured_tilts
from .skeleton import Body, body_from_calibration


@dataclass(frozen=True)
class AugmentConfig:
    """Shares of the batch, and standard deviations of what varies between people, devices and calibrations."""

    window_frames: tuple[int, ...] = (0, 6, 15)
    recombined: float = 0.8
    lost_hand: float = 0.06
    # Lost hands were seen last up to this long ago [frames].
    lost_frames: int = 180
    # Share of lost hands that are seen again: since one frame, or up to one more than the window is long. They were
    # seen last so long before that.
    returned: float = 0.15
    # Share of windows whose trackers report the frame before.
    late: float = 0.3
    # Share of people who sit, lower by 0.2 to 0.35 of the eye height, and were calibrated standing.
    seated: float = 0.04
    arm_scale: float = 0.03
    eye_height_error: float = 0.025
    arm_span_error: float = 0.02
    # Share of wearers who typed how long their forearm is, and by how much they err [m].
    typed_forearms: float = 0.5
    forearm_error: float = FOREARM_ERROR
    balance: BalanceConfig = BalanceConfig()
    trackers: TrackerConfig = TrackerConfig(headset_offset=0.025, wrist_offset=0.01)


@dataclass(frozen=True)
class Batch:
    """The inputs [N, T·46 + 38] and targets [N, 18] of the network."""

    inputs: NDArray[np.float32]
    targets: NDArray[np.float32]


@dataclass(frozen=True)
class _Bodies:
    """Bodies [N] put together from torsos and arms: the newest frame of each part, and their sizes."""

    parts: BodyParts
    newest: NDArray[np.int64]
    # The source frames of the left and the right arm, and the side of the person there.
    arm_frames: tuple[NDArray[np.int64], NDArray[np.int64]]
    arm_sides: tuple[NDArray[np.int64], NDArray[np.int64]]
    # Eye height and span [N, 2], length of both arms [N], and by how much a chair lowers them [N]; all [m].
    sizes: Array
    arm_length: Array
    drop: Array

    def torso_at(self, ago: NDArray[np.int64]) -> tuple[Array, NDArray[np.int64]]:
        """Hips, chest, neck and head [N, 4, 3] that many frames before the newest, and the frames."""
        frames = np.maximum(self.newest - ago, self.parts.clip_start[self.newest])
        return self.parts.torso[frames] - np.array([0.0, 1.0, 0.0]) * self.drop[:, None, None], frames

    def arm_at(self, side: int, ago: NDArray[np.int64]) -> tuple[Array, Array]:
        """Shoulder, elbow and wrist [N, 3, 3] of the body, and the wrist's rotation, that many frames before the
        newest.
        """
        parts, which = self.parts, self.arm_sides[side]
        torso, frames = self.torso_at(ago)
        chest = parts.chest[frames]
        source = np.maximum(self.arm_frames[side] - ago, parts.clip_start[self.arm_frames[side]])
        arm = np.where(which[:, None, None] == 0, parts.arms[0][source], parts.arms[1][source])
        wrist = np.where(which[:, None] == 0, parts.wrist_turns[0][source], parts.wrist_turns[1][source])
        length = np.where(which == 0, parts.arm_length[0][source], parts.arm_length[1][source])
        # The shoulder scales with the body, the arm with its length.
        shoulder = arm[:, :1] * (self.sizes[:, :1] / parts.sizes[source, :1])[:, None]
        arm = shoulder + (arm - arm[:, :1]) * (self.arm_length / length)[:, None, None]
        if side == 0:
            arm, wrist = arm * mirror.POSITION, wrist * mirror.ROTATION
        neck = torso[:, TORSO.index("neck")]
        arm = neck[:, None] + quaternion.rotate(np.broadcast_to(chest[:, None], (*arm.shape[:-1], 4)), arm)
        return arm, quaternion.multiply(chest, wrist)

    def truth(self) -> Array:
        """The six estimated joints [N, 6, 3] of the newest frames."""
        now = np.zeros(len(self.newest), np.int64)
        torso, _ = self.torso_at(now)
        left, right = (self.arm_at(side, now)[0] for side in (0, 1))
        return np.stack([left[:, 1], right[:, 1], left[:, 0], right[:, 0], torso[:, 1], torso[:, 0]], axis=1)

    def tilts(self) -> Array:
        """The tilts of the left and the right hand [N, 2, 2], from the people that the arms are taken from."""
        left, right = (
            self.parts.tilts[self.parts.person[frames], sides]
            for frames, sides in zip(self.arm_frames, self.arm_sides, strict=True)
        )
        return np.stack([left * mirror.TILT, right], axis=1)

    def forearms(self) -> Array:
        """Lengths of the left and of the right forearm [N, 2], in arms of the body's length."""
        left, right = (
            self.parts.forearm_shares[frames, sides]
            for frames, sides in zip(self.arm_frames, self.arm_sides, strict=True)
        )
        return np.stack([left, right], axis=1) * self.arm_length[:, None]

    def tracked_at(self, ago: NDArray[np.int64]) -> tuple[Array, Array]:
        """Head joint and wrists [N, 3, 3] and their rotations [N, 3, 4] that many frames before the newest."""
        torso, frames = self.torso_at(ago)
        (left, left_turn), (right, right_turn) = (self.arm_at(side, ago) for side in (0, 1))
        positions = np.stack([torso[:, TORSO.index("head")], left[:, 2], right[:, 2]], axis=1)
        return positions, np.stack([self.parts.head_turn[frames], left_turn, right_turn], axis=1)

    def of(self, chosen: NDArray[np.int64]) -> "_Bodies":
        """These bodies alone."""
        frames, sides = (tuple(each[chosen] for each in arms) for arms in (self.arm_frames, self.arm_sides))
        return _Bodies(
            self.parts,
            self.newest[chosen],
            frames,
            sides,
            self.sizes[chosen],
            self.arm_length[chosen],
            self.drop[chosen],
        )


def _draw_bodies(parts: BodyParts, count: int, config: AugmentConfig, random: np.random.Generator) -> _Bodies:
    newest = parts.draw_trunks(random, count)
    sizes = parts.sizes[newest].copy()
    arm_frames, arm_sides = [], []
    for side in (0, 1):
        other = random.uniform(size=count) < config.recombined
        frames, sides = parts.draw_arms(random, count)
        arm_frames.append(np.where(other, frames, newest))
        arm_sides.append(np.where(other, sides, side))
    own = (parts.arm_length[0][newest] + parts.arm_length[1][newest]) / 2
    wanted = own * (1 + random.normal(size=count) * config.arm_scale)
    sizes[:, 1] += 2 * (wanted - own)
    return _Bodies(parts, newest, tuple(arm_frames), tuple(arm_sides), sizes, wanted, np.zeros(count))


def _draw_worn(count: int, trackers: TrackerConfig, random: np.random.Generator) -> tuple[Array, Array]:
    """How trackers of N wearers sit: offsets [N, 3, 3] in the frames of head and hands [m], and rotations [N, 3, 4]
    against those.
    """
    hands = draw_turns(trackers.hand_turn, (count, 2), random)
    head = quaternion.from_rotation_vector(
        np.stack([random.normal(size=count) * trackers.headset_pitch, np.zeros(count), np.zeros(count)], -1)
    )
    offsets = np.concatenate(
        [
            EYES_FROM_HEAD_JOINT + random.normal(size=(count, 1, 3)) * trackers.headset_offset,
            random.normal(size=(count, 2, 3)) * trackers.wrist_offset,
        ],
        axis=1,
    )
    return offsets, np.concatenate([head[:, None], hands], axis=1)


@dataclass(frozen=True)
class _Tracking:
    """How bodies [N] are tracked, through their whole window."""

    # How they sit on head and hands, as `_draw_worn` returns it.
    offsets: Array
    worn: Array
    # Which bodies are seen in a mirror; their left and right hands are those of the image.
    mirrored: NDArray[np.bool_]
    # For how many frames the left and the right hand are lost [N, 2], 0: never; and for how many they have been seen
    # again, 0: they are still lost.
    lost: NDArray[np.int64]
    returned: NDArray[np.int64]
    # By how many frames what is reported is late [N].
    late: NDArray[np.int64]

    def of(self, chosen: NDArray[np.int64]) -> "_Tracking":
        """That of these bodies alone."""
        return _Tracking(*(getattr(self, each.name)[chosen] for each in fields(self)))

    def unseen_at(self, age: int) -> NDArray[np.int64]:
        """For how many frames the left and the right hand had not been seen [N, 2], that many frames before the newest;
        0: it was seen.
        """
        return np.where(age < self.returned, 0, np.maximum(self.lost + self.returned - age, 0))

    def images(self, own: Array, mirrored: Array) -> Array:
        """What is true of the mirror image where a body is mirrored, else what is true of its own; both [N, …]."""
        return np.where(self.mirrored.reshape(-1, *[1] * (own.ndim - 1)), mirrored, own)


def _draw_tracking(count: int, config: AugmentConfig, random: np.random.Generator) -> _Tracking:
    offsets, worn = _draw_worn(count, config.trackers, random)
    mirrored = random.uniform(size=count) < 0.5
    lost, returned = (random.uniform(size=(count, 2)) < share for share in (config.lost_hand, config.returned))
    lost_frames = np.where(lost, random.integers(1, config.lost_frames + 1, size=(count, 2)), 0)
    returned_frames = np.where(returned, random.integers(1, max(config.window_frames) + 2, size=(count, 2)), 0)
    late = (random.uniform(size=count) < config.late).astype(np.int64)
    return _Tracking(offsets, worn, mirrored, lost_frames, returned_frames, late)


def _calibrated(bodies: _Bodies, tracking: _Tracking, config: AugmentConfig, random: np.random.Generator) -> Body:
    """What calibrations find of these bodies, as they are seen: sizes with errors, tilts of hands, and forearms where
    they are typed.
    """
    count, sizes = len(bodies.newest), bodies.sizes
    body = body_from_calibration(
        sizes[:, 0] * (1 + random.normal(size=count) * config.eye_height_error),
        sizes[:, 1] * (1 + random.normal(size=count) * config.arm_span_error),
    )
    tilts = tracking.images(bodies.tilts(), mirror.tilts(bodies.tilts()))
    tilts = measured_tilts(tilts, tracking.worn[:, 1:], config.trackers, random)
    body = body.with_hands(np.where(hand_tilt.plausible(tilts)[..., None], tilts, hand_tilt.usual()))
    forearms = (
        tracking.images(bodies.forearms(), bodies.forearms()[:, ::-1])
        + random.normal(size=(count, 1)) * config.forearm_error
    )
    return body.with_forearms(forearms, random.uniform(size=(count, 1)) < config.typed_forearms)


def _trackers_at(ago: NDArray[np.int64], bodies: _Bodies, tracking: _Tracking) -> tuple[Array, Array]:
    """Headset and hands [N, 3, 3] and their rotations [N, 3, 4] as they were that many frames before the newest, seen
    or not, without noise.
    """
    own = bodies.tracked_at(ago)
    positions, rotations = (tracking.images(*each) for each in zip(own, mirror.trackers(*own), strict=True))
    return positions + quaternion.rotate(rotations, tracking.offsets), quaternion.multiply(rotations, tracking.worn)


def _with_noise(
    positions: Array, rotations: Array, trackers: TrackerConfig, random: np.random.Generator
) -> tuple[Array, Array]:
    """What trackers report that are at these positions [N, 3, 3] and rotations [N, 3, 4]."""
    jitter = draw_turns(trackers.rotation_noise, positions.shape[:-1], random)
    return positions + random.normal(size=positions.shape) * np.reshape(
        trackers.position_noise, (-1, 1)
    ), quaternion.multiply(rotations, jitter)


@dataclass(frozen=True)
class _Completed:
    """Headset and hands of one frame of every window, floor frame, lost hands completed: points [N, 3, 3], rotations
    [N, 3, 4]; and which hands are seen [N, 2].
    """

    positions: Array
    rotations: Array
    seen: NDArray[np.bool_]


@dataclass(frozen=True)
class _Draw:
    """Bodies [N] with their tracking, their calibrations, and what trackers report that are at some place."""

    bodies: _Bodies
    tracking: _Tracking
    calibrated: Body
    noisy: Callable[[Array, Array], tuple[Array, Array]]

    def truth(self) -> Array:
        """The six estimated joints [N, 6, 3] of the newest frames, as they are seen."""
        truth = self.bodies.truth()
        return self.tracking.images(truth, mirror.joints(truth))

    def at(self, age: int) -> _Completed:
        """The frames `age` frames before the newest. Lost hands are where they were seen last, carried along with the
        headset, as `complete_hands` wants them.
        """
        bodies, tracking, noisy = self.bodies, self.tracking, self.noisy
        # Trackers may report what was true a frame before.
        ago = age + tracking.late
        positions, rotations = noisy(*_trackers_at(ago, bodies, tracking))
        unseen = tracking.unseen_at(age)
        for hand in (0, 1):
            lost, column = np.flatnonzero(unseen[:, hand]), 1 + hand
            place, turn = noisy(*_trackers_at(ago[lost] + unseen[lost, hand], bodies.of(lost), tracking.of(lost)))
            positions[lost, column], rotations[lost, column] = carry_with_head(
                place[:, column], turn[:, column], (place[:, 0], turn[:, 0]), (positions[lost, 0], rotations[lost, 0])
            )
        positions, rotations = complete_hands(
            positions,
            rotations,
            unseen / RATE_HZ,
            self.calibrated.eye_height[:, 0],
            self.calibrated.arm[:, 0],
        )
        return _Completed(positions, rotations, unseen == 0)


def _draw(parts: BodyParts, count: int, config: AugmentConfig, random: np.random.Generator) -> _Draw:
    bodies = _draw_bodies(parts, count, config, random)
    tracking = _draw_tracking(count, config, random)
    seated = np.where(random.uniform(size=count) < config.seated, random.uniform(0.2, 0.35, count), 0.0)
    bodies = replace(bodies, drop=seated * bodies.sizes[:, 0])
    calibrated = _calibrated(bodies, tracking, config, random)
    return _Draw(bodies, tracking, calibrated, lambda *given: _with_noise(*given, config.trackers, random))


def draw_batch(parts: BodyParts, count: int, config: AugmentConfig, random: np.random.Generator) -> Batch:
    """`count` windows of recombined bodies; config.window_frames must have the newest frame, 0."""
    drawn = _draw(parts, count, config, random)
    body, window = drawn.calibrated, {age: drawn.at(age) for age in config.window_frames}
    vectors = {
        age: frame_features(frame.positions, frame.rotations, body, frame.seen)[0] for age, frame in window.items()
    }
    newest = window[0]
    targets = residual(drawn.truth(), newest.positions, newest.rotations, body, vectors[0])
    inputs = np.concatenate([*vectors.values(), chest_features(vectors[0])], axis=1)
    return Batch(inputs.astype(np.float32), targets.astype(np.float32))


@dataclass(frozen=True)
class TrackedWindows:
    """Windows as trackers report them, oldest frame first, floor frame [m]: positions [N, T, 3, 3] and rotations [N, T,
    3, 4] of headset and hands, lost hands completed; the calibrated bodies, and the six joints [N, 6, 3] of the newest
    frames.
    """

    positions: Array
    rotations: Array
    body: Body
    truth: Array


def draw_windows(parts: BodyParts, count: int, config: AugmentConfig, random: np.random.Generator) -> TrackedWindows:
    """Draws the same bodies as `draw_batch`, as trackers report them in every one of config.window_frames."""
    drawn = _draw(parts, count, config, random)
    frames = [drawn.at(age) for age in sorted(config.window_frames, reverse=True)]
    positions, rotations = (
        np.stack([getattr(frame, name) for frame in frames], axis=1) for name in ("positions", "rotations")
    )
    return TrackedWindows(positions, rotations, drawn.calibrated, drawn.truth())
