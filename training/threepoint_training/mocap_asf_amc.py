"""Acclaim skeletons (.asf) and motions (.amc).

Joints are named by their bones: "lhumerus" is where the bone starts, "lhumerus:end" where it ends. The root is "root".
A bone's rotation in its parent is C·M·C⁻¹ with the bone's `axis` C and the motion's angles M, both R = Rz·Ry·Rx for
order XYZ.
"""

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from . import quaternion
from .motion import MocapError, Motion

# What the head of an .amc file says of its angles, in radians; without it they are in the skeleton's unit.
_RADIANS_PER_UNIT = {":DEGREES": np.pi / 180, ":RADIANS": 1.0}


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
    """Bones in parent-before-child order, the root's channel order, the factor to radians of its angles and of a
    motion's that names no unit.
    """

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


@dataclass(frozen=True)
class _RawBone:
    """A bone as :bonedata has it; angles in the file's unit."""

    name: str
    direction: NDArray[np.float64]
    length: float
    axis: NDArray[np.float64]
    axis_order: str
    dof: tuple[str, ...]


@dataclass
class _Sections:
    """What an .asf file says, before its bones are put in order."""

    radians_per_unit: float = np.pi / 180
    root: dict[str, list[str]] = field(default_factory=dict)
    bones: dict[str, _RawBone] = field(default_factory=dict)
    # Parents by child.
    parents: dict[str, str] = field(default_factory=dict)


def parse_asf(path: Path) -> AsfSkeleton:
    """Reads a skeleton; what is missing or malformed raises MocapError with the line."""
    sections = _read_sections(path)
    orientation = np.array([float(word) for word in sections.root.get("orientation", ["0", "0", "0"])[:3]])
    axis_order = (sections.root.get("axis") or ["XYZ"])[0]
    return AsfSkeleton(
        path=path,
        bones=_ordered_bones(path, sections),
        root_order=tuple(word.lower() for word in sections.root.get("order", ["TX", "TY", "TZ", "RX", "RY", "RZ"])),
        root_axis=euler_quaternion(orientation * sections.radians_per_unit, axis_order),
        root_position=np.array([float(word) for word in sections.root.get("position", ["0", "0", "0"])[:3]]),
        radians_per_unit=sections.radians_per_unit,
    )


def _read_sections(path: Path) -> _Sections:
    result, section = _Sections(), ""
    block: dict[str, list[str]] | None = None
    for number, line in enumerate(path.read_text(errors="replace").splitlines(), start=1):
        words = line.split("#")[0].split()
        if not words:
            continue
        if words[0].startswith(":"):
            section = words[0]
        elif section == ":units" and words[0] == "angle":
            result.radians_per_unit = _radians_per_angle(words, f"{path.name}, line {number}")
        elif section == ":root":
            result.root[words[0]] = words[1:]
        elif section == ":bonedata" and words[0] == "begin":
            block = {}
        elif section == ":bonedata" and words[0] == "end":
            bone = _raw_bone(block, f"{path.name}, line {number}")
            result.bones[bone.name], block = bone, None
        elif section == ":bonedata":
            if block is not None and words[0] in ("name", "direction", "length", "axis", "dof"):
                block[words[0]] = words[1:]
        elif section == ":hierarchy" and words[0] not in ("begin", "end"):
            result.parents |= dict.fromkeys(words[1:], words[0])
    if not result.bones:
        raise MocapError(f"{path.name}: no :bonedata with bones, so this is no ASF skeleton")
    return result


def _radians_per_angle(words: list[str], where: str) -> float:
    """From the unit that a skeleton gives its angles in; `where` it does begins every complaint."""
    if len(words) < 2:
        raise MocapError(f"{where}: angle should have a unit, deg or rad")
    unit = words[1].lower()
    if unit.startswith("deg"):
        return np.pi / 180
    if unit.startswith("rad"):
        return 1.0
    raise MocapError(f"{where}: angles are in deg or rad, not in “{words[1]}”")


def _raw_bone(block: dict[str, list[str]] | None, where: str) -> _RawBone:
    """The bone of a block; `where` it ends begins every complaint."""
    if block is None or not block.get("name"):
        raise MocapError(f"{where}: a bone without a name ends here")

    def numbers(words: list[str], count: int, what: str) -> NDArray[np.float64]:
        try:
            values = np.array([float(word) for word in words[:count]])
        except ValueError:
            values = np.empty(0)
        if len(values) < count or not np.all(np.isfinite(values)):
            raise MocapError(f"{where}: {what} should be {count} numbers, is “{' '.join(words)}”")
        return values

    name = block["name"][0]
    direction = numbers(block.get("direction", []), 3, f"the direction of {name}")
    length = float(numbers(block.get("length", []), 1, f"the length of {name}")[0])
    axis = block.get("axis", ["0", "0", "0", "XYZ"])
    norm = np.linalg.norm(direction)
    return _RawBone(
        name=name,
        direction=direction / norm if norm > 0 else direction,
        length=length,
        axis=numbers(axis, 3, f"the axis of {name}"),
        axis_order=axis[3] if len(axis) > 3 else "XYZ",
        dof=tuple(word.lower() for word in block.get("dof", [])),
    )


def _ordered_bones(path: Path, sections: _Sections) -> tuple[Bone, ...]:
    """Parents before children; bones that the hierarchy does not name are left out."""
    for child in sections.parents:
        if child not in sections.bones:
            raise MocapError(f"{path.name}: the hierarchy names “{child}”, but :bonedata has no such bone")
    bones: list[Bone] = []
    placed = {"root"}
    remaining = [bone for bone in sections.bones.values() if bone.name in sections.parents]
    while remaining:
        ready = [bone for bone in remaining if sections.parents[bone.name] in placed]
        if not ready:
            raise MocapError(f"{path.name}: the hierarchy does not lead from the root to {remaining[0].name}")
        for bone in ready:
            axis = euler_quaternion(bone.axis * sections.radians_per_unit, bone.axis_order)
            bones.append(Bone(bone.name, bone.direction, bone.length, axis, bone.dof, sections.parents[bone.name]))
            placed.add(bone.name)
        remaining = [bone for bone in remaining if bone.name not in placed]
    return tuple(bones)


def _read_channels(path: Path, skeleton: AsfSkeleton) -> tuple[NDArray[np.float64], float]:
    """All channels of a motion, [frames, channels], in the order root, then bones with freedom; and its angles' factor
    to radians.
    """
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
    radians_per_unit = skeleton.radians_per_unit

    def close(line_number: int) -> None:
        if started and len(seen) < len(expected):
            missing = next(name for name in expected if name not in seen)
            raise MocapError(f"{path.name}, line {line_number}: frame {started} ends without “{missing}”")

    with path.open(errors="replace") as lines:
        line_number = 0
        for line_number, line in enumerate(lines, start=1):
            words = line.split()
            if not words or words[0][0] == "#":
                continue
            if words[0][0] == ":":
                radians_per_unit = _RADIANS_PER_UNIT.get(words[0].upper(), radians_per_unit)
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
                raise MocapError(
                    f"{path.name}, line {line_number}: “{name}” is no bone with freedom in {skeleton.path.name}"
                )
            try:
                values = [float(word) for word in words[1:]]
            except ValueError:
                raise MocapError(
                    f"{path.name}, line {line_number}: “{line.strip()}” has something that is no number"
                ) from None
            if len(values) != count:
                raise MocapError(
                    f"{path.name}, line {line_number}: {name} has {len(values)} numbers, its skeleton says {count}"
                )
            row[offsets[name] : offsets[name] + count] = values
            seen.add(name)
        close(line_number)
    if not frames:
        raise MocapError(f"{path.name}: no frames")
    channels = np.array(frames)
    bad = np.flatnonzero(~np.all(np.isfinite(channels), axis=1))
    if len(bad):
        raise MocapError(f"{path.name}: frame {bad[0] + 1} has a number that is not finite")
    return channels, radians_per_unit


def _joint_names(skeleton: AsfSkeleton) -> tuple[str, ...]:
    return ("root", *(bone.name for bone in skeleton.bones), *(f"{bone.name}:end" for bone in skeleton.bones))


def parse_amc(path: Path, skeleton: AsfSkeleton, frame_rate: float | None = None) -> Motion:
    """Reads a motion of that skeleton; AMC carries no frame rate, so the caller gives it."""
    channels, radians_per_unit = _read_channels(path, skeleton)
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
            angles = (
                np.stack([values.get(name, np.zeros(frames)) for name in ("rx", "ry", "rz")], -1) * radians_per_unit
            )
            order = "".join(name[1] for name in values if name in ("rx", "ry", "rz"))
            motion = euler_quaternion(angles, order or "xyz")
            return quaternion.multiply(axis, quaternion.multiply(motion, quaternion.conjugate(axis)))

        root = take(skeleton.root_order)
        position = (
            np.stack([root.get(name, np.zeros(frames)) for name in ("tx", "ty", "tz")], -1) + skeleton.root_position
        )
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
        positions = np.stack(
            [starts["root"], *(starts[name] for name in order), *(ends[name] for name in order)], axis=1
        )
        turns = np.stack(
            [rotations["root"], *(rotations[name] for name in order), *(rotations[name] for name in order)], axis=1
        )
        return positions, turns

    rest, _ = pose(None)
    positions, rotations = pose(channels)
    assert positions.shape[0] == count
    return Motion(names, rest[0] - skeleton.root_position, positions, rotations, frame_rate)
