"""Recombined bodies: one person's torso with the arms of two others, in chest space, as trackers would see it.

Eleven people are too few to learn how arms and torsos go together; their recombinations are many.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from . import quaternion
from .features import frame_features, seen_from_chest, target
from .lost_hands import carry, sink
from .prepared_corpus import JOINTS, MIRRORED_JOINTS, PreparedCorpus
from .simulate_trackers import TrackerConfig
from .prepare import EYES_FROM_HEAD_JOINT
from .skeleton import body_from_calibration

Array = NDArray[np.float64]

TORSO = ("hips", "chest", "neck", "head")
ARM = ("UpperArm", "LowerArm", "Hand")
# Of the corpus [Hz].
FRAME_RATE = 60

_MIRROR = np.array([-1.0, 1.0, 1.0])
_MIRROR_TURN = np.array([1.0, -1.0, -1.0, 1.0])


@dataclass(frozen=True)
class AugmentConfig:
    """Shares of the batch, and standard deviations of what varies between people, devices and calibrations."""

    window_frames: tuple[int, ...] = (0, 6, 15)
    recombined: float = 0.8
    lost_hand: float = 0.06
    # Lost hands were seen last up to this long ago [frames].
    lost_frames: int = 180
    # Trackers that tell of the frame before.
    late: float = 0.3
    # People on a chair that their calibration knows nothing of, lower by 0.2 to 0.35 of the eye height.
    seated: float = 0.04
    arm_scale: float = 0.03
    eye_height_error: float = 0.025
    arm_span_error: float = 0.02
    trackers: TrackerConfig = TrackerConfig(headset_offset=0.025, wrist_offset=0.02)


@dataclass(frozen=True)
class Batch:
    """inputs [N, T·46 + 38], targets [N, 18]; float32. people [N, 3]: whose torso, left and right arm, as numbers of `BodyParts.people`."""

    inputs: NDArray[np.float32]
    targets: NDArray[np.float32]
    people: NDArray[np.int64]


class BodyParts:
    """The corpus of some people taken apart: torsos in the floor frame, arms in chest space, all on the right side."""

    def __init__(self, corpus: PreparedCorpus, people: tuple[str, ...]) -> None:
        clips = corpus.clips_of(set(people))
        slices = [corpus.clip_slice(clip) for clip in clips]
        frames = np.concatenate([np.arange(s.start, s.stop) for s in slices])
        positions = corpus.positions[frames].astype(np.float64)
        rotations = corpus.rotations[frames].astype(np.float64)
        joint = {name: positions[:, index] for index, name in enumerate(JOINTS)}
        sizes = [(corpus.people[corpus.clip_people[clip]].eye_height, corpus.people[corpus.clip_people[clip]].arm_span) for clip in clips]
        lengths = [s.stop - s.start for s in slices]
        self.clip_start = np.repeat(np.cumsum([0, *lengths[:-1]]), lengths)
        self.sizes = np.repeat(np.array(sizes), lengths, axis=0)
        names = np.array([corpus.clip_people[clip] for clip in clips])
        # Everybody counts alike, but a person with ten times the motion still counts somewhat more.
        self.people, self.person, counts = np.unique(np.repeat(names, lengths), return_inverse=True, return_counts=True)
        weight = counts[self.person] ** -0.5
        self.cumulative = np.cumsum(weight) / weight.sum()

        x = joint["rightUpperArm"] - joint["leftUpperArm"]
        x /= np.linalg.norm(x, axis=-1, keepdims=True)
        up = joint["neck"] - joint["chest"]
        up = up - np.sum(up * x, -1, keepdims=True) * x
        up /= np.maximum(np.linalg.norm(up, axis=-1, keepdims=True), 1e-9)
        self.chest = quaternion.from_matrix(np.stack([x, up, np.cross(x, up)], axis=-1))
        self.torso = np.stack([joint[name] for name in TORSO], axis=1)
        self.head_turn = rotations[:, 0]
        inverse_chest = quaternion.conjugate(self.chest)
        self.arms = []
        self.wrist_turns = []
        for side, turn in (("left", 1), ("right", 2)):
            arm = np.stack([joint[f"{side}{part}"] for part in ARM], axis=1) - joint["neck"][:, None]
            arm = quaternion.rotate(np.broadcast_to(inverse_chest[:, None], (*arm.shape[:-1], 4)), arm)
            wrist = quaternion.multiply(inverse_chest, rotations[:, turn])
            self.arms.append(arm * _MIRROR if side == "left" else arm)
            self.wrist_turns.append(wrist * _MIRROR_TURN if side == "left" else wrist)
        self.arm_length = [
            np.linalg.norm(arm[:, 1] - arm[:, 0], axis=-1) + np.linalg.norm(arm[:, 2] - arm[:, 1], axis=-1) for arm in self.arms
        ]

    def draw(self, random: np.random.Generator, count: int) -> NDArray[np.int64]:
        """Frames, people balanced."""
        return np.searchsorted(self.cumulative, random.uniform(size=count)).clip(max=len(self.cumulative) - 1)


def draw_batch(parts: BodyParts, count: int, config: AugmentConfig, random: np.random.Generator) -> Batch:
    """That many windows."""
    newest = parts.draw(random, count)
    sizes = parts.sizes[newest].copy()
    arm_frames, arm_sides = [], []
    for side in (0, 1):
        other = random.uniform(size=count) < config.recombined
        arm_frames.append(np.where(other, parts.draw(random, count), newest))
        arm_sides.append(np.where(other, random.integers(0, 2, count), side))
    lengths = np.stack(parts.arm_length)
    own = (lengths[0][newest] + lengths[1][newest]) / 2
    wanted = own * (1 + random.normal(size=count) * config.arm_scale)
    sizes[:, 1] += 2 * (wanted - own)

    turn_jitter = quaternion.from_rotation_vector(random.normal(size=(count, 2, 3)) * config.trackers.hand_turn / np.sqrt(3))
    head_jitter = quaternion.from_rotation_vector(
        np.stack([random.normal(size=count) * config.trackers.headset_pitch, np.zeros(count), np.zeros(count)], -1)
    )
    offsets = np.concatenate(
        [
            EYES_FROM_HEAD_JOINT + random.normal(size=(count, 1, 3)) * config.trackers.headset_offset,
            random.normal(size=(count, 2, 3)) * config.trackers.wrist_offset,
        ],
        axis=1,
    )
    mirrored = random.uniform(size=count) < 0.5
    lost = random.uniform(size=(count, 2)) < config.lost_hand
    unseen = np.where(lost, random.integers(1, config.lost_frames + 1, size=(count, 2)), 0)
    # Arms are those of the body before it is mirrored.
    unseen_arms = np.where(mirrored[:, None], unseen[:, ::-1], unseen)
    late = (random.uniform(size=count) < config.late).astype(np.int64)
    drop = np.where(random.uniform(size=count) < config.seated, random.uniform(0.2, 0.35, count), 0.0) * sizes[:, 0]
    calibrated = body_from_calibration(
        sizes[:, 0] * (1 + random.normal(size=count) * config.eye_height_error),
        sizes[:, 1] * (1 + random.normal(size=count) * config.arm_span_error),
    )
    def torso_at(ago: NDArray[np.int64]) -> tuple[Array, NDArray[np.int64]]:
        """Hips, chest, neck and head that many frames before the newest, and the frames."""
        frames = np.maximum(newest - ago, parts.clip_start[newest])
        return parts.torso[frames] - np.array([0.0, 1.0, 0.0]) * drop[:, None, None], frames

    def arm_at(side: int, ago: NDArray[np.int64]) -> tuple[Array, Array]:
        """Shoulder, elbow and wrist of the body, and the wrist's turn, that many frames before the newest."""
        torso, frames = torso_at(ago)
        chest = parts.chest[frames]
        source = np.maximum(arm_frames[side] - ago, parts.clip_start[arm_frames[side]])
        which = arm_sides[side]
        arm = np.where(which[:, None, None] == 0, parts.arms[0][source], parts.arms[1][source])
        wrist = np.where(which[:, None] == 0, parts.wrist_turns[0][source], parts.wrist_turns[1][source])
        length = np.where(which == 0, lengths[0][source], lengths[1][source])
        # The shoulder scales with the body, the arm with its length.
        shoulder = arm[:, :1] * (sizes[:, :1] / parts.sizes[source, :1])[:, None]
        arm = shoulder + (arm - arm[:, :1]) * (wanted / length)[:, None, None]
        if side == 0:
            arm, wrist = arm * _MIRROR, wrist * _MIRROR_TURN
        neck = torso[:, TORSO.index("neck")]
        arm = neck[:, None] + quaternion.rotate(np.broadcast_to(chest[:, None], (*arm.shape[:-1], 4)), arm)
        return arm, quaternion.multiply(chest, wrist)

    def hand_at(side: int, ago: NDArray[np.int64]) -> tuple[Array, Array]:
        """A wrist and its turn that many frames before the newest; unseen: where it was last, carried along with the head."""
        arm, turn = arm_at(side, ago + unseen_arms[:, side])
        (before, frames_before), (now, frames) = torso_at(ago + unseen_arms[:, side]), torso_at(ago)
        head = TORSO.index("head")
        return carry(arm[:, 2], turn, (before[:, head], parts.head_turn[frames_before]), (now[:, head], parts.head_turn[frames]))

    columns = []
    targets = seen = np.empty(0)
    for age in config.window_frames:
        now = np.full(count, age)
        torso, _ = torso_at(now)
        arms = [arm_at(side, now)[0] for side in (0, 1)]
        truth = np.stack([arms[0][:, 1], arms[1][:, 1], arms[0][:, 0], arms[1][:, 0], torso[:, 1], torso[:, 0]], axis=1)
        # What trackers tell may be older than what is true.
        torso, frames = torso_at(now + late)
        hands = [hand_at(side, now + late) for side in (0, 1)]
        anchors = np.stack([torso[:, TORSO.index("head")], hands[0][0], hands[1][0]], axis=1)
        rotations = np.stack([parts.head_turn[frames], hands[0][1], hands[1][1]], axis=1)

        flip = mirrored[:, None, None]
        anchors = np.where(flip, anchors[:, [0, 2, 1]] * _MIRROR, anchors)
        rotations = np.where(flip, rotations[:, [0, 2, 1]] * _MIRROR_TURN, rotations)
        truth = np.where(flip, truth[:, MIRRORED_JOINTS] * _MIRROR, truth)

        positions = anchors + quaternion.rotate(rotations, offsets)
        positions = positions + random.normal(size=positions.shape) * config.trackers.position_noise
        rotations = quaternion.multiply(rotations, np.concatenate([head_jitter[:, None], turn_jitter], axis=1))
        positions, rotations = sink(positions, rotations, unseen / FRAME_RATE, calibrated.eye_height[:, 0], calibrated.arm[:, 0])
        vector, _ = frame_features(positions, rotations, calibrated, ~lost)
        columns.append(vector)
        if age == 0:
            targets, seen = target(truth, positions, rotations, calibrated, vector), seen_from_chest(vector)
    arms_of = np.stack([parts.person[frames] for frames in arm_frames], axis=1)
    whose = np.column_stack([parts.person[newest], np.where(mirrored[:, None], arms_of[:, ::-1], arms_of)])
    return Batch(np.concatenate([*columns, seen], axis=1).astype(np.float32), targets.astype(np.float32), whose)
