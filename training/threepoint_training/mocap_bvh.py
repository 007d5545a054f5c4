"""Biovision hierarchies (.bvh). A joint is its bone's origin; an end site is named "<parent>:end"."""

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from . import quaternion
from .motion import MocapError, Motion


@dataclass
class _Hierarchy:
    """Joints in the file's order, parents before children (−1: none); offsets in the file's units, channels by joint."""

    names: list[str] = field(default_factory=list)
    parents: list[int] = field(default_factory=list)
    offsets: list[NDArray[np.float64]] = field(default_factory=list)
    channels: list[tuple[str, ...]] = field(default_factory=list)

    def open(self, name: str, parent: int) -> int:
        """The number of a joint that begins here."""
        self.names.append(name)
        self.parents.append(parent)
        self.offsets.append(np.zeros(3))
        self.channels.append(())
        return len(self.names) - 1


def parse_bvh(path: Path) -> Motion:
    """Reads skeleton and motion; what is malformed raises MocapError with the line."""
    lines = path.read_text(errors="replace").splitlines()
    hierarchy, motion_line = _read_hierarchy(path, lines)
    values, frame_time = _read_frames(path, lines, motion_line, sum(map(len, hierarchy.channels)))
    return _pose(path, hierarchy, values, 1.0 / frame_time)


def _read_hierarchy(path: Path, lines: list[str]) -> tuple[_Hierarchy, int]:
    """What stands before MOTION, and that line's number."""
    hierarchy, stack = _Hierarchy(), list[int]()
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
                raise MocapError(f"{path.name}, line {number}: a frame has {len(row)} numbers, the hierarchy has {width} channels")
            rows.append(row)
    if not rows:
        raise MocapError(f"{path.name}: no frames")
    if declared is not None and declared != len(rows):
        raise MocapError(f"{path.name}: “Frames: {declared}”, but {len(rows)} follow")
    if not frame_time or frame_time <= 0:
        raise MocapError(f"{path.name}: frame rate unknown; a line “Frame Time: seconds” is needed")
    values = np.array(rows)
    if not np.all(np.isfinite(values)):
        raise MocapError(f"{path.name}: frame {int(np.flatnonzero(~np.isfinite(values).all(1))[0]) + 1} has a number that is not finite")
    return values, frame_time


def _pose(path: Path, hierarchy: _Hierarchy, values: NDArray[np.float64], frame_rate: float) -> Motion:
    """Forward kinematics of the channels."""
    frames, count = len(values), len(hierarchy.names)
    positions = np.zeros((frames, count, 3))
    rotations = np.zeros((frames, count, 4))
    rest = np.zeros((count, 3))
    column = 0
    axes = {"X": np.array([1.0, 0, 0]), "Y": np.array([0, 1.0, 0]), "Z": np.array([0, 0, 1.0])}
    for joint, parent in enumerate(hierarchy.parents):
        local = np.broadcast_to(hierarchy.offsets[joint], (frames, 3)).copy()
        turn = np.broadcast_to([0.0, 0.0, 0.0, 1.0], (frames, 4))
        for channel in hierarchy.channels[joint]:
            axis, kind = channel[0].upper(), channel[1:].lower()
            if kind == "position":
                # A root's position replaces its offset; the same channel on other joints does too in files that carry them.
                local[:, "XYZ".index(axis)] = values[:, column]
            elif kind == "rotation" and axis in axes:
                step = quaternion.from_axis_angle(np.broadcast_to(axes[axis], (frames, 3)), np.radians(values[:, column]))
                turn = quaternion.multiply(turn, step)
            else:
                raise MocapError(f"{path.name}: channel “{channel}” of {hierarchy.names[joint]} is not known")
            column += 1
        if parent < 0:
            positions[:, joint] = local
            rotations[:, joint] = turn
        else:
            rest[joint] = rest[parent] + hierarchy.offsets[joint]
            positions[:, joint] = positions[:, parent] + quaternion.rotate(rotations[:, parent], local)
            rotations[:, joint] = quaternion.multiply(rotations[:, parent], turn)
    return Motion(tuple(hierarchy.names), rest, positions, rotations, frame_rate)
