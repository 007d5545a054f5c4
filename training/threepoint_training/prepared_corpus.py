"""The prepared motion: what every later step reads."""

import json
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from .arrays import Array

JOINTS = (
    "hips", "spine", "chest", "neck", "head",
    "leftUpperArm", "leftLowerArm", "leftHand",
    "rightUpperArm", "rightLowerArm", "rightHand",
)  # fmt: skip
# What no estimator gives: truth for measuring legs alone.
LEG_JOINTS = (
    "leftUpperLeg", "leftLowerLeg", "leftFoot", "leftToes",
    "rightUpperLeg", "rightLowerLeg", "rightFoot", "rightToes",
)  # fmt: skip
ROTATIONS = ("head", "leftHand", "rightHand")
# The indices of the tracked joints in JOINTS.
TRACKED_COLUMNS = [JOINTS.index(joint) for joint in ROTATIONS]

# The six joints that no tracker sees, in the order of every tensor (src/threepoint/core/body/joints.ts).
ESTIMATED_JOINTS = ("leftLowerArm", "rightLowerArm", "leftUpperArm", "rightUpperArm", "chest", "hips")


def joints_of(positions: Array) -> dict[str, Array]:
    """Each of JOINTS [F, 3] by its name, from positions [F, 11, 3]."""
    return {name: positions[:, index] for index, name in enumerate(JOINTS)}


def chest_axes_of(
    joints: dict[str, Array],
) -> tuple[Array, Array, Array]:
    """The axes [F, 3] of the chest by true joints, unit, in the joints' frame: x from the left to the right shoulder, y
    up the thorax, z backward.
    """
    x = joints["rightUpperArm"] - joints["leftUpperArm"]
    x = x / np.linalg.norm(x, axis=-1, keepdims=True)
    up = joints["neck"] - joints["chest"]
    up = up - np.sum(up * x, axis=-1, keepdims=True) * x
    # A thorax along the line of the shoulders has no direction.
    up = up / np.maximum(np.linalg.norm(up, axis=-1, keepdims=True), 1e-9)
    return x, up, np.cross(x, up)


# Names of people; not a single name, which would be searched for parts of names.
People = set[str] | tuple[str, ...]


@dataclass(frozen=True)
class Person:
    """What a calibration would find: eye height and wrist-to-wrist span [m]."""

    name: str
    eye_height: float
    arm_span: float


@dataclass(frozen=True)
class PreparedCorpus:
    """
    positions [F, 11, 3] (JOINTS) in the floor frame [m]; rotations [F, 3, 4] (ROTATIONS) global, xyzw; 60 Hz. legs [F,
    8, 3] (LEG_JOINTS), NaN where a file has no such joint; None: motion without legs.
    """

    VERSION: ClassVar[int] = 3

    positions: NDArray[np.float32]
    rotations: NDArray[np.float32]
    clips: tuple[str, ...]
    clip_people: tuple[str, ...]
    clip_starts: NDArray[np.int64]
    people: dict[str, Person]
    rate_hz: int
    corpus_hash: str
    problems: tuple[str, ...]
    legs: NDArray[np.float32] | None = None

    def clip_slice(self, clip: int) -> slice:
        """The frames of a clip."""
        return slice(int(self.clip_starts[clip]), int(self.clip_starts[clip + 1]))

    def clips_of(self, people: People) -> list[int]:
        """The clips of these people."""
        return [clip for clip, person in enumerate(self.clip_people) if person in people]

    def frames_of(self, people: People, stride: int = 1) -> NDArray[np.int64]:
        """The frames of these people's clips, one clip after the other: of each clip the first and every `stride`-th
        after it.
        """
        slices = [self.clip_slice(clip) for clip in self.clips_of(people)]
        return np.concatenate([np.arange(each.start, each.stop, stride) for each in slices])

    def minutes_of(self, people: People) -> float:
        """How much motion there is of these people together [min]."""
        slices = [self.clip_slice(clip) for clip in self.clips_of(people)]
        return sum(each.stop - each.start for each in slices) / self.rate_hz / 60

    def truth(self, frames: slice | NDArray[np.int64]) -> NDArray[np.float32]:
        """The six estimated joints [frames, 6, 3]."""
        return self.positions[frames][:, [JOINTS.index(joint) for joint in ESTIMATED_JOINTS]]

    def forearm(self, person: str) -> float:
        """Mean length of a person's forearms, elbow to wrist, over both arms and all frames [m]."""
        positions = self.positions[self.frames_of({person})]
        forearms = [
            positions[:, JOINTS.index(f"{side}Hand")] - positions[:, JOINTS.index(f"{side}LowerArm")]
            for side in ("left", "right")
        ]
        return float(np.linalg.norm(forearms, axis=-1).mean())

    def save(self, path: Path) -> None:
        """Writes one .npz."""
        path.parent.mkdir(parents=True, exist_ok=True)
        meta = {
            "clips": self.clips,
            "clipPeople": self.clip_people,
            "people": [asdict(person) for person in self.people.values()],
            "rateHz": self.rate_hz,
            "corpusHash": self.corpus_hash,
            "problems": self.problems,
        }
        legs = {} if self.legs is None else {"legs": self.legs}
        np.savez(
            path,
            positions=self.positions,
            rotations=self.rotations,
            clip_starts=self.clip_starts,
            meta=json.dumps(meta),
            **legs,
        )

    @staticmethod
    def load(path: Path) -> "PreparedCorpus":
        """Reads what `save` wrote."""
        with np.load(path) as arrays:
            meta = json.loads(str(arrays["meta"]))
            return PreparedCorpus(
                positions=arrays["positions"],
                rotations=arrays["rotations"],
                clips=tuple(meta["clips"]),
                clip_people=tuple(meta["clipPeople"]),
                clip_starts=arrays["clip_starts"],
                people={person["name"]: Person(**person) for person in meta["people"]},
                rate_hz=meta["rateHz"],
                corpus_hash=meta["corpusHash"],
                problems=tuple(meta["problems"]),
                legs=arrays.get("legs"),
            )
