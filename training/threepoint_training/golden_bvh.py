"""BVH files of skeletons that no one has, with where their joints are: the page's reader is held against ours by them.
"""

import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from .mocap_bvh import parse_bvh

# Parent, words for position and rotation channels: every order of axes, positions on inner joints, joints that do not
# move.
JOINTS: tuple[tuple[int, str, str], ...] = (
    (-1, "XYZ", "ZXY"),
    (0, "", "YXZ"),
    (1, "ZYX", "XYZ"),
    (2, "", ""),
    (0, "", "ZYX"),
    (4, "Y", "XZY"),
    (5, "", "YZX"),
    (0, "", "Z"),
)
FRAMES = 6


def _text(random: np.random.Generator) -> str:
    lines, numbers = ["HIERARCHY"], 0

    def write(index: int, depth: int) -> None:
        nonlocal numbers
        parent, places, turns = JOINTS[index]
        pad = "\t" * depth
        x, y, z = random.uniform(-2, 2, 3).round(4)
        channels = [f"{axis}position" for axis in places] + [f"{axis}rotation" for axis in turns]
        numbers += len(channels)
        lines.extend(
            [f"{pad}{'ROOT' if parent < 0 else 'JOINT'} joint {index}", pad + "{", f"{pad}  OFFSET {x} {y} {z}"]
        )
        lines.append(" ".join([f"{pad}  CHANNELS {len(channels)}", *channels]))
        children = [child for child, (of, *_) in enumerate(JOINTS) if of == index]
        for child in children:
            write(child, depth + 1)
        if not children:
            lines.extend([f"{pad}  End Site", pad + "  {", f"{pad}    OFFSET 0 {x} -0.5", pad + "  }"])
        lines.append(pad + "}")

    write(0, 0)
    lines += ["MOTION", f"Frames: {FRAMES}", "Frame Time: 0.0083333"]
    lines += [" ".join(str(value) for value in random.uniform(-180, 180, numbers).round(4)) for _ in range(FRAMES)]
    return "\n".join(lines) + "\n"


def bvh_vectors() -> list[dict[str, Any]]:
    """Some files, each with names, rate and every joint's position and rotation in every frame as our reader has them.
    """
    random = np.random.default_rng(2460)
    cases = []
    for _ in range(3):
        text = _text(random)
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "golden.bvh")
            path.write_text(text)
            motion = parse_bvh(path)
        cases.append(
            {
                "text": text,
                "names": list(motion.names),
                "frameRate": motion.frame_rate,
                "positions": motion.positions,
                "rotations": motion.rotations,
            }
        )
    return cases
