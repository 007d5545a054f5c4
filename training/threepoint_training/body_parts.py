"""Torsos and arms of recorded people, from which `augment` puts bodies together."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from . import hand_tilt, mirror, quaternion
from .arrays import Array
from .prepared_corpus import PreparedCorpus, chest_axes_of, joints_of

TORSO = ("hips", "chest", "neck", "head")
ARM = ("UpperArm", "LowerArm", "Hand")


@dataclass(frozen=True)
class BalanceConfig:
    """How often a frame is drawn: in proportion to (frames of its person)^-people · (frames of its posture's
    cluster)^-postures.
    """

    people: float = 0.25
    postures: float = 0.7
    clusters: int = 200


class BodyParts:
    """The frames [F] of some people taken apart.

    Torsos are in the floor frame [m]. Arms hang from the neck, in the frame of the chest by the true joints, `chest`
    [F, 4]; left arms are kept as their mirror images, so that each arm is a right one.
    """

    def __init__(
        self, corpus: PreparedCorpus, people: tuple[str, ...], balance: BalanceConfig = BalanceConfig()
    ) -> None:
        clips = corpus.clips_of(people)
        frames = corpus.frames_of(people)
        positions = corpus.positions[frames].astype(np.float64)
        rotations = corpus.rotations[frames].astype(np.float64)
        joint = joints_of(positions)
        sizes = [
            (corpus.people[corpus.clip_people[clip]].eye_height, corpus.people[corpus.clip_people[clip]].arm_span)
            for clip in clips
        ]
        lengths = np.diff(corpus.clip_starts)[clips]
        self.clip_start = np.repeat(np.cumsum([0, *lengths[:-1]]), lengths)
        self.sizes = np.repeat(np.array(sizes), lengths, axis=0)
        names = np.array([corpus.clip_people[clip] for clip in clips])
        people_by_index, self.person = np.unique(np.repeat(names, lengths), return_inverse=True)

        self.chest = quaternion.from_matrix(np.stack(chest_axes_of(joint), axis=-1))
        self.torso = np.stack([joint[name] for name in TORSO], axis=1)
        self.head_turn = rotations[:, 0]
        inverse_chest = quaternion.conjugate(self.chest)
        self.arms = []
        self.wrist_turns = []
        for side, turn in (("left", 1), ("right", 2)):
            arm = np.stack([joint[f"{side}{part}"] for part in ARM], axis=1) - joint["neck"][:, None]
            arm = quaternion.rotate(np.broadcast_to(inverse_chest[:, None], (*arm.shape[:-1], 4)), arm)
            wrist = quaternion.multiply(inverse_chest, rotations[:, turn])
            self.arms.append(arm * mirror.POSITION if side == "left" else arm)
            self.wrist_turns.append(wrist * mirror.ROTATION if side == "left" else wrist)
        forearms = hand_tilt.ForearmMeans(corpus, people)
        own = np.stack([forearms.of(name) for name in people_by_index])
        # Tilts of each person's left and right hand [P, 2, 2], both as of a right hand.
        self.tilts = np.stack([own[:, 0] * mirror.TILT, own[:, 1]], axis=1)
        self.arm_length = [
            np.linalg.norm(arm[:, 1] - arm[:, 0], axis=-1) + np.linalg.norm(arm[:, 2] - arm[:, 1], axis=-1)
            for arm in self.arms
        ]
        # Shares of the left and the right forearm in their arm length [F, 2].
        self.forearm_shares = np.stack(
            [
                np.linalg.norm(arm[:, 2] - arm[:, 1], axis=-1) / length
                for arm, length in zip(self.arms, self.arm_length, strict=True)
            ],
            axis=1,
        )
        weights = frequency(self.person) ** -balance.people
        if balance.postures > 0:
            weights *= frequency(clusters_of(self._postures(), balance.clusters)) ** -balance.postures
        self._cumulative_trunks, self._cumulative_arms = (
            np.cumsum(each) / each.sum() for each in (weights, np.tile(weights, 2))
        )

    def _postures(self) -> Array:
        """The posture [F, 16] of each frame, numbers of about equal spread: elbows and wrists from the neck in the
        chest frame, in arm lengths; the room's up in the chest frame; the head's height, in half eye heights.
        """
        arms = [arm[:, 1:] / length[:, None, None] for arm, length in zip(self.arms, self.arm_length, strict=True)]
        up = np.broadcast_to([0.0, 1.0, 0.0], (len(self.chest), 3))
        lean = quaternion.rotate(quaternion.conjugate(self.chest), up)
        height = self.torso[:, TORSO.index("head"), 1] / self.sizes[:, 0]
        return np.concatenate([*(arm.reshape(len(arm), -1) for arm in arms), lean, 2 * height[:, None]], axis=1)

    def draw_trunks(self, random: np.random.Generator, count: int) -> NDArray[np.int64]:
        """Frames [N] to take trunks from, people balanced."""
        return _drawn(self._cumulative_trunks, random, count)

    def draw_arms(self, random: np.random.Generator, count: int) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Frames [N] to take arms from, people balanced, and which arm of each [N]: 0 the left, 1 the right."""
        side, frame = np.divmod(_drawn(self._cumulative_arms, random, count), len(self.person))
        return frame, side


def _drawn(cumulative: Array, random: np.random.Generator, count: int) -> NDArray[np.int64]:
    return np.searchsorted(cumulative, random.uniform(size=count)).clip(max=len(cumulative) - 1)


# k-means runs on this many frames, this many times; the centres hardly move afterwards.
_SAMPLE, _ITERATIONS, _SEED = 20_000, 10, 7


def clusters_of(postures: Array, clusters: int) -> NDArray[np.int64]:
    """Returns the cluster [F] of each posture [F, D]: k-means (Lloyd) that starts from postures drawn at random."""
    random = np.random.default_rng(_SEED)
    sample = postures[random.choice(len(postures), min(_SAMPLE, len(postures)), replace=False)]
    centres = sample[:clusters]
    for _ in range(_ITERATIONS):
        nearest = _nearest(sample, centres)
        counts = np.bincount(nearest, minlength=len(centres))[:, None]
        sums = np.stack([np.bincount(nearest, column, len(centres)) for column in sample.T], axis=1)
        # A centre that is nearest to no posture keeps its place.
        centres = np.where(counts > 0, sums / np.maximum(counts, 1), centres)
    return _nearest(postures, centres)


def _nearest(postures: Array, centres: Array) -> NDArray[np.int64]:
    half_squares = (centres**2).sum(axis=1) / 2
    blocks = np.array_split(postures, len(postures) // 8192 + 1)
    return np.concatenate([np.argmin(half_squares - block @ centres.T, axis=1) for block in blocks])


def frequency(labels: NDArray[np.int64]) -> Array:
    """Returns how many frames [F] share each frame's label [F]."""
    return np.bincount(labels)[labels].astype(np.float64)
