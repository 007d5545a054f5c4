"""Files of motion that the page's reader reads: BVH and VRM Animations, of any humanoid skeleton."""

import json
import os
import shutil
import subprocess
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from .motion import MocapError
from .prepared_corpus import JOINTS, LEG_JOINTS

_ROOT = Path(__file__).parents[2]
_READER = "scripts/motion/read-foreign.ts"

SUFFIXES = (".bvh", ".vrma")


@dataclass(frozen=True)
class ForeignMotion:
    """
    A motion in our joints, floor frame [m]: positions [frames, joints, 3], rotations of head and hands [frames, 3, 4],
    legs [frames, 8, 3] (NaN: not in the file), the rest pose by joint, and what was assumed, a sentence each.
    """

    positions: NDArray[np.float64]
    rotations: NDArray[np.float64]
    legs: NDArray[np.float64]
    rest: dict[str, NDArray[np.float64]]
    rate: float
    notes: tuple[str, ...]


def read_foreign(paths: Sequence[Path], skeleton_map: Path | None) -> dict[Path, ForeignMotion | MocapError]:
    """Reads files by the page's reader. A file that it refuses has the error with the reader's sentence."""
    if not paths:
        return {}
    node = os.environ.get("npm_node_execpath") or shutil.which("node")
    if node is None:
        raise MocapError("Node.js is needed to read BVH files, and there is none on the PATH")
    with tempfile.TemporaryDirectory() as out:
        request = {
            "files": [str(path.resolve()) for path in paths],
            "map": str(skeleton_map.resolve()) if skeleton_map else None,
            "out": out,
        }
        command = [node, "-C", "source", "--import", "tsx", _READER]
        done = subprocess.run(
            command, input=json.dumps(request), text=True, capture_output=True, cwd=_ROOT, check=False
        )
        if done.returncode != 0:
            raise MocapError(f"the reader of motion files failed: {done.stderr.strip() or done.returncode}")
        index = json.loads(Path(out, "index.json").read_text())
        return {
            path: _read(Path(out), number, found) for number, (path, found) in enumerate(zip(paths, index, strict=True))
        }


def _read(out: Path, number: int, found: dict[str, object]) -> ForeignMotion | MocapError:
    if "refused" in found:
        return MocapError(str(found["refused"]))
    positions = np.fromfile(out / f"{number}.positions").reshape(-1, len(JOINTS) + len(LEG_JOINTS), 3)
    rest = found["rest"]
    notes = found["notes"]
    assert isinstance(rest, dict)
    assert isinstance(notes, list)
    return ForeignMotion(
        positions=positions[:, : len(JOINTS)],
        rotations=np.fromfile(out / f"{number}.rotations").reshape(len(positions), -1, 4),
        legs=positions[:, len(JOINTS) :],
        rest={joint: np.array(at) for joint, at in rest.items()},
        rate=float(str(found["rateHz"])),
        notes=tuple(map(str, notes)),
    )
