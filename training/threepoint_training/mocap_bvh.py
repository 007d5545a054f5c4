"""Biovision hierarchies (.bvh). A joint is its bone's origin; an end site is named "<parent>:end"."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from . import quaternion
from .bvh_hierarchy import BvhHierarchy
from .cmuconvert import put_back_lost_bones
from .motion import MocapError, Motion
from .rest_pose import take_as_rest

_AXES = {"X": np.array([1.0, 0, 0]), "Y": np.array([0, 1.0, 0]), "Z": np.array([0, 0, 1.0])}


def parse_bvh(path: Path, rest_pose: Mapping[str, tuple[float, ...]] | None = None) -> Motion:
    """
    Reads skeleton and motion; what is malformed raises MocapError with the line. The rest is the pose of all angles
    zero, or that of `rest_pose`: the angles [degrees] of joints in the order of their rotation channels; joints it
    leaves out have zeros.
    """
    lines = path.read_text(errors="replace").splitlines()
    hierarchy, motion_line = _read_hierarchy(path, lines)
    values, frame_time = _read_frames(path, lines, motion_line, sum(map(len, hierarchy.channels)))
    notes = put_back_lost_bones(hierarchy)
    positions, rotations = _pose(path, hierarchy, values)
    motion = Motion(tuple(hierarchy.names), hierarchy.rest_positions(), positions, rotations, 1.0 / frame_time, notes)
    if rest_pose is None:
        return motion
    rest_positions, rest_rotations = _pose(path, hierarchy, _channels_of(path, hierarchy, rest_pose))
    return take_as_rest(motion, rest_positions[0], rest_rotations[0])


def _read_hierarchy(path: Path, lines: list[str]) -> tuple[BvhHierarchy, int]:
    """What stands before MOTION, and that line's number."""
    hierarchy, stack = BvhHierarchy(), list[int]()
    pending: str | None = None
    number = 0

    def fail(message: str) -> MocapError:
        return MocapError(f"{path.name}, line {number}: {message}")

    for number, line in enumerate(lines, start=1):
        words = line.split()
        if not words:
            continue
        match words[0].upper():
            case "HIERARCHY":
                pass
            case "ROOT" | "JOINT":
                pending = " ".join(words[1:])
                if not pending:
                    raise fail("a joint without a name")
            case "END":
                pending = f"{hierarchy.names[stack[-1]]}:end" if stack else "end"
            case "{":
                if pending is None:
                    raise fail("“{” without a joint before it")
                stack.append(hierarchy.open(pending, stack[-1] if stack else -1))
                pending = None
            case "}":
                if not stack:
                    raise fail("“}” closes nothing")
                stack.pop()
            case "OFFSET":
                try:
                    offset = np.array([float(word) for word in words[1:4]])
                except ValueError:
                    raise fail(f"OFFSET should be three numbers, is “{' '.join(words[1:])}”") from None
                if not stack or offset.shape != (3,):
                    raise fail("OFFSET should be three numbers inside a joint")
                hierarchy.offsets[stack[-1]] = offset
            case "CHANNELS":
                if not stack or len(words) < 2 or not words[1].isdigit() or len(words) != 2 + int(words[1]):
                    raise fail(f"CHANNELS should be a count and as many names, is “{' '.join(words[1:])}”")
                hierarchy.channels[stack[-1]] = tuple(words[2:])
            case "MOTION":
                if stack:
                    raise fail("the hierarchy is not closed before MOTION")
                return hierarchy, number
            case _:
                raise fail(f"“{words[0]}” is not known in a BVH hierarchy")
    raise MocapError(f"{path.name}: no MOTION section")


def _read_frames(path: Path, lines: list[str], motion_line: int, width: int) -> tuple[NDArray[np.float64], float]:
    """The channels of all frames [frames, width] after the line MOTION, and the time between frames [s]."""
    frame_time: float | None = None
    declared: int | None = None
    rows: list[list[float]] = []
    for number, line in enumerate(lines[motion_line:], start=motion_line + 1):
        text = line.strip()
        if not text:
            continue
        lower = text.lower()
        if lower.startswith("frames:"):
            declared = int(text.split(":")[1])
        elif lower.startswith("frame time:"):
            frame_time = float(text.split(":")[1])
        else:
            try:
                row = [float(word) for word in text.split()]
            except ValueError:
                raise MocapError(f"{path.name}, line {number}: a frame has something that is no number") from None
            if len(row) != width:
                raise MocapError(
                    f"{path.name}, line {number}: a frame has {len(row)} numbers, the hierarchy has {width} channels"
                )
            rows.append(row)
    if not rows:
        raise MocapError(f"{path.name}: no frames")
    if declared is not None and declared != len(rows):
        raise MocapError(f"{path.name}: “Frames: {declared}”, but {len(rows)} follow")
    if not frame_time or frame_time <= 0:
        raise MocapError(f"{path.name}: frame rate unknown; a line “Frame Time: seconds” is needed")
    values = np.array(rows)
    if not np.all(np.isfinite(values)):
        raise MocapError(
            f"{path.name}: frame {int(np.flatnonzero(~np.isfinite(values).all(1))[0]) + 1} has a number that is not finite"
        )
    return values, frame_time


def _channels_of(
    path: Path, hierarchy: BvhHierarchy, rest_pose: Mapping[str, tuple[float, ...]]
) -> NDArray[np.float64]:
    """One frame [1, channels] of these angles, the root at the origin, every other joint at its offset."""
    for name in rest_pose:
        if name not in hierarchy.names:
            raise MocapError(f"{path.name}: no joint “{name}”, which the map's restPose turns")
    row: list[float] = []
    for joint, channels in enumerate(hierarchy.channels):
        angles = rest_pose.get(hierarchy.names[joint], ())
        turning = sum(channel.lower().endswith("rotation") for channel in channels)
        if angles and len(angles) != turning:
            raise MocapError(
                f"{path.name}: restPose gives {hierarchy.names[joint]} {len(angles)} angles, the file {turning} rotation channels"
            )
        remaining = iter(angles or (0.0,) * turning)
        for channel in channels:
            axis = "XYZ".find(channel[0].upper())
            at_offset = 0.0 if hierarchy.parents[joint] < 0 else float(hierarchy.offsets[joint][axis])
            row.append(next(remaining) if channel.lower().endswith("rotation") else at_offset)
    return np.array([row])


def _pose(
    path: Path, hierarchy: BvhHierarchy, values: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Forward kinematics of the channels: positions [frames, joints, 3] and global rotations [frames, joints, 4]."""
    frames, count = len(values), len(hierarchy.names)
    positions = np.zeros((frames, count, 3))
    rotations = np.zeros((frames, count, 4))
    column = 0
    for joint, parent in enumerate(hierarchy.parents):
        local = np.broadcast_to(hierarchy.offsets[joint], (frames, 3)).copy()
        turn = np.broadcast_to([0.0, 0.0, 0.0, 1.0], (frames, 4))
        for channel in hierarchy.channels[joint]:
            axis, kind = channel[0].upper(), channel[1:].lower()
            if kind == "position" and axis in _AXES:
                # A root's position replaces its offset; the same channel on other joints does too in files that carry
                # them.
                local[:, "XYZ".index(axis)] = values[:, column]
            elif kind == "rotation" and axis in _AXES:
                step = quaternion.from_axis_angle(
                    np.broadcast_to(_AXES[axis], (frames, 3)), np.radians(values[:, column])
                )
                turn = quaternion.multiply(turn, step)
            else:
                raise MocapError(f"{path.name}: channel “{channel}” of {hierarchy.names[joint]} is not known")
            column += 1
        if parent < 0:
            positions[:, joint] = local
            rotations[:, joint] = turn
        else:
            positions[:, joint] = positions[:, parent] + quaternion.rotate(rotations[:, parent], local)
            rotations[:, joint] = quaternion.multiply(rotations[:, parent], turn)
    return positions, rotations
