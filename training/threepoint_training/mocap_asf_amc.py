"""Acclaim skeletons (.asf) and motions (.amc).

Joints are named by their bones: "lhumerus" is where the bone starts, "lhumerus:end" where it ends. The root is "root".
A bone's rotation in its parent is C·M·C⁻¹ with the bone's `axis` C and the motion's angles M, both R = Rz·Ry·Rx for order XYZ.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from . import quaternion
from .motion import MocapError, Motion


@dataclass(frozen=True)
class Bone:
    """A bone in rest: from the end of its parent along direction·length (in the file's units)."""

    name: str
    direction: NDArray[np.float64]
    length: float
    axis: NDArray[np.float64]
    dof: tuple[str, ...]
    parent: str


@dataclass(frozen=True)
class AsfSkeleton:
    """Bones in parent-before-child order, the root's channel order and the factor from degrees or radians to radians."""

    path: Path
    bones: tuple[Bone, ...]
    root_order: tuple[str, ...]
    root_axis: NDArray[np.float64]
    root_position: NDArray[np.float64]
    radians_per_unit: float


def euler_quaternion(angles: NDArray[np.float64], order: str = "xyz") -> NDArray[np.float64]:
    """Rotations [..., 4] of angles [..., 3] about x, y, z [rad] applied in the given order (xyz: R = Rz·Ry·Rx)."""
    q = np.zeros((*angles.shape[:-1], 4))
    q[..., 3] = 1.0
    for name in order.lower():
        axis = np.eye(3)["xyz".index(name)]
        turn = quaternion.from_axis_angle(np.broadcast_to(axis, angles.shape), angles[..., "xyz".index(name)])
        q = quaternion.multiply(turn, q)
    return q


def parse_asf(path: Path) -> AsfSkeleton:
    """Reads a skeleton; what is missing or malformed raises MocapError with the line."""
    section = ""
    radians_per_unit = np.pi / 180
    root: dict[str, list[str]] = {}
    blocks: list[dict[str, list[str]]] = []
    children: list[tuple[str, str]] = []
    block: dict[str, list[str]] | None = None
    line_number = 0

    def fail(message: str) -> MocapError:
        return MocapError(f"{path.name}, line {line_number}: {message}")

    def numbers(words: list[str], count: int, what: str) -> NDArray[np.float64]:
        try:
            values = np.array([float(word) for word in words[:count]])
        except ValueError:
            raise fail(f"{what} should be {count} numbers, is “{' '.join(words)}”") from None
        if len(values) < count or not np.all(np.isfinite(values)):
            raise fail(f"{what} should be {count} numbers, is “{' '.join(words)}”")
        return values

    parsed: list[tuple[str, NDArray[np.float64], float, NDArray[np.float64], str, tuple[str, ...]]] = []
    for line_number, line in enumerate(path.read_text(errors="replace").splitlines(), start=1):
        words = line.split("#")[0].split()
        if not words:
            continue
        if words[0].startswith(":"):
            section = words[0]
            continue
        if section == ":units" and words[0] == "angle":
            radians_per_unit = np.pi / 180 if words[1:2] == ["deg"] else 1.0
        elif section == ":root":
            root[words[0]] = words[1:]
        elif section == ":bonedata":
            if words[0] == "begin":
                block = {}
            elif words[0] == "end":
                if block is None or "name" not in block or not block["name"]:
                    raise fail("a bone without a name ends here")
                direction = numbers(block.get("direction", []), 3, f"the direction of {block['name'][0]}")
                length = float(numbers(block.get("length", []), 1, f"the length of {block['name'][0]}")[0])
                axis_words = block.get("axis", ["0", "0", "0", "XYZ"])
                axis = numbers(axis_words, 3, f"the axis of {block['name'][0]}")
                order = axis_words[3] if len(axis_words) > 3 else "XYZ"
                norm = np.linalg.norm(direction)
                if norm > 0:
                    direction = direction / norm
                parsed.append((block["name"][0], direction, length, axis, order, tuple(word.lower() for word in block.get("dof", []))))
                block = None
            elif block is not None and words[0] in ("name", "direction", "length", "axis", "dof"):
                block[words[0]] = words[1:]
        elif section == ":hierarchy" and words[0] not in ("begin", "end"):
            children += [(child, words[0]) for child in words[1:]]

    if not parsed:
        raise MocapError(f"{path.name}: no :bonedata with bones, so this is no ASF skeleton")
    parent_of = dict(children)
    by_name = {entry[0]: entry for entry in parsed}
    bones: list[Bone] = []
    placed = {"root"}
    for child, parent in children:
        if child not in by_name:
            raise MocapError(f"{path.name}: the hierarchy names “{child}”, but :bonedata has no such bone")
    remaining = [entry for entry in parsed if entry[0] in parent_of]
    while remaining:
        ready = [entry for entry in remaining if parent_of[entry[0]] in placed]
        if not ready:
            raise MocapError(f"{path.name}: the hierarchy does not lead from the root to {remaining[0][0]}")
        for name, direction, length, axis, order, dof in ready:
            axis_quaternion = euler_quaternion(axis * radians_per_unit, order)
            bones.append(Bone(name, direction, length, axis_quaternion, dof, parent_of[name]))
            placed.add(name)
        remaining = [entry for entry in remaining if entry[0] not in placed]
    orientation = np.array([float(word) for word in root.get("orientation", ["0", "0", "0"])[:3]])
    axis_order = (root.get("axis") or ["XYZ"])[0]
    return AsfSkeleton(
        path=path,
        bones=tuple(bones),
        root_order=tuple(word.lower() for word in root.get("order", ["TX", "TY", "TZ", "RX", "RY", "RZ"])),
        root_axis=euler_quaternion(orientation * radians_per_unit, axis_order),
        root_position=np.array([float(word) for word in root.get("position", ["0", "0", "0"])[:3]]),
        radians_per_unit=radians_per_unit,
    )


def _read_channels(path: Path, skeleton: AsfSkeleton) -> NDArray[np.float64]:
    """All channels of a motion, [frames, channels], in the order root, then bones with degrees of freedom."""
    expected = {"root": len(skeleton.root_order)} | {bone.name: len(bone.dof) for bone in skeleton.bones if bone.dof}
    offsets: dict[str, int] = {}
    total = 0
    for name, count in expected.items():
        offsets[name] = total
        total += count
    frames: list[list[float]] = []
    row: list[float] = []
    seen: set[str] = set()
    started = 0

    def close(line_number: int) -> None:
        if started and len(seen) < len(expected):
            missing = next(name for name in expected if name not in seen)
            raise MocapError(f"{path.name}, line {line_number}: frame {started} ends without “{missing}”")

    with path.open(errors="replace") as lines:
        line_number = 0
        for line_number, line in enumerate(lines, start=1):
            words = line.split()
            if not words or words[0][0] in "#:":
                continue
            if len(words) == 1 and words[0].isdigit():
                close(line_number)
                row = [0.0] * total
                frames.append(row)
                seen = set()
                started = int(words[0])
                continue
            name = words[0]
            count = expected.get(name)
            if count is None or not started:
                raise MocapError(f"{path.name}, line {line_number}: “{name}” is no bone with freedom in {skeleton.path.name}")
            try:
                values = [float(word) for word in words[1:]]
            except ValueError:
                raise MocapError(f"{path.name}, line {line_number}: “{line.strip()}” has something that is no number") from None
            if len(values) != count:
                raise MocapError(f"{path.name}, line {line_number}: {name} has {len(values)} numbers, its skeleton says {count}")
            row[offsets[name] : offsets[name] + count] = values
            seen.add(name)
        close(line_number)
    if not frames:
        raise MocapError(f"{path.name}: no frames")
    channels = np.array(frames)
    bad = np.flatnonzero(~np.all(np.isfinite(channels), axis=1))
    if len(bad):
        raise MocapError(f"{path.name}: frame {bad[0] + 1} has a number that is not finite")
    return channels


def _joint_names(skeleton: AsfSkeleton) -> tuple[str, ...]:
    return ("root", *(bone.name for bone in skeleton.bones), *(f"{bone.name}:end" for bone in skeleton.bones))


def parse_amc(path: Path, skeleton: AsfSkeleton, frame_rate: float | None = None) -> Motion:
    """Reads a motion of that skeleton; AMC carries no frame rate, so the caller gives it."""
    channels = _read_channels(path, skeleton)
    count = len(channels)
    names = _joint_names(skeleton)

    def pose(channel_values: NDArray[np.float64] | None) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        frames = 1 if channel_values is None else len(channel_values)
        column = 0
        identity = np.broadcast_to([0.0, 0.0, 0.0, 1.0], (frames, 4))

        def take(dof: tuple[str, ...]) -> dict[str, NDArray[np.float64]]:
            nonlocal column
            values = {}
            for name in dof:
                values[name] = np.zeros(frames) if channel_values is None else channel_values[:, column]
                column += 1
            return values

        def turn(values: dict[str, NDArray[np.float64]], axis: NDArray[np.float64]) -> NDArray[np.float64]:
            angles = np.stack([values.get(name, np.zeros(frames)) for name in ("rx", "ry", "rz")], -1) * skeleton.radians_per_unit
            order = "".join(name[1] for name in values if name in ("rx", "ry", "rz"))
            motion = euler_quaternion(angles, order or "xyz")
            return quaternion.multiply(axis, quaternion.multiply(motion, quaternion.conjugate(axis)))

        root = take(skeleton.root_order)
        position = np.stack([root.get(name, np.zeros(frames)) for name in ("tx", "ty", "tz")], -1) + skeleton.root_position
        rotations = {"root": turn(root, skeleton.root_axis)}
        starts = {"root": position}
        ends = {"root": position}
        for bone in skeleton.bones:
            local = turn(take(bone.dof), bone.axis) if bone.dof else identity
            rotations[bone.name] = quaternion.multiply(rotations[bone.parent], local)
            starts[bone.name] = ends[bone.parent]
            ends[bone.name] = starts[bone.name] + quaternion.rotate(
                rotations[bone.name], np.broadcast_to(bone.direction * bone.length, (frames, 3))
            )
        order = [bone.name for bone in skeleton.bones]
        positions = np.stack([starts["root"], *(starts[name] for name in order), *(ends[name] for name in order)], axis=1)
        turns = np.stack([rotations["root"], *(rotations[name] for name in order), *(rotations[name] for name in order)], axis=1)
        return positions, turns

    rest, _ = pose(None)
    positions, rotations = pose(channels)
    assert positions.shape[0] == count
    return Motion(names, rest[0] - skeleton.root_position, positions, rotations, frame_rate)
