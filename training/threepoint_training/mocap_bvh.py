"""Biovision hierarchies (.bvh). A joint is its bone's origin; an end site is named "<parent>:end"."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from . import quaternion
from .motion import MocapError, Motion


def parse_bvh(path: Path) -> Motion:
    """Reads skeleton and motion; what is malformed raises MocapError with the line."""
    lines = path.read_text(errors="replace").splitlines()
    names: list[str] = []
    parents: list[int] = []
    offsets: list[NDArray[np.float64]] = []
    channels: list[tuple[str, ...]] = []
    stack: list[int] = []
    pending: str | None = None
    motion_line: int | None = None
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
                pending = f"{names[stack[-1]]}:end" if stack else "end"
            case "{":
                if pending is None:
                    raise fail("“{” without a joint before it")
                names.append(pending)
                parents.append(stack[-1] if stack else -1)
                offsets.append(np.zeros(3))
                channels.append(())
                stack.append(len(names) - 1)
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
                offsets[stack[-1]] = offset
            case "CHANNELS":
                if not stack or len(words) < 2 or not words[1].isdigit() or len(words) != 2 + int(words[1]):
                    raise fail(f"CHANNELS should be a count and as many names, is “{' '.join(words[1:])}”")
                channels[stack[-1]] = tuple(words[2:])
            case "MOTION":
                motion_line = number
                break
            case _:
                raise fail(f"“{words[0]}” is not known in a BVH hierarchy")
    if motion_line is None:
        raise MocapError(f"{path.name}: no MOTION section")
    if stack:
        raise MocapError(f"{path.name}, line {motion_line}: the hierarchy is not closed before MOTION")

    frame_time: float | None = None
    declared: int | None = None
    width = sum(len(channel) for channel in channels)
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
                raise fail("a frame has something that is no number") from None
            if len(row) != width:
                raise fail(f"a frame has {len(row)} numbers, the hierarchy has {width} channels")
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

    frames = len(values)
    positions = np.zeros((frames, len(names), 3))
    rotations = np.zeros((frames, len(names), 4))
    rest = np.zeros((len(names), 3))
    column = 0
    axes = {"X": np.array([1.0, 0, 0]), "Y": np.array([0, 1.0, 0]), "Z": np.array([0, 0, 1.0])}
    for joint, parent in enumerate(parents):
        local = np.broadcast_to(offsets[joint], (frames, 3)).copy()
        turn = np.broadcast_to([0.0, 0.0, 0.0, 1.0], (frames, 4))
        for channel in channels[joint]:
            axis, kind = channel[0].upper(), channel[1:].lower()
            if kind == "position":
                # A root's position replaces its offset; the same channel on other joints does too in files that carry them.
                local[:, "XYZ".index(axis)] = values[:, column]
            elif kind == "rotation" and axis in axes:
                step = quaternion.from_axis_angle(np.broadcast_to(axes[axis], (frames, 3)), np.radians(values[:, column]))
                turn = quaternion.multiply(turn, step)
            else:
                raise MocapError(f"{path.name}: channel “{channel}” of {names[joint]} is not known")
            column += 1
        if parent < 0:
            positions[:, joint] = local
            rotations[:, joint] = turn
        else:
            rest[joint] = rest[parent] + offsets[joint]
            positions[:, joint] = positions[:, parent] + quaternion.rotate(rotations[:, parent], local)
            rotations[:, joint] = quaternion.multiply(rotations[:, parent], turn)
    return Motion(tuple(names), rest, positions, rotations, 1.0 / frame_time)
