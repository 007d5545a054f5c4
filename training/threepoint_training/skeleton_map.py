"""Maps the joints of a file to the project's joints: built in for CMU's ASF, else from JSON.
"""

import json
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .mocap_rules import RULES
from .motion import MocapError

REQUIRED_JOINTS = (
    "hips", "chest", "neck", "head",
    "leftUpperArm", "leftLowerArm", "leftHand",
    "rightUpperArm", "rightLowerArm", "rightHand",
)  # fmt: skip
OPTIONAL_JOINTS = (
    "spine",
    "leftUpperLeg", "leftLowerLeg", "leftFoot", "leftToes",
    "rightUpperLeg", "rightLowerLeg", "rightFoot", "rightToes",
)  # fmt: skip
_AXES = {"+x": (1, 0, 0), "-x": (-1, 0, 0), "+y": (0, 1, 0), "-y": (0, -1, 0), "+z": (0, 0, 1), "-z": (0, 0, -1)}


@dataclass(frozen=True)
class SkeletonMap:
    """
    joints: our name to the file's. scale [m per unit] is None where it must be guessed. rotations: whose turn head and
    hands follow. rest_frame: a frame in T-pose (from 1), of each file or of rest_file; rest_pose: its angles [degrees]
    by joint; neither: all angles 0.
    """

    name: str
    joints: dict[str, str]
    scale: float | None = None
    frame_rate: float | None = None
    up: str = "+y"
    forward: str = "+z"
    rotations: dict[str, str] = field(default_factory=dict)
    rest_frame: int | None = None
    rest_file: Path | None = None
    rest_pose: dict[str, tuple[float, ...]] | None = None

    def floor_from_file(self) -> NDArray[np.float64]:
        """The rotation matrix from the file's axes to ours (+Y up, −Z forward)."""
        up, forward = np.array(_AXES[self.up], float), np.array(_AXES[self.forward], float)
        return np.stack([np.cross(forward, up), up, -forward])


ACCLAIM = SkeletonMap(**RULES["acclaim"])


def read_skeleton_map(path: Path) -> SkeletonMap:
    """Reads a map from JSON; anything missing or unknown raises MocapError with a sentence."""
    try:
        content = json.loads(path.read_text())
    except json.JSONDecodeError as error:
        raise MocapError(f"{path.name}, line {error.lineno}: no valid JSON: {error.msg}") from None
    if not isinstance(content, dict) or not isinstance(content.get("joints"), dict):
        raise MocapError(f"{path.name}: expected an object with “joints”")
    unknown = set(content) - {
        "name",
        "scale",
        "frameRate",
        "up",
        "forward",
        "joints",
        "rotations",
        "restFrame",
        "restPose",
    }
    if unknown:
        raise MocapError(f"{path.name}: “{sorted(unknown)[0]}” is not known; see docs/accuracy.md")
    joints = content["joints"]
    for joint in REQUIRED_JOINTS:
        if not isinstance(joints.get(joint), str):
            raise MocapError(f"{path.name}: joints.{joint} is missing")
    for joint in joints:
        if joint not in REQUIRED_JOINTS + OPTIONAL_JOINTS:
            raise MocapError(
                f"{path.name}: joints.{joint} is none of ours ({', '.join(REQUIRED_JOINTS + OPTIONAL_JOINTS)})"
            )
    for key in ("up", "forward"):
        if content.get(key, "+y") not in _AXES:
            raise MocapError(f"{path.name}: “{key}” should be one of {', '.join(_AXES)}")
    for key in ("scale", "frameRate"):
        value = content.get(key)
        if value is not None and (not isinstance(value, int | float) or value <= 0):
            raise MocapError(f"{path.name}: “{key}” should be a number above zero")
    up, forward = content.get("up", "+y"), content.get("forward", "+z")
    if up[1] == forward[1]:
        raise MocapError(f"{path.name}: “up” {up} and “forward” {forward} are one axis")
    rest_frame, rest_file = _rest_frame(content, path)
    return SkeletonMap(
        name=content.get("name", path.stem),
        joints=dict(joints),
        scale=content.get("scale"),
        frame_rate=content.get("frameRate"),
        up=up,
        forward=forward,
        rotations=dict(content.get("rotations", {})),
        rest_frame=rest_frame,
        rest_file=rest_file,
        rest_pose=_rest_pose(content, path),
    )


def _rest_frame(content: dict[str, Any], path: Path) -> tuple[int | None, Path | None]:
    """The frame of restFrame and the file it is of (None: each file's own)."""
    given = content.get("restFrame")
    if given is None:
        return None, None
    if "restPose" in content:
        raise MocapError(f"{path.name}: either “restFrame” or “restPose”")
    if isinstance(given, dict) and isinstance(given.get("file"), str) and not set(given) - {"file", "frame"}:
        file = path.parent / given["file"]
        if not file.is_file():
            raise MocapError(f"{path.name}: restFrame.file: no file {file}")
        frame = given.get("frame", 1)
    else:
        file, frame = None, given
    if not isinstance(frame, int) or isinstance(frame, bool) or frame < 1:
        raise MocapError(
            f'{path.name}: “restFrame” should be the number of a frame, from 1, or {{"file": …, "frame": …}}'
        )
    return frame, file


def _rest_pose(content: dict[str, Any], path: Path) -> dict[str, tuple[float, ...]] | None:
    given = content.get("restPose")
    if given is None:
        return None
    if not isinstance(given, dict):
        raise MocapError(f"{path.name}: “restPose” should be an object: angles [degrees] by the file's joint")
    for joint, angles in given.items():
        if not isinstance(angles, list) or not all(
            isinstance(angle, int | float) and not isinstance(angle, bool) for angle in angles
        ):
            raise MocapError(f"{path.name}: restPose.{joint} should be a list of angles [degrees]")
    return {joint: tuple(map(float, angles)) for joint, angles in given.items()}


def find_skeleton_map(names: tuple[str, ...], file_name: str) -> SkeletonMap:
    """Returns the map of an Acclaim skeleton without what the file lacks; without a needed joint raises MocapError."""
    missing = [joint for joint in REQUIRED_JOINTS if ACCLAIM.joints[joint] not in names]
    if missing:
        raise MocapError(
            f"{file_name}: the skeleton has no {' and no '.join(missing)} (it has {', '.join(names[:8])}, …); give a map with --skeleton MAP.json"
        )
    return replace(ACCLAIM, joints={ours: theirs for ours, theirs in ACCLAIM.joints.items() if theirs in names})
